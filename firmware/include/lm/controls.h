/* What an operator can do, whatever he does it with: a key, a script or a hand controller. */
#ifndef LM_CONTROLS_H
#define LM_CONTROLS_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/geo.h"

enum lm_control_kind {
    LM_CONTROL_GM,      /* ground map */
    LM_CONTROL_SAR,     /* a patch: see `sar` */
    LM_CONTROL_RANGE,   /* value: 0..LM_RANGES - 1 */
    LM_CONTROL_AZIMUTH, /* value: 0..LM_AZIMUTHS - 1 */
    LM_CONTROL_GAIN,    /* value: decibels brighter than the table says, -30..30 */
    LM_CONTROL_FREEZE   /* value: 1 on, 0 off */
};

/* A patch of cells x cells around a place. Either seen from where the ownship is when the command
 * comes, or, for training and tests, from a commanded range and heading. */
struct lm_sar_command {
    struct lm_place centre;
    uint32_t cell_mm;      /* within the radar table's limits */
    bool is_from_ownship;  /* then the rest is ignored */
    fx_bam_t look_azimuth; /* from the radar to the patch */
    uint32_t range_m;      /* along the ground, 1,000..250,000 */
    int32_t height_q6;     /* of the antenna, metres * 64 above mean sea level, below 30 km */
};

struct lm_control {
    enum lm_control_kind kind;
    int32_t value;
    struct lm_sar_command sar;
};

#endif
