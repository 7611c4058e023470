/* From one sweep to the next: what a window has kept of another place is not shown, and the tiles
 * of the lines to come are asked for in time. */
#include "check.h"
#include "hs/angle.h"
#include "sector_world.h"

#include <stdlib.h>
#include <string.h>

enum { LINES_MAX = 1024 };

/* ---- a window seen from two sides ---- */

/* Soil, and a ridge to the south-west of the middle, across the sight from there. */
static double ridge_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const bool is_ridge = p->east_m < -800 && p->north_m > -8500 && p->north_m < -7500;
    return is_ridge ? 1400 : 0;
}

static struct sector_world *make_world(double (*elevation_m)(void *, const struct tiny_place *))
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 12;
    spec.rows = spec.columns = 16;
    spec.elevation_m = elevation_m;
    struct sector_world *w = make_sector_world(&spec);
    w->platform.height_m_q10 = 3000 * 1024;
    w->platform.speed_mm_s = 150000;
    return w;
}

static const struct lm_position middle_of_map = {0x20b60b61, 0x07d27d28};

/* Put the platform 12 km south of the window's centre and some way to the east, with the centre
 * straight ahead. Returns its distance. */
static uint32_t face_centre(struct sector_world *w, int32_t east_bam)
{
    const struct lm_position centre = middle_of_map;
    uint32_t distance_m_q8;
    fx_bam_t azimuth;
    w->platform.position.latitude = centre.latitude - hs_bam(0.108);
    w->platform.position.longitude = centre.longitude + (fx_bam_t)east_bam;
    lm_geo_inverse(w->platform.position, centre, &distance_m_q8, &azimuth);
    w->platform.heading = w->platform.track = azimuth;
    return distance_m_q8;
}

struct sweep {
    uint8_t grey[LINES_MAX][LM_CELLS_MAX];
    uint32_t lines, edge_m_q8;
    bool has_foreground;
};

static void keep_sweep(struct sector_world *w, struct sweep *kept)
{
    struct lm_sector *s = &w->sector;
    do {
        memset(w->line.grey, 0, sizeof w->line.grey);
        const uint32_t drawn = draw_line(w);
        assert_true(drawn < LINES_MAX);
        memcpy(kept->grey[drawn], w->line.grey, s->slant.cells);
    } while (!lm_sector_is_at_edge(s));
    kept->lines = s->lines;
    kept->edge_m_q8 = s->edge_m_q8;
    kept->has_foreground = s->foreground.grid.cells != 0;
}

/* Greys that differ by more than a step, which is what the ground's leak of the line before may do.
 */
static uint32_t differing(const struct sweep *a, const struct sweep *b)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < a->lines; i++) {
        for (uint32_t k = 0; k < LM_CELLS_MAX; k++) {
            count += abs(a->grey[i][k] - b->grey[i][k]) > 1;
        }
    }
    return count;
}

/* Begin the sweep of this number, and so its direction, as if there had been none before. */
static void start_anew(struct sector_world *w, const struct lm_sector_command *command,
                       uint32_t sweep)
{
    const struct lm_sector_turn turn = {.sweep = sweep};
    lm_sector_start(&w->sector, &w->radar, command, sweep);
    lm_sector_begin(&w->sector, &w->map.tiles, &w->platform);
    lm_sector_join(&w->sector, &turn);
}

/* Two sweeps, the second from the other side and as far from the centre, to 4 mm: nothing of it is
 * another than if it were the first. */
static void judge_turn(struct sector_world *w, const struct lm_sector_command *command,
                       uint32_t sweep)
{
    static struct sweep from_west, after, anew;
    const int32_t aside_bam = (int32_t)hs_bam(0.04);
    const uint32_t distance_m_q8 = face_centre(w, -aside_bam);
    start_anew(w, command, sweep);
    draw_sweep(w);
    start_anew(w, command, sweep);
    keep_sweep(w, &from_west);
    assert_true(from_west.has_foreground);
    int32_t east_bam = aside_bam - 100;
    while (face_centre(w, east_bam) != distance_m_q8 && east_bam < aside_bam + 100) {
        east_bam++;
    }
    assert_int_equal(face_centre(w, east_bam), distance_m_q8);
    keep_sweep(w, &after);
    assert_int_equal(after.edge_m_q8, from_west.edge_m_q8);
    assert_int_equal(after.lines, from_west.lines);
    start_anew(w, command, sweep + 1);
    keep_sweep(w, &anew);
    print_message("# field %u: %u greys of another place, %u of the last sweep\n", command->fov,
                  differing(&from_west, &anew), differing(&after, &anew));
    assert_true(differing(&from_west, &anew) > 10000);
    assert_int_equal(differing(&after, &anew), 0);
}

TEST(a_window_shows_nothing_of_where_its_last_sweep_was_seen_from)
{
    static const uint8_t fields[] = {LM_FOV_EXP, LM_FOV_DBS1};
    for (uint32_t n = 0; n < 2 * sizeof fields; n++) {
        struct sector_world *w = make_world(ridge_m);
        const struct lm_sector_command command = {.centre = middle_of_map,
                                                  .mode = LM_SECTOR_GM,
                                                  .fov = fields[n / 2],
                                                  .range_index =
                                                      (uint8_t)lm_radar_find_range(&w->radar, 10)};
        judge_turn(w, &command, n % 2);
        free_sector_world(w);
    }
}

/* ---- tiles ahead ---- */

/* Look-ups that found no tile when the beam, after line 0, is on a line further on. */
static uint32_t missing_ahead(uint32_t lines)
{
    struct sector_world *w = make_world(NULL);
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM,
                                              .fov = LM_FOV_NORM,
                                              .range_index =
                                                  (uint8_t)lm_radar_find_range(&w->radar, 10)};
    w->platform.position = middle_of_map;
    lm_sector_start(&w->sector, &w->radar, &command, 0);
    assert_int_equal(draw_line(w), 0); /* and what it asked for is read */
    w->sector.line = lines;
    w->sector.has_taps = false;
    lm_beam_clear(&w->sector.beam);
    const uint32_t before = w->map.tiles.count.misses;
    lm_sector_draw_line(&w->sector, &w->map.tiles, &w->platform, &w->tone, &w->line);
    const uint32_t missing = w->map.tiles.count.misses - before;
    free_sector_world(w);
    return missing;
}

TEST(the_tiles_of_a_line_are_there_when_the_line_32_before_it_was_drawn)
{
    const uint32_t there = missing_ahead(32), not_yet = missing_ahead(64);
    print_message("# missing: %u look-ups 32 lines ahead, %u 64 lines ahead\n", there, not_yet);
    assert_true(there < 10 && not_yet > 50);
}

/* Look-ups of two sweeps that found no tile, when what was asked for at their start was read. */
static uint32_t missing_of_sweep(struct sector_world *w, uint8_t fov)
{
    const struct lm_sector_command command = {.centre = middle_of_map,
                                              .mode = LM_SECTOR_GM,
                                              .fov = fov,
                                              .range_index =
                                                  (uint8_t)lm_radar_find_range(&w->radar, 10)};
    struct lm_sector *s = &w->sector;
    lm_tile_cache_mount(&w->map.tiles, &w->map.db, 1); /* no tile is there */
    lm_sector_start(s, &w->radar, &command, 0);
    lm_sector_prefetch(s, &w->map.tiles);
    assert_true(lm_tile_cache_is_idle(&w->map.tiles)); /* of no geometry none is asked for */
    lm_sector_begin(s, &w->map.tiles, &w->platform);
    for (uint32_t rays = 0; !s->is_asked_for; rays++) {
        assert_true(rays < 100);
        lm_sector_prefetch(s, &w->map.tiles);
        tiny_map_read_tiles(&w->map);
    }
    const uint32_t before = w->map.tiles.count.misses;
    for (uint32_t lines = 2 * s->lines; lines > 0; lines--) {
        lm_sector_draw_line(s, &w->map.tiles, &w->platform, &w->tone, &w->line);
    }
    return w->map.tiles.count.misses - before;
}

TEST(the_tiles_of_all_of_a_sweep_are_there_when_they_were_asked_for_at_its_start)
{
    static const uint8_t fields[] = {LM_FOV_NORM, LM_FOV_EXP, LM_FOV_DBS1};
    struct sector_world *w = make_world(NULL);
    for (uint32_t n = 0; n < sizeof fields; n++) {
        uint32_t missing = 0;
        face_centre(w, 0);
        for (int degrees = 0; degrees < 360; degrees += fields[n] == LM_FOV_NORM ? 7 : 360) {
            if (fields[n] == LM_FOV_NORM) {
                w->platform.position = middle_of_map;
                w->platform.heading = hs_bam(degrees);
            }
            missing += missing_of_sweep(w, fields[n]);
        }
        print_message("# field %u: %u look-ups without a tile\n", fields[n], missing);
        assert_int_equal(missing, 0);
    }
    free_sector_world(w);
}

/* Steps are a 128th to a 256th of the height, and the nearest counts. */
TEST(a_shared_sector_is_seen_from_within_a_256th_of_the_own_height)
{
    const struct tiny_spec spec = tiny_spec_at(46, 11);
    struct sector_world *w = make_sector_world(&spec);
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM, .fov = LM_FOV_NORM};
    start_sector(w, &command, NULL, NULL);
    w->sector.is_shared = true;
    for (int32_t height_m = 300; height_m < 15000; height_m += 37) {
        w->platform.height_m_q10 = height_m * 1024;
        lm_sector_begin(&w->sector, &w->map.tiles, &w->platform);
        const int32_t off_m_q10 = w->sector.grid.height_m_q10 - w->platform.height_m_q10;
        assert_in_range(abs(off_m_q10), 0, height_m * 1024 / 256);
    }
    free_sector_world(w);
}
