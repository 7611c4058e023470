#include "look.h"

#include "console.h"
#include "drv/timer_generic.h"
#include "exception.h"
#include "fx/crc32c.h"

static const uint32_t *shown(const struct drv_display *display)
{
    return display->scans[display->presented % DRV_DISPLAY_BUFFERS].pixels;
}

static uint32_t pixels_of(const struct drv_display *display)
{
    return (uint32_t)display->port.width_px * display->port.height_px;
}

uint32_t look_checksum(const struct drv_display *display)
{
    uint32_t crc = 0;
    const uint32_t *const pixels = shown(display);
    for (uint32_t i = 0; i < pixels_of(display); i++) {
        const uint32_t pixel = pixels[i] >> DRV_DISPLAY_SHIFT;
        crc = fx_crc32c(crc, &pixel, sizeof pixel);
    }
    return crc;
}

void look_keep(const struct drv_display *display, uint32_t *pixels)
{
    for (uint32_t i = 0; i < pixels_of(display); i++) {
        pixels[i] = shown(display)[i] >> DRV_DISPLAY_SHIFT;
    }
}

void look_show(struct drv_display *display, const uint32_t *pixels)
{
    static const struct lm_damage unused;
    struct lm_surface surface;
    display->port.acquire(display, &surface);
    for (uint32_t i = 0; i < pixels_of(display); i++) {
        surface.pixels[i] = pixels[i] << surface.shift;
    }
    display->port.present(display, &unused);
}

void look(struct drv_uart *console, const struct drv_display *display, const char *name)
{
    zcu102_print(console, "LOOK ");
    zcu102_print(console, name);
    zcu102_print(console, " ");
    zcu102_print_hex(console, look_checksum(display), 8);
    zcu102_print(console, "\n");
    zcu102_mask_interrupts();
    while (drv_uart_get(console) < 0) {
        drv_timer_wait();
        zcu102_unmask_interrupts();
        zcu102_mask_interrupts();
    }
    zcu102_unmask_interrupts();
}
