/* The radar parameter table: every number that belongs to the radar and not to the display. An
 * integrator replaces the table (firmware/src/radar.c), not the code. */
#ifndef LM_RADAR_H
#define LM_RADAR_H

#include <stdint.h>

#include "fx/types.h"
#include "lm/aspect.h"
#include "lm/speckle.h"
#include "lm/tone.h"

enum { LM_RANGES = 4, LM_AZIMUTHS = 3 };

struct lm_radar {
    uint32_t range_m[LM_RANGES];        /* display scales */
    uint16_t range_nm[LM_RANGES];       /* the same, as the pilot reads them */
    fx_bam_t azimuth_half[LM_AZIMUTHS]; /* of the sector: A6, A3, A1 */
    uint32_t wavelength_um;             /* LM_WAVELENGTH_MIN_UM..MAX_UM (lm/rcs.h) */
    uint32_t sweep_bam_per_ms;          /* GM antenna rate */
    uint16_t gm_cells;                  /* range cells of a GM line */
    fx_bam_t gm_line;                   /* azimuth width of a GM line */
    uint16_t sar_cells;                 /* of a patch, both ways */
    uint16_t sar_lines_per_s;           /* how fast a patch builds up */
    uint32_t sar_cell_min_mm, sar_cell_max_mm;
    struct lm_aspect_config aspect;
    struct lm_speckle_config gm_speckle, sar_speckle;
    struct lm_tone_config gm_tone, sar_tone;
};

extern const struct lm_radar lm_radar_default;

#endif
