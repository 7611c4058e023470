#include "lm/grain.h"

#include <stdbool.h>

#include "fx/log.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/kernels_clutter.h"
#include "lm/kernels_radar.h"
#include "lm/lanes.h"

_Static_assert((int)LM_GRAIN_LINES == (int)LM_K_CURVE_LINES,
               "as many lines as the kernels look up");
_Static_assert((int)LM_GRAIN_WAY == (int)LM_K_GRAIN_WAY, "as many weights");

void lm_grain_curve_set(struct lm_grain_curve *curve, uint32_t looks_q8)
{
    const uint32_t looks = fx_min_u32(fx_max_u32(looks_q8, 256), LM_GRAIN_LOOKS_MAX_Q8);
    /* Eight rows an octave, in Q16: 0..48. At the last row the one behind it has no weight. */
    const int32_t at_q16 = 8 * (fx_log2_q16(looks) - (8 << 16));
    const int32_t row = fx_min_i32(at_q16 >> 16, LM_GRAIN_LOOKS_ROWS - 2);
    const int32_t part_q8 = (at_q16 - row * 65536) >> 8;
    const int16_t *few = lm_grain_knot_db_q8[row], *many = lm_grain_knot_db_q8[row + 1];
    int32_t knot_db_q8[LM_GRAIN_LINES + 1];
    for (uint32_t n = 0; n <= LM_GRAIN_LINES; n++) {
        knot_db_q8[n] = few[n] + ((many[n] - few[n]) * part_q8 >> 8);
    }
    for (uint32_t n = 0; n < LM_GRAIN_LINES; n++) {
        curve->base_db_q8[n] = knot_db_q8[n];
        curve->rise_db_q8[n] = knot_db_q8[n + 1] - knot_db_q8[n];
    }
}

void lm_grain_row(struct lm_grain_place place, int8_t *grain_q5, uint32_t cells)
{
    const int8_t *row = lm_grain_q5[place.row % LM_GRAIN_ROWS];
    uint32_t from = (place.column + place.row / LM_GRAIN_ROWS * LM_GRAIN_TWIST) % LM_GRAIN_COLUMNS;
    for (uint32_t i = 0; i < cells;) {
        const uint32_t count = fx_min_u32(cells - i, LM_GRAIN_COLUMNS - from);
        memcpy(grain_q5 + i, row + from, count);
        i += count;
        from = 0;
    }
}

enum { GROUP = 16 }; /* cells that kernels read and write at once */

static struct lm_k_curve kernel_curve(const struct lm_grain_curve *curve)
{
    return (struct lm_k_curve){curve->base_db_q8, curve->rise_db_q8};
}

void lm_grain_run(const struct lm_grain_curve *curve, struct lm_grain_place place,
                  int16_t *level_db_q8, uint32_t cells)
{
    int8_t grain_q5[LM_CELLS_ROOM];
    const struct lm_k_curve lines = kernel_curve(curve);
    lm_grain_row(place, grain_q5, cells);
    lm_k_grain_add(&lines, grain_q5, level_db_q8, cells);
}

void lm_grain_floor_run(const struct lm_grain_curve *curve, struct lm_grain_place place,
                        int32_t floor_db_q8, const int16_t *level_db_q8, int16_t *speckled_db_q8,
                        uint32_t cells)
{
    int8_t grain_q5[LM_CELLS_ROOM];
    const struct lm_k_curve lines = kernel_curve(curve);
    lm_grain_row(place, grain_q5, cells);
    lm_k_grain_floor(&lines, grain_q5, floor_db_q8, level_db_q8, speckled_db_q8, cells);
}

/* Numbers between two rows, in sixty-fourths of the way from the first. */
static void mix_rows(const struct lm_grain_stretch *s, int8_t *grain_q5, uint32_t columns)
{
    int8_t second_q5[LM_CELLS_ROOM];
    struct lm_grain_place place = s->start;
    place.row += (uint32_t)(s->row_q16 >> 16);
    lm_grain_row(place, grain_q5, columns);
    place.row++;
    lm_grain_row(place, second_q5, columns);
    const uint32_t way = (uint32_t)(s->row_q16 & 65535) / (65536 / LM_GRAIN_WAY);
    const int16_t first_q7 = lm_grain_weight_q7[LM_GRAIN_WAY - way];
    const int16_t second_q7 = lm_grain_weight_q7[way];
    for (uint32_t i = 0; i < columns; i++) {
        grain_q5[i] = lm_k_grain_between(grain_q5[i], first_q7, second_q5[i], second_q7);
    }
}

void lm_grain_powers(const struct lm_grain_curve *curve, const struct lm_grain_stretch *stretch,
                     uint32_t *power_q24, uint32_t cells)
{
    int8_t column_q5[LM_CELLS_ROOM + LM_K_GRAIN_BEHIND], grain_q5[LM_CELLS_ROOM];
    int16_t level_db_q8[LM_CELLS_ROOM];
    const struct lm_k_curve lines = kernel_curve(curve);
    const bool is_stretched = stretch->step_q16 < 65536;
    mix_rows(stretch, column_q5, cells + 1);
    if (is_stretched) {
        lm_k_grain_stretch(lm_grain_weight_q7, stretch->step_q16, column_q5, grain_q5, cells);
    }
    memset(level_db_q8, 0, (cells + GROUP - 1) / GROUP * GROUP * sizeof *level_db_q8);
    lm_k_grain_add(&lines, is_stretched ? grain_q5 : column_q5, level_db_q8, cells);
    lm_k_powers_of_levels(level_db_q8, power_q24, cells);
}
