/* Finding a screen and its mode among what the kernel offers. Private to the DRM driver. */
#ifndef DRM_SCREEN_H
#define DRM_SCREEN_H

#include <stdbool.h>
#include <stdint.h>

#include <drm.h>
#include <drm_mode.h>

#include "drv/drm.h"

/* ioctl() that is begun again when a signal interrupted it. 0 or -1 with errno. */
int drm_call(int fd, unsigned long request, void *argument);

struct drm_screen {
    uint32_t connector_id, crtc_id;
    struct drm_mode_modeinfo mode;
    char name[32]; /* of the connector */
};

/* Find a connected screen that the config accepts, its mode and a controller for it. The kernel
 * reads the screen's description: some 10 ms. NULL, or the cause why there is none. */
const char *drm_screen_find(int fd, const struct drv_drm_config *config, struct drm_screen *screen);

/* Find the plane that shows the controller's picture, if it takes clips of what changed: only then
 * are its id and those of its properties not 0. `*plane` is set in any case. */
void drm_screen_find_plane(int fd, uint32_t crtc_id, struct drv_drm_plane *plane);

/* True if the connector still has a screen, as far as the kernel has noticed. Costs nothing. */
bool drm_screen_is_there(int fd, uint32_t connector_id);

#endif
