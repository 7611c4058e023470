/* Targets for tests: made from metres and degrees. */
#ifndef TARGET_SUPPORT_H
#define TARGET_SUPPORT_H

#include "fx/crc32c.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "lm/target.h"

#include <math.h>
#include <string.h>

#define X_BAND_UM 31228u /* 9.6 GHz */

static inline void seal_target(struct lm_target *t)
{
    t->crc = fx_crc32c(0, (const uint8_t *)t + 4, LM_TARGET_BYTES - 4);
}

/* A steady point of so many dBsm. */
static inline struct lm_target point_at(double latitude, double longitude, double elevation_m,
                                        double rcs_db)
{
    struct lm_target t = {.id = 7,
                          .latitude = hs_bam(latitude),
                          .longitude = hs_bam(longitude),
                          .elevation_m_q6 = (int32_t)lround(elevation_m * 64),
                          .mean_rcs_dbsm_q8 = (int32_t)lround(rcs_db * 256)};
    seal_target(&t);
    return t;
}

static inline void add_scatterer(struct lm_target *t, uint8_t kind, uint32_t size_mm,
                                 int32_t forward_mm, int32_t right_mm, int32_t up_mm,
                                 double azimuth_deg, double elevation_deg)
{
    t->scatterers[t->scatterer_count++] =
        (struct lm_scatterer){.kind = kind,
                              .size_mm = {size_mm, size_mm},
                              .offset_mm = {forward_mm, right_mm, up_mm},
                              .azimuth = hs_bam(azimuth_deg),
                              .elevation = hs_bam(elevation_deg)};
    seal_target(t);
}

/* Any sound target: up to 16 bodies of any kind, anywhere that the record allows. */
static inline struct lm_target random_target(struct hs_rng *r, int32_t extent_mm)
{
    struct lm_target t = {.id = hs_rng_below(r, 1000), .heading = (fx_bam_t)hs_rng_u64(r)};
    const uint32_t count = 1 + hs_rng_below(r, LM_SCATTERERS_MAX);
    const uint32_t span = (uint32_t)(2 * extent_mm + 1);
    for (uint32_t i = 0; i < count; i++) {
        const double elevation_deg = 180 * hs_rng_uniform(r) - 90;
        const double azimuth_deg = 360 * hs_rng_uniform(r);
        const int32_t up_mm = (int32_t)hs_rng_below(r, span) - extent_mm;
        const int32_t right_mm = (int32_t)hs_rng_below(r, span) - extent_mm;
        const int32_t forward_mm = (int32_t)hs_rng_below(r, span) - extent_mm;
        const uint32_t size_mm = 50 + hs_rng_below(r, 800);
        const uint8_t kind = (uint8_t)(1 + hs_rng_below(r, LM_SHAPE_KINDS - 1));
        add_scatterer(&t, kind, size_mm, forward_mm, right_mm, up_mm, azimuth_deg, elevation_deg);
        t.scatterers[i].roll = (fx_bam_t)hs_rng_u64(r);
        t.scatterers[i].is_two_sided = hs_rng_below(r, 2) != 0;
    }
    seal_target(&t);
    return t;
}

/* Change one to six of its bytes and seal it again, as a hostile image might have it. Whether it
 * still passes the check. */
static inline bool damage_target(struct hs_rng *r, struct lm_target *t)
{
    uint8_t *bytes = (uint8_t *)t;
    for (uint32_t k = 1 + hs_rng_below(r, 6); k > 0; k--) {
        const uint32_t place = 4 + hs_rng_below(r, LM_TARGET_BYTES - 4);
        bytes[place] = (uint8_t)hs_rng_u64(r);
    }
    seal_target(t);
    return lm_target_check(t) == LM_OK;
}

#endif
