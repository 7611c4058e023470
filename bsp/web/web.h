/* The board of a browser, as its files share it. */
#ifndef WEB_WEB_H
#define WEB_WEB_H

#include "drv/control_ring.h"
#include "exports.h"
#include "lm/unit.h"
#include "replay.h"

enum { WEB_SIDE_MIN_PX = 256, WEB_SIDE_MAX_PX = 1024, WEB_FRAMES = 512 };

/* Those of a live unit, or of a replay, which lays its own out in them. */
enum { WEB_SURFACES = 1 + REPLAY_BUFFERS };

/* Frames on their way in. The page puts them in, a step takes them out. */
struct web_frame_ring {
    struct lm_can_frame frame[WEB_FRAMES];
    uint32_t head, tail;
};

struct web {
    struct lm_unit unit;
    struct lm_board board;
    struct lm_flash flash;
    struct lm_can can;
    struct lm_controls controls;
    struct lm_display display; /* of a replay its size alone */
    struct web_frame_ring frames;
    struct drv_control_ring acts;
    struct lm_damage stale; /* what the canvas has not been given yet */
    uint32_t pictures, frames_lost, acts_lost;
    bool is_replay;
    struct replay replay;
};

extern struct web web;
extern struct lm_tile web_pool[LM_TILE_SLOTS_MAX];
extern uint8_t web_plane[WEB_SIDE_MAX_PX * WEB_SIDE_MAX_PX];
extern uint32_t web_surface[WEB_SURFACES][WEB_SIDE_MAX_PX * WEB_SIDE_MAX_PX];

/* The flash's port, whose ctx is struct web. */
int web_read_start(void *ctx, uint64_t offset, void *destination, uint32_t length);
int web_read_poll(void *ctx);

/* The picture shown last. */
const uint32_t *web_glass(void);

/* The values of a replay; -1 for others. */
double web_replay_value(enum web_value which);

#endif
