/* The golden pictures on the board: each country's image read from the flash by DMA, each flight
 * flown, each picture shown on the display for the host to look at. */
#include "addresses.h"
#include "board.h"
#include "console.h"
#include "fx/crc32c.h"
#include "golden_flash.h"
#include "golden_flight.h"
#include "look.h"
#include "psci.h"
#include "sections.h"

int main(void);

static ZCU102_BULK struct golden_rig rig;
static ZCU102_BULK uint8_t image[GOLDEN_IMAGE_BYTES_MAX];
static ZCU102_SHARED uint32_t scanned[DRV_DISPLAY_BUFFERS][GOLDEN_PIXELS_MAX];
static ZCU102_SHARED struct drv_display_scan scans[DRV_DISPLAY_BUFFERS];

static _Noreturn void fail(struct zcu102 *z, const char *words)
{
    zcu102_print(&z->console, words);
    zcu102_print(&z->console, "\n");
    zcu102_power_off();
}

static void read_flash(struct zcu102 *z, uint64_t offset, void *to, uint64_t length)
{
    const struct lm_flash *flash = &z->flash.port;
    int status = flash->read_start(flash->ctx, offset, to, (uint32_t)length);
    while (status == LM_OK && (status = flash->read_poll(flash->ctx)) == LM_BUSY) {
        status = LM_OK;
    }
    if (status != LM_OK) {
        fail(z, "the flash cannot be read");
    }
}

/* Print "RADAR name checksum". */
static void say_radar_checksum(struct zcu102 *z, const char *name)
{
    zcu102_print(&z->console, "RADAR ");
    zcu102_print(&z->console, name);
    zcu102_print(&z->console, " ");
    zcu102_print_hex(&z->console, golden_radar_checksum(&rig), 8);
    zcu102_print(&z->console, "\n");
}

static void show(struct zcu102 *z, const char *name)
{
    const struct drv_display_config config = {.dp = (drv_registers)DP_BASE,
                                              .dma = (drv_registers)DPDMA_BASE,
                                              .lanes = ZCU102_DISPLAY_LANES,
                                              .now_us = zcu102_now_us,
                                              .clock = &z->timer,
                                              .width_px = rig.board.display.width_px,
                                              .height_px = rig.board.display.height_px,
                                              .scans = scans};
    drv_display_open(&z->display, &config);
    look_show(&z->display, rig.glass);
    look(&z->console, &z->display, name);
}

int main(void)
{
    static struct zcu102 z;
    static struct golden_flash flash;
    zcu102_open(&z);
    for (uint32_t i = 0; i < DRV_DISPLAY_BUFFERS; i++) {
        scans[i].pixels = scanned[i];
    }
    read_flash(&z, 0, &flash, sizeof flash);
    if (flash.magic != GOLDEN_FLASH_MAGIC) {
        fail(&z, "the flash does not hold the golden images");
    }
    for (uint8_t place = 0; place < GOLDEN_PLACES; place++) {
        const uint64_t size = flash.places[place].size;
        if (size > sizeof image) {
            fail(&z, "an image is too large");
        }
        read_flash(&z, flash.places[place].offset, image, size);
        zcu102_print(&z.console, "image-");
        zcu102_print(&z.console, flash.places[place].name);
        zcu102_print(&z.console, " ");
        zcu102_print_hex(&z.console, fx_crc32c(0, image, size), 8);
        zcu102_print(&z.console, "\n");
        const struct golden_country country = {
            .centre = flash.places[place].centre, .image = image, .image_bytes = size};
        for (uint32_t i = 0; i < golden_picture_count; i++) {
            const struct golden_picture *p = &golden_pictures[i];
            if (p->place == place && golden_fly(&rig, p, &country) == LM_OK) {
                say_radar_checksum(&z, p->name);
                show(&z, p->name);
            }
        }
    }
    zcu102_print_value(&z.console, "stack-used", zcu102_stack_used());
    zcu102_power_off();
}
