/* Rain of a patch: loss of rain between the antenna and a SAR patch, and the echo of rain over it.
 *
 * The echo is not focused: it is smeared over the beam. It is computed at stations, directions a
 * sixteenth of a beam apart, and is linear between them:
 *
 *     patch        |                          |
 *     lines        | | | | | | | | | | | | | ||
 *     stations  --s-----s-----s-----s-----s-----s--    s apart: beam / 16
 *                       \  ^  /
 *                     veil[0], veil[1] of the line in between
 *
 * Order of the calls: _find and _set once for a patch, _run for each line from left to right,
 * _weaken once its targets are found. No call fails. Source: docs/EQUATIONS.md, "Rain over a
 * patch". */
#ifndef LM_PATCH_RAIN_H
#define LM_PATCH_RAIN_H

#include "lm/illumination.h"
#include "lm/target_patch.h"
#include "lm/weather.h"

/* Veil: noise plus the rain's echo along one direction, averaged over the beam around it. */
struct lm_rain_veil {
    int32_t station; /* direction: sixteenths of a beam to the right of the line of sight */
    bool is_set;
    int32_t level_db_q8[LM_CELLS_ROOM]; /* dB of gamma */
};

/* Showers that a patch meets, and their effect on it. The caller owns it. */
struct lm_patch_rain {
    uint32_t count; /* of showers; 0: fair weather, and the other fields are not set */
    struct lm_shower shower[LM_RAINS_MAX];
    uint32_t slant_q16; /* metres along the ray for each metre along the ground; 1 or more */
    int32_t beam;       /* width of the beam in azimuth, signed BAM, > 0 */
    int32_t noise_db_q8;
    int32_t volume_db_q8[LM_CELLS_ROOM]; /* volume of each cell's rain over its clutter area, dB */
    struct lm_rain_veil veil[2];         /* of the stations on either side of the line */
    /* Work space. */
    int32_t loss_db_q8[LM_CELLS_ROOM];
    int32_t left[LM_CELLS_ROOM], right[LM_CELLS_ROOM]; /* edges of a circle, signed BAM */
    uint64_t power_q32[LM_CELLS_ROOM];
};

/* Find the circles of rain of `environment` (NULL: none), seen from `antenna`. `azimuth` is the
 * direction to the patch's centre, from north. Nothing is borrowed after the call. Cost: nothing in
 * fair weather, 800 instructions for each circle. */
void lm_patch_rain_find(struct lm_patch_rain *p, const struct lm_environment *environment,
                        const struct lm_radar *radar, struct lm_position antenna, fx_bam_t azimuth);

/* Keep the showers that reach a line of the patch or the beam around it, and compute the patch's
 * constants. `noise_db_q8` is the patch's noise, dB of gamma. May be called again when heights
 * change. Cost: nothing in fair weather, else 150 instructions a cell. */
void lm_patch_rain_set(struct lm_patch_rain *p, const struct lm_radar *radar,
                       const struct lm_patch_geometry *geometry, int32_t noise_db_q8);

/* Compute the levels of line `line` from its clutter: less the loss, plus the veil (rain and
 * noise). Only for p->count > 0. Both arrays have geometry->cells entries.
 *
 * Cost: 12 instructions a cell, and 13 for each circle that the line meets. At each new station,
 * 800 a cell for each circle; a patch of 5 m cells 40 km away is nine stations wide. */
void lm_patch_rain_run(struct lm_patch_rain *p, const struct lm_patch_geometry *geometry,
                       uint32_t line, const int16_t *clutter_db_q8, int16_t *level_db_q8);

/* Attenuate the scatterers by the rain before them. Chips are attenuated by lm_patch_rain_run,
 * because they are in the lines' levels. */
void lm_patch_rain_weaken(const struct lm_patch_rain *p, const struct lm_patch_geometry *geometry,
                          struct lm_target_patch *target_patch);

#endif
