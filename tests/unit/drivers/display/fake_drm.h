/* A display card for tests, in the place of the kernel's: link with FAKE_DRM_WRAPS. Buffers are
 * real memory that a test may look at; reports come when the test says so. */
#ifndef FAKE_DRM_H
#define FAKE_DRM_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { FAKE_DRM_BUFFERS = 8, FAKE_DRM_EVENTS = 8, FAKE_DRM_CLIPS = 64, FAKE_DRM_WORDS = 1 << 19 };

/* Parts of a buffer, as struct drm_mode_rect. */
struct fake_drm_clips {
    int32_t rectangle[FAKE_DRM_CLIPS][4];
    uint32_t count; /* 0: all of it */
};

struct fake_drm {
    /* What the test sets. */
    bool has_screen, has_dumb, is_foreign; /* foreign: another program holds the screen */
    uint16_t width, height;                /* of the preferred mode */
    uint32_t extra_modes;                  /* listed before it */
    int flip_errno;                        /* what page flips answer; 0: they work */
    int interrupts;                        /* so many calls are interrupted by a signal first */
    bool is_silent;                        /* flips are never reported */
    bool takes_clips;                      /* an atomic card with FB_DAMAGE_CLIPS */
    int atomic_errno;                      /* what its flips answer; 0: they work */

    /* What it has seen. */
    uint32_t modes_set, flips, probes, masters;
    uint32_t shown; /* framebuffer on the screen */
    uint32_t handle_of_shown;
    uint32_t live_buffers, live_framebuffers, live_blobs;
    uint64_t copied_px;         /* within clips */
    struct fake_drm_clips blob; /* the one that was made last */
    struct {
        uint64_t user_data;
        uint32_t framebuffer;
        struct fake_drm_clips clips;
    } pending[FAKE_DRM_EVENTS];
    uint32_t pending_count;
    uint8_t reports[512];
    size_t report_bytes;
    struct fake_drm_buffer {
        uint32_t *pixels;
        size_t size;
        uint32_t width, height, bpp;
    } buffer[FAKE_DRM_BUFFERS]; /* handle n is n - 1 */
    uint32_t handle_of_framebuffer[FAKE_DRM_BUFFERS];
    /* What cards show that copy the clips: to one memory, and to one for each buffer. */
    uint32_t screen[FAKE_DRM_WORDS], copy[FAKE_DRM_BUFFERS][FAKE_DRM_WORDS];
};

extern struct fake_drm fake_drm;

/* As after power-up: a screen of 640 x 480 whose console is shown as framebuffer 99. */
void fake_drm_reset(void);

/* The next vertical blank: the flips that wait come on the screen and are reported. */
void fake_drm_blank(void);

#endif
