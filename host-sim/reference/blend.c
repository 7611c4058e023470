/* What lies between the map's cells: EQUATIONS.md, "Finer than the map". */
#include "fx/hash.h"
#include "reference/reference.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>

enum { TEXELS = 64, STEPS = 128, ROWS_OF_TREES = 11, TREES_IN_A_ROW = 10 };

/* H of the page. */
static double drawn(int a, int b, int c)
{
    return ldexp(fx_hash3((uint32_t)a, (uint32_t)b, (uint32_t)c), -32);
}

static double bend(int row, int column)
{
    const double turn = 2 * acos(-1.0);
    double sum = 0;
    for (int p = 0; p <= 16; p++) {
        for (int q = p == 0 ? 1 : -16; q <= 16; q++) {
            const double k = hypot(p, q);
            if (k >= 3 && k <= 16) {
                const double phase =
                    (p * 2 * row + q * 2 * column) / (double)STEPS + drawn(p, q, 1);
                sum += cos(turn * phase) / pow(k, 1.2);
            }
        }
    }
    return 230.0 / 32768 * fmax(-127, fmin(127, round(60 * sum)));
}

/* The shorter way round between two places of the pattern. */
static double apart(double a, double b)
{
    const double d = fmod(fabs(a - b), STEPS);
    return fmin(d, STEPS - d);
}

static double dome(int i, int j, int row, int column)
{
    const double north = 128.0 / ROWS_OF_TREES * (i + 0.5 + 0.7 * (drawn(i, j, 2) - 0.5));
    const double east = 128.0 / TREES_IN_A_ROW * (j + 0.5 * (i % 2) + 0.7 * (drawn(i, j, 3) - 0.5));
    const double radius = 4.6 + 2.6 * drawn(i, j, 4);
    const double x = hypot(apart(2 * row, north), 0.75 * apart(2 * column, east)) / radius;
    if (drawn(i, j, 6) < 1.0 / 12 || x >= 1) {
        return 0;
    }
    return (0.96 + 0.16 * drawn(i, j, 5)) * (1 - 0.16 * x * x);
}

static double crown(int row, int column)
{
    double canopy = 0.8;
    for (int i = 0; i < ROWS_OF_TREES; i++) {
        for (int j = 0; j < TREES_IN_A_ROW; j++) {
            canopy = fmax(canopy, dome(i, j, row, column));
        }
    }
    return round(canopy / 0.923 * 256) / 256;
}

/* The pattern of every texel, worked out once. */
static struct pattern {
    double bend[TEXELS][TEXELS], crown[TEXELS][TEXELS];
} pattern;

static void grow(void)
{
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        pattern.bend[i / TEXELS][i % TEXELS] = bend(i / TEXELS, i % TEXELS);
        pattern.crown[i / TEXELS][i % TEXELS] = crown(i / TEXELS, i % TEXELS);
    }
}

static const struct pattern *grown(void)
{
    static pthread_once_t once = PTHREAD_ONCE_INIT;
    pthread_once(&once, grow);
    return &pattern;
}

/* What lies between four texels. */
static double between(const double at[TEXELS][TEXELS], double row, double column)
{
    const int r = (int)floor(row), c = (int)floor(column), after_r = (r + 1) % TEXELS,
              after_c = (c + 1) % TEXELS;
    const double v = row - r, u = column - c;
    return (1 - v) * ((1 - u) * at[r][c] + u * at[r][after_c]) +
           v * ((1 - u) * at[after_r][c] + u * at[after_r][after_c]);
}

double ref_grown_bend(double row, double column)
{
    return between(grown()->bend, row, column);
}

double ref_grown_crown(double row, double column)
{
    return between(grown()->crown, row, column);
}

static int class_of(uint16_t cell)
{
    return cell >> 4 & 15;
}

static bool is_natural(const struct ref_db *db, int k)
{
    return db->classes->entry[k].flags & LM_CLASS_NATURAL;
}

/* The class that wins among four cells with these weights; `bend` is n. */
static int winner_of(const struct ref_db *db, const uint16_t cell[4], const double share[16],
                     double bend)
{
    int m = class_of(cell[0]);
    for (int i = 1; i < 4; i++) {
        const int k = class_of(cell[i]);
        const double n = is_natural(db, k) && is_natural(db, m) ? bend : 0;
        const double lean = (k > m ? n : -n) * (share[k] + share[m]);
        if (k != m && share[k] - share[m] + lean > 0) {
            m = k;
        }
    }
    return m;
}

void ref_blend_cells(const struct ref_db *db, const struct ref_corners *c, struct ref_bin *bin)
{
    const double weight[4] = {(1 - c->east) * (1 - c->north), c->east * (1 - c->north),
                              (1 - c->east) * c->north, c->east * c->north};
    double share[16] = {0}, gamma_db = 0, height_m = 0;
    bool are_mixed = false;
    for (int i = 0; i < 4; i++) {
        share[class_of(c->cell[i])] += weight[i];
        are_mixed = are_mixed || class_of(c->cell[i]) != class_of(c->cell[0]);
    }
    const double bend = are_mixed ? ref_grown_bend(c->texel_row, c->texel_column) : 0;
    const int k = winner_of(db, c->cell, share, bend);
    for (int i = 0; i < 4; i++) {
        if (class_of(c->cell[i]) == k) {
            gamma_db += weight[i] / share[k] * ((c->cell[i] >> 8) / 2.0 - 80);
            height_m += weight[i] / share[k] * db->classes->height_dm[c->cell[i] & 15] / 10.0;
        }
    }
    bin->class_index = k;
    bin->kind = db->classes->entry[k].kind;
    bin->facing = db->classes->entry[k].facing;
    bin->has_data = k != LM_DB_CLASS_NONE;
    bin->gamma_db = gamma_db;
    bin->height_m = height_m;
    if (c->has_crowns && bin->kind == LM_KIND_TREES) {
        bin->height_m *= ref_grown_crown(c->texel_row, c->texel_column);
    }
}
