/* Display of the panel: a DRM screen, a frame buffer, or nothing, behind struct lm_display. */
#ifndef PANEL_DISPLAY_H
#define PANEL_DISPLAY_H

#include "config.h"
#include "drv/drm.h"
#include "drv/fbdev.h"
#include "lm/port.h"

enum glass_kind { GLASS_NONE, GLASS_DRM, GLASS_FBDEV };

struct glass {
    const struct config *config; /* borrowed */
    enum glass_kind kind;
    struct drv_drm drm;
    struct drv_fbdev fbdev;
    struct lm_surface picture; /* memory that the firmware draws in; its pixels are owned */
    struct lm_display port;    /* port for the firmware */
    uint64_t now_us;           /* time of the present step */
    uint64_t retry_us;         /* time of the next look for a device */
    bool was_lit;              /* glass_is_lit as reported last */

    struct {
        uint32_t pictures; /* frames that the firmware presented */
        uint32_t renders;  /* frames shown, or dropped because there is no display */
    } count;
};

/* Open the display that the config names, and choose the size of the picture. A display that is
 * missing is reported and looked for once a second. Returns 0; or -1 if there is no memory. */
int glass_open(struct glass *g, const struct config *config, uint64_t now_us);

/* Close the display and free the picture. */
void glass_close(struct glass *g);

/* Look for the device, and take its reports. Call before each step of the firmware. */
void glass_service(struct glass *g, uint64_t now_us);

/* File descriptor for poll(): readable when a frame was shown; -1: the device has no reports. */
int glass_fd(const struct glass *g);

/* True if a frame would be seen. */
bool glass_is_lit(const struct glass *g);

/* Count of frames shown, for lm/liveness.h. */
uint32_t glass_renders(const struct glass *g);

#endif
