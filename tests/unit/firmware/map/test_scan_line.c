/* What a line finds on the ground, against a direct evaluation of the image in double precision.
 * The evaluation reads the image's bytes by docs/FORMATS.md, not through the cache. */
#include "check.h"
#include "hs/rng.h"
#include "lm/scan_line.h"
#include "tiny_map.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double bam_per_degree = 4294967296.0 / 360;

struct world {
    struct tiny_map map;
    struct lm_scan_line line;
};

enum { SLOTS = 400 };

/* Hills, and cells that differ from their neighbours. */
static struct tiny_cell speckled(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const double u = sin(p->latitude_deg * 9e4) + sin(p->longitude_deg * 7e4);
    return (struct tiny_cell){round(u * 20), (uint8_t)(lround(fabs(u) * 7) % 15),
                              (uint8_t)(lround(fabs(u) * 31) % 16)};
}

static double hills(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 300 + 200 * sin(p->north_m / 300) + 90 * cos(p->latitude_deg * 2e3);
}

static void open_world_with(struct world *w, struct tiny_spec spec)
{
    memset(w, 0, sizeof *w);
    spec.cell = speckled;
    spec.elevation_m = hills;
    tiny_map_open(&w->map, &spec, SLOTS);
}

/* Square of 6 x 6 tiles of 64 cells of 4.8 m. */
static void open_world(struct world *w, double latitude_deg, double longitude_deg)
{
    struct tiny_spec spec = tiny_spec_at(latitude_deg, longitude_deg);
    spec.rows = spec.columns = 6;
    open_world_with(w, spec);
}

/* The record of a tile, or NULL where the image has none. */
static const struct lm_tile *find_tile(const struct world *w, uint32_t level, uint32_t row,
                                       uint32_t column)
{
    const int64_t entry = lm_db_entry(&w->map.db, (uint8_t)level, row, column);
    uint32_t place = UINT32_MAX;
    if (entry >= 0) {
        memcpy(&place, w->map.image.bytes + w->map.image.directory_offset + (size_t)entry * 16, 4);
    }
    return place == UINT32_MAX ? NULL
                               : (const struct lm_tile *)(const void *)(w->map.image.bytes +
                                                                        w->map.image.tiles_offset +
                                                                        (size_t)place * 64);
}

/* What the image says at a place, in BAM with a fraction, from the finest level not below `level`
 * that has it. `doubt` is how close the place is to a border between cells, in cells. */
struct ground {
    int is_known;
    uint32_t cell, level;
    double elevation_m, roughness_m, doubt;
};

static struct ground ground_at(const struct world *w, uint32_t level, double latitude,
                               double longitude)
{
    const double from_pole = latitude + 1073741824.0;
    const double share = fabs(latitude) / 1073741824.0 * 16;
    const int zone = share < 11 ? 0 : share < 13 ? 1 : share < 15 ? 2 : 3;
    longitude -= floor(longitude / 4294967296.0) * 4294967296.0;
    for (; level < w->map.db.lod_count; level++) {
        const double high = ldexp(1, w->map.db.shift0 + (int)level), wide = ldexp(high, zone);
        const double y = from_pole / high, x = longitude / wide;
        const uint32_t row = (uint32_t)floor(y), column = (uint32_t)floor(x);
        const struct lm_tile *t = find_tile(w, level, row / 64, column / 64);
        if (t == NULL) {
            continue;
        }
        const uint32_t r = row % 64 + 1, c = column % 64 + 1;
        const double v = y - floor(y), u = x - floor(x);
        const double step_m = ldexp(1, t->post_shift) / 64;
        const double sw = t->points[r][c].post, se = t->points[r][c + 1].post,
                     nw = t->points[r + 1][c].post, ne = t->points[r + 1][c + 1].post;
        return (struct ground){.is_known = 1,
                               .cell = t->points[r][c].cell,
                               .level = level,
                               .elevation_m = t->base_m_q6 / 64.0 +
                                              step_m * ((sw * (1 - u) + se * u) * (1 - v) +
                                                        (nw * (1 - u) + ne * u) * v),
                               .roughness_m = step_m * fmax(fmax(fabs(se - sw), fabs(ne - nw)),
                                                            fmax(fabs(nw - sw), fabs(ne - se))),
                               .doubt = fmin(fmin(u, 1 - u), fmin(v, 1 - v))};
    }
    return (struct ground){0};
}

static double path_at(uint64_t value, uint64_t step, uint64_t bend, uint32_t i, int is_signed)
{
    const double start = is_signed ? (double)(int64_t)value : (double)value;
    return (start + i * (double)(int64_t)step + i * (i - 1.0) / 2 * (double)(int64_t)bend) /
           4294967296.0;
}

struct place {
    double latitude, longitude; /* BAM with a fraction; without wrapping */
};

static struct place place_at(const struct lm_ground_path *p, uint32_t i)
{
    return (struct place){
        path_at(p->latitude, p->latitude_step, p->latitude_bend, i, 1),
        path_at(p->longitude, p->longitude_step, p->longitude_bend, i, 0),
    };
}

/* Compare the line with the image; returns the number of cells that were known. */
static uint32_t compare(const struct world *w, uint32_t level, const struct lm_ground_path *p,
                        uint32_t cells)
{
    uint32_t known = 0, doubtful = 0;
    for (uint32_t i = 0; i < cells; i++) {
        const struct place at = place_at(p, i);
        const struct ground g = ground_at(w, level, at.latitude, at.longitude);
        known += (uint32_t)g.is_known;
        /* Within a thousandth of a cell of a border either side is right; elevation has no border.
         */
        if (g.is_known && g.doubt < 1.0 / 1024) {
            doubtful++;
        } else {
            assert_int_equal(w->line.cell[i], g.is_known ? g.cell : LM_CELL_NONE);
            /* Weights are cut to 1/256, each way. */
            const double allowed_m = g.roughness_m * (2.0 / 256 + 2.0 / 1024) + 10.0 / 16384;
            assert_true(fabs(w->line.elevation_m_q14[i] / 16384.0 - g.elevation_m) <= allowed_m);
        }
    }
    assert_true(doubtful <= 2 + cells / 50);
    return known;
}

/* Compare the runs that are told with the tiles that the places lie in. A line that is told of
 * LM_SCAN_RUNS_MAX tiles may cross more. */
static void compare_runs(const struct world *w, uint32_t level, const struct lm_ground_path *p,
                         uint32_t cells)
{
    const struct lm_scan_run *run = w->line.run, *const end = run + w->line.run_count;
    for (uint32_t i = 0; i < cells; i++) {
        const struct place at = place_at(p, i);
        const double share = fabs(at.latitude) / 1073741824.0 * 16;
        const int zone = share < 11 ? 0 : share < 13 ? 1 : share < 15 ? 2 : 3;
        const double side = ldexp(64, w->map.db.shift0 + (int)level);
        const double turn = 4294967296.0, east = at.longitude - floor(at.longitude / turn) * turn;
        const double row = (at.latitude + 1073741824.0) / side, column = east / ldexp(side, zone);
        while (run < end && run->end <= i) {
            run++;
        }
        if (run == end) {
            assert_int_equal(w->line.run_count, LM_SCAN_RUNS_MAX);
            return;
        }
        if (fabs(row - round(row)) > 1e-4 && fabs(column - round(column)) > 1e-4) {
            assert_int_equal(run->row, (uint32_t)floor(row));
            assert_int_equal(run->column, (uint32_t)floor(column));
        }
    }
}

/* A path of `cells` steps of step_m from a place, bending by so many 2^-32 BAM a step. */
static struct lm_ground_path path_from(double latitude_deg, double longitude_deg,
                                       double azimuth_deg, double step_m, double bend_m)
{
    const double azimuth = azimuth_deg * 3.14159265358979323846 / 180;
    const double to_bam = 4294967296.0 / 0.00931506;
    const double squeeze = cos(latitude_deg * 3.14159265358979323846 / 180);
    return (struct lm_ground_path){
        .latitude = (uint64_t)(int64_t)(latitude_deg * bam_per_degree * 4294967296.0),
        .longitude = (uint64_t)(int64_t)(longitude_deg * bam_per_degree) << 32,
        .latitude_step = (uint64_t)(int64_t)(cos(azimuth) * step_m * to_bam),
        .longitude_step = (uint64_t)(int64_t)(sin(azimuth) * step_m / squeeze * to_bam),
        .latitude_bend = (uint64_t)(int64_t)(bend_m * to_bam),
        .longitude_bend = (uint64_t)(int64_t)(-bend_m * to_bam)};
}

/* Ask for a line, read its tiles, ask again, compare. */
static uint32_t scan_and_compare(struct world *w, uint8_t level, const struct lm_ground_path *p,
                                 uint32_t cells)
{
    lm_scan_line_prefetch(&w->map.tiles, level, p, cells);
    tiny_map_read_tiles(&w->map);
    const uint32_t misses = w->map.tiles.count.misses;
    const struct lm_scan_blend nearest = {.tells_runs = true, .cell_mm = 1u << 29};
    lm_scan_line_run(&w->line, &w->map.tiles, level, &nearest, p, cells);
    assert_int_equal(w->map.tiles.count.misses, misses);
    compare_runs(w, level, p, cells);
    return compare(w, level, p, cells);
}

TEST(lines_of_every_direction_level_and_step_agree_with_the_image)
{
    static struct world w;
    struct hs_rng rng;
    hs_rng_seed(&rng, 12);
    static const double places[][2] = {
        {46, 11}, {-33.5, 151.2}, {0, 0}, {5, -179.9999}, {-12, 180}};
    uint32_t known = 0;
    for (int n = 0; n < 5; n++) {
        open_world(&w, places[n][0], places[n][1]);
        for (int i = 0; i < 120; i++) {
            const uint8_t level = (uint8_t)hs_rng_below(&rng, w.map.db.lod_count);
            const double step_m = 4.8 * (1 << level) * 2.5 * hs_rng_uniform(&rng);
            const double off_deg = 0.012 * (hs_rng_uniform(&rng) - 0.5);
            const double bend_m = 0.001 * (hs_rng_uniform(&rng) - 0.5);
            const double azimuth_deg = 360 * hs_rng_uniform(&rng);
            const double longitude_deg = places[n][1] + 0.012 * (hs_rng_uniform(&rng) - 0.5);
            const struct lm_ground_path p =
                path_from(places[n][0] + off_deg, longitude_deg, azimuth_deg, step_m, bend_m);
            known += scan_and_compare(&w, level, &p, 1 + hs_rng_below(&rng, LM_CELLS_MAX));
        }
        tiny_map_close(&w.map);
    }
    assert_true(known > 20000);
}

/* Its last lanes fill the array to the end, behind which the elevations begin. */
TEST(the_longest_line_ends_without_harm_to_its_beginning)
{
    static struct world w;
    open_world(&w, 46, 11);
    const struct lm_ground_path p = path_from(45.9935, 10.9935, 45, 1.5, 0);
    assert_true(scan_and_compare(&w, 0, &p, LM_CELLS_MAX) > LM_CELLS_MAX / 2);
    assert_true(w.line.run_count > 1 && w.line.elevation_m_q14[0] != 0);
    tiny_map_close(&w.map);
}

TEST(every_step_of_elevation_that_a_tile_may_have_is_read)
{
    static struct world w;
    for (uint8_t post_shift = 0; post_shift <= LM_TILE_POST_SHIFT_MAX; post_shift++) {
        struct tiny_spec spec = tiny_spec_at(46, 11);
        spec.rows = spec.columns = 2;
        spec.post_shift = post_shift;
        open_world_with(&w, spec);
        const struct lm_ground_path p = path_from(45.998, 10.998, 45, 5, 0);
        assert_true(scan_and_compare(&w, 0, &p, 80) > 40);
        tiny_map_close(&w.map);
    }
}

TEST(a_line_that_turns_round_at_a_border_stays_right)
{
    static struct world w;
    open_world(&w, 46, 11);
    /* The vertex of the parabola within a few centimetres of a tile's edge, either side. */
    const double edge_bam =
        floor((46 * bam_per_degree + 1073741824.0) / 32768) * 32768 - 1073741824.0;
    for (int n = -40; n <= 40; n++) {
        struct lm_ground_path p = path_from(46, 10.99, 90, 4, 0);
        const double start_bam = edge_bam + n * 4.0;
        p.latitude = (uint64_t)(int64_t)(start_bam * 4294967296.0);
        p.latitude_step = (uint64_t)(int64_t)(-2000.0 * 4294967296.0 / 20);
        p.latitude_bend = (uint64_t)(int64_t)(2000.0 * 4294967296.0 / 20 / 100 * (1 + n % 7));
        scan_and_compare(&w, 0, &p, 400);
    }
    tiny_map_close(&w.map);
}

TEST(lines_agree_across_the_border_of_a_zone)
{
    static struct world w;
    static const double borders_deg[] = {61.875, -61.875, 73.125, 84.375};
    for (int n = 0; n < 4; n++) {
        open_world(&w, borders_deg[n], 25);
        uint32_t known = 0;
        for (int azimuth = 0; azimuth < 360; azimuth += 20) {
            const struct lm_ground_path p =
                path_from(borders_deg[n] - 0.003 * cos(azimuth * 0.0174533), 25, azimuth, 5, 0);
            known += scan_and_compare(&w, 0, &p, 300);
        }
        assert_true(known > 1500);
        tiny_map_close(&w.map);
    }
}

TEST(lines_agree_across_the_antimeridian_and_greenwich)
{
    static struct world w;
    for (int n = 0; n < 2; n++) {
        const double longitude_deg = n ? 0 : 180;
        open_world(&w, 20, longitude_deg);
        for (int i = 0; i < 20; i++) {
            const double side = i % 2 ? 1 : -1;
            struct lm_ground_path p = path_from(20 + 0.0003 * i, 0, 90 * side + i, 5, 0);
            const double start = longitude_deg * bam_per_degree - side * 500 / 0.00931506;
            p.longitude = (uint64_t)(uint32_t)(int64_t)start << 32;
            assert_true(scan_and_compare(&w, 0, &p, 200) > 150);
        }
        tiny_map_close(&w.map);
    }
}

TEST(lines_near_the_poles_do_no_harm)
{
    static struct world w;
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    static const double latitudes_deg[] = {89.95, -89.95, 88};
    for (int n = 0; n < 3; n++) {
        struct tiny_spec spec = tiny_spec_at(latitudes_deg[n], 100);
        spec.rows = spec.columns = 4;
        open_world_with(&w, spec);
        for (int i = 0; i < 200; i++) {
            const uint8_t level = (uint8_t)hs_rng_below(&rng, w.map.db.lod_count);
            const struct lm_ground_path p = {
                .latitude = (uint64_t)(w.map.db.centre_latitude + hs_rng_below(&rng, 1 << 21))
                            << 32,
                .longitude = hs_rng_u64(&rng),
                .latitude_step = hs_rng_u64(&rng) >> hs_rng_below(&rng, 40),
                .longitude_step = hs_rng_u64(&rng) >> hs_rng_below(&rng, 40),
                .latitude_bend = hs_rng_u64(&rng) >> (16 + hs_rng_below(&rng, 40)),
                .longitude_bend = hs_rng_u64(&rng) >> (16 + hs_rng_below(&rng, 40))};
            lm_scan_line_run(&w.line, &w.map.tiles, level, NULL, &p, LM_CELLS_MAX);
            for (uint32_t k = 0; k < LM_CELLS_MAX; k++) {
                assert_in_range(w.line.cell[k], 0, 0xFFFF);
            }
        }
        for (int azimuth = 0; azimuth < 360; azimuth += 30) {
            const struct lm_ground_path p = path_from(latitudes_deg[n], 100, azimuth, 5, 0);
            scan_and_compare(&w, 0, &p, 150);
        }
        tiny_map_close(&w.map);
    }
}

/* Cells far longer than a tile: every cell is a run of its own. */
TEST(steps_over_whole_tiles_find_the_right_ones)
{
    static struct world w;
    open_world(&w, 46, 11);
    for (int azimuth = 0; azimuth < 360; azimuth += 15) {
        for (double step_m = 150; step_m < 1000; step_m *= 1.7) {
            const struct lm_ground_path p = path_from(46.0021, 11.0037, azimuth, step_m, 0);
            assert_true(scan_and_compare(&w, 0, &p, 20) >= 1);
        }
    }
    tiny_map_close(&w.map);
}

TEST(what_is_not_resident_is_answered_by_the_nearest_ancestor)
{
    static struct world w;
    open_world(&w, 46, 11);
    const struct lm_ground_path p = path_from(45.9965, 10.995, 40, 5, 0);
    const uint8_t coarsest = (uint8_t)(w.map.db.lod_count - 1);
    /* Nothing but the coarsest level has been read. */
    lm_scan_line_run(&w.line, &w.map.tiles, 0, NULL, &p, 150);
    assert_true(compare(&w, coarsest, &p, 150) == 150);
    assert_true(w.map.tiles.count.substituted > 0);
    /* Though its cells are longer than the line's: what is late is not worth blending. */
    struct lm_scan_blend blend;
    lm_scan_blend_set(&blend, &w.map.db, 5000);
    lm_scan_line_run(&w.line, &w.map.tiles, 0, &blend, &p, 150);
    assert_true(compare(&w, coarsest, &p, 150) == 150);
    /* It has asked for what it missed; with the parents there too, they are not used. */
    tiny_map_read_tiles(&w.map);
    lm_scan_line_run(&w.line, &w.map.tiles, 0, NULL, &p, 150);
    assert_true(compare(&w, 0, &p, 150) == 150);
    tiny_map_close(&w.map);
    /* Each level in turn is the finest that is there. */
    for (uint8_t level = 1; level < coarsest; level++) {
        open_world(&w, 46, 11);
        lm_scan_line_prefetch(&w.map.tiles, level, &p, 150);
        tiny_map_read_tiles(&w.map);
        lm_scan_line_run(&w.line, &w.map.tiles, 0, NULL, &p, 150);
        assert_true(compare(&w, level, &p, 150) == 150);
        tiny_map_close(&w.map);
    }
}

static bool leave_out_odd(void *ctx, uint8_t level, uint32_t row, uint32_t column)
{
    (void)ctx;
    return level == 0 && (row + column) % 2 == 1;
}

TEST(tiles_that_the_image_leaves_out_are_answered_by_their_parents)
{
    static struct world w;
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.rows = spec.columns = 6;
    spec.leave_out = leave_out_odd;
    open_world_with(&w, spec);
    uint32_t blended[2] = {0};
    for (int azimuth = 0; azimuth < 360; azimuth += 24) {
        const struct lm_ground_path p = path_from(46, 11, azimuth, 5, 0);
        lm_scan_line_prefetch(&w.map.tiles, 1, &p, 150);
        lm_scan_line_prefetch(&w.map.tiles, 0, &p, 150);
        tiny_map_read_tiles(&w.map);
        lm_scan_line_run(&w.line, &w.map.tiles, 0, NULL, &p, 150);
        assert_true(compare(&w, 0, &p, 150) > 100);
        /* Parents of cells so much longer than the line's are blended; the level itself is not. */
        struct lm_scan_blend blend;
        lm_scan_blend_set(&blend, &w.map.db, 5000);
        lm_scan_line_run(&w.line, &w.map.tiles, 0, &blend, &p, 150);
        for (uint32_t i = 0; i < 150; i++) {
            const struct place at = place_at(&p, i);
            const struct ground g = ground_at(&w, 0, at.latitude, at.longitude);
            blended[g.level != 0] += g.is_known && w.line.cell[i] != g.cell;
        }
    }
    print_message("# %u cells of the level and %u of its parents' are others\n", blended[0],
                  blended[1]);
    assert_true(blended[0] < 10 && blended[1] > 100);
    tiny_map_close(&w.map);
}

TEST(beyond_the_map_there_is_no_data_at_sea_level)
{
    static struct world w;
    open_world(&w, 46, 11);
    const struct lm_ground_path p = path_from(10, 50, 45, 5, 0);
    lm_scan_line_run(&w.line, &w.map.tiles, 0, NULL, &p, 100);
    for (int i = 0; i < 100; i++) {
        assert_int_equal(w.line.cell[i], LM_CELL_NONE);
        assert_int_equal(w.line.elevation_m_q14[i], 0);
    }
    tiny_map_close(&w.map);
}

/* Two tiles 15 rows and 31 columns apart are in one chain of the cache: the one read first is not
 * found at its head. */
TEST(a_tile_that_is_not_the_first_of_its_chain_is_still_the_tile_itself)
{
    static struct world w;
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.rows = 16;
    spec.columns = 32;
    open_world_with(&w, spec);
    const uint32_t side_log2 = w.map.db.shift0 + LM_TILE_CELLS_LOG2;
    const struct lm_band *b = &w.map.db.bands[0];
    assert_int_equal(b->lod, 0);
    for (uint32_t i = 0; i < 2; i++) {
        lm_tile_cache_want(&w.map.tiles, 0, b->row0 + 15 * i, b->column0 + 31 * i);
        tiny_map_read_tiles(&w.map);
    }
    for (uint32_t i = 0; i < 2; i++) {
        const uint32_t row = b->row0 + 15 * i, column = b->column0 + 31 * i;
        const struct lm_ground_path p = {
            .latitude = (uint64_t)((row << side_log2) + (1u << side_log2 >> 1) - FX_BAM_90) << 32,
            .longitude = (uint64_t)((column << side_log2) + (1u << side_log2 >> 1)) << 32};
        assert_int_equal(lm_tile_cache_peek(&w.map.tiles, 0, row, column) != NULL, i);
        lm_scan_line_run(&w.line, &w.map.tiles, 0, NULL, &p, 1);
        assert_int_equal(w.line.cell[0] & 0xFFFF,
                         find_tile(&w, 0, row, column)->points[33][33].cell);
        assert_int_equal(w.line.coarse_cells, 0);
        assert_int_equal(w.line.coarsest_lod, 0);
    }
    tiny_map_close(&w.map);
}

TEST(crowns_are_drawn_where_the_picture_shows_them_and_the_map_does_not)
{
    struct lm_db db = {.shift0 = 9, .lod_count = 1, .classes = *tiny_classes()};
    struct lm_scan_blend blend = {.is_on = false};
    lm_scan_blend_set(&blend, &db, 1000);
    assert_int_equal(blend.crowned, 1 << TINY_TREES);
    lm_scan_blend_set(&blend, &db, 3500);
    assert_int_equal(blend.crowned, 0);
    db.shift0 = 8; /* cells of 2.4 m */
    lm_scan_blend_set(&blend, &db, 1000);
    assert_int_equal(blend.crowned, 0);
}

TEST(one_elevation_is_that_of_a_line)
{
    static struct world w;
    open_world(&w, 46, 11);
    for (int i = 0; i < 100; i++) {
        const struct lm_ground_path p = path_from(46 + i * 1e-5, 11 - i * 2e-5, 0, 1, 0);
        const struct lm_position position = {(fx_bam_t)(p.latitude >> 32),
                                             (fx_bam_t)(p.longitude >> 32)};
        lm_scan_line_run(&w.line, &w.map.tiles, 0, NULL, &p, 1);
        const int32_t q10 = lm_scan_elevation(&w.map.tiles, 0, position, -99);
        /* A place is whole BAM: a fraction of a weight's step. */
        assert_true(abs(q10 - (w.line.elevation_m_q14[0] >> 4)) < 64);
        tiny_map_read_tiles(&w.map);
    }
    const struct lm_position nowhere = {FX_BAM_DEG(10), FX_BAM_DEG(10)};
    assert_int_equal(lm_scan_elevation(&w.map.tiles, 0, nowhere, -99), -99);
    tiny_map_close(&w.map);
}

TEST(the_level_is_the_largest_cell_that_is_not_longer_by_more_than_an_eighth)
{
    static struct world w;
    open_world(&w, 46, 11);
    for (uint32_t cell_mm = 100; cell_mm < 3000000; cell_mm = cell_mm * 9 / 8) {
        const uint8_t level = lm_scan_lod(&w.map.db, cell_mm);
        assert_true(level == 0 || lm_db_cell_mm(&w.map.db, level) <= cell_mm + cell_mm / 8);
        assert_true(level + 1 == w.map.db.lod_count ||
                    lm_db_cell_mm(&w.map.db, (uint8_t)(level + 1)) > cell_mm + cell_mm / 8);
    }
    tiny_map_close(&w.map);
}
