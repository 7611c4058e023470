#include "lm/chip_patch.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "fx/trig.h"

/* Corner of a box of pixels, relative to the origin, in lines and cells. */
struct chip_corner {
    int32_t right, beyond;
};

/* a / b for a length on the chip below 2^26 and a step of at least 1. Longer than 2^20 cells is as
 * good as that. */
static int32_t whole_cells(int64_t a, int64_t b)
{
    const int64_t most = 1 << 20;
    return (int32_t)fx_clamp_i64(a / b, -most, most);
}

/* Lines and cells from the origin to a place on the chip. With the steps (a, c) of a line and (b,
 * d) of a cell, in columns and rows, and the place (x, y):
 *
 *     right = (x d - y b) / (a d - b c)        beyond = (y a - x c) / (a d - b c)
 *
 * Places are below 2^23 and steps below 2^21; products are below 2^45. The determinant is not 0,
 * as the ray is within 75 degrees of the line of sight and steps are half a pixel or more; where
 * rounding makes it so, the cells are nowhere. */
static struct chip_corner corner_of(const struct lm_chip_patch *chip, int32_t column_q16,
                                    int32_t row_q16)
{
    const int64_t x = column_q16 - chip->origin_px_q16[0], y = row_q16 - chip->origin_px_q16[1];
    const int64_t a = chip->right_px_q16[0], c = chip->right_px_q16[1];
    const int64_t b = chip->beyond_px_q16[0], d = chip->beyond_px_q16[1];
    const int64_t determinant = a * d - b * c > 0 ? a * d - b * c : 1;
    return (struct chip_corner){whole_cells(x * d - y * b, determinant),
                                whole_cells(y * a - x * c, determinant)};
}

/* Whole cells that a stretched box covers more on either side, rounded up. */
static int32_t more_of(uint32_t stretch_q8)
{
    return (int32_t)((stretch_q8 - 256 + 511) / 512);
}

/* Cells that show any pixel of a box: the box of pixels grows by half a pixel, and the cells by
 * one, all around. */
static struct lm_chip_reach reach_of(const struct lm_chip_patch *chip,
                                     const struct lm_chip_box *box)
{
    struct lm_chip_reach r = {INT32_MAX, 0, INT32_MAX, 0};
    if (box->row_end == 0) {
        return (struct lm_chip_reach){0, 0, 0, 0};
    }
    r.right_end = r.beyond_end = INT32_MIN;
    for (int i = 0; i < 4; i++) {
        const int32_t column_q16 =
            i % 2 ? box->column_end * 65536 + 32768 : box->column * 65536 - 32768;
        const int32_t row_q16 = i / 2 ? box->row_end * 65536 + 32768 : box->row * 65536 - 32768;
        const struct chip_corner c = corner_of(chip, column_q16, row_q16);
        r.right = fx_min_i32(r.right, c.right - 1);
        r.right_end = fx_max_i32(r.right_end, c.right + 2);
        r.beyond = fx_min_i32(r.beyond, c.beyond - 1);
        r.beyond_end = fx_max_i32(r.beyond_end, c.beyond + 2);
    }
    return r;
}

static void widen(struct lm_chip_reach *r, const struct lm_smear *smear)
{
    r->right -= more_of(smear->across_stretch_q8);
    r->right_end += more_of(smear->across_stretch_q8);
    r->beyond -= more_of(smear->along_stretch_q8);
    r->beyond_end += more_of(smear->along_stretch_q8);
}

/* Half the side of a stretched cell on the chip, and at least half a pixel. scale_q16 is below 2^18
 * and stretch_q8 below 2^16: the product is below 2^34, held in 64 bits. */
static int32_t half_px_q8_of(uint32_t scale_q16, uint32_t stretch_q8)
{
    const uint32_t side_q8 = (uint32_t)((uint64_t)scale_q16 * stretch_q8 >> 16);
    return (int32_t)(fx_max_u32(side_q8, 256) / 2);
}

/* Side of a stretched cell over that of its box. It is less than 1 if a pixel is larger than the
 * cell. */
static int32_t side_gain_db_q8(uint32_t scale_q16, uint32_t stretch_q8, int32_t half_px_q8)
{
    return fx_db_q8(scale_q16) + fx_db_q8(stretch_q8) - fx_db_q8(2 * (uint32_t)half_px_q8) -
           fx_db_q8(65536);
}

/* Part of a step's length along the columns or rows: a length below 2^20 times a sine or cosine. */
static int32_t step_px_q16(uint32_t length_px_q16, int32_t part_q30)
{
    return (int32_t)((int64_t)length_px_q16 * part_q30 >> 30);
}

/* Column and row of a cell `right` and `beyond` of the target's origin. With m pixels to a cell, a
 * line w cells wide, the chip turned by d and the ray by e:
 *
 *     column = column0 + m ( right w cos(e - d) + beyond sin d / cos e)
 *     row    = row0    + m ( right w sin(e - d) + beyond cos d / cos e) */
void lm_chip_patch_set(struct lm_chip_patch *chip, const struct lm_chip_slot *slot, fx_bam_t turn,
                       const struct lm_chip_cells *cells, const struct lm_smear *smear)
{
    /* Pixels of a cell. A chip is reduced to pixels of half a cell or more, so this is below 2^18.
     * So is that of a line, and cos e is 1/4 or more. */
    const uint32_t deep_q16 = (uint32_t)(((uint64_t)cells->cell_mm << 16) / slot->pixel_mm);
    const uint32_t wide_q16 = (uint32_t)((uint64_t)deep_q16 * cells->wide_q16 >> 16);
    const int32_t cos_q30 = fx_max_i32(fx_cos_q30(cells->aside), 1 << 28);
    const uint32_t ray_q16 = (uint32_t)(((uint64_t)deep_q16 << 30) / (uint32_t)cos_q30);
    chip->slot = slot;
    chip->right_px_q16[0] = step_px_q16(wide_q16, fx_cos_q30(cells->aside - turn));
    chip->right_px_q16[1] = step_px_q16(wide_q16, fx_sin_q30(cells->aside - turn));
    chip->beyond_px_q16[0] = step_px_q16(ray_q16, fx_sin_q30(turn));
    chip->beyond_px_q16[1] = step_px_q16(ray_q16, fx_cos_q30(turn));
    chip->origin_px_q16[0] = (int32_t)slot->side << 15;
    chip->origin_px_q16[1] = (int32_t)((uint32_t)slot->origin_row << 16 >> slot->key.shift);
    chip->lit = reach_of(chip, &slot->lit);
    chip->dark = reach_of(chip, &slot->dark);
    widen(&chip->lit, smear);
    chip->half_px_q8[0] = half_px_q8_of(wide_q16, smear->across_stretch_q8);
    chip->half_px_q8[1] = half_px_q8_of(deep_q16, smear->along_stretch_q8);
    chip->dark_half_px_q8 = half_px_q8_of(deep_q16, 256);
    chip->gain_db_q8 = side_gain_db_q8(wide_q16, smear->across_stretch_q8, chip->half_px_q8[0]) +
                       side_gain_db_q8(deep_q16, smear->along_stretch_q8, chip->half_px_q8[1]);
}

/* Box on the chip, from edge [0] to edge [1]. */
struct box {
    uint32_t column_q8[2], row_q8[2];
};

/* Box around a cell, as far as it lies on the chip. Within the reach a cell is some hundreds of
 * pixels from the origin: below 2^26 in Q16. */
static struct box box_at(const struct lm_chip_patch *chip, int32_t right_cells_q8,
                         int32_t beyond_cells_q8, int32_t half_columns_q8, int32_t half_rows_q8)
{
    const int32_t end_q8 = chip->slot->side * 256;
    int32_t at_q8[2];
    for (int i = 0; i < 2; i++) {
        const int64_t away_q24 = (int64_t)right_cells_q8 * chip->right_px_q16[i] +
                                 (int64_t)beyond_cells_q8 * chip->beyond_px_q16[i];
        at_q8[i] = (int32_t)((chip->origin_px_q16[i] + (away_q24 >> 8)) >> 8);
    }
    struct box b;
    for (int i = 0; i < 2; i++) {
        const int32_t side = 2 * i - 1;
        b.column_q8[i] = (uint32_t)fx_clamp_i32(at_q8[0] + side * half_columns_q8, 0, end_q8);
        b.row_q8[i] = (uint32_t)fx_clamp_i32(at_q8[1] + side * half_rows_q8, 0, end_q8);
    }
    return b;
}

/* Sum before a column in one row of the table, linear within a pixel, times 256: up to 2^39. */
static uint64_t at_column(const uint32_t row[LM_CHIP_ROOM], uint32_t column_q8)
{
    const uint32_t column = column_q8 >> 8, on = column_q8 & 255;
    return (uint64_t)row[column] * (256 - on) + (uint64_t)row[column + 1] * on;
}

/* Sum between the box's columns and before a row, times 65536: up to 2^47. */
static uint64_t before_row(const uint32_t sum[][LM_CHIP_ROOM], const struct box *b, uint32_t row_q8)
{
    const uint32_t row = row_q8 >> 8, on = row_q8 & 255;
    const uint64_t near =
        at_column(sum[row], b->column_q8[1]) - at_column(sum[row], b->column_q8[0]);
    const uint64_t far =
        at_column(sum[row + 1], b->column_q8[1]) - at_column(sum[row + 1], b->column_q8[0]);
    return near * (256 - on) + far * on;
}

/* Sum in the box, times 65536: the difference of the sums before its two rows. */
static uint64_t within(const uint32_t sum[][LM_CHIP_ROOM], const struct box *b)
{
    return before_row(sum, b, b->row_q8[1]) - before_row(sum, b, b->row_q8[0]);
}

int32_t lm_chip_patch_rcs_dbsm_q8(const struct lm_chip_patch *chip, int32_t right_cells_q8,
                                  int32_t beyond_cells_q8)
{
    const struct box b =
        box_at(chip, right_cells_q8, beyond_cells_q8, chip->half_px_q8[0], chip->half_px_q8[1]);
    const uint64_t power_q47 = within(chip->slot->power_q31, &b);
    return power_q47 == 0 ? LM_RCS_NONE_DBSM_Q8
                          : chip->slot->total_dbsm_q8 + chip->gain_db_q8 + fx_db_q8_u64(power_q47) -
                                fx_db_q8_u64((uint64_t)1 << 47);
}

uint32_t lm_chip_patch_shadow(const struct lm_chip_patch *chip, int32_t right_cells_q8,
                              int32_t beyond_cells_q8)
{
    const int32_t half_px_q8 = chip->dark_half_px_q8;
    const struct box b = box_at(chip, right_cells_q8, beyond_cells_q8, half_px_q8, half_px_q8);
    const uint32_t area_q16 = 4 * (uint32_t)half_px_q8 * (uint32_t)half_px_q8;
    return (uint32_t)(4 * within(chip->slot->shadow, &b) / area_q16);
}
