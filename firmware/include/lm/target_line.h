/* Targets in a line of the picture: which of them a line meets, in which cells, and how bright.
 * docs/DESIGN.md, "Targets". */
#ifndef LM_TARGET_LINE_H
#define LM_TARGET_LINE_H

#include "lm/target.h"

enum {
    LM_TARGETS_NEAR = 32,    /* that one sweep or patch takes up */
    LM_TARGET_DRIFT_M = 1024 /* the antenna's way until they are chosen again */
};

/* Power addition of two levels in 1/256 dB. Worst error 0.02 dB. Cost: about 80 instructions. */
int32_t lm_level_add_q8(int32_t a_q8, int32_t b_q8);

/* The targets of an image, as they were read. */
struct lm_target_set {
    const struct lm_target *items; /* borrowed, checked */
    uint32_t count;
};

/* The targets within reach of a sweep or patch. Chosen once for it, so that a line looks at few. */
struct lm_targets_near {
    bool is_chosen;        /* false: not yet */
    struct lm_place place; /* from where */
    uint32_t count;
    uint32_t left_out; /* in reach, but there was no room */
    struct {
        uint16_t index;
        fx_bam_t azimuth;     /* from the place that was given */
        uint32_t distance_q8; /* metres * 256 */
    } item[LM_TARGETS_NEAR];
};

/* Choose among `count` (up to 65535) targets those not farther than reach_m + LM_TARGET_DRIFT_M
 * from `place`: the antenna and the range for a sweep, the centre and half the diagonal for a
 * patch. The first LM_TARGETS_NEAR of them, in their order in the image. reach_m up to 250 km.
 * Cost: about 500 instructions a target. */
void lm_targets_select(struct lm_targets_near *near, const struct lm_target *targets,
                       uint32_t count, struct lm_place place, uint32_t reach_m);

/* Choose anew unless that was done from within LM_TARGET_DRIFT_M of `place`. */
void lm_targets_refresh(struct lm_targets_near *near, const struct lm_target_set *targets,
                        struct lm_place place, uint32_t reach_m);

/* A line of the picture as targets need to know it. Lengths in metres * 256, heights * 1024. */
struct lm_target_line {
    bool is_patch; /* a line of a SAR patch; else of a sector that fans out from the antenna */
    struct lm_place place; /* the antenna; the centre of the patch */
    fx_bam_t azimuth;      /* of the line's middle; of the patch's line of sight */
    fx_bam_t width;        /* sector: of the line */
    int32_t across_q8;     /* patch: of the line's middle from the patch's, right positive */
    uint32_t centre_q8;    /* patch: ground range from the antenna to the centre */
    uint32_t first_q8, cell_q8, cells; /* as lm_range_grid_set has them */
    uint32_t first;                    /* cells before this are not shown */
    int32_t height_q10, reference_q10; /* antenna; flat ground of the time gain */
    uint32_t wavelength_um;
    uint32_t scan, pulse; /* for what fluctuates: number of the sweep or patch, and of the line */
};

/* What hides a target: the horizon before each cell of the line, the largest tangent at which a
 * nearer cell appears, times 2^bits (38..62). */
struct lm_target_sight {
    const int64_t *horizon;
    uint32_t bits;
};

/* Add what the targets return to the levels of a line's cells: a cross section sigma in a cell of
 * width w, length ds and flat-ground grazing g counts as gamma = sigma / (w ds g). A scatterer
 * below the horizon of the cells before its own is hidden; `sight` NULL hides nothing. `targets`
 * are checked records, `near` was chosen for this sweep or patch. Returns how many times a cell was
 * given something. Cost: 70 instructions for each target near; some 2700 and 1100 a scatterer for
 * those that the line may touch. */
uint32_t lm_target_add(const struct lm_target *targets, const struct lm_targets_near *near,
                       const struct lm_target_line *line, const struct lm_target_sight *sight,
                       int32_t *level_q8);

#endif
