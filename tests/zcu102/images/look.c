#include "look.h"

#include "console.h"
#include "drv/timer_generic.h"
#include "exception.h"
#include "fx/crc32c.h"

uint32_t look_checksum(const struct drv_display *display)
{
    const struct lm_display *port = &display->port;
    return fx_crc32c(0, display->drawn, (size_t)port->width_px * port->height_px * 4);
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
