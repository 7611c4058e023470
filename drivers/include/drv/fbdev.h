/* A panel behind the older frame buffer device: for kernels whose display has no DRM driver. */
#ifndef DRV_FBDEV_H
#define DRV_FBDEV_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drv/blit.h"

struct drv_fbdev {
    int fd; /* -1: closed */
    void *bytes;
    size_t size_bytes;
    struct drv_target target; /* all of the visible screen */
    bool can_pan;             /* the memory holds two pictures: no picture is seen half drawn */
    uint32_t shown;           /* 0 or 1: the picture that is visible */
    enum drv_turn turn;
    char error[160];

    struct {
        uint32_t pictures;
        uint32_t errors; /* the kernel refused to show the other picture */
    } count;
};

/* Map the screen of `device` ("/dev/fb0") and make it black; the format is the device's own. LM_OK,
 * or LM_ERR_IO with f->error saying why and nothing open. */
int drv_fbdev_open(struct drv_fbdev *f, const char *device, enum drv_turn turn);
void drv_fbdev_close(struct drv_fbdev *f);

/* Copy the picture to the screen. Waits for no vertical blank: some drivers never report one.
 * LM_OK or LM_ERR_IO. */
int drv_fbdev_present(struct drv_fbdev *f, const struct lm_surface *picture);

#endif
