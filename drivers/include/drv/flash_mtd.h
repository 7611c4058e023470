/* MTD flash: NOR or NAND flash behind Linux's MTD character device ("/dev/mtd0"), read only.
 *
 * On NAND the image must be stored as nandwrite stores it: bad blocks are skipped, and the image
 * continues in the next good block. The map of good blocks is made when the device is opened. */
#ifndef DRV_FLASH_MTD_H
#define DRV_FLASH_MTD_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

struct drv_flash_mtd {
    int fd;               /* -1: closed */
    uint32_t block_bytes; /* size of an erase block */
    uint32_t *blocks; /* owned; blocks[n] is the device's block that holds block n of the image */
    uint32_t block_count; /* good blocks */
    bool has_ecc;    /* the device corrects errors, and counts those that it could not correct */
    int last_status; /* result that read_poll returns */
    struct lm_flash port; /* its ctx is this struct, which must not move. Reads wait for the
                             device; a loop reads through a drv_flash_reader */

    struct {
        uint32_t bad_blocks;
        uint32_t corrected;     /* reads with corrected bits */
        uint32_t uncorrectable; /* reads with bits that could not be corrected */
        uint32_t errors;        /* reads that failed for another cause */
    } count;
};

/* Open `path`. Returns 0, ENOTTY when it is no MTD device (an ordinary file, another device), or
 * the errno of what failed; then nothing is open. Asks the device about each of its blocks. */
int drv_flash_mtd_open(struct drv_flash_mtd *f, const char *path);
void drv_flash_mtd_close(struct drv_flash_mtd *f);

#endif
