/* Targets in a line of a sector: which of them a line meets, in which cells, and how bright. Those
 * of a patch: lm/target_patch.h. docs/EQUATIONS.md, "Targets". */
#ifndef LM_TARGET_LINE_H
#define LM_TARGET_LINE_H

#include "lm/speckle.h"
#include "lm/target_view.h"

/* A line of the sector as targets need to know it. Lengths in metres * 256, heights * 1024. */
struct lm_target_line {
    struct lm_position position;           /* the antenna */
    fx_bam_t azimuth;                      /* of the line's middle */
    fx_bam_t width;                        /* from the middle of a line to that of the next */
    uint32_t first_m_q8, cell_m_q8, cells; /* as lm_range_grid_set has them */
    uint32_t first;                        /* cells before this are not shown */
    int32_t height_m_q10, reference_m_q10; /* antenna; flat ground of the time gain */
    uint32_t wavelength_um;
    bool is_doppler;     /* directions are told by Doppler: movers are displaced */
    fx_bam_t beam;       /* the antenna's one-way half-power width, likewise */
    uint32_t speed_mm_s; /* of the antenna over the ground, and which way */
    fx_bam_t track;
    uint32_t gate_mm_s[2]; /* closing speeds, either way, that are shown; [1] is 0: all */
    uint32_t scan, pulse;  /* for what fluctuates: number of the sweep, and of the line */
    const struct lm_noise_key
        *noise_key; /* borrowed: of the cells' speckle, for chips; NULL: none */
    struct lm_speckle_config speckle;
};

/* What hides a target: the horizon before each cell of the line, the largest tangent at which a
 * nearer cell appears, times 2^bits (0..38). */
struct lm_target_horizon {
    const int32_t *horizon;
    uint32_t bits;
};

/* Add what the targets return to the levels of a line's cells: a cross section sigma in a cell of
 * width w, length ds and flat-ground grazing g counts as gamma = sigma / (w ds g). The two lines
 * that a scatterer lies between share its power, so that their mean stands where it is. A scatterer
 * below the horizon of the cells before its own is hidden; `horizon` NULL hides nothing; a mover is
 * looked for where it appears. `targets` are checked records, `candidates` was chosen for this
 * sweep or patch. Returns how many times a cell was given something. Cost: 250 instructions, 20 for
 * each target near; some 2000 and 1100 a scatterer for those that the line may touch. */
uint32_t lm_target_line_add(const struct lm_target_candidates *candidates,
                            const struct lm_target_line *line,
                            const struct lm_target_horizon *horizon, int32_t *level_db_q8);

#endif
