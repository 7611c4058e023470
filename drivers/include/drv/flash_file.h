/* File flash: an image in a file, or an MTD device that can be read as a file, as struct lm_flash.
 * read_start waits for the file. */
#ifndef DRV_FLASH_FILE_H
#define DRV_FLASH_FILE_H

#include "lm/port.h"

struct drv_flash_file {
    int descriptor;
    int last_status; /* result that read_poll returns */
    struct lm_flash
        port; /* hand this to the firmware; its ctx is this struct, which must not move */
};

/* Open `path` for reading. Returns 0; or the errno of the failure, with nothing open. */
int drv_flash_file_open(struct drv_flash_file *f, const char *path);
void drv_flash_file_close(struct drv_flash_file *f);

#endif
