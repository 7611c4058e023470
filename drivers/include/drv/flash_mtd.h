/* Flash behind Linux's MTD character device ("/dev/mtd0"), read only, NOR or NAND.
 *
 * On NAND an image lies as nandwrite leaves it: blocks that are marked bad are left out, and the
 * image goes on in the next good one. The map of good blocks is made when the device is opened. */
#ifndef DRV_FLASH_MTD_H
#define DRV_FLASH_MTD_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

struct drv_flash_mtd {
    int fd;               /* -1: closed */
    uint32_t block_bytes; /* of an erase block */
    uint32_t *blocks;     /* owned: number of the good block that is n-th in the image */
    uint32_t block_count; /* good ones */
    bool has_ecc;         /* the device corrects errors and counts those it could not */
    int last_status;      /* of the read that read_poll will report */
    struct lm_flash port; /* its ctx is this struct, which must not move. Reading waits for the
                             device: put a drv_flash_reader in front of it for a loop */

    struct {
        uint32_t bad_blocks;
        uint32_t corrected;     /* reads in which bits were put right */
        uint32_t uncorrectable; /* reads in which they could not be */
        uint32_t errors;        /* reads that failed otherwise */
    } count;
};

/* Open `path`. Returns 0, ENOTTY when it is no MTD device (an ordinary file, another device), or
 * the errno of what failed; then nothing is open. Asks the device about each of its blocks. */
int drv_flash_mtd_open(struct drv_flash_mtd *f, const char *path);
void drv_flash_mtd_close(struct drv_flash_mtd *f);

#endif
