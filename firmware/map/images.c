#include "lm/images.h"

#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/units.h"

int lm_images_judge(const struct lm_db *first, const struct lm_db *other)
{
    if (other->sensor != first->sensor) {
        return LM_ERR_SENSOR;
    }
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        const struct lm_class *a = &first->classes.entry[i], *b = &other->classes.entry[i];
        if (memcmp(a->name, b->name, sizeof a->name) != 0 || a->kind != b->kind ||
            a->facing != b->facing || a->flags != b->flags) {
            return LM_ERR_TABLE;
        }
    }
    const bool has_radar = other->radar_bytes != 0;
    const bool is_same = memcmp(first->classes.height_dm, other->classes.height_dm,
                                sizeof first->classes.height_dm) == 0 &&
                         (!has_radar || (other->radar_bytes == first->radar_bytes &&
                                         other->radar_crc == first->radar_crc));
    return is_same ? LM_OK : LM_ERR_TABLE;
}

/* LOD of an image with cells of 2^shift, or 255 or less that it does not have. */
static uint8_t lod_of(const struct lm_db *image, uint32_t shift)
{
    return (uint8_t)(shift - image->shift0);
}

/* The gain of each class at each LOD is that of the finest image that has the LOD. */
static void take_gains(struct lm_db *view, const struct lm_db *image)
{
    for (uint8_t lod = 0; lod < view->lod_count; lod++) {
        const uint8_t own = lod_of(image, (uint32_t)view->shift0 + lod);
        for (uint32_t i = 0; i < LM_DB_CLASSES && own < image->lod_count; i++) {
            view->classes.entry[i].lod_gain_db_q8[lod] =
                image->classes.entry[i].lod_gain_db_q8[own];
        }
    }
}

void lm_images_view(struct lm_db *view, const struct lm_db *images, uint32_t count)
{
    uint32_t coarsest = 0;
    view->detail_size = 0;
    view->shift0 = images[0].shift0;
    for (uint32_t i = 0; i < count; i++) {
        coarsest = fx_max_u32(coarsest, (uint32_t)images[i].shift0 + images[i].lod_count);
        view->detail_size |= images[i].detail_size;
    }
    view->lod_count = (uint8_t)fx_min_u32(coarsest - view->shift0, LM_DB_LODS_MAX);
    for (uint32_t i = count; i-- > 0;) {
        take_gains(view, &images[i]);
    }
}

/* Box on the Earth. */
struct box {
    fx_bam_t south, north, west, east;
};

static struct box box_around(struct lm_position place, uint32_t reach_m)
{
    struct lm_geo_origin origin;
    const uint32_t reach_m_q8 = reach_m << 8;
    lm_geo_set_origin(&origin, place);
    return (struct box){.south = lm_geo_direct(&origin, FX_BAM_180, reach_m_q8).latitude,
                        .north = lm_geo_direct(&origin, 0, reach_m_q8).latitude,
                        .west =
                            lm_geo_direct(&origin, FX_BAM_180 + FX_BAM_90, reach_m_q8).longitude,
                        .east = lm_geo_direct(&origin, FX_BAM_90, reach_m_q8).longitude};
}

/* True if tiles of the finest level may lie in a box. */
static bool touches(const struct lm_db *image, const struct box *box)
{
    const uint32_t side_log2 = (uint32_t)image->shift0 + LM_TILE_CELLS_LOG2;
    const uint32_t south = (box->south + FX_BAM_90) >> side_log2;
    const uint32_t north = (box->north + FX_BAM_90) >> side_log2;
    for (uint32_t i = 0; i < image->band_count; i++) {
        const struct lm_band *b = &image->bands[i];
        const uint32_t round = UINT32_MAX >> (side_log2 + b->zone);
        const uint32_t west = box->west >> (side_log2 + b->zone);
        const uint32_t across = ((box->east >> (side_log2 + b->zone)) - west) & round;
        if (b->lod == 0 && south < b->row0 + b->rows && north >= b->row0 &&
            (((b->column0 - west) & round) <= across ||
             ((west - b->column0) & round) < b->columns)) {
            return true;
        }
    }
    return false;
}

static uint32_t finest_in(const struct lm_db *images, uint32_t count, const struct box *box)
{
    uint32_t i = 0;
    while (i + 1 < count && !touches(&images[i], box)) {
        i++;
    }
    return i;
}

void lm_images_look(struct lm_db *view, const struct lm_db *images, uint32_t count,
                    struct lm_position place, uint32_t reach_m)
{
    const struct box box = box_around(place, reach_m);
    const struct lm_db *image = &images[finest_in(images, count, &box)];
    view->finest = (uint8_t)(image->shift0 - view->shift0);
    view->mean_elevation_m_q6 = image->mean_elevation_m_q6;
}

uint32_t lm_images_at(const struct lm_db *images, uint32_t count, struct lm_position place)
{
    const struct box box = {place.latitude, place.latitude, place.longitude, place.longitude};
    return finest_in(images, count, &box);
}
