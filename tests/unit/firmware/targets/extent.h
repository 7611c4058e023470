/* How far the power of a smeared target reaches in a picture. */
#ifndef EXTENT_H
#define EXTENT_H

#include <math.h>
#include <stddef.h>

/* Lines and cells that the middle 80 % of the power takes, the correlation of both, and all of it.
 */
struct extent {
    double across, along, correlation, sum;
};

/* What row or column `number` has: `count` powers, `step` apart. */
static inline double extent_sum(const double *power, size_t count, size_t step)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += power[i * step];
    }
    return sum;
}

/* Of `count` rows, `apart` from each other, whose numbers are `step` apart. */
static inline double middle_80(const double *power, size_t count, size_t apart, size_t others,
                               size_t step)
{
    double all = 0, sum = 0, from = 0, to = 0;
    for (size_t i = 0; i < count; i++) {
        all += extent_sum(power + i * apart, others, step);
    }
    for (size_t i = 0; i < count; i++) {
        const double before = sum, own = extent_sum(power + i * apart, others, step);
        sum += own;
        if (before < 0.1 * all && sum >= 0.1 * all) {
            from = (double)i + (0.1 * all - before) / own;
        }
        if (before < 0.9 * all && sum >= 0.9 * all) {
            to = (double)i + (0.9 * all - before) / own;
        }
    }
    return to - from;
}

static inline struct extent extent_of(const double *power, size_t lines, size_t cells)
{
    double sum = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
    for (size_t n = 0; n < lines * cells; n++) {
        const double p = power[n], k = (double)(n / cells), i = (double)(n % cells);
        sum += p;
        x += p * k, y += p * i, xx += p * k * k, yy += p * i * i, xy += p * k * i;
    }
    x /= sum, y /= sum;
    return (struct extent){middle_80(power, lines, cells, cells, 1),
                           middle_80(power, cells, 1, lines, cells),
                           (xy / sum - x * y) / sqrt((xx / sum - x * x) * (yy / sum - y * y)), sum};
}

#endif
