/* Side lobes of a patch's strong cells: EQUATIONS.md, "Side lobes of the ground". */
#include "fx/hash.h"
#include "hs/error.h"
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>

enum { REACH = 8, BESIDE = 4, PLACES = 8 };

static const double first_null = 1.663, left_out_db = 25;

/* Strong cell: its power, and where its point lies, cells from the middle. */
struct strong {
    size_t cell;
    double power, right, beyond;
};

static double place(uint32_t draw)
{
    return (2 * (double)(draw % PLACES) - (PLACES - 1)) / (2 * PLACES);
}

/* At the ends of the line its first or last cell stands for those beyond. */
static bool stands_out(const double *level_db, size_t cells, size_t cell,
                       const struct ref_side_lobes *law)
{
    const size_t first = cell > BESIDE ? cell - BESIDE : 0;
    const size_t last = cell + BESIDE < cells ? cell + BESIDE : cells - 1;
    for (size_t i = first; i <= last; i++) {
        if (level_db[i] > level_db[cell]) {
            return false;
        }
    }
    return level_db[first] <= level_db[cell] - law->above_db &&
           level_db[last] <= level_db[cell] - law->above_db;
}

/* The strongest that stand out, the first of equals; returns how many. */
static size_t find(const double *level_db, size_t cells, double least_db, uint32_t line,
                   uint32_t seed, const struct ref_side_lobes *law, struct strong *strong)
{
    size_t count = 0;
    for (size_t i = 0; i < cells; i++) {
        if (level_db[i] < least_db || !stands_out(level_db, cells, i, law)) {
            continue;
        }
        const uint32_t draw = fx_hash3(line, (uint32_t)i, seed);
        const double power = pow(10, level_db[i] / 10);
        size_t at = count;
        for (; at > 0 && strong[at - 1].power < power; at--) {
            if (at < (size_t)law->a_line) {
                strong[at] = strong[at - 1];
            }
        }
        if (at < (size_t)law->a_line) {
            strong[at] = (struct strong){i, power, place(draw), place(draw / PLACES)};
            count += count < (size_t)law->a_line;
        }
    }
    return count;
}

/* Power of a point `off` its cell's middle in the cell `n` away, over that in its own. */
static double side(double own, double n, double off)
{
    const double x = n - off;
    return fabs(x) < first_null || fabs(x) > REACH ? 0 : pow(ref_point_response(x), 2) / own;
}

static double own_power(void)
{
    double sum = 0;
    for (uint32_t k = 0; k < PLACES; k++) {
        sum += pow(ref_point_response(place(k)), 2) / PLACES;
    }
    return sum;
}

/* A side lobe that is not far under what is there. */
static void add(double *sum, double level_db, double power)
{
    *sum += power > pow(10, (level_db - left_out_db) / 10) ? power : 0;
}

/* The cross of a point on line k. */
static void draw_cross(double own, const struct strong *p, ptrdiff_t k, const double *level_db,
                       double *sum, ptrdiff_t lines, ptrdiff_t cells)
{
    const ptrdiff_t cell = (ptrdiff_t)p->cell;
    for (ptrdiff_t n = -REACH; n <= REACH; n++) {
        const ptrdiff_t along = k * cells + cell + n, across = (k + n) * cells + cell;
        if (cell + n >= 0 && cell + n < cells) {
            add(&sum[along], level_db[along], p->power * side(own, (double)n, p->beyond));
        }
        if (k + n >= 0 && k + n < lines) {
            add(&sum[across], level_db[across], p->power * side(own, (double)n, p->right));
        }
    }
}

int ref_side_lobes(const struct ref_side_lobes *law, double *level_db, const double *shadow_db,
                   size_t lines, size_t cells, uint32_t seed)
{
    const double own = own_power();
    double *sum = calloc(lines * cells, sizeof *sum);
    struct strong *strong = calloc((size_t)law->a_line + 1, sizeof *strong);
    for (size_t k = 0; sum && strong && k < lines; k++) {
        const size_t count = find(&level_db[k * cells], cells, shadow_db[k] + law->over_shadow_db,
                                  (uint32_t)k, seed, law, strong);
        for (size_t i = 0; i < count; i++) {
            draw_cross(own, &strong[i], (ptrdiff_t)k, level_db, sum, (ptrdiff_t)lines,
                       (ptrdiff_t)cells);
        }
    }
    for (size_t i = 0; sum && strong && i < lines * cells; i++) {
        level_db[i] = 10 * log10(pow(10, level_db[i] / 10) + sum[i]);
    }
    const bool is_done = sum && strong;
    free(sum);
    free(strong);
    return is_done ? 0 : hs_error("picture", "ask for fewer lines or cells", "out of memory");
}
