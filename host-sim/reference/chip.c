#include "reference/chip.h"

#include "reference/reference.h"

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

/* A polygon in columns and rows. */
enum { CORNERS_MOST = 8 };
struct polygon {
    int count;
    double at[CORNERS_MOST][2];
};

/* The part of a convex polygon where column or row (`axis`) is beyond `edge`, or, sign -1, before.
 */
static struct polygon cut(const struct polygon *p, int axis, double sign, double edge)
{
    struct polygon left = {0};
    for (int i = 0; i < p->count; i++) {
        const double *a = p->at[i], *b = p->at[(i + 1) % p->count];
        const double in_a = sign * (a[axis] - edge), in_b = sign * (b[axis] - edge);
        if (in_a >= 0) {
            left.at[left.count][0] = a[0];
            left.at[left.count++][1] = a[1];
        }
        if ((in_a >= 0) != (in_b >= 0)) {
            const double t = in_a / (in_a - in_b);
            left.at[left.count][0] = a[0] + t * (b[0] - a[0]);
            left.at[left.count++][1] = a[1] + t * (b[1] - a[1]);
        }
    }
    return left;
}

static double area_of(const struct polygon *p)
{
    double twice = 0;
    for (int i = 0; i < p->count; i++) {
        const double *a = p->at[i], *b = p->at[(i + 1) % p->count];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return fabs(twice) / 2;
}

/* The part of a pixel that lies under a polygon. */
static double overlap(const struct polygon *p, int column, int row)
{
    struct polygon part = cut(p, 0, 1, column);
    part = cut(&part, 0, -1, column + 1);
    part = cut(&part, 1, 1, row);
    part = cut(&part, 1, -1, row + 1);
    return area_of(&part);
}

static double lowest(const struct polygon *p, int axis)
{
    return fmin(fmin(p->at[0][axis], p->at[1][axis]), fmin(p->at[2][axis], p->at[3][axis]));
}

static double highest(const struct polygon *p, int axis)
{
    return fmax(fmax(p->at[0][axis], p->at[1][axis]), fmax(p->at[2][axis], p->at[3][axis]));
}

double ref_chip_cell_m2(const struct ref_chip *c, int block, double right_m, double beyond_m,
                        double cell_m)
{
    static const double corner[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    const double side_m = fmax(cell_m, c->pixel_m * block);
    struct polygon box = {.count = 4};
    double sum = 0;
    for (int i = 0; i < 4; i++) {
        pixel_at(c, right_m + corner[i][0] * side_m, beyond_m + corner[i][1] * side_m,
                 &box.at[i][0], &box.at[i][1]);
        box.at[i][0] /= block;
        box.at[i][1] /= block;
    }
    for (int row = (int)floor(lowest(&box, 1)); row < highest(&box, 1); row++) {
        for (int column = (int)floor(lowest(&box, 0)); column < highest(&box, 0); column++) {
            const double m2 = block_m2(c->chip, block, row, column);
            sum += m2 == 0 ? 0 : m2 * overlap(&box, column, row);
        }
    }
    return sum * pow(cell_m / side_m, 2);
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

double ref_chip_level_m(double antenna_m, double range_m, double beyond_m, double rise_m)
{
    const double tangent = ref_tangent(antenna_m, range_m + beyond_m, rise_m);
    double near_m = 1 - range_m, far_m = 2 * range_m;
    for (int i = 0; i < 60; i++) {
        const double middle_m = (near_m + far_m) / 2;
        const bool is_above = ref_tangent(antenna_m, range_m + middle_m, 0) < tangent;
        *(is_above ? &near_m : &far_m) = middle_m;
    }
    return (near_m + far_m) / 2;
}
