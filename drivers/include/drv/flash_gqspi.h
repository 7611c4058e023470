/* Quad-SPI flash: serial flash behind the generic quad-SPI controller of Zynq UltraScale+, as
 * struct lm_flash, read by the controller's DMA. Registers and sequences: UG1085, chapter 24, and
 * UG1087, module QSPI; commands: data sheet of the N25Q512A (Micron), "quad output fast read,
 * 4-byte address" (6Ch) and "read identification" (9Fh).
 *
 * There is one device on the lower bus, or two of one kind on both buses, which are read as one.
 * The lower device then holds the first half of the image.
 *
 * A read goes through a buffer that DMA and core share uncached, so the firmware's destination may
 * be anywhere and of any length. Nothing waits: read_start queues one command for up to
 * DRV_FLASH_PIECE bytes; read_poll copies them when they have come, and queues the next command.
 *
 * Tested in QEMU: contents, lengths and offsets of all kinds, the end of the device, an absent
 * device. Its DMA takes no time, so a read that stays busy is tested on registers in memory
 * (tests/unit/drivers/test_zynqmp_devices.c). NOT tested: clock phases on a real board. */
#ifndef DRV_FLASH_GQSPI_H
#define DRV_FLASH_GQSPI_H

#include <stdbool.h>

#include "drv/registers.h"
#include "lm/port.h"

enum {
    DRV_FLASH_PIECE = 32768,
    DRV_FLASH_TIMEOUT_US = 100000 /* for a piece, which takes 2 ms at the slowest clock in use */
};

struct drv_flash {
    drv_registers base;
    uint64_t (*now_us)(const void *clock);
    const void *clock;       /* borrowed */
    volatile uint8_t *piece; /* borrowed: DRV_FLASH_PIECE bytes, 64-byte aligned, not cached */
    uint64_t device_bytes;   /* of each device */
    struct {
        uint8_t *to;
        uint64_t offset;
        uint32_t left;  /* bytes still to come, including the present piece */
        uint32_t piece; /* bytes of the present piece */
        uint32_t skip;  /* bytes of the piece before the first that was asked for */
        uint64_t deadline_us;
    } now;
    struct lm_flash
        port; /* hand this to the firmware; its ctx is this struct, which must not move */
    struct {
        uint32_t pieces, timeouts;
    } count;
};

struct drv_flash_config {
    drv_registers base;
    volatile uint8_t *piece;
    uint64_t (*now_us)(const void *clock);
    const void *clock;
};

/* Identify the devices. Buffer and clock of the config stay borrowed. Returns LM_OK; or LM_ERR_IO
 * iff no device answers on the lower bus, or it is of another kind. The port then has size 0, and
 * every read fails with LM_ERR_RANGE. */
int drv_flash_open(struct drv_flash *f, const struct drv_flash_config *config);

#endif
