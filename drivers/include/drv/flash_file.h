/* Flash that is a file: the bench's image, or an MTD device that can be read as one. */
#ifndef DRV_FLASH_FILE_H
#define DRV_FLASH_FILE_H

#include "lm/port.h"

struct drv_flash_file {
    int descriptor;
    int last_status; /* of the read that read_poll will report */
    struct lm_flash
        port; /* hand this to the firmware; its ctx is this struct, which must not move */
};

/* Open `path` for reading. Returns 0, or the errno of what failed with nothing open. */
int drv_flash_file_open(struct drv_flash_file *f, const char *path);
void drv_flash_file_close(struct drv_flash_file *f);

#endif
