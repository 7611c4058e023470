/* A panel behind Linux's Direct Rendering Manager: two buffers in the card's memory and a flip for
 * each picture, so that no picture is ever seen half drawn.
 *
 * The kernel is spoken to directly (linux/drm.h): nothing here allocates memory after the opening,
 * which libdrm cannot promise, and a screen that was unplugged comes back in the loop.
 *
 *   dark     no screen is connected, or it was lost; looked after once a second
 *   idle     the other buffer may be drawn in
 *   due      it is drawn; the kernel was busy and is asked again
 *   flipping the kernel has it; no other picture is taken until it says that it is on the screen
 *
 * A flip that is not reported within DRV_DRM_FLIP_US is given up and counted, and a kernel that
 * stays busy that long is told the mode anew: the picture goes on whatever gets lost. */
#ifndef DRV_DRM_H
#define DRV_DRM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drv/blit.h"

enum { DRV_DRM_FLIP_US = 200000, DRV_DRM_LOOK_US = 1000000, DRV_DRM_BUFFERS = 2 };

struct drv_drm_config {
    const char *device;           /* "/dev/dri/card0" */
    const char *connector;        /* "HDMI-A-1"; NULL: the first that is connected */
    uint16_t width_px, height_px; /* of the mode; 0: the one that the screen prefers */
    enum drv_format format;
    enum drv_turn turn;
};

enum drv_drm_state { DRV_DRM_DARK, DRV_DRM_IDLE, DRV_DRM_DUE, DRV_DRM_FLIPPING };

struct drv_drm_buffer {
    uint32_t handle, framebuffer; /* of the kernel; 0: none */
    size_t size_bytes;
    struct drv_target target;
};

struct drv_drm {
    int fd; /* -1: closed. For poll(): readable when a flip was reported */
    struct drv_drm_config config;
    enum drv_drm_state state;
    uint16_t width_px, height_px; /* of the screen; 0 until one was there */
    char connector[32];           /* the name of the one in use */
    uint32_t connector_id, crtc_id;
    struct drv_drm_buffer buffer[DRV_DRM_BUFFERS];
    uint8_t front;     /* the buffer that is shown */
    uint32_t sequence; /* of the last flip, to know a report that comes too late */
    uint64_t since_us; /* since when it is due or flipping */
    uint64_t look_us;  /* when to look after the screen again */
    struct {
        uint32_t crtc_id, framebuffer, x, y;
        bool has_mode;
        char mode[68]; /* struct drm_mode_modeinfo */
    } before;          /* what the screen showed, for the end */
    char error[160];

    struct {
        uint32_t flips;         /* pictures that the kernel reported on the screen */
        uint32_t busy;          /* times that it was asked in vain */
        uint32_t lost;          /* flips never reported */
        uint32_t late;          /* reports of flips that were given up */
        uint32_t errors;        /* flips refused for another cause */
        uint32_t lit, darkened; /* times that a screen was set up, and lost */
    } count;
};

/* Open the device and light a screen if one is connected. LM_OK also when none is: then d->state
 * is dark and the rest comes about in drv_drm_service. LM_ERR_IO with d->error saying why and
 * nothing open. The strings of the config stay borrowed. */
int drv_drm_open(struct drv_drm *d, const struct drv_drm_config *config, uint64_t now_us);

/* Give the screen back to whoever had it, and everything to the kernel. Safe on one that is
 * closed. */
void drv_drm_close(struct drv_drm *d);

/* Take the reports of the kernel, give up what takes too long, look after the screen. Never waits,
 * but for the mode of a screen that was plugged in: the kernel reads its description (some 10 ms).
 */
void drv_drm_service(struct drv_drm *d, uint64_t now_us);

/* Copy the picture and ask for the flip. LM_OK: taken (or seen by nobody, when the screen is dark);
 * LM_BUSY: the last one is not on the screen yet; LM_ERR_IO: the kernel refused it. */
int drv_drm_present(struct drv_drm *d, const struct lm_surface *picture, uint64_t now_us);

#endif
