#include "build/towns.h"

#include "image/codes.h"
#include "lm/radar.h"

#include <math.h>
#include <stdbool.h>

enum { CELLS = LM_TILE_CELLS };

/* UNSOURCED: what counts as built-up, and how steeply towns are usually looked at: from 3,000 m,
 * 20 km away. */
static const double surroundings_m = 150, built_share = 0.15, grazing_tangent = 0.15;
/* Levels without towns of their own are not turned up to the table's mean by force. */
static const double gain_most_db = 12;

static bool is_structure(const struct lm_classes *classes, uint16_t cell)
{
    const uint8_t k = image_cell_class(cell);
    return k != LM_DB_CLASS_NONE && classes->entry[k].kind == LM_KIND_STRUCTURE;
}

/* Sums over all cells south and west of a corner. */
static void sum_structures(const uint16_t cells[CELLS][CELLS], const struct lm_classes *classes,
                           int sum[CELLS + 1][CELLS + 1])
{
    for (int c = 0; c <= CELLS; c++) {
        sum[0][c] = 0;
    }
    for (int r = 0; r < CELLS; r++) {
        int row = 0;
        sum[r + 1][0] = 0;
        for (int c = 0; c < CELLS; c++) {
            row += is_structure(classes, cells[r][c]);
            sum[r + 1][c + 1] = sum[r][c + 1] + row;
        }
    }
}

static int within(int i)
{
    return i < 0 ? 0 : i > CELLS ? CELLS : i;
}

void build_towns_mark(const uint16_t cells[CELLS][CELLS], const struct lm_classes *classes,
                      double cell_m, float built[CELLS][CELLS])
{
    int sum[CELLS + 1][CELLS + 1];
    sum_structures(cells, classes, sum);
    const int half = (int)fmin(CELLS, round(0.5 * surroundings_m / cell_m));
    for (int r = 0; r < CELLS; r++) {
        for (int c = 0; c < CELLS; c++) {
            const int south = within(r - half), north = within(r + half + 1);
            const int west = within(c - half), east = within(c + half + 1);
            const int found =
                sum[north][east] - sum[south][east] - sum[north][west] + sum[south][west];
            const float share = (float)found / (float)((north - south) * (east - west));
            built[r][c] = share >= (float)built_share ? share : 0;
        }
    }
}

static double power_of_db(double db)
{
    return pow(10, db / 10);
}

/* A line across the tile: cells are cell0, cell0 + step, ... */
struct line {
    const struct build_towns_tile *tile;
    const struct lm_classes *classes;
    double cell_m;
    int row, column, row_step, column_step;
};

static double ground_m(const struct build_towns_tile *t, int r, int c)
{
    return ((double)t->posts_q6[r][c] + t->posts_q6[r][c + 1] + t->posts_q6[r + 1][c] +
            t->posts_q6[r + 1][c + 1]) /
           256;
}

/* Sums over one tile. */
struct share {
    double area, structure_power, other_power;
};

/* The law of illumination for rays that all come in at the same angle. The quarter of the line that
 * is met first only raises the horizon. */
static void add_line(struct share *share, const struct line *l)
{
    const double flat = l->cell_m * grazing_tangent;
    const double edge = power_of_db(lm_radar_default.illumination.edge_structure_db_q8 / 256.0);
    double horizon = 0;
    bool was_structure = true;
    for (int i = 0; i < CELLS; i++) {
        const int r = l->row + i * l->row_step, c = l->column + i * l->column_step;
        const uint16_t cell = l->tile->cells[r][c];
        const bool stands = is_structure(l->classes, cell);
        const double height_m = l->classes->height_dm[image_cell_height(cell)] / 10.0;
        const double top = ground_m(l->tile, r, c) + height_m + i * flat;
        const double rise = i == 0 ? flat : top - horizon;
        const double weight = i < CELLS / 4 ? 0 : (double)l->tile->built[r][c];
        if (rise > 0) {
            horizon = top;
            const double power = weight * rise / flat *
                                 power_of_db(image_gamma_db(image_cell_gamma(cell))) *
                                 (stands && !was_structure ? edge : 1);
            *(stands ? &share->structure_power : &share->other_power) += power;
        }
        share->area += weight;
        was_structure = stands;
    }
}

static void add_table(struct build_towns *towns, const struct build_towns_tile *tile,
                      const struct lm_classes *classes)
{
    double power = 0, count = 0;
    for (int i = 0; i < CELLS * CELLS; i++) {
        const uint16_t cell = tile->cells[i / CELLS][i % CELLS];
        if (is_structure(classes, cell)) {
            const double weight = (double)tile->built[i / CELLS][i % CELLS];
            power +=
                weight * power_of_db(classes->entry[image_cell_class(cell)].gamma_db_q8 / 256.0);
            count += weight;
        }
    }
    build_sum_add(&towns->table_power, power);
    build_sum_add(&towns->table_count, count);
}

static bool has_built(const struct build_towns_tile *tile)
{
    for (int i = 0; i < CELLS * CELLS; i++) {
        if (tile->built[i / CELLS][i % CELLS] > 0) {
            return true;
        }
    }
    return false;
}

void build_towns_add(struct build_towns *t, int level, const struct build_towns_tile *tile,
                     const struct lm_classes *classes, double north_m, double east_m)
{
    struct share share = {0};
    if (!has_built(tile)) {
        return;
    }
    for (int i = 0; i < CELLS; i++) {
        const struct line lines[4] = {{tile, classes, east_m, i, 0, 0, 1},
                                      {tile, classes, east_m, i, CELLS - 1, 0, -1},
                                      {tile, classes, north_m, 0, i, 1, 0},
                                      {tile, classes, north_m, CELLS - 1, i, -1, 0}};
        for (int k = 0; k < 4; k++) {
            add_line(&share, &lines[k]);
        }
    }
    build_sum_add(&t->area[level], share.area);
    build_sum_add(&t->structure_power[level], share.structure_power);
    build_sum_add(&t->other_power[level], share.other_power);
    if (level == 0) {
        add_table(t, tile, classes);
    }
}

void build_towns_join(struct build_towns *t, const struct build_towns *other)
{
    for (int level = 0; level < LM_DB_LODS_MAX; level++) {
        build_sum_join(&t->area[level], &other->area[level]);
        build_sum_join(&t->structure_power[level], &other->structure_power[level]);
        build_sum_join(&t->other_power[level], &other->other_power[level]);
    }
    build_sum_join(&t->table_power, &other->table_power);
    build_sum_join(&t->table_count, &other->table_count);
}

double build_towns_gain_db(const struct build_towns *t, int level)
{
    const double count = build_sum_value(&t->table_count);
    const double power = build_sum_value(&t->structure_power[level]);
    if (count <= 0 || power <= 0) {
        return 0;
    }
    const double wanted =
        build_sum_value(&t->table_power) / count * build_sum_value(&t->area[level]) -
        build_sum_value(&t->other_power[level]);
    const double gain = wanted > 0 ? 10 * log10(wanted / power) : -gain_most_db;
    return fmin(gain_most_db, fmax(-gain_most_db, gain));
}
