/* Targets in a SAR patch: every body is a point that is spread over cells and lines by the point
 * response. Found once for the patch, added line by line. docs/EQUATIONS.md, "Point response" and
 * "Targets". */
#ifndef LM_TARGET_PATCH_H
#define LM_TARGET_PATCH_H

#include "lm/chip_patch.h"
#include "lm/response.h"
#include "lm/scan_line.h"
#include "lm/smear.h"
#include "lm/target_view.h"

enum { LM_PATCH_SCATTERERS_MAX = LM_TARGET_CANDIDATES_MAX * LM_SCATTERERS_MAX };

/* The patch as targets need to know it. Lengths in metres * 256. */
struct lm_patch_geometry {
    struct lm_position centre;
    fx_bam_t look;
    uint32_t centre_m_q8; /* ground range from the antenna to the centre */
    uint32_t cell_m_q8, lines, cells;
    uint32_t guard; /* of the cells: that lie before the patch */
    uint32_t first; /* cells before this are not shown */
    struct lm_target_heights heights;
    uint32_t wavelength_um;
    int32_t across_mm_s; /* the radar's velocity to the right of the line of sight; 0 displaces
                            nothing */
    int32_t lean_q16;    /* layover: cells nearer for each metre of height above the reference, by
                            the metre; 0: none */
    uint32_t dwell_ms;   /* below 2^17: how long movers smear */
    uint32_t epoch;      /* for what fluctuates */
};

/* A body in the patch. Places in cells * 256 from the middle of cell 0 of line 0. */
struct lm_patch_scatterer {
    int32_t across_cells_q8, along_cells_q8;
    int32_t level_db_q8; /* dB of gamma, were all its power in one cell */
    fx_bam_t phase;
    int64_t tangent_q38; /* at which it appears */
    int32_t line, cell;  /* that hold its place on the ground */
    uint8_t target;      /* whose body it is: index in lm_target_patch.target */
    bool is_displaced;   /* by Doppler: it may appear on a line before its own */
    bool is_hidden;
    bool is_chip; /* the place and level of one, not to be spread itself */
};

/* A target near the patch. Its bodies add as phasors. */
struct lm_patch_target {
    struct lm_smear smear;
    uint32_t begin, end;           /* its points */
    bool has_scatterers, has_chip; /* to be spread; in their place or beside them */
};

/* The chip of a target in the patch. */
struct lm_patch_chip {
    struct lm_chip_patch patch;
    uint32_t scatterer;             /* its place, and whether it is hidden */
    int32_t shadow_across_cells_q8; /* where its shadow lies: Doppler does not displace that */
    int32_t area_dbm2_q8;           /* of a cell of clutter there, dB * 256 of a square metre */
};

/* Cells of a line that are given something of chips, so that its cost is bounded. */
enum { LM_CHIP_CELLS_A_LINE = 1024 };

struct lm_target_patch {
    uint32_t scatterer_count;
    struct lm_patch_scatterer scatterer[LM_PATCH_SCATTERERS_MAX];
    uint32_t target_count;
    struct lm_patch_target target[LM_TARGET_CANDIDATES_MAX];
    struct lm_patch_chip chip[LM_TARGET_CANDIDATES_MAX]; /* of the targets that have one */
    /* Most lines of a patch pass by most targets: bit n of a line is set if target n, or a body of
     * it, stands on the line or may touch it with its power or its chip's shadow. */
    uint32_t on_line[LM_CELLS_MAX];
    int32_t re_q24[LM_CELLS_ROOM], im_q24[LM_CELLS_ROOM]; /* zero between calls */
};

_Static_assert(LM_TARGET_CANDIDATES_MAX <= 32, "a bit each");

/* No targets. */
void lm_target_patch_clear(struct lm_target_patch *p);

/* Find the points of the targets near, and their chips. Cost: some 3000 instructions for each
 * target and 1200 for each of its bodies. */
void lm_target_patch_set(struct lm_target_patch *p, const struct lm_target_candidates *candidates,
                         const struct lm_patch_geometry *g);

/* Note which points something nearer hides: those that stand on line `line`, whose horizons before
 * its cells are `horizon`, times 2^bits (0..38). Points beside the patch are not hidden. */
void lm_target_patch_mark_hidden(struct lm_target_patch *p, uint32_t line, const int32_t *horizon,
                                 uint32_t bits, uint32_t cells);

/* Add the points to the levels of line `line`, cells first..cells - 1. What stays below
 * `least_db_q8` is left out. Cost: 200 instructions for a point that reaches the line and 25 for
 * each cell that it reaches, at most 17; up to LM_SMEAR_SLICES times as much for one that moves,
 * and for as many more cells as its response is stretched. */
void lm_target_patch_add_scatterers(struct lm_target_patch *p, uint32_t line, int32_t least_db_q8,
                                    const struct lm_patch_geometry *g, int32_t *level_db_q8);

/* Put the ground of line `line` that lies in the chips' shadows into the dark: behind layover,
 * before speckle and noise. A hidden target throws none. Cost: 200 instructions for each cell under
 * a chip. */
void lm_target_patch_shade(const struct lm_target_patch *p, uint32_t line,
                           const struct lm_patch_geometry *g, int32_t *level_db_q8);

/* Add the chips to the levels of line `line`, whose shadows are in, each slice of a mover's smear
 * by itself. A chip is the mean of many scatterers in every pixel, unlike a point: speckle and
 * noise come behind it. Returns how many cells were left out to bound the cost: 250 instructions
 * for each cell under a slice, of LM_CHIP_CELLS_A_LINE at most. */
uint32_t lm_target_patch_add_chips(const struct lm_target_patch *p, uint32_t line,
                                   const struct lm_patch_geometry *g, int32_t *level_db_q8);

#endif
