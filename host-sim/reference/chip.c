#include "chip.h"

#include <math.h>
#include <stdbool.h>

enum { STEPS = 16 }; /* of a cell, either way */

static double pixel_m2(const struct lm_chip *chip, int row, int column)
{
    if (row < 0 || row >= LM_CHIP_SIDE || column < 0 || column >= LM_CHIP_SIDE) {
        return 0;
    }
    const int code = chip->level[row][column];
    return code == 0 ? 0 : pow(10, (code / 2.0 - 80) / 10);
}

double ref_chip_total_m2(const struct lm_chip *chip)
{
    double sum = 0;
    for (int row = 0; row < LM_CHIP_SIDE; row++) {
        for (int column = 0; column < LM_CHIP_SIDE; column++) {
            sum += pixel_m2(chip, row, column);
        }
    }
    return sum;
}

static double block_m2(const struct lm_chip *chip, int block, int row, int column)
{
    double sum = 0;
    for (int r = row * block; r < (row + 1) * block; r++) {
        for (int k = column * block; k < (column + 1) * block; k++) {
            sum += pixel_m2(chip, r, k);
        }
    }
    return sum;
}

/* Column and row, in pixels from the chip's corner, of a place beside the origin. */
static void pixel_at(const struct ref_chip *c, double right_m, double beyond_m, double *column,
                     double *row)
{
    const double cosine = cos(c->turn_rad), sine = sin(c->turn_rad);
    *column = LM_CHIP_SIDE / 2.0 + (right_m * cosine + beyond_m * sine) / c->pixel_m;
    *row = c->origin_row + (beyond_m * cosine - right_m * sine) / c->pixel_m;
}

/* Square metres of cross section a block of pixels, between the middles of four of them. */
static double interpolated_m2(const struct ref_chip *c, int block, double right_m, double beyond_m)
{
    double column, row;
    pixel_at(c, right_m, beyond_m, &column, &row);
    const double x = column / block - 0.5, y = row / block - 0.5;
    const int left = (int)floor(x), low = (int)floor(y);
    const double fx = x - left, fy = y - low;
    return (1 - fy) * ((1 - fx) * block_m2(c->chip, block, low, left) +
                       fx * block_m2(c->chip, block, low, left + 1)) +
           fy * ((1 - fx) * block_m2(c->chip, block, low + 1, left) +
                 fx * block_m2(c->chip, block, low + 1, left + 1));
}

static double shadow_at(const struct ref_chip *c, double right_m, double beyond_m)
{
    double column, row;
    pixel_at(c, right_m, beyond_m, &column, &row);
    const int k = (int)floor(column), r = (int)floor(row);
    const bool is_on_chip = r >= 0 && r < LM_CHIP_SIDE && k >= 0 && k < LM_CHIP_SIDE;
    return is_on_chip ? c->chip->shadow[r][k / 8] >> k % 8 & 1 : 0;
}

/* The middle of step i of a cell, from the cell's own. */
static double step_m(int i, double cell_m)
{
    return ((i + 0.5) / STEPS - 0.5) * cell_m;
}

double ref_chip_cell_m2(const struct ref_chip *c, int block, double right_m, double beyond_m,
                        double cell_m)
{
    const double blocks_a_step = pow(cell_m / STEPS / (c->pixel_m * block), 2);
    double sum = 0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        sum += interpolated_m2(c, block, right_m + step_m(i % STEPS, cell_m),
                               beyond_m + step_m(i / STEPS, cell_m));
    }
    return sum * blocks_a_step;
}

double ref_chip_cell_shadow(const struct ref_chip *c, double right_m, double beyond_m,
                            double cell_m)
{
    double sum = 0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        sum +=
            shadow_at(c, right_m + step_m(i % STEPS, cell_m), beyond_m + step_m(i / STEPS, cell_m));
    }
    return sum / (STEPS * STEPS);
}
