#include "lm/target_near.h"

#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/scan_line.h"

const struct lm_signature *lm_target_signature(const struct lm_target_set *set,
                                               const struct lm_target *t)
{
    const bool has_one = (t->flags & LM_TARGET_HAS_SIGNATURE) &&
                         t->signature < set->signature_count &&
                         set->signatures[t->signature].aspects != 0;
    return has_one ? &set->signatures[t->signature] : NULL;
}

static int32_t elevation_q6(const struct lm_target *t, struct lm_place place,
                            const struct lm_target_scene *scene)
{
    if (!(t->flags & LM_TARGET_ABOVE_GROUND)) {
        return t->elevation_q6;
    }
    /* Ground within 2^20, as the tiles are held to, and so is the height above it. */
    const int32_t ground_q10 = scene->tiles
                                   ? lm_scan_elevation(scene->tiles, scene->level, place,
                                                       scene->tiles->db->mean_elevation_q6 * 16)
                                   : 0;
    return t->elevation_q6 + ground_q10 / 16;
}

/* How well the place of a target is known to whoever looks for it: lm_geo_inverse and a plane are
 * right within this part of the distance, up to 75 degrees of latitude and then up to 88; and so
 * is a plane, within 16 m, for the way that the antenna has gone since. */
static uint32_t rough_q8(struct lm_place from, uint32_t distance_q8)
{
    const bool is_polar = fx_abs_u32((int32_t)from.latitude) > FX_BAM_DEG(75);
    return distance_q8 / (is_polar ? 64 : 256) + 16 * 256;
}

/* A circle that holds the target, metres * 256: bodies by both of their axes together, below 2^19
 * mm; a chip by its far corners, which are up to 32 columns and 64 rows away. */
static uint32_t extent_q8(const struct lm_target_set *set, const struct lm_target *t)
{
    const struct lm_signature *s = lm_target_signature(set, t);
    uint32_t most_mm = s ? s->pixel_mm * (LM_CHIP_SIDE * 9 / 8) : 0;
    for (uint32_t i = 0; i < t->scatterer_count; i++) {
        const int32_t *o = t->scatterers[i].offset_mm;
        most_mm = fx_max_u32(most_mm, fx_abs_u32(o[0]) + fx_abs_u32(o[1]));
    }
    return most_mm / 1000 * 256 + 256;
}

void lm_targets_select(struct lm_targets_near *near, const struct lm_target_set *set,
                       const struct lm_target_scene *scene)
{
    near->set = *set;
    near->is_chosen = true;
    near->place = scene->place;
    near->time_us = scene->time_us;
    near->count = near->left_out = 0;
    const uint32_t reach_q8 = (scene->reach_m + LM_TARGET_DRIFT_M + LM_TARGET_EXTENT_M) * 256;
    for (uint32_t i = 0; i < set->count; i++) {
        const struct lm_target *t = &set->items[i];
        struct lm_target_item item = {.index = (uint16_t)i,
                                      .is_mover = t->speed_mm_s != 0,
                                      .pose = lm_target_pose(t, scene->time_us)};
        fx_bam_t azimuth;
        lm_geo_inverse(scene->place, item.pose.place, &item.distance_q8, &azimuth);
        if (item.distance_q8 > reach_q8) {
            continue;
        }
        if (near->count == LM_TARGETS_NEAR) {
            near->left_out++;
            continue;
        }
        /* Within 2^26, by sines of 2^15. */
        item.north_q8 = (int32_t)((int64_t)item.distance_q8 * fx_cos_q15(azimuth) >> 15);
        item.east_q8 = (int32_t)((int64_t)item.distance_q8 * fx_sin_q15(azimuth) >> 15);
        item.slack_q8 = extent_q8(set, t) + rough_q8(scene->place, item.distance_q8);
        item.elevation_q6 = elevation_q6(t, item.pose.place, scene);
        near->item[near->count++] = item;
    }
}

bool lm_targets_refresh(struct lm_targets_near *near, const struct lm_target_set *set,
                        const struct lm_target_scene *scene)
{
    /* 77,000 BAM are 717 m of latitude, and no more than that of longitude. */
    const uint32_t limit = 77000;
    const struct lm_place *from = &near->place, *to = &scene->place;
    const bool holds = near->is_chosen && near->time_us == scene->time_us &&
                       fx_abs_u32((int32_t)(to->latitude - from->latitude)) < limit &&
                       fx_abs_u32((int32_t)(to->longitude - from->longitude)) < limit;
    if (!holds) {
        lm_targets_select(near, set, scene);
    }
    return !holds;
}
