#include "lm/chip_sector.h"

#include "fx/const.h"
#include "fx/log.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/chip_slope.h"
#include "lm/illumination.h"
#include "lm/units.h"

/* Map from pixels to lines and cells. Entry [0] is the middle of pixel (0, 0), [1] is the step of a
 * column, [2] the step of a row. `across` is BAM to the right of the line; `along` is from the
 * middle of its cell 0. */
struct pixel_map {
    int64_t across[3], along_cells_q16[3];
    int64_t origin_cells_q16; /* of the target, along */
};

/* Compute the map of a chip turned by `turn` about its origin:
 *
 *     x = x0 cos - y0 sin, y = x0 sin + y0 cos      for the steps of a column and of a row
 *     across = x / range                            in BAM
 *     along  = y / cell                             in cells
 *
 * A pixel is at most 16 m << 4: 2^32 in Q24. A product with a sine in Q30 is below 2^62. */
static struct pixel_map pixel_map_of(const struct lm_chip_slot *slot, fx_bam_t turn,
                                     const struct lm_chip_sector_origin *origin,
                                     const struct lm_target_line *line)
{
    const int64_t pixel_m_q24 = lm_m_q24_of_mm(slot->pixel_mm);
    const int64_t cos_q24 = pixel_m_q24 * fx_cos_q30(turn) >> 30;
    const int64_t sin_q24 = pixel_m_q24 * fx_sin_q30(turn) >> 30;
    /* Metres in Q24, below 2^32. Cut to Q12, times 2^29.3 BAM a radian, over metres in Q8. */
    const int64_t x_q24[3] = {0, cos_q24, -sin_q24}, y_q24[3] = {0, sin_q24, cos_q24};
    const int64_t range_m_q8 = fx_max_u32(origin->range_m_q8, LM_M_Q8(LM_RANGE_MIN_M));
    /* Half pixels from the origin to the middle of pixel (0, 0), before the reduction. */
    const int64_t columns = ((int64_t)1 - slot->side) * (1 << slot->key.shift);
    const int64_t rows = (1 << slot->key.shift) - 2 * (int64_t)slot->origin_row;
    struct pixel_map map;
    for (int i = 1; i < 3; i++) {
        map.across[i] = (x_q24[i] >> 12) * FX_BAM_PER_RADIAN / range_m_q8 >> 4;
        map.along_cells_q16[i] = y_q24[i] / line->cell_m_q8;
    }
    const uint32_t halves = slot->key.shift + 1u;
    map.origin_cells_q16 =
        ((int64_t)origin->range_m_q8 - line->first_m_q8) * 65536 / line->cell_m_q8;
    map.across[0] = (columns * map.across[1] + rows * map.across[2]) >> halves;
    map.along_cells_q16[0] =
        map.origin_cells_q16 +
        ((columns * map.along_cells_q16[1] + rows * map.along_cells_q16[2]) >> halves);
    return map;
}

/* What a chip has in one line: the weights of its pixels, in cells from `first` on, which may lie
 * before the line or behind it. */
struct profile {
    int32_t first;
    uint32_t cells; /* 0..LM_CHIP_SPAN */
    uint32_t cell[LM_CHIP_SPAN + 1];
};

/* Set the cells that the pixels of a box lie between. A chip is within 2^21 cells of the line, and
 * its pixels within 2^15 of its origin. */
static void set_cells(struct profile *p, const struct lm_chip_box *box, const struct pixel_map *map)
{
    const int64_t along = map->along_cells_q16[1], beyond = map->along_cells_q16[2];
    const int64_t columns = (int64_t)(box->column_end - box->column - 1) * along;
    const int64_t rows = (int64_t)(box->row_end - box->row - 1) * beyond;
    const int64_t corner = map->along_cells_q16[0] + box->column * along + box->row * beyond;
    const int64_t least = corner + (columns < 0 ? columns : 0) + (rows < 0 ? rows : 0);
    const int64_t most = corner + (columns > 0 ? columns : 0) + (rows > 0 ? rows : 0);
    const int64_t cells = (most >> 16) - (least >> 16) + 2;
    p->first = (int32_t)(least >> 16);
    p->cells = box->row_end == 0 ? 0 : (uint32_t)(cells < LM_CHIP_SPAN ? cells : LM_CHIP_SPAN);
    memset(p->cell, 0, sizeof p->cell);
}

/* Share `amount` between the two cells that a pixel lies between, by nearness. */
static void share(struct profile *p, int64_t along_cells_q16, uint32_t amount)
{
    const int64_t whole = (along_cells_q16 >> 16) - p->first;
    const uint32_t beyond =
        (uint32_t)((uint64_t)amount * ((uint64_t)along_cells_q16 & 65535u) >> 16);
    if (whole >= 0 && whole < (int64_t)p->cells) {
        p->cell[whole] += amount - beyond;
        p->cell[whole + 1] += beyond;
    }
}

/* Weight of a pixel: its share of the target's power, Q31, or the dark part of its ground, Q20. The
 * sum over a chip of at most 32 x 32 pixels fits 32 bits: 2^31, or 2^10 * 2^20. */
static uint32_t power_q31(const struct lm_chip_slot *slot, uint32_t row, uint32_t column)
{
    return lm_chip_pixel(slot->power_q31, row, column);
}

static uint32_t dark_q20(const struct lm_chip_slot *slot, uint32_t row, uint32_t column)
{
    return lm_chip_pixel(slot->shadow, row, column) * 4112u;
}

/* Sum the weights of the pixels in a box into the cells, by nearness to the line. `off` is the
 * line's azimuth less that of the origin. */
static void gather(const struct lm_chip_slot *slot, const struct lm_chip_box *box,
                   const struct pixel_map *map,
                   uint32_t (*count)(const struct lm_chip_slot *, uint32_t, uint32_t), int32_t off,
                   uint32_t width, struct profile *p)
{
    set_cells(p, box, map);
    for (uint32_t row = box->row; row < box->row_end; row++) {
        int64_t across = map->across[0] + row * map->across[2] + box->column * map->across[1] - off;
        int64_t along_cells_q16 = map->along_cells_q16[0] + row * map->along_cells_q16[2] +
                                  box->column * map->along_cells_q16[1];
        for (uint32_t column = box->column; column < box->column_end; column++) {
            const int64_t aside = across < 0 ? -across : across;
            const uint32_t amount = aside < (int64_t)width ? count(slot, row, column) : 0;
            if (amount != 0) {
                const uint64_t weight = width - (uint64_t)aside;
                share(p, along_cells_q16, (uint32_t)(amount * weight / width));
            }
            across += map->across[1];
            along_cells_q16 += map->along_cells_q16[1];
        }
    }
}

/* Area of a pixel over that of a cell of the line, at most 2^24 in Q16. A pixel is at most 256 m;
 * its square is 2^32 in Q16, and 2^48 when shifted. */
static uint32_t pixels_a_cell_q16(const struct lm_chip_slot *slot,
                                  const struct lm_chip_sector_origin *origin,
                                  const struct lm_target_line *line)
{
    const uint64_t pixel_m_q8 = lm_m_q8_of_mm_u32(slot->pixel_mm);
    const uint64_t arc_m_q8 = lm_arc_m_q8(origin->range_m_q8, line->width);
    const uint64_t ratio_q16 = (pixel_m_q8 * pixel_m_q8 << 16) / ((arc_m_q8 + 1) * line->cell_m_q8);
    return ratio_q16 < 1u << 24 ? (uint32_t)ratio_q16 : 1u << 24;
}

/* ---- shadow ---- */

/* A line's ground, and the shadow that it would have if the ground were level. */
struct shade {
    const struct lm_target_line *line;
    struct lm_chip_slope slope;
    int64_t origin_cells_q16;
    int32_t first;                         /* cell where the shadow begins */
    uint32_t cells;                        /* of the shadow */
    uint32_t before_q16[LM_CHIP_SPAN + 1]; /* dark part of all cells before this one */
};

/* Add the parts of cells up. A cell's dark pixels add up to Q20 of pixels; by area they become a
 * part of the cell. All parts are below 2^25. */
static void set_shade(struct shade *s, const struct lm_target_candidate *candidate,
                      const struct lm_chip_sector_origin *origin, const struct lm_target_line *line,
                      const struct pixel_map *map, const struct profile *dark)
{
    const struct lm_target_heights h = {line->height_m_q10, line->reference_m_q10};
    const uint32_t ratio_q16 = pixels_a_cell_q16(candidate->chip, origin, line);
    s->line = line;
    s->origin_cells_q16 = map->origin_cells_q16;
    s->first = dark->first;
    s->cells = dark->cells;
    s->before_q16[0] = 0;
    for (uint32_t i = 0; i < dark->cells; i++) {
        const uint64_t part_q16 = (uint64_t)dark->cell[i] * ratio_q16 >> 20;
        s->before_q16[i + 1] = s->before_q16[i] + (uint32_t)(part_q16 < 65536 ? part_q16 : 65536);
    }
    lm_chip_slope_set(&s->slope, lm_m_q10_of_m_q6(candidate->elevation_m_q6),
                      fx_max_u32(origin->range_m_q8, 1), line->cell_m_q8, &h);
}

/* Where the ray over the border between a cell and the one before it meets the level of the foot,
 * in cells. Before the origin the ground counts as level, for the target stands on it. */
static int64_t level_of_border_q16(const struct shade *s, uint32_t cell)
{
    const int64_t border_q16 = (int64_t)cell * 65536 - 32768;
    const int32_t *const elevation_m_q14 = s->line->elevation_m_q14;
    if (!elevation_m_q14 || border_q16 <= s->origin_cells_q16) {
        return border_q16;
    }
    const uint32_t near = cell == 0 ? 0 : cell - 1, far = fx_min_u32(cell, s->line->cells - 1);
    const int64_t both_m_q14 = (int64_t)elevation_m_q14[near] + elevation_m_q14[far];
    const int32_t rise_m_q14 = fx_sat_i32(both_m_q14 / 2 - s->slope.foot_m_q14);
    return border_q16 + lm_chip_slope_level_cells_q8(&s->slope, 0, rise_m_q14) * 256;
}

/* Dark part of all cells up to a place on the level of the foot. */
static uint32_t dark_before_q16(const struct shade *s, int64_t level_q16)
{
    const int64_t past_q16 = level_q16 + 32768 - (int64_t)s->first * 65536;
    if (past_q16 <= 0) {
        return 0;
    }
    if (past_q16 >= (int64_t)s->cells << 16) {
        return s->before_q16[s->cells];
    }
    const uint32_t i = (uint32_t)(past_q16 >> 16), on_q16 = (uint32_t)past_q16 & 65535;
    const uint32_t part_q16 = s->before_q16[i + 1] - s->before_q16[i];
    return s->before_q16[i] + (uint32_t)((uint64_t)part_q16 * on_q16 >> 16);
}

/* Take a part from a cell's level. */
static int16_t darkened_db_q8(int16_t level_db_q8, uint64_t dark_q16)
{
    return dark_q16 >= 65536
               ? LM_LEVEL_SHADOW
               : fx_sat_i16(level_db_q8 + fx_db_q8((uint32_t)(65536 - dark_q16)) - fx_db_q8(65536));
}

/* Take from each cell the part of its level that lies in shadow: its share of what the rays over it
 * meet at the level of the foot. A cell over which they do not go on is hidden by the ground. */
static void darken(const struct shade *s, int16_t *level_db_q8)
{
    const int64_t origin = s->origin_cells_q16 >> 16;
    const int64_t begin = s->first < origin ? s->first : origin;
    const int64_t end_q16 = (int64_t)s->first * 65536 + ((int64_t)s->cells << 16) - 32768;
    uint32_t i = begin < (int64_t)s->line->first ? s->line->first : (uint32_t)begin;
    int64_t near_q16 = i < s->line->cells ? level_of_border_q16(s, i) : end_q16;
    for (; i < s->line->cells && near_q16 < end_q16; i++) {
        const int64_t far_q16 = level_of_border_q16(s, i + 1);
        const uint32_t dark_q16 =
            far_q16 > near_q16 ? dark_before_q16(s, far_q16) - dark_before_q16(s, near_q16) : 0;
        if (dark_q16 != 0) {
            level_db_q8[i] = darkened_db_q8(level_db_q8[i], ((uint64_t)dark_q16 << 16) /
                                                                (uint64_t)(far_q16 - near_q16));
        }
        near_q16 = far_q16;
    }
}

/* ---- the target itself ---- */

/* A chip is the mean over many looks, as the clutter's level is: both take their speckle together.
 */
static uint32_t brighten(const struct lm_chip_slot *slot, const struct lm_target_line *line,
                         const struct profile *lit, int32_t clutter_db_q8, int16_t *level_db_q8)
{
    const int32_t unit_q8 = fx_db_q8(1u << 31);
    uint32_t given = 0;
    for (uint32_t i = 0; i < lit->cells; i++) {
        const int64_t at = (int64_t)lit->first + i;
        if (lit->cell[i] != 0 && at >= (int64_t)line->first && at < (int64_t)line->cells) {
            const int32_t chip_db_q8 =
                slot->total_dbsm_q8 + fx_db_q8(lit->cell[i]) - unit_q8 - clutter_db_q8;
            level_db_q8[at] = fx_sat_i16(fx_db_q8_sum_vec(level_db_q8[at], chip_db_q8));
            given++;
        }
    }
    return given;
}

uint32_t lm_chip_sector_add(const struct lm_target_candidate *candidate,
                            const struct lm_chip_sector_origin *origin,
                            const struct lm_target_line *line, int32_t clutter_db_q8,
                            int16_t *level_db_q8)
{
    struct profile profile;
    const struct lm_chip_slot *slot = candidate->chip;
    const struct pixel_map map = pixel_map_of(slot, candidate->chip_turn, origin, line);
    gather(slot, &slot->dark, &map, dark_q20, origin->shadow_off_bam, line->width, &profile);
    if (profile.cells != 0) {
        struct shade shade;
        set_shade(&shade, candidate, origin, line, &map, &profile);
        darken(&shade, level_db_q8);
    }
    gather(slot, &slot->lit, &map, power_q31, origin->off_bam, line->width, &profile);
    return brighten(slot, line, &profile, clutter_db_q8, level_db_q8);
}
