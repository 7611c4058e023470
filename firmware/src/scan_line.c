#include "lm/scan_line.h"

#include "fx/bits.h"
#include "fx/hash.h"
#include "fx/lerp.h"

/* The tile that the last cell was found in, and what it takes to see that the next one is in it too. */
struct window {
    const struct lm_tile *tile; /* NULL: nothing is known here */
    fx_bam_t south, west;       /* of the tile; south counts from the south pole */
    uint8_t zone, shift;        /* shift of the level that answered */
};

struct lm_sampling lm_sampling_for(const struct lm_db *db, uint32_t cell_mm, uint32_t epoch)
{
    struct lm_sampling s = {.level = 0, .noise_shift = 0, .epoch = epoch};
    while (s.level + 1 < db->level_count && lm_db_cell_mm(db, (uint8_t)(s.level + 1)) <= cell_mm) {
        s.level++;
    }
    /* cell / sqrt 2 in BAM: mm * 46341 / 65536 / 9.31506, that is mm * 4975 >> 16. */
    const uint32_t noise_bam = (uint32_t)(((uint64_t)cell_mm * 4975) >> 16);
    s.noise_shift = noise_bam ? (uint8_t)(31 - fx_clz32(noise_bam)) : 0;
    return s;
}

static struct window open_window(struct lm_tile_cache *tiles, uint8_t level, fx_bam_t latitude,
                                 fx_bam_t longitude)
{
    const fx_bam_t from_pole = latitude + FX_BAM_90;
    struct window w = {.zone = lm_db_zone(latitude),
                       .shift = (uint8_t)(tiles->db->shift0 + level)};
    const uint32_t tile_shift = w.shift + LM_TILE_CELLS_LOG2;
    w.tile = lm_tile_cache_get(tiles, level, from_pole >> tile_shift,
                               longitude >> (tile_shift + w.zone));
    if (w.tile) {
        w.shift = (uint8_t)(tiles->db->shift0 + w.tile->level);
    }
    w.south = from_pole >> tile_shift << tile_shift;
    w.west = longitude >> (tile_shift + w.zone) << (tile_shift + w.zone);
    return w;
}

/* Terrain at a place given as position in the tile, in cells, Q8 each way. */
static inline int32_t elevation_at(const struct lm_tile *tile, uint32_t north_q8, uint32_t east_q8)
{
    const uint16_t *sw = &tile->posts[north_q8 >> 8][east_q8 >> 8];
    const uint16_t *nw = sw + LM_TILE_POSTS;
    const uint32_t post_q16 =
        fx_bilerp_u16_q16(sw[0], sw[1], nw[0], nw[1], east_q8 & 255, north_q8 & 255);
    /* A post step is 2^post_shift / 64 m, so the step's Q16 is Q22 of 2^post_shift metres; to Q10.
     * lm_tile_check holds post_shift to 4, so the sum stays below 2^24 + 2^24. */
    return (int32_t)((uint32_t)tile->base_q6 * 16u + (post_q16 >> (12 - tile->post_shift)));
}

/* Position within the tile of an ancestor: in cells of its level, Q8. The tile's own borders at the asked level
 * are known to hold the place; an ancestor's origin is found by masking. */
static inline uint32_t in_tile_q8(fx_bam_t offset_bam, uint8_t shift)
{
    const uint32_t inside = offset_bam & ((1u << (shift + LM_TILE_CELLS_LOG2)) - 1);
    return (uint32_t)((uint64_t)inside << 8 >> shift);
}

void lm_scan_line_run(struct lm_scan_line *line, struct lm_tile_cache *tiles,
                      const struct lm_sampling *sampling, struct lm_ground_path *path,
                      uint32_t cells)
{
    const uint32_t own_shift = (uint32_t)tiles->db->shift0 + sampling->level + LM_TILE_CELLS_LOG2;
    struct lm_ground_path at = *path;
    struct window w = open_window(tiles, sampling->level, (fx_bam_t)(at.latitude >> 32),
                                  (fx_bam_t)(at.longitude >> 32));
    for (uint32_t i = 0; i < cells; i++, lm_ground_path_step(&at)) {
        const fx_bam_t latitude = (fx_bam_t)(at.latitude >> 32);
        const fx_bam_t longitude = (fx_bam_t)(at.longitude >> 32);
        const fx_bam_t from_pole = latitude + FX_BAM_90;
        if (((from_pole - w.south) | (longitude - w.west) >> w.zone) >> own_shift) {
            w = open_window(tiles, sampling->level, latitude, longitude);
        }
        const uint32_t hash = fx_hash3(latitude >> sampling->noise_shift,
                                       longitude >> sampling->noise_shift, sampling->epoch);
        line->noise[i] = (uint16_t)(hash >> 22);
        if (!w.tile) {
            line->cell[i] = LM_CELL_NONE;
            line->elevation_q10[i] = 0;
            continue;
        }
        const uint32_t north_q8 = in_tile_q8(from_pole, w.shift);
        const uint32_t east_q8 = in_tile_q8(longitude >> w.zone, w.shift);
        line->cell[i] = w.tile->cells[north_q8 >> 8][east_q8 >> 8];
        line->elevation_q10[i] = elevation_at(w.tile, north_q8, east_q8);
    }
    *path = at;
}

void lm_scan_line_prefetch(struct lm_tile_cache *tiles, const struct lm_sampling *sampling,
                           struct lm_ground_path path, uint32_t cells)
{
    const uint32_t tile_shift = (uint32_t)tiles->db->shift0 + sampling->level + LM_TILE_CELLS_LOG2;
    uint32_t last_row = UINT32_MAX, last_column = UINT32_MAX;
    enum { STRIDE = 8 };
    for (uint32_t i = 0; i < cells; i += STRIDE) {
        const fx_bam_t latitude = (fx_bam_t)(path.latitude >> 32);
        const uint32_t row = (uint32_t)(latitude + FX_BAM_90) >> tile_shift;
        const uint32_t column =
            (fx_bam_t)(path.longitude >> 32) >> (tile_shift + lm_db_zone(latitude));
        if (row != last_row || column != last_column) {
            lm_tile_cache_want(tiles, sampling->level, row, column);
            last_row = row;
            last_column = column;
        }
        lm_ground_path_skip(&path, STRIDE);
    }
}

int32_t lm_scan_elevation(struct lm_tile_cache *tiles, uint8_t level, struct lm_place place,
                          int32_t otherwise_q10)
{
    const struct window w = open_window(tiles, level, place.latitude, place.longitude);
    if (!w.tile) {
        return otherwise_q10;
    }
    return elevation_at(w.tile, in_tile_q8(place.latitude + FX_BAM_90, w.shift),
                        in_tile_q8(place.longitude >> w.zone, w.shift));
}
