#include "lm/chip_patch.h"

#include "fx/log.h"
#include "fx/sat.h"
#include "fx/trig.h"

/* a b / 2^30, for a position on the chip below 2^23 and a sine or cosine: below 2^53. */
static int32_t part(int64_t a, int32_t b_q30)
{
    return (int32_t)(a * b_q30 >> 30);
}

/* Angle by which the chip is turned. */
struct rotation {
    int32_t cos_q30, sin_q30;
};

/* Corner of a box of pixels, relative to the origin and turned by the chip's angle. */
struct chip_corner {
    int32_t right_px_q16, beyond_px_q16;
};

static struct chip_corner turned(const struct lm_chip_patch *chip, const struct rotation *r,
                                 int32_t column_q16, int32_t row_q16)
{
    const int32_t x = column_q16 - chip->origin_px_q16[0], y = row_q16 - chip->origin_px_q16[1];
    return (struct chip_corner){part(x, r->cos_q30) - part(y, r->sin_q30),
                                part(x, r->sin_q30) + part(y, r->cos_q30)};
}

/* Whole cells from the origin to a coordinate in pixels, with `more` for what lies within a cell.
 */
static int32_t cells_of(int32_t pixels_q16, uint32_t pixels_a_cell_q16, int32_t more)
{
    return pixels_q16 / (int32_t)fx_max_u32(pixels_a_cell_q16, 1) + more;
}

/* Whole cells that a stretched box covers more on either side, rounded up. */
static int32_t more_of(uint32_t stretch_q8)
{
    return (int32_t)((stretch_q8 - 256 + 511) / 512);
}

/* Cells that show any pixel of a box: the box of pixels grows by half a pixel, and the cells by
 * one, all around. */
static struct lm_chip_reach reach_of(const struct lm_chip_patch *chip,
                                     const struct lm_chip_box *box, const struct rotation *turn,
                                     uint32_t scale_q16)
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
        const struct chip_corner c = turned(chip, turn, column_q16, row_q16);
        r.right = fx_min_i32(r.right, cells_of(c.right_px_q16, scale_q16, -1));
        r.right_end = fx_max_i32(r.right_end, cells_of(c.right_px_q16, scale_q16, 2));
        r.beyond = fx_min_i32(r.beyond, cells_of(c.beyond_px_q16, scale_q16, -1));
        r.beyond_end = fx_max_i32(r.beyond_end, cells_of(c.beyond_px_q16, scale_q16, 2));
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

/* Column and row of a cell `right` and `beyond` of the target's origin, with k pixels to a cell and
 * the chip turned by d:
 *
 *     column = column0 + k ( right cos d + beyond sin d)
 *     row    = row0    + k (-right sin d + beyond cos d) */
void lm_chip_patch_set(struct lm_chip_patch *chip, const struct lm_chip_slot *slot, fx_bam_t turn,
                       uint32_t cell_mm, const struct lm_smear *smear)
{
    /* Pixels of a cell. A chip is reduced to pixels of half a cell or more, so this is below 2^18.
     */
    const uint32_t scale_q16 = (uint32_t)(((uint64_t)cell_mm << 16) / slot->pixel_mm);
    const struct rotation r = {fx_cos_q30(turn), fx_sin_q30(turn)};
    chip->slot = slot;
    chip->right_px_q16[0] = chip->beyond_px_q16[1] = part(scale_q16, r.cos_q30);
    chip->beyond_px_q16[0] = part(scale_q16, r.sin_q30);
    chip->right_px_q16[1] = -chip->beyond_px_q16[0];
    chip->origin_px_q16[0] = (int32_t)slot->side << 15;
    chip->origin_px_q16[1] = (int32_t)((uint32_t)slot->origin_row << 16 >> slot->key.shift);
    chip->lit = reach_of(chip, &slot->lit, &r, scale_q16);
    chip->dark = reach_of(chip, &slot->dark, &r, scale_q16);
    widen(&chip->lit, smear);
    chip->half_px_q8[0] = half_px_q8_of(scale_q16, smear->across_stretch_q8);
    chip->half_px_q8[1] = half_px_q8_of(scale_q16, smear->along_stretch_q8);
    chip->dark_half_px_q8 = half_px_q8_of(scale_q16, 256);
    chip->gain_db_q8 = side_gain_db_q8(scale_q16, smear->across_stretch_q8, chip->half_px_q8[0]) +
                       side_gain_db_q8(scale_q16, smear->along_stretch_q8, chip->half_px_q8[1]);
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
