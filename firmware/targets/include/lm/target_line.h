/* Targets in a line of a sector: which of them the line meets, in which cells, and at what level.
 * lm/target_patch.h does the same for a patch. Source: docs/EQUATIONS.md, "Targets" and "Movers".
 */
#ifndef LM_TARGET_LINE_H
#define LM_TARGET_LINE_H

#include "lm/target_view.h"

/* Line of a sector: one sampled azimuth, with what targets need to know of it. */
struct lm_target_line {
    struct lm_position position;           /* of the antenna */
    fx_bam_t azimuth;                      /* from north, of the line's middle */
    fx_bam_t width;                        /* from the middle of a line to that of the next */
    uint32_t first_m_q8, cell_m_q8, cells; /* as given to lm_range_grid_set */
    uint32_t first;                        /* cells before this one are not displayed */
    int32_t height_m_q10, reference_m_q10; /* antenna, and flat ground of the receiver's gain */
    uint32_t wavelength_um;
    bool is_doppler;        /* true if azimuth is measured by Doppler, which displaces movers */
    fx_bam_t beam;          /* one-way half-power width of the antenna in azimuth */
    uint32_t speed_mm_s;    /* speed of the antenna over the ground */
    fx_bam_t track;         /* direction of that speed */
    uint32_t gate_mm_s[2];  /* least and greatest closing speed displayed, of either sign; the least
                               is lm_mover_clutter_mm_s where that is more; [1] = 0: every target is
                               displayed */
    uint32_t stretch_cells; /* cells before and behind its own that a target also fills, so that it
                               is seen; then it is a point even if it has a chip */
    uint32_t scan, pulse;   /* number of the sweep and of the line: they choose random draws */
    int16_t *clutter_db_q8; /* borrowed for the call: levels of the ground, which chips darken and
                               add to; NULL: those of the scatterers */
    const int32_t *elevation_m_q14; /* borrowed for the call: of the ground in each cell, above mean
                                       sea level; NULL: level, as high as each target's origin */
};

/* Horizon of a line, which hides targets. `horizon[i]` is the largest tangent at which a cell
 * before cell i appears, times 2^bits; `bits` is 0..38. `horizon` is borrowed for the call. */
struct lm_target_horizon {
    const int32_t *horizon;
    uint32_t bits;
};

/* Add the returns of targets to the levels of a line's cells. Returns the number of additions.
 *
 * - A cross section sigma counts as gamma = sigma / (w ds g) in a cell of width w, length ds and
 *   grazing g of flat ground.
 * - A scatterer between two lines shares its power between them, so that the beam's mean of both
 *   has its middle at the scatterer.
 * - A scatterer is hidden if it appears below the horizon before its own cell. A displaced mover is
 *   tested where it appears. `horizon` NULL hides nothing.
 *
 * `candidates` was selected for this sweep, from a checked set. All pointers are borrowed for the
 * call. Cost: 250 instructions, and 20 for each candidate; for those that the line may touch, some
 * 2000 more each and 1100 for each of their scatterers. */
uint32_t lm_target_line_add(const struct lm_target_candidates *candidates,
                            const struct lm_target_line *line,
                            const struct lm_target_horizon *horizon, int16_t *level_db_q8);

/* Beacon that a line's interrogation meets, and that sees the antenna. */
struct lm_target_reply {
    uint32_t range_m_q8; /* along the ground */
    uint32_t cell;       /* of the line */
    uint32_t share_q24;  /* of the line in it, as of an echo; up to 2^24 */
    uint8_t code;        /* as lm_target.signature has it */
};

/* Find the beacons among the candidates that the line meets and the horizon does not hide, with the
 * positions that their echoes would have. Returns their number. Cost: 250 instructions, 20 for each
 * candidate, and some 1,800 for each beacon near the line. */
uint32_t lm_target_line_replies(const struct lm_target_candidates *candidates,
                                const struct lm_target_line *line,
                                const struct lm_target_horizon *horizon,
                                struct lm_target_reply reply[LM_TARGET_CANDIDATES_MAX]);

#endif
