/* Targets in the pictures themselves: patch, sweep, and the unit that reads them. */
#include "hs/angle.h"
#include "lm/unit.h"

#include "check.h"
#include "memory_flash.h"
#include "scales.h"
#include "target_image.h"
#include "tiny_map.h"

#include <stdlib.h>

enum { POLLS = 16, SLOTS = 32, SIDE = 256 };

static uint8_t pool[SLOTS * sizeof(struct lm_tile)] __attribute__((aligned(8)));
static struct tiny_map map;
static struct lm_line line;
static struct lm_tone tone;

static void draw_patch_of_cells(const struct lm_target_set *set, uint32_t cell_mm,
                                uint8_t picture[SIDE][SIDE])
{
    static struct lm_sar sar;
    const struct lm_sar_command command = {.centre = {hs_bam(46), hs_bam(11)},
                                           .range_m = 20000,
                                           .height_m_q6 = 6000 * 64,
                                           .look_azimuth = hs_bam(90),
                                           .cell_mm = cell_mm};
    const struct lm_sar_setup scene = {
        .targets = set, .epoch = 5, .sea_state = LM_SEA_STATE_OF_IMAGE};
    assert_int_equal(lm_sar_start(&sar, &lm_radar_default, &map.db, &command, &scene), LM_OK);
    /* Of the lines, which are more than cells, those in the middle. */
    const int beside = ((int)sar.lines - SIDE) / 2;
    for (int k = -beside; k < SIDE + beside; k++) {
        lm_sar_draw_line(&sar, &map.tiles, &tone, &line);
        if (k >= 0 && k < SIDE) {
            memcpy(picture[k], line.grey, SIDE);
        }
    }
}

static void draw_patch(const struct lm_target_set *set, uint8_t picture[SIDE][SIDE])
{
    draw_patch_of_cells(set, 4000, picture);
}

TEST(a_corner_is_bright_with_its_side_lobes_and_the_rest_is_untouched)
{
    static uint8_t without[SIDE][SIDE], with[SIDE][SIDE];
    tiny_map_open_soil(&map, SLOTS, &tone);
    /* 203.2 m north and 122 m east of the centre, looking east: on a ray 202 m to the left at the
     * centre, line 128 - 50.5, cell 158. */
    struct lm_target t = point_at(46, 11, 0, 0);
    t.heading = FX_BAM_DEG(270); /* towards the radar */
    add_scatterer(&t, LM_SHAPE_TRIHEDRAL, 1500, -122000, 203232, 1000, 0, 35.264);
    const struct lm_target_set set = {.items = &t, .count = 1}, none = {0};
    draw_patch(&none, without);
    draw_patch(&set, with);
    for (int k = 0; k < SIDE * SIDE; k++) {
        const int l = k / SIDE, c = k % SIDE, dl = abs(l - 77), dc = abs(c - 158);
        if (dl == 0 && dc == 0) {
            assert_int_equal(with[l][c], 255);
            assert_true(without[l][c] < 200);
        } else if (dl < 8 && dc < 8) {
            assert_true(with[l][c] >= without[l][c]);
            assert_true(dl + dc > 1 || with[l][c] > without[l][c] + 50);
        } else {
            assert_int_equal(with[l][c], without[l][c]);
        }
    }
    tiny_map_close(&map);
}

TEST(a_patch_has_nothing_of_the_targets_of_the_one_before_it)
{
    static uint8_t before[SIDE][SIDE], with[SIDE][SIDE], behind[SIDE][SIDE];
    tiny_map_open_soil(&map, SLOTS, &tone);
    struct lm_target t = point_at(46, 11, 3, 45);
    const struct lm_target_set set = {.items = &t, .count = 1}, none = {0};
    draw_patch(&none, before);
    draw_patch(&set, with);
    draw_patch(&none, behind);
    assert_memory_not_equal(with, before, sizeof with);
    assert_memory_equal(behind, before, sizeof behind);
    tiny_map_close(&map);
}

/* The cell that a target has made brighter by the most grey levels. */
static int brightest_cell(uint8_t with[SIDE][SIDE], uint8_t without[SIDE][SIDE])
{
    int most = 0, cell = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        const int more = with[k / SIDE][k % SIDE] - without[k / SIDE][k % SIDE];
        if (more > most) {
            most = more;
            cell = k;
        }
    }
    return cell;
}

/* Its corners are 3.6 km from its centre, the targets 3.1 km. It looks east: lines from north to
 * south, cells from west to east. The target is just below
 * white, or neighbours would be as white. */
TEST(a_target_in_the_corner_of_a_coarse_patch_is_shown)
{
    enum { CELL_MM = 20000, OUT_CELLS = 110 };
    static uint8_t without[SIDE][SIDE], with[SIDE][SIDE];
    const struct lm_target_set none = {0};
    tiny_map_open_soil(&map, SLOTS, &tone);
    draw_patch_of_cells(&none, CELL_MM, without);
    const double out_deg = OUT_CELLS * CELL_MM * 180 / (acos(-1) * 6371e3 * 1000);
    for (int corner = 0; corner < 4; corner++) {
        const int south = corner / 2 * 2 - 1, east = corner % 2 * 2 - 1;
        const double longitude_deg = 11 + east * out_deg / cos(46 * acos(-1) / 180);
        const struct lm_target t = point_at(46 - south * out_deg, longitude_deg, 0, 29);
        const struct lm_target_set set = {.items = &t, .count = 1};
        draw_patch_of_cells(&set, CELL_MM, with);
        const int cell = brightest_cell(with, without);
        /* Lines are rays from 20 km away. */
        const int out_lines = OUT_CELLS * 20000 / (20000 + east * OUT_CELLS * CELL_MM / 1000);
        assert_true(abs(cell / SIDE - (SIDE / 2 + south * out_lines)) <= 1);
        assert_true(abs(cell % SIDE - (SIDE / 2 + east * OUT_CELLS)) <= 1);
    }
    tiny_map_close(&map);
}

/* Forty lines to the left of where it is, so that its line comes long after it has been shown. */
/* A mover 500 m south of a patch's southern edge, which closes or opens at 10 m/s: the patch, made
 * as at 250 m/s, shows it 800 m to one side or to the other. */
TEST(a_mover_beside_a_patch_is_displaced_into_it_one_way_alone)
{
    static uint8_t without[SIDE][SIDE], with[SIDE][SIDE];
    const struct lm_target_set none = {0};
    int shown = 0;
    tiny_map_open_soil(&map, SLOTS, &tone);
    draw_patch(&none, without);
    for (int way = 0; way < 2; way++) {
        struct lm_target t = point_at(46 - (128 * 4 + 500) / 111150.0, 11, 3, 45);
        t.heading = way == 0 ? FX_BAM_90 : FX_BAM_DEG(270);
        t.speed_mm_s = 10000;
        t.leg_m = 1000;
        seal_target(&t);
        const struct lm_target_set set = {.items = &t, .count = 1};
        draw_patch(&set, with);
        shown += memcmp(with, without, sizeof with) != 0;
    }
    assert_int_equal(shown, 1);
    tiny_map_close(&map);
}

TEST(a_mover_that_is_hidden_where_it_stands_shows_nowhere_in_a_patch)
{
    static uint8_t without[SIDE][SIDE], with[SIDE][SIDE];
    const struct lm_target_set none = {0};
    tiny_map_open_soil(&map, SLOTS, &tone);
    draw_patch(&none, without);
    for (int is_hidden = 0; is_hidden < 2; is_hidden++) {
        struct lm_target t = point_at(46, 11, is_hidden ? -3 : 3, 45);
        t.heading = hs_bam(270); /* towards the radar at 2 m/s: 160 m to the left at 20 km */
        t.speed_mm_s = 2000;
        t.leg_m = 10;
        seal_target(&t);
        const struct lm_target_set set = {.items = &t, .count = 1};
        draw_patch(&set, with);
        int changed = 0;
        for (int k = 0; k < SIDE; k++) {
            for (int c = 0; c < SIDE; c++) {
                changed += with[k][c] != without[k][c];
                assert_true(with[k][c] == without[k][c] || abs(k - 88) < 10);
            }
        }
        assert_int_equal(changed > 0, !is_hidden);
    }
    tiny_map_close(&map);
}

/* A sweep over the target, from the right height and place: levels of each line and bin. */
static void sweep(const struct lm_target_set *set, int16_t level_q8[SIDE][SIDE])
{
    static struct lm_sector sector;
    const struct lm_platform platform = {.position = {hs_bam(45.95), hs_bam(11)},
                                         .height_m_q10 = 3000 * 1024};
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM, .range_index = scale_of(10)};
    lm_sector_start(&sector, &lm_radar_default, &command, 5);
    sector.targets = set;
    for (uint32_t k = 0; k < SIDE; k++) {
        const uint32_t drawn = lm_sector_draw_line(&sector, &map.tiles, &platform, &tone, &line);
        memcpy(level_q8[drawn], sector.level_db_q8, sizeof level_q8[drawn]);
    }
}

/* Bins of a line that differ by more than a quarter of a decibel, and the line where they differ
 * most. */
static int changed_bins(int16_t with[SIDE][SIDE], int16_t without[SIDE][SIDE], int bin,
                        int *brightest)
{
    int bins = 0, most = 0;
    for (int k = 0; k < SIDE; k++) {
        for (int i = 0; i < SIDE; i++) {
            const int rise = with[k][i] - without[k][i];
            bins += rise > 64 && i != bin;
            if (rise > most) {
                most = rise;
                *brightest = k;
            }
        }
    }
    return bins;
}

TEST(a_target_shows_in_one_bin_over_the_beam_and_a_hidden_one_nowhere)
{
    static int16_t with[SIDE][SIDE], without[SIDE][SIDE];
    tiny_map_open_soil(&map, SLOTS, &tone);
    const struct lm_target_set none = {0};
    sweep(&none, without);
    const struct lm_target shown = point_at(46, 11, 1, 60), hidden = point_at(46, 11, -100, 60);
    const struct lm_target_set set = {.items = &shown, .count = 1},
                               hidden_set = {.items = &hidden, .count = 1};
    sweep(&hidden_set, with);
    assert_memory_equal(with, without, sizeof with);
    /* Dead ahead, 0.05 degrees of latitude away, from 3 km of height. */
    const double slant_m = hypot(5557, 3000 - 100);
    const int bin = (int)(slant_m / (18520.0 / SIDE));
    int brightest = -1;
    sweep(&set, with);
    assert_true(changed_bins(with, without, bin, &brightest) <= 4); /* the pulse is no longer */
    assert_in_range(brightest, 126, 129);
    /* Two-way half-power width: 3.3 degrees / sqrt 2 are 4.98 lines. */
    int lines = 0;
    for (int k = 0; k < SIDE; k++) {
        lines += with[k][bin] > with[brightest][bin] - 3 * 256;
    }
    assert_in_range(lines, 4, 6);
}

/* A unit is large: one is enough. */
static struct lm_unit unit;

TEST(the_unit_reads_the_targets_and_counts_those_it_has_not)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_image image;
    struct with_targets w;
    struct memory_flash flash;
    static uint8_t plane[256 * 256];
    const struct lm_display display = {.width_px = 256, .height_px = 256};
    assert_int_equal(tiny_image_build(&image, &spec), 0);
    add_targets(&w, &image, point_at(46, 11, 0, 20));
    w.bytes[w.head_at + 64 + LM_TARGET_BYTES + 9] ^= 1; /* the middle one */
    memory_flash_open(&flash, w.bytes, w.size);
    const struct lm_board board = {.radar = &lm_radar_default,
                                   .flash = &flash.port,
                                   .display = &display,
                                   .tile_pool = pool,
                                   .tile_pool_bytes = sizeof pool,
                                   .plane = plane,
                                   .flash_poll_limit = POLLS};
    assert_int_equal(lm_unit_init(&unit, &board), LM_OK);
    assert_true(unit.map.is_usable);
    assert_int_equal(unit.map.target_set.count, 2);
    assert_int_equal(unit.map.target_set.items[1].id, 2);
    assert_int_equal(unit.map.count.targets_lost, 1);
    assert_ptr_equal(unit.picture.sector.targets, &unit.map.target_set);
    free(w.bytes);
    tiny_image_free(&image);
}

TEST(a_patch_wants_detail_where_the_map_has_some_and_longer_cells)
{
    static struct lm_sar sar;
    tiny_map_open_soil(&map, SLOTS, &tone);
    const uint32_t finest_mm = lm_db_cell_mm(&map.db, map.db.finest);
    struct lm_db db = map.db;
    for (int has_detail = 0; has_detail < 2; has_detail++) {
        for (int is_finer = 0; is_finer < 2; is_finer++) {
            const struct lm_sar_command command = {.centre = {hs_bam(46), hs_bam(11)},
                                                   .range_m = 20000,
                                                   .height_m_q6 = 6000 * 64,
                                                   .look_azimuth = hs_bam(90),
                                                   .cell_mm = finest_mm - (uint32_t)is_finer};
            const struct lm_target_set none = {0};
            const struct lm_sar_setup scene = {
                .targets = &none, .epoch = 5, .sea_state = LM_SEA_STATE_OF_IMAGE};
            db.detail_size = has_detail ? 64 : 0;
            assert_int_equal(lm_sar_start(&sar, &lm_radar_default, &db, &command, &scene), LM_OK);
            assert_int_equal(sar.detail_state,
                             has_detail && is_finer ? LM_SAR_DETAIL_WANTED : LM_SAR_DETAIL_NONE);
        }
    }
    tiny_map_close(&map);
}
