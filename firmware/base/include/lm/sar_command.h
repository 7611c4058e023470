/* SAR command: the request for a patch, with its place and the antenna's.
 *
 * Limits are checked by lm_sar_start (lm/sar.h). Law: docs/EQUATIONS.md, "Synthetic aperture". */
#ifndef LM_SAR_COMMAND_H
#define LM_SAR_COMMAND_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/geo.h"

/* A square patch around a position. The antenna is where the ownship is when the command comes, or,
 * for training and tests, at a commanded range, azimuth and height.
 *
 *            ^ look_azimuth
 *        +---|---+
 *        |   o   |  centre
 *        +---|---+
 *            |      range_m
 *            o  antenna, at height_m_q6 */
struct lm_sar_command {
    struct lm_position centre;
    uint32_t cell_mm;      /* side of a cell, within the radar table's limits */
    bool is_plan;          /* no layover: high ground and tops are where they are (lm/layover.h) */
    bool is_steady;        /* no defocus from unsteady flight (lm/defocus.h) */
    bool is_from_ownship;  /* true: ignore the three members below */
    fx_bam_t look_azimuth; /* from the antenna to the patch */
    uint32_t range_m;      /* from the antenna to the centre, along the ground: 1,000..250,000 */
    int32_t height_m_q6;   /* of the antenna above mean sea level, below 30 km */
};

#endif
