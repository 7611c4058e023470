/* DRM display: a panel behind Linux's Direct Rendering Manager. It has two buffers in the card's
 * memory and a flip for each picture, so no picture is shown half drawn.
 *
 * It uses the kernel's interface (linux/drm.h) without libdrm, which allocates memory: nothing is
 * allocated here after drv_drm_open. A screen that was unplugged is set up again in the loop.
 *
 *   state     meaning
 *   dark      no screen is connected, or it was lost; it is looked for once a second
 *   idle      the buffer that is not shown may be drawn in
 *   due       that buffer is drawn, and the kernel was busy: the flip is asked for again
 *   flipping  the kernel has the flip; no picture is taken until it reports it done
 *
 * Where the card takes clips (FB_DAMAGE_CLIPS of an atomic driver), a flip tells which parts of the
 * buffer were drawn since it was shown last. They hold what changed since the picture before, too:
 * a card that keeps a copy of each buffer, and one that keeps a copy of the screen, both get all.
 * The first flip of each buffer after the mode was set has no clips; nor has any after a refusal.
 *
 * A flip that is not reported within DRV_DRM_FLIP_US is given up and counted. If the kernel stays
 * busy for that long, the mode is set again. So a lost report does not stop the picture. */
#ifndef DRV_DRM_H
#define DRV_DRM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drv/blit.h"

enum {
    DRV_DRM_FLIP_US = 200000,
    DRV_DRM_LOOK_US = 1000000,
    DRV_DRM_BUFFERS = 2,
    DRV_DRM_CLIPS = 32
};

struct drv_drm_config {
    const char *device;           /* "/dev/dri/card0" */
    const char *connector;        /* "HDMI-A-1"; NULL: the first that is connected */
    uint16_t width_px, height_px; /* of the mode; 0: the one that the screen prefers */
    enum drv_format format;
    enum drv_turn turn;
};

enum drv_drm_state { DRV_DRM_DARK, DRV_DRM_IDLE, DRV_DRM_DUE, DRV_DRM_FLIPPING };

struct drv_drm_buffer {
    uint32_t handle, framebuffer; /* names that the kernel gave; 0: none */
    size_t size_bytes;
    struct drv_target target;
    struct lm_damage lacks; /* blocks that changed since the buffer was drawn */
};

/* The plane that shows the picture, and its properties, by the kernel's numbers; 0: it takes no
 * clips. */
struct drv_drm_plane {
    uint32_t id, picture, clips;
};

struct drv_drm {
    int fd; /* -1: closed; else for poll(): readable when a flip was reported */
    struct drv_drm_config config;
    enum drv_drm_state state;
    uint16_t width_px, height_px; /* of the screen; 0 until one was connected */
    char connector[32];           /* name of the connector in use */
    uint32_t connector_id, crtc_id;
    struct drv_drm_buffer buffer[DRV_DRM_BUFFERS];
    struct drv_drm_plane plane;
    struct lm_rectangle clip[DRV_DRM_CLIPS]; /* of the flip that is due: where its buffer changed */
    uint32_t clips;
    uint8_t whole;     /* so many flips are still to be made without clips */
    uint8_t front;     /* the buffer that is shown */
    uint32_t sequence; /* number of the last flip, to recognise late reports */
    uint64_t since_us; /* time since when the state is due or flipping */
    uint64_t look_us;  /* time of the next look for a screen */
    struct {
        uint32_t crtc_id, framebuffer, x, y;
        bool has_mode;
        char mode[68]; /* struct drm_mode_modeinfo */
    } before;          /* what the screen showed at the start; drv_drm_close restores it */
    char error[160];

    struct {
        uint32_t flips;         /* flips that the kernel reported done */
        uint32_t clipped;       /* flips asked for with clips */
        uint32_t busy;          /* flips that a busy kernel refused */
        uint32_t lost;          /* flips never reported */
        uint32_t late;          /* reports of flips that were given up */
        uint32_t errors;        /* flips refused for another cause */
        uint32_t lit, darkened; /* times that a screen was set up, and was lost */
    } count;
};

/* Open the device, and set up a screen if one is connected. The config is copied; its strings stay
 * borrowed. Returns
 * - LM_OK, also if no screen is connected: d->state is then dark;
 * - LM_ERR_IO: the cause is in d->error, and nothing is open. */
int drv_drm_open(struct drv_drm *d, const struct drv_drm_config *config, uint64_t now_us);

/* Restore what the screen showed before, and free everything. Safe on one that is closed. */
void drv_drm_close(struct drv_drm *d);

/* Take the kernel's reports, give up overdue flips, and look for the screen. Call in every step.
 * Never waits, except some 10 ms when a screen is plugged in: the kernel reads its description. */
void drv_drm_service(struct drv_drm *d, uint64_t now_us);

/* Copy what the buffer lacks of the picture and ask for the flip. The picture differs from that of
 * the call before within the blocks of *changed, whatever that call returned. Returns
 * - LM_OK: taken; or dropped, because the state is dark;
 * - LM_BUSY: the last picture is not shown yet, and this one was not taken;
 * - LM_ERR_IO: the kernel refused the flip. */
int drv_drm_present(struct drv_drm *d, const struct lm_surface *picture,
                    const struct lm_damage *changed, uint64_t now_us);

#endif
