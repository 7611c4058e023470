/* The request for a SAR patch: where it lies and from where it is seen. */
#ifndef LM_SAR_COMMAND_H
#define LM_SAR_COMMAND_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/geo.h"

/* A patch of cells x cells around a place. Either seen from where the ownship is when the command
 * comes, or, for training and tests, from a commanded range and heading. */
struct lm_sar_command {
    struct lm_position centre;
    uint32_t cell_mm;      /* within the radar table's limits */
    bool has_layover;      /* what stands high is displayed nearer */
    bool is_steady;        /* unsteady flight leaves no blur */
    bool is_from_ownship;  /* then the rest is ignored */
    fx_bam_t look_azimuth; /* from the radar to the patch */
    uint32_t range_m;      /* along the ground, 1,000..250,000 */
    int32_t height_m_q6;   /* of the antenna, metres * 64 above mean sea level, below 30 km */
};

#endif
