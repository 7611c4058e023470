/* A SAR patch of 256 x 256 cells with every effect, all tiles resident, for benchmarks: on a PC
 * (stage_bench.c) and on a microcontroller (tests/cortex-m7/bench.c). Nothing is allocated. */
#ifndef PATCH_RIG_H
#define PATCH_RIG_H

#include "lm/sar.h"
#include "lm/scan_conv.h"
#include "memory_flash.h"

enum {
    PATCH_RIG_PX = 512, /* the glass is a square; a patch has 366 x 366 pixels of it */
    PATCH_RIG_CELL_MM = 5000,
    PATCH_RIG_TILES = 400,
};

struct patch_rig {
    struct memory_flash flash;
    struct lm_db db;
    struct lm_tile_cache tiles;
    struct lm_signature signature;
    struct lm_chips chips;
    struct lm_tone tone;
    struct lm_line line;
    struct lm_plane plane;
    struct lm_frame frame;
    struct lm_patch_painter painter;
    struct lm_sar sar;
};

/* An image in memory, or wherever `fetch` finds it (may be NULL). `pool` has room for
 * PATCH_RIG_TILES tiles, `pixels` PATCH_RIG_PX squared zeros; both are borrowed. LM_OK, or why
 * not. */
int patch_rig_open(struct patch_rig *r, const uint8_t *image, size_t image_bytes,
                   memory_flash_fetch *fetch, void *pool, uint8_t *pixels);

/* Serve flash and chips until nothing is asked for. */
void patch_rig_make_resident(struct patch_rig *r);

/* Begin a patch in the middle of the image, seen from 20 km, and read what it needs. `targets` may
 * be NULL. LM_OK, or why not. */
int patch_rig_begin(struct patch_rig *r, const struct lm_target_set *targets, uint32_t cell_mm);

/* Draw its lines; `paints`: and paint them. */
void patch_rig_draw(struct patch_rig *r, bool paints);

#endif
