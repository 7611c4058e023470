/* Targets in a SAR patch: each scatterer is spread over cells and lines by the point response. They
 * are found once for the patch and added line by line.
 *
 * Order of the calls:
 * - for the patch: lm_target_patch_set;
 * - for the lines that chips stand on: lm_target_patch_lean;
 * - for each scatterer, when terrain's hiding of chips is known: lm_target_patch_mark_shaded;
 * - for each line, before layover: lm_target_patch_shade;
 * - for each line, before speckle and noise: lm_target_patch_add_chips;
 * - for each line, when its horizon is known: lm_target_patch_mark_hidden;
 * - for each line, after speckle and noise: lm_target_patch_add_scatterers.
 *
 * No call fails. Source: docs/EQUATIONS.md, "Point response", "Targets" and "Signatures".
 *
 *     line 0                                 lines - 1
 *         \                                      /   cell `cells` - 1
 *          \                 ^ look             /
 *           \                |                 /
 *            \            centre              /
 *             \                              /
 *              \----------------------------/     cell 0
 *
 *                         antenna, centre_m_q8 from the centre
 *
 * Lines are rays from the antenna. A point x to the right of the line of sight through the centre
 * and s away from the antenna along it lies on line x S / s / ds, counted from the middle, with S
 * the centre's range and ds a cell. */
#ifndef LM_TARGET_PATCH_H
#define LM_TARGET_PATCH_H

#include "lm/chip_patch.h"
#include "lm/chip_slope.h"
#include "lm/response.h"
#include "lm/scan_line.h"
#include "lm/smear.h"
#include "lm/target_view.h"

enum { LM_PATCH_SCATTERERS_MAX = LM_TARGET_CANDIDATES_MAX * LM_SCATTERERS_MAX };

/* Lines of a patch: twice as many as cells for one that begins half-way to its centre. */
enum { LM_PATCH_LINES_MAX = 2 * LM_CELLS_MAX };

/* Geometry of a patch: what targets need to know of it. */
struct lm_patch_geometry {
    struct lm_position centre;
    fx_bam_t look;        /* azimuth of the line of sight to the centre, from north */
    uint32_t centre_m_q8; /* ground range from the antenna to the centre */
    uint32_t cell_m_q8, lines, cells;
    uint32_t overscan; /* cells that are traced before those, and not counted here */
    uint32_t traced;   /* all that are traced: overscan, patch, overscan behind it */
    uint32_t first;    /* cells before this one are not displayed */
    struct lm_target_heights heights;
    uint32_t wavelength_um;
    int32_t across_mm_s; /* the radar's velocity to the right of the line of sight; 0 displaces
                            nothing */
    int32_t lean_q16;    /* layover: metres nearer for each metre of height above the reference; 0:
                            no layover */
    uint32_t dwell_ms;   /* below 2^17; movers smear for so long */
    uint32_t epoch;      /* chooses the random draws of fluctuating targets */
};

/* Scatterer in a patch, or a whole target that is one point. Coordinates are from the middle of
 * cell 0 of line 0. `across` and `along` are where it is displayed, Doppler and layover included;
 * `line` and `cell` hold its true position on the ground, and may lie outside the patch. */
struct lm_patch_scatterer {
    int32_t across_cells_q8, along_cells_q8;
    int32_t level_db_q8; /* dB of gamma, if all its power were in one cell */
    fx_bam_t phase;
    int64_t tangent_q38; /* tangent of elevation at which it appears */
    int32_t line, cell;
    uint8_t target;            /* its target: index in lm_target_patch.target */
    bool is_displaced;         /* by Doppler: it may appear on a line before its own */
    bool is_hidden, is_shaded; /* by anything; by another target's chip */
    bool is_chip;              /* it stands for a chip, and is not spread itself */
};

/* Target in or near a patch. Its scatterers add as phasors. */
struct lm_patch_target {
    struct lm_smear smear;
    uint32_t begin, end; /* its scatterers, from `begin` to before `end` */
    bool has_scatterers, has_chip;
};

/* Chip of a target in a patch. */
struct lm_patch_chip {
    struct lm_chip_patch patch;
    uint32_t scatterer; /* index of the scatterer that has its position and whether it is hidden */
    int32_t shadow_across_cells_q8; /* of the true origin: Doppler does not displace a shadow */
    int32_t shadow_along_cells_q8;  /* likewise, and layover moves it with the ground */
    int32_t area_dbm2_q8;           /* area of a clutter cell there */
    int32_t range_m_q8;             /* of the true origin, along the look */
    struct lm_chip_slope slope;
};

/* Most cells of a line that chips are added to. It bounds the line's cost. */
enum { LM_CHIP_CELLS_A_LINE = 1024 };

/* Targets of a patch. The caller owns it; all fields are read-only to others. The chips' slots are
 * borrowed until the next lm_target_patch_set or _clear. */
struct lm_target_patch {
    uint32_t scatterer_count;
    struct lm_patch_scatterer scatterer[LM_PATCH_SCATTERERS_MAX];
    uint32_t target_count;
    struct lm_patch_target target[LM_TARGET_CANDIDATES_MAX];
    struct lm_patch_chip chip[LM_TARGET_CANDIDATES_MAX]; /* same index as target; if it has_chip */
    /* Targets of each line. Bit n is set if target n or one of its scatterers is on the line, or
     * may touch the line with its power or its chip's shadow. Most lines have few bits. */
    uint32_t on_line[LM_PATCH_LINES_MAX];
    int32_t re_q24[LM_CELLS_ROOM], im_q24[LM_CELLS_ROOM]; /* scratch: zero between calls */
};

_Static_assert(LM_TARGET_CANDIDATES_MAX <= 32, "a bit each");

/* Remove all targets. */
void lm_target_patch_clear(struct lm_target_patch *p);

/* Compute scatterers and chips of the candidates. Earlier ones are removed. Candidates whose
 * position cannot be computed (lm_target_view_locate) are left out. Cost: some 3000 instructions
 * for each target and 1200 for each scatterer. */
void lm_target_patch_set(struct lm_target_patch *p, const struct lm_target_candidates *candidates,
                         const struct lm_patch_geometry *g);

/* Mark the scatterers of line `line` that nearer terrain hides. `horizon` holds the horizon before
 * each cell, times 2^bits (0..38), in `cells` + 1 entries. Scatterers beside the patch and
 * before its first cell stay visible. */
void lm_target_patch_mark_hidden(struct lm_target_patch *p, uint32_t line, const int32_t *horizon,
                                 uint32_t bits, uint32_t cells);

/* Take the slope that chips stand on along line `line`, if they stand on this one. A chip whose
 * line is not shown stands on level ground. `elevation_m_q14` is that of the ground in cell 0; the
 * line has elevations from g->overscan cells before it on, g->traced in all. */
void lm_target_patch_lean(struct lm_target_patch *p, uint32_t line, const int32_t *elevation_m_q14,
                          const struct lm_patch_geometry *g);

/* Mark scatterer `number` if it stands in the shadow of another target's chip, and no higher than
 * the ray above it. A chip that terrain hides shades nothing. True if a chip's shadow was looked
 * at. Cost: for each chip that is looked at 200 instructions. */
bool lm_target_patch_mark_shaded(struct lm_target_patch *p, uint32_t number,
                                 const struct lm_patch_geometry *g);

/* Add the scatterers to the levels of line `line`, from cell g->first to g->cells - 1. What stays
 * below `least_db_q8` is left out. Cost: 200 instructions for a scatterer that reaches the line,
 * and 25 for each cell that it reaches, at most 17. A mover costs up to LM_SMEAR_SLICES times as
 * much, and more cells as its response is stretched. */
void lm_target_patch_add_scatterers(struct lm_target_patch *p, uint32_t line, int32_t least_db_q8,
                                    const struct lm_patch_geometry *g, int16_t *level_db_q8);

/* Darken the ground of line `line` in the shadows of chips, as far as it rises above the rays that
 * pass over them, or falls below. Call it before layover, which moves dark ground like other
 * ground, and before speckle and noise. A hidden target has no shadow. Elevations are as in
 * lm_target_patch_lean, and levels lie likewise. Cost: 200 instructions for each cell in or about a
 * shadow, 20 for each behind it as long as the ground falls as a ray does. */
void lm_target_patch_shade(const struct lm_target_patch *p, uint32_t line,
                           const struct lm_patch_geometry *g, const int32_t *elevation_m_q14,
                           int16_t *level_db_q8);

/* Add the chips to the levels of line `line`, each slice of a mover's smear separately. Call it
 * after layover, and before speckle and noise: each pixel of a chip is the mean of many scatterers,
 * as clutter is. Where the ground leans away from the radar a chip is longer, and where it leans
 * across it is sheared; of a displaced mover the ground across is not known. Elevations are as in
 * lm_target_patch_lean. Returns how many cells were left out because the line had
 * LM_CHIP_CELLS_A_LINE. Cost: 250 instructions for each cell under a slice. */
uint32_t lm_target_patch_add_chips(const struct lm_target_patch *p, uint32_t line,
                                   const struct lm_patch_geometry *g,
                                   const int32_t *elevation_m_q14, int16_t *level_db_q8);

#endif
