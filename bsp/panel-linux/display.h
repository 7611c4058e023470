/* The panel's glass: a DRM screen, a frame buffer, or nothing, behind the firmware's display. */
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
    struct lm_surface picture; /* what the firmware draws in; its pixels are owned */
    struct lm_display port;
    uint64_t now_us;
    uint64_t retry_us; /* when to look for a device again */
    bool was_lit;      /* as it was reported last */

    struct {
        uint32_t pictures; /* that the firmware handed over */
        uint32_t renders;  /* of them on the glass, or seen by nobody because there is no glass */
    } count;
};

/* Open the glass that the config names, and decide the size of the picture. A glass that is not
 * there is reported and looked for again once a second. 0, or -1 without memory. */
int glass_open(struct glass *g, const struct config *config, uint64_t now_us);
void glass_close(struct glass *g);

/* At every step, before the firmware's. */
void glass_service(struct glass *g, uint64_t now_us);

/* For poll(): readable when a picture has come to be seen; -1: no such thing. */
int glass_fd(const struct glass *g);

/* Whether somebody could see a picture. */
bool glass_is_lit(const struct glass *g);

uint32_t glass_renders(const struct glass *g);

#endif
