#include "lm/chip_sector.h"

#include "fx/const.h"
#include "fx/log.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/illumination.h"
#include "lm/units.h"

/* Map from pixels to lines and cells. Entry [0] is the middle of pixel (0, 0), [1] is the step of a
 * column, [2] the step of a row. `across` is BAM to the right of the line; `along` is from cell
 * `first`. */
struct pixel_map {
    int64_t across[3], along_cells_q16[3]; /* [0] the first pixel, [1] a column, [2] a row */
    int32_t first;
    uint32_t cells; /* cells from there, 0..LM_CHIP_SPAN */
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
    map.across[0] = (columns * map.across[1] + rows * map.across[2]) >> halves;
    map.along_cells_q16[0] =
        (columns * map.along_cells_q16[1] + rows * map.along_cells_q16[2]) >> halves;
    /* Cells from the middle of the line's cell 0 to the chip's origin. The chip's corner is at most
     * 1.5 sides from it, whatever the turn and the origin's row. */
    const int64_t origin_cells_q16 =
        ((int64_t)origin->range_m_q8 - line->first_m_q8) * 65536 / line->cell_m_q8;
    const int64_t reach_m_q16 = (int64_t)slot->side * 3 / 2 *
                                (int64_t)(fx_abs_u32((int32_t)(pixel_m_q24 / line->cell_m_q8)));
    const int64_t first_reached = (origin_cells_q16 - reach_m_q16) >> 16,
                  end_reached = ((origin_cells_q16 + reach_m_q16) >> 16) + 2;
    const int64_t first =
        first_reached < (int64_t)line->first ? (int64_t)line->first : first_reached;
    const int64_t end = end_reached > (int64_t)line->cells ? (int64_t)line->cells : end_reached;
    map.first = (int32_t)first;
    map.cells =
        end > first ? (uint32_t)(end - first < LM_CHIP_SPAN ? end - first : LM_CHIP_SPAN) : 0;
    map.along_cells_q16[0] += origin_cells_q16 - first * 65536;
    return map;
}

/* Share `amount` between the two cells that a pixel lies between, by nearness. */
static void share(uint32_t cell[LM_CHIP_SPAN + 1], uint32_t cells, int64_t along_cells_q16,
                  uint32_t amount)
{
    const int64_t whole = along_cells_q16 >> 16;
    const uint32_t beyond =
        (uint32_t)((uint64_t)amount * ((uint64_t)along_cells_q16 & 65535u) >> 16);
    if (whole >= 0 && whole < (int64_t)cells) {
        cell[whole] += amount - beyond;
    }
    if (whole >= -1 && whole + 1 < (int64_t)cells) {
        cell[whole + 1] += beyond;
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
                   uint32_t width, uint32_t cell[LM_CHIP_SPAN + 1])
{
    memset(cell, 0, (LM_CHIP_SPAN + 1) * sizeof *cell);
    for (uint32_t row = box->row; row < box->row_end; row++) {
        int64_t across = map->across[0] + row * map->across[2] + box->column * map->across[1] - off;
        int64_t along_cells_q16 = map->along_cells_q16[0] + row * map->along_cells_q16[2] +
                                  box->column * map->along_cells_q16[1];
        for (uint32_t column = box->column; column < box->column_end; column++) {
            const int64_t aside = across < 0 ? -across : across;
            const uint32_t amount = aside < (int64_t)width ? count(slot, row, column) : 0;
            if (amount != 0) {
                const uint64_t weight = width - (uint64_t)aside;
                share(cell, map->cells, along_cells_q16, (uint32_t)(amount * weight / width));
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

/* Take from each cell the part of its level that lies in shadow. A cell's dark pixels add up to Q20
 * of pixels; by area they become a part of the cell. */
static void darken(const struct pixel_map *map, const uint32_t cell[LM_CHIP_SPAN + 1],
                   uint32_t ratio_q16, int16_t *level_db_q8)
{
    for (uint32_t i = 0; i < map->cells; i++) {
        const uint64_t dark_q16 = (uint64_t)cell[i] * ratio_q16 >> 20;
        if (dark_q16 >= 65536) {
            level_db_q8[map->first + (int32_t)i] = LM_LEVEL_SHADOW;
        } else if (dark_q16 != 0) {
            int16_t *const at = &level_db_q8[map->first + (int32_t)i];
            *at = fx_sat_i16(*at + fx_db_q8((uint32_t)(65536 - dark_q16)) - fx_db_q8(65536));
        }
    }
}

/* A chip is the mean over many looks, as the clutter's level is: both take their speckle together.
 */
static uint32_t brighten(const struct lm_chip_slot *slot, const struct pixel_map *map,
                         const uint32_t cell[LM_CHIP_SPAN + 1], int32_t clutter_db_q8,
                         int16_t *level_db_q8)
{
    const int32_t unit_q8 = fx_db_q8(1u << 31);
    uint32_t given = 0;
    for (uint32_t i = 0; i < map->cells; i++) {
        if (cell[i] != 0) {
            const uint32_t at = (uint32_t)map->first + i;
            const int32_t chip_db_q8 =
                slot->total_dbsm_q8 + fx_db_q8(cell[i]) - unit_q8 - clutter_db_q8;
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
    uint32_t cell[LM_CHIP_SPAN + 1];
    const struct lm_chip_slot *slot = candidate->chip;
    const struct pixel_map map = pixel_map_of(slot, candidate->chip_turn, origin, line);
    gather(slot, &slot->dark, &map, dark_q20, origin->shadow_off_bam, line->width, cell);
    darken(&map, cell, pixels_a_cell_q16(slot, origin, line), level_db_q8);
    gather(slot, &slot->lit, &map, power_q31, origin->off_bam, line->width, cell);
    return brighten(slot, &map, cell, clutter_db_q8, level_db_q8);
}
