/* Frame buffer: a panel behind Linux's older frame buffer device, for displays without a DRM
 * driver. */
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
    struct drv_target target; /* the visible screen */
    bool can_pan;             /* the memory holds two pictures; none is shown half drawn */
    uint32_t shown;           /* 0 or 1: the picture that is shown */
    enum drv_turn turn;
    char error[160];

    struct {
        uint32_t pictures;
        uint32_t errors; /* the kernel refused to show the other picture */
    } count;
};

/* Map the screen of `device` ("/dev/fb0") and make it black. The format is the device's. Returns
 * LM_OK; or LM_ERR_IO, with the cause in f->error and nothing open. */
int drv_fbdev_open(struct drv_fbdev *f, const char *device, enum drv_turn turn);
/* Unmap and close. Safe on one that is closed. */
void drv_fbdev_close(struct drv_fbdev *f);

/* Copy the picture to the screen. Does not wait for the vertical blank, which some drivers never
 * report. Returns LM_OK; or LM_ERR_IO: the kernel refused to show the other picture. */
int drv_fbdev_present(struct drv_fbdev *f, const struct lm_surface *picture);

#endif
