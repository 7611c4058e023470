/* Rain between the antenna and a SAR patch, and over it. docs/EQUATIONS.md, "Rain over a patch". */
#ifndef LM_PATCH_RAIN_H
#define LM_PATCH_RAIN_H

#include "lm/illumination.h"
#include "lm/target_patch.h"
#include "lm/weather.h"

/* Noise and the rain's return along one direction, over the beam around it. */
struct lm_rain_veil {
    int32_t station; /* sixteenths of a beam to the right of the line of sight */
    bool is_set;
    int32_t level_db_q8[LM_CELLS_ROOM]; /* dB of gamma */
};

/* The circles of rain that a patch meets, and what they do to it. */
struct lm_patch_rain {
    uint32_t count; /* 0: fair, and the rest means nothing */
    struct lm_shower shower[LM_RAINS_MAX];
    uint32_t slant_q16; /* metres of the way for each metre along the ground, >= 1 */
    int32_t beam;       /* signed BAM, > 0 */
    int32_t noise_db_q8;
    int32_t volume_db_q8[LM_CELLS_ROOM]; /* of each cell's rain over its clutter's area, dB */
    struct lm_rain_veil veil[2];         /* of the stations on either side of the line */
    /* Scratch. */
    int32_t loss_db_q8[LM_CELLS_ROOM];
    int32_t left[LM_CELLS_ROOM], right[LM_CELLS_ROOM]; /* edges of a circle, signed BAM */
    uint64_t power_q32[LM_CELLS_ROOM];
};

/* Find the circles of `environment` (NULL: none) as seen from `antenna`, which has the patch's
 * centre in direction `azimuth`. Cost: nothing in fair weather, 800 instructions for each circle.
 */
void lm_patch_rain_find(struct lm_patch_rain *p, const struct lm_environment *environment,
                        const struct lm_radar *radar, struct lm_position antenna, fx_bam_t azimuth);

/* Keep those that reach a line of the patch or the beam about it, for a patch whose noise is
 * `noise_db_q8`. May be called again when heights change. Cost: nothing in fair weather, else 150
 * instructions a cell. */
void lm_patch_rain_set(struct lm_patch_rain *p, const struct lm_radar *radar,
                       const struct lm_patch_geometry *geometry, int32_t noise_db_q8);

/* Put rain and noise over the clutter of line `line`: its levels; for a patch whose count is not 0.
 * Cost: 12 instructions a cell, and 13 for each circle that the line meets. Once in a sixteenth of
 * a beam (a patch of 5 m cells 40 km away is nine of them wide), 800 a cell for each circle. */
void lm_patch_rain_run(struct lm_patch_rain *p, const struct lm_patch_geometry *geometry,
                       uint32_t line, const int32_t *clutter_db_q8, int32_t *level_db_q8);

/* Weaken the points by the rain before them. (Chips are in the lines' levels already.) */
void lm_patch_rain_weaken(const struct lm_patch_rain *p, const struct lm_patch_geometry *geometry,
                          struct lm_target_patch *target_patch);

#endif
