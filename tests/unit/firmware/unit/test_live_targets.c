/* Live targets in the pictures: beside targets of the image that move alike. */
#include "hs/angle.h"
#include "lm/unit.h"

#include "bus_frames.h"
#include "check.h"
#include "glass_text.h"
#include "scales.h"
#include "target_support.h"
#include "tiny_map.h"
#include "unit_rig.h"

#include <stdlib.h>

enum { SLOTS = 32, SIDE = 256, S = 1000000, LINES_MAX = LM_SECTOR_LINES_MAX };

static struct tiny_map map;
static struct lm_line line;
static struct lm_tone tone;
static struct lm_live live;

/* A mover of the image, steady, and the same one as a live target that was told 2 s before. */
static struct lm_target image_mover(double latitude, double longitude, double heading_deg,
                                    double speed_m_s)
{
    struct lm_target t = point_at(latitude, longitude, 3, 45);
    t.flags = LM_TARGET_ABOVE_GROUND;
    t.heading = hs_bam(heading_deg);
    t.speed_mm_s = (uint32_t)lround(speed_m_s * 1000);
    t.leg_m = speed_m_s > 0 ? 50000 : 0;
    seal_target(&t);
    return t;
}

static void tell(const struct lm_target *t, uint32_t number, uint64_t told_us)
{
    const struct lm_mover_state was = lm_mover_state_at(t, told_us);
    const double heading = hs_degrees(t->heading) * M_PI / 180;
    memset(&live, 0, sizeof live);
    live.target[number] =
        (struct lm_live_target){.motion_us = told_us,
                                .heard_us = told_us,
                                .position = was.position,
                                .velocity = {(int16_t)lround(t->speed_mm_s / 50.0 * sin(heading)),
                                             (int16_t)lround(t->speed_mm_s / 50.0 * cos(heading))},
                                .heading = t->heading,
                                .rcs_dbsm_q8 = (int16_t)t->mean_rcs_dbsm_q8,
                                .height_m_q6 = t->elevation_m_q6,
                                .has_height = true, /* the soil is at 0 */
                                .kind = LM_LIVE_REFLECTOR,
                                .reckoning = LM_LIVE_RPB,
                                .is_there = true};
    live.count = 1;
}

/* ---- sweeps ---- */

struct view {
    uint8_t mode, fov;
};

static uint32_t sweep(struct view view, const struct lm_target_set *set,
                      int16_t level_q8[LINES_MAX][SIDE])
{
    static struct lm_sector sector;
    const struct lm_platform platform = {.position = {hs_bam(45.95), hs_bam(10.95)},
                                         .height_m_q10 = 3000 * 1024,
                                         .heading = hs_bam(35),
                                         .track = hs_bam(0),
                                         .speed_mm_s = 180000,
                                         .time_us = 7 * S};
    const struct lm_sector_command command = {.mode = view.mode,
                                              .fov = view.fov,
                                              .range_index = scale_of(10),
                                              .centre = {hs_bam(46), hs_bam(11)}};
    lm_sector_start(&sector, &lm_radar_default, &command, 5);
    sector.targets = set;
    memset(level_q8, 0, LINES_MAX * sizeof *level_q8);
    do {
        const uint32_t drawn = lm_sector_draw_line(&sector, &map.tiles, &platform, &tone, &line);
        memcpy(level_q8[drawn], sector.level_db_q8, sizeof *level_q8);
    } while (!lm_sector_is_at_edge(&sector));
    return sector.lines;
}

struct difference {
    int rises; /* cells that are brighter by 3 dB */
    int most;  /* greatest difference of either sign */
};

static struct difference compare(int16_t a[LINES_MAX][SIDE], int16_t b[LINES_MAX][SIDE])
{
    struct difference d = {0, 0};
    for (int k = 0; k < LINES_MAX; k++) {
        for (int i = 0; i < SIDE; i++) {
            d.rises += a[k][i] > b[k][i] + 3 * 256;
            d.most = abs(a[k][i] - b[k][i]) > d.most ? abs(a[k][i] - b[k][i]) : d.most;
        }
    }
    return d;
}

static const struct view views[] = {{LM_SECTOR_GM, LM_FOV_NORM},  {LM_SECTOR_GMT, LM_FOV_NORM},
                                    {LM_SECTOR_SEA, LM_FOV_NORM}, {LM_SECTOR_GM, LM_FOV_EXP},
                                    {LM_SECTOR_GMT, LM_FOV_EXP},  {LM_SECTOR_GM, LM_FOV_DBS1},
                                    {LM_SECTOR_GM, LM_FOV_DBS2}};

TEST(a_live_mover_is_drawn_as_a_mover_of_the_image_in_every_mode)
{
    static int16_t without[LINES_MAX][SIDE], image[LINES_MAX][SIDE], told[LINES_MAX][SIDE];
    static const double headings[] = {0, 90, 216.8698976};
    const struct lm_target_set none = {0}, live_set = {.live = &live};
    tiny_map_open_soil(&map, SLOTS, &tone);
    for (size_t v = 0; v < sizeof views / sizeof *views; v++) {
        sweep(views[v], &none, without);
        for (size_t h = 0; h < sizeof headings / sizeof *headings; h++) {
            /* DBS shows what is displaced by no more than a beam. */
            const double speed_m_s = views[v].fov >= LM_FOV_DBS1 ? 4 : 12;
            const struct lm_target t = image_mover(46.002, 11.001, headings[h], speed_m_s);
            const struct lm_target_set set = {.items = &t, .count = 1};
            tell(&t, 255, 5 * S);
            sweep(views[v], &set, image);
            sweep(views[v], &live_set, told);
            const struct difference shown = compare(image, without), apart = compare(told, image);
            print_message("# mode %d field %d heading %.0f: %d cells, at most %.2f dB apart\n",
                          views[v].mode, views[v].fov, headings[h], shown.rises,
                          apart.most / 256.0);
            assert_true(shown.rises > 3);
            assert_true(apart.most < 256);
        }
    }
    tiny_map_close(&map);
}

/* Of 5 m/s towards the radar across the track, DBS displaces by 5 / 180 of the range. */
TEST(doppler_displaces_a_live_mover_as_the_law_says)
{
    static int16_t still[LINES_MAX][SIDE], moving[LINES_MAX][SIDE];
    const struct lm_target_set live_set = {.live = &live};
    const struct view view = {LM_SECTOR_GM, LM_FOV_DBS1};
    tiny_map_open_soil(&map, SLOTS, &tone);
    struct lm_target t = image_mover(46, 11, 215, 0);
    tell(&t, 3, 7 * S);
    const uint32_t lines = sweep(view, &live_set, still);
    t = image_mover(46, 11, 215, 5);
    tell(&t, 3, 7 * S);
    live.target[3].position = (struct lm_position){hs_bam(46), hs_bam(11)};
    sweep(view, &live_set, moving);
    int at[2] = {0, 0}, most[2] = {INT32_MIN, INT32_MIN};
    for (int k = 0; k < (int)lines; k++) {
        for (int i = 0; i < SIDE; i++) {
            if (still[k][i] > most[0]) {
                most[0] = still[k][i];
                at[0] = k;
            }
            if (moving[k][i] > most[1]) {
                most[1] = moving[k][i];
                at[1] = k;
            }
        }
    }
    print_message("# line %d still, %d moving, of %u\n", at[0], at[1], lines);
    assert_true(abs(at[1] - at[0]) > 5);
    tiny_map_close(&map);
}

TEST(terrain_hides_a_live_target)
{
    static int16_t with[LINES_MAX][SIDE], without[LINES_MAX][SIDE];
    const struct lm_target_set none = {0}, live_set = {.live = &live};
    tiny_map_open_soil(&map, SLOTS, &tone);
    const struct lm_target t = image_mover(46, 11, 0, 0);
    for (size_t v = 0; v < sizeof views / sizeof *views; v++) {
        if (views[v].mode != LM_SECTOR_GMT) {
            sweep(views[v], &none, without);
            tell(&t, 0, 7 * S);
            sweep(views[v], &live_set, with);
            assert_true(compare(with, without).rises > 3);
            live.target[0].height_m_q6 = -100 * 64;
            sweep(views[v], &live_set, with);
            assert_memory_equal(with, without, sizeof with);
        }
    }
    tiny_map_close(&map);
}

/* 256 within the sweep: each is brighter than the ground at its place, but those that its beam and
 * bin share with others. */
TEST(all_256_are_drawn)
{
    static int16_t with[LINES_MAX][SIDE], without[LINES_MAX][SIDE];
    const struct lm_target_set none = {0}, live_set = {.live = &live};
    tiny_map_open_soil(&map, SLOTS, &tone);
    for (size_t v = 0; v < sizeof views / sizeof *views; v++) {
        if (views[v].mode == LM_SECTOR_GMT) {
            continue;
        }
        sweep(views[v], &none, without);
        const struct lm_target t = image_mover(46, 11, 0, 0);
        int shown = 0;
        tell(&t, 0, 7 * S);
        const struct lm_live_target one = live.target[0];
        /* In each beam less than 32. */
        const double side_deg = views[v].fov <= LM_FOV_EXP ? 0.04 : 0.03;
        live.count = LM_LIVE_MAX;
        for (int i = 0; i < LM_LIVE_MAX; i++) {
            live.target[i] = one;
            live.target[i].position =
                (struct lm_position){hs_bam(46 + side_deg * (i / 16 - 7.5) / 16),
                                     hs_bam(11 + 1.4 * side_deg * (i % 16 - 7.5) / 16)};
        }
        sweep(views[v], &live_set, with);
        shown = compare(with, without).rises;
        /* Alone, each in turn: whatever it brightens is as bright with all. */
        int lost = 0;
        static int16_t alone[LINES_MAX][SIDE];
        static struct lm_live all;
        all = live;
        for (int i = 0; i < LM_LIVE_MAX; i += 17) {
            memset(&live, 0, sizeof live);
            live.target[i] = all.target[i];
            live.count = 1;
            sweep(views[v], &live_set, alone);
            for (int k = 0; k < LINES_MAX * SIDE; k++) {
                const int a = alone[k / SIDE][k % SIDE];
                lost +=
                    a > without[k / SIDE][k % SIDE] + 6 * 256 && with[k / SIDE][k % SIDE] < a - 256;
            }
        }
        print_message("# mode %d field %d: %d cells brighter, %d lost\n", views[v].mode,
                      views[v].fov, shown, lost);
        assert_int_equal(lost, 0);
        assert_true(shown > 256);
    }
    tiny_map_close(&map);
}

/* 72 in a row before the antenna, the last 24 numbers stronger than the others. */
static void crowd_the_beam(int16_t strong_dbsm)
{
    const struct lm_target t = image_mover(46, 11, 0, 0);
    tell(&t, 0, 7 * S);
    const struct lm_live_target one = live.target[0];
    live.count = 72;
    for (int i = 0; i < 72; i++) {
        live.target[i] = one;
        live.target[i].position.latitude += hs_bam(0.00008 * (i * 7 % 72 - 36));
        live.target[i].position.longitude += hs_bam(0.00008 * (i * 7 % 72 - 36));
        live.target[i].rcs_dbsm_q8 = (int16_t)((i < 48 ? 20 : strong_dbsm) * 256);
    }
}

static void select_all(struct lm_target_candidates *candidates, const struct lm_target_set *set)
{
    const struct lm_target_query query = {
        .position = {hs_bam(46), hs_bam(11)}, .reach_m = 5000, .time_us = 7 * S};
    lm_target_candidates_select(candidates, set, &query);
    lm_target_candidates_add_live(candidates, &query);
}

TEST(where_there_is_no_room_the_strongest_are_taken_and_the_others_counted)
{
    static struct lm_target_candidates candidates;
    static const int16_t strong_dbsm[] = {45, 20, -5};
    static const int firsts[] = {48, 0, 0};
    const struct lm_target_set set = {.live = &live};
    for (int c = 0; c < 3; c++) {
        crowd_the_beam(strong_dbsm[c]);
        select_all(&candidates, &set);
        assert_int_equal(candidates.count, LM_TARGET_CANDIDATES_MAX);
        assert_int_equal(candidates.left_out, 72 - LM_TARGET_CANDIDATES_MAX);
        int taken = 0;
        for (uint32_t i = 0; i < candidates.count; i++) {
            taken += candidates.candidate[i].index >= firsts[c];
        }
        /* All 24 that are stronger, with the first eight of the others; or the first 32. */
        assert_int_equal(taken, c == 0 ? 24 : 32);
        assert_int_equal(candidates.candidate[0].index, 0);
        assert_int_equal(candidates.candidate[31].index, c == 0 ? 71 : 31);
    }
    /* As many as there is room for beside the image's: all. */
    const struct lm_target image = image_mover(46, 11, 0, 0);
    const struct lm_target_set both = {.items = &image, .count = 1, .live = &live};
    for (int i = 31; i < 72; i++) {
        live.target[i].is_there = false;
    }
    select_all(&candidates, &both);
    assert_int_equal(candidates.count, 32);
    assert_int_equal(candidates.left_out, 0);
    live.target[31].is_there = true;
    select_all(&candidates, &both);
    assert_int_equal(candidates.left_out, 1);
}

/* What a crowded beam shows of strong ones is what it shows of them alone. */
TEST(strong_targets_are_not_lost_in_a_crowded_beam)
{
    static int16_t all[LINES_MAX][SIDE], strong[LINES_MAX][SIDE], without[LINES_MAX][SIDE];
    const struct lm_target_set none = {0}, live_set = {.live = &live};
    tiny_map_open_soil(&map, SLOTS, &tone);
    for (size_t v = 0; v < sizeof views / sizeof *views; v++) {
        sweep(views[v], &none, without);
        crowd_the_beam(45);
        sweep(views[v], &live_set, all);
        for (int i = 0; i < 48; i++) {
            live.target[i].is_there = false;
        }
        sweep(views[v], &live_set, strong);
        int lost = 0, bright = 0;
        for (int k = 0; k < LINES_MAX * SIDE; k++) {
            const int level = strong[k / SIDE][k % SIDE];
            const bool is_bright = level > without[k / SIDE][k % SIDE] + 6 * 256;
            bright += is_bright;
            lost += is_bright && all[k / SIDE][k % SIDE] < level - 256;
        }
        print_message("# mode %d field %d: %d cells bright, %d lost\n", views[v].mode, views[v].fov,
                      bright, lost);
        assert_int_equal(lost, 0);
        assert_true(views[v].mode == LM_SECTOR_GMT || bright > 0);
    }
    tiny_map_close(&map);
}

/* ---- patches ---- */

static void draw_patch(const struct lm_target_set *set, uint8_t picture[SIDE][SIDE])
{
    static struct lm_sar sar;
    const struct lm_sar_command command = {.centre = {hs_bam(46), hs_bam(11)},
                                           .range_m = 20000,
                                           .height_m_q6 = 6000 * 64,
                                           .look_azimuth = hs_bam(90),
                                           .cell_mm = 4000};
    const struct lm_sar_setup scene = {
        .targets = set, .epoch = 5, .sea_state = LM_SEA_STATE_OF_IMAGE, .time_us = 7 * S};
    assert_int_equal(lm_sar_start(&sar, &lm_radar_default, &map.db, &command, &scene), LM_OK);
    const int beside = ((int)sar.lines - SIDE) / 2;
    for (int k = -beside; k < SIDE + beside; k++) {
        lm_sar_draw_line(&sar, &map.tiles, &tone, &line);
        if (k >= 0 && k < SIDE) {
            memcpy(picture[k], line.grey, SIDE);
        }
    }
}

static int brighter(uint8_t a[SIDE][SIDE], uint8_t b[SIDE][SIDE], int *most)
{
    int cells = 0;
    *most = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        const int rise = a[k / SIDE][k % SIDE] - b[k / SIDE][k % SIDE];
        cells += rise > 30;
        *most = abs(rise) > *most ? abs(rise) : *most;
    }
    return cells;
}

TEST(a_patch_displaces_and_smears_a_live_mover_as_one_of_the_image)
{
    static uint8_t without[SIDE][SIDE], image[SIDE][SIDE], told[SIDE][SIDE];
    static const double motions[][2] = {
        {0, 0}, {270, 1.5}, {0, 3}, {180 + 36.8698976, 2.5}, {90, 1}};
    const struct lm_target_set none = {0}, live_set = {.live = &live};
    tiny_map_open_soil(&map, SLOTS, &tone);
    draw_patch(&none, without);
    for (size_t i = 0; i < sizeof motions / sizeof *motions; i++) {
        const struct lm_target t = image_mover(46, 11, motions[i][0], motions[i][1]);
        const struct lm_target_set set = {.items = &t, .count = 1};
        int most, apart;
        tell(&t, 77, 5 * S);
        draw_patch(&set, image);
        draw_patch(&live_set, told);
        const int shown = brighter(image, without, &most);
        brighter(told, image, &apart);
        print_message("# heading %.0f, %.1f m/s: %d cells, at most %d grey apart\n", motions[i][0],
                      motions[i][1], shown, apart);
        assert_true(shown > 4);
        assert_true(apart < 30);
        live.target[77].height_m_q6 = -100 * 64; /* below the ground */
        draw_patch(&live_set, told);
        assert_memory_equal(told, without, sizeof told);
    }
    tiny_map_close(&map);
}

/* ---- heights ---- */

static double hill(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return 300;
}

TEST(a_live_target_stands_on_the_map_or_at_its_height_above_sea_level)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 12;
    spec.rows = spec.columns = 4;
    spec.elevation_m = hill;
    tiny_map_open(&map, &spec, SLOTS);
    const struct lm_target_set set = {.live = &live};
    const struct lm_target_query query = {.position = {hs_bam(46), hs_bam(11)},
                                          .reach_m = 5000,
                                          .time_us = 7 * S,
                                          .tiles = &map.tiles};
    const struct lm_target t = image_mover(46, 11, 0, 0);
    static struct lm_target_candidates candidates;
    for (int has_height = 0; has_height < 2; has_height++) {
        tell(&t, 9, 7 * S);
        live.target[9].has_height = has_height;
        live.target[9].height_m_q6 = has_height ? 1234 * 64 : 0;
        for (int turn = 0; turn < 2; turn++) { /* the first asks for the tile */
            lm_target_candidates_select(&candidates, &set, &query);
            lm_target_candidates_add_live(&candidates, &query);
            tiny_map_read_tiles(&map);
        }
        assert_int_equal(candidates.count, 1);
        /* The map's steps are finer than a sixteenth of a metre. */
        const int32_t expected_m_q6 = (has_height ? 1234 : 300) * 64;
        assert_in_range(candidates.candidate[0].elevation_m_q6, expected_m_q6 - 4,
                        expected_m_q6 + 4);
    }
    tiny_map_close(&map);
}

/* ---- the unit ---- */

/* The rig's bus, and live targets between its frames. */
static struct {
    const struct lm_can *flight;
    struct rig *rig;
    uint64_t next_us;
    uint32_t sent, sets;
    bool is_silent;
} feed;

static struct lm_can_frame live_frame(uint32_t number)
{
    static const uint16_t ids[] = {1815, 1810, 1811, 1812, 1813, 1814};
    static const uint8_t types[] = {LM_CANAS_UCHAR4, LM_CANAS_LONG,   LM_CANAS_LONG,
                                    LM_CANAS_FLOAT,  LM_CANAS_SHORT2, LM_CANAS_SHORT2};
    const uint32_t target = number / 6 % LM_LIVE_MAX, part = number % 6;
    const float height = 300;
    uint32_t words[6] = {0x02020007u,
                         (uint32_t)(460000000 + 5000 * (target / 16)),
                         (uint32_t)(110000000 + 5000 * (target % 16)),
                         0,
                         0x00640000u,
                         0};
    memcpy(&words[3], &height, sizeof height);
    struct lm_can_frame f = {.id = ids[part], .length = 8, .time_us = feed.rig->now_us};
    const uint8_t head[] = {30, types[part], (uint8_t)target, (uint8_t)(number / 6)};
    memcpy(f.data, head, 4);
    for (int i = 0; i < 4; i++) {
        f.data[4 + i] = (uint8_t)(words[part] >> (24 - 8 * i));
    }
    return f;
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    (void)ctx;
    if (!feed.is_silent && feed.rig->now_us >= feed.next_us) {
        *frame = live_frame(feed.sent++);
        feed.next_us += S / (6 * LM_LIVE_MAX);
        return 1;
    }
    return feed.flight->receive(feed.flight->ctx, frame);
}

/* The reason stands below the flag on the glass. */
static bool says_targets(const struct rig *r)
{
    const struct lm_surface glass = glass_of(r);
    const struct lm_palette *palette = &r->unit.palette;
    return glass_find(&glass, "EXC", palette->warning, palette->ink, NULL) &&
           glass_find(&glass, "TARGETS", palette->warning, palette->ink, NULL);
}

TEST(the_unit_takes_256_live_targets_at_1_hz_and_loses_none)
{
    struct rig *r = fly_rig();
    const struct lm_board *was = r->unit.board;
    struct lm_board board = *was;
    struct lm_can can = *was->can;
    can.receive = receive;
    can.ctx = NULL;
    board.can = &can;
    feed.flight = was->can;
    feed.rig = r;
    feed.next_us = r->now_us;
    r->unit.board = &board;
    const uint32_t lines = r->unit.count.lines, dropped = r->unit.count.lines_dropped;
    run(r, 10);
    const struct lm_live_bus *b = &r->unit.live;
    assert_int_equal(b->live.count, LM_LIVE_MAX);
    assert_in_range(b->count.sets, feed.sent / 6 - 1, feed.sent / 6);
    assert_in_range(feed.sent, 15300, 15400);
    assert_int_equal(b->count.torn + b->count.refused + b->count.rivals + b->count.aged, 0);
    print_message("# %u frames, %u sets, %u lines, %u dropped\n", feed.sent, b->count.sets,
                  r->unit.count.lines - lines, r->unit.count.lines_dropped - dropped);
    assert_int_equal(r->unit.count.lines_dropped, dropped);
    assert_false(r->unit.flags & LM_FLAG_EXERCISE);
    feed.is_silent = true;
    run(r, 2.9);
    assert_false(r->unit.flags & LM_FLAG_EXERCISE);
    run(r, 0.5);
    assert_true(r->unit.flags & LM_FLAG_EXERCISE);
    assert_true(says_targets(r));
    run(r, 5.6);
    assert_int_equal(b->live.count, LM_LIVE_MAX);
    run(r, 2.2);
    assert_int_equal(b->live.count, 0);
    assert_int_equal(b->count.aged, LM_LIVE_MAX);
    assert_false(r->unit.flags & LM_FLAG_EXERCISE);
    run(r, 0.2);
    assert_false(says_targets(r));
    r->unit.board = was;
    free_rig(r);
}

/* ---- its time and the exercise's ---- */

/* Frames of one step, and then the rig's bus. */
static struct {
    const struct lm_can *flight;
    struct lm_can_frame frame[16];
    uint32_t count, next;
} told;

static int receive_told(void *ctx, struct lm_can_frame *frame)
{
    (void)ctx;
    if (told.next < told.count) {
        *frame = told.frame[told.next++];
        return 1;
    }
    return told.flight->receive(told.flight->ctx, frame);
}

static void tell_clock(const struct rig *r, int32_t ms)
{
    const uint8_t code = (uint8_t)told.count;
    told.frame[told.count++] = bus_frame(1820, LM_CANAS_LONG, code, (uint32_t)ms, r->now_us);
}

/* Target 0, which moves at 1 m/s east and whatever the rig's time. */
static void tell_target(struct rig *r)
{
    feed.rig = r;
    for (uint32_t part = 0; part < 6; part++) {
        told.frame[told.count++] = live_frame(part);
    }
}

/* How far the target is reckoned to have come since it was told, in milliseconds. */
static int32_t reckoned_ms(const struct rig *r)
{
    const struct lm_unit *u = &r->unit;
    assert_int_equal(u->live.live.count, 1);
    return (int32_t)((int64_t)(u->exercise.time_us - u->live.live.target[0].motion_us) / 1000);
}

static struct rig *tell_in(void)
{
    static struct lm_board board;
    static struct lm_can can;
    struct rig *r = fly_rig();
    run(r, 1);
    memset(&told, 0, sizeof told);
    board = *r->unit.board;
    can = *board.can;
    can.receive = receive_told;
    told.flight = board.can;
    board.can = &can;
    r->unit.board = &board;
    return r;
}

TEST(a_target_of_the_step_in_which_the_clock_begins_stands_where_it_was_told)
{
    for (int is_clock_first = 0; is_clock_first < 2; is_clock_first++) {
        struct rig *r = tell_in();
        if (is_clock_first) {
            tell_clock(r, 3600000);
            tell_target(r);
        } else {
            tell_target(r);
            tell_clock(r, 3600000);
        }
        run(r, 0.004);
        assert_int_equal(r->unit.exercise.time_us / S, 3600);
        assert_in_range(reckoned_ms(r) + 10, 0, 20);
        free_rig(r);
    }
}

TEST(a_target_stays_where_it_is_when_the_clock_steps)
{
    struct rig *r = tell_in();
    tell_clock(r, 3600000);
    tell_target(r);
    run(r, 0.5);
    assert_in_range(reckoned_ms(r), 490, 510);
    tell_clock(r, 7200000); /* the instructor takes it forward, */
    run(r, 0.1);
    assert_in_range(reckoned_ms(r), 590, 610);
    tell_clock(r, 1000); /* and back */
    run(r, 0.1);
    assert_in_range(reckoned_ms(r), 690, 710);
    tell_clock(r, 1150); /* jitter moves it, as everything */
    run(r, 0.1);
    assert_in_range(reckoned_ms(r), 790, 900);
    free_rig(r);
}

/* What has gone goes on for a while at its last speed, but not for an hour. */
TEST(a_target_that_has_gone_does_not_coast_over_a_step_of_the_clock)
{
    struct rig *r = tell_in();
    const struct lm_track *t = &r->unit.track;
    tell_target(r);
    run(r, 0.1);
    command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_SEA, 0}});
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                   .cursor = r->unit.live.live.target[0].position});
    command(r, (struct lm_control){.kind = LM_CONTROL_TRACK});
    for (int i = 0; i < 300 && t->state != LM_TRACK_COASTING; i++) {
        run(r, 0.1);
    }
    assert_int_equal(t->state, LM_TRACK_COASTING);
    const struct lm_position was = t->seen.position;
    tell_clock(r, 7200000);
    run(r, 0.3);
    assert_int_equal(t->state, LM_TRACK_COASTING);
    assert_int_equal(r->unit.exercise.time_us / S, 7200);
    /* A thousand BAM are 9 m; it moves at 5 m/s. */
    assert_in_range(t->seen.position.latitude - was.latitude + 1000, 0, 2000);
    assert_in_range(t->seen.position.longitude - was.longitude + 1000, 0, 2000);
    free_rig(r);
}

/* Targets follow the first step of a step of the unit, and no second one. */
TEST(of_a_clock_that_steps_in_every_frame_targets_follow_one_step_at_a_time)
{
    struct rig *r = tell_in();
    tell_clock(r, 3600000);
    tell_target(r);
    run(r, 0.5);
    tell_clock(r, 7200000);
    tell_clock(r, 10200000);
    run(r, 0.1);
    assert_int_equal(r->unit.exercise.time_us / S, 10200);
    assert_in_range(reckoned_ms(r), 3000590, 3000610);
    free_rig(r);
}

/* Over water or not: in SEA what is at the cursor is tracked, and this one is told by the bus. */
TEST(a_live_target_is_tracked_until_it_goes)
{
    struct rig *r = tell_in();
    tell_target(r);
    run(r, 0.1);
    assert_int_equal(r->unit.live.live.count, 1);
    command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_SEA, 0}});
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                   .cursor = r->unit.live.live.target[0].position});
    command(r, (struct lm_control){.kind = LM_CONTROL_TRACK});
    run(r, 0.5);
    const struct lm_track *t = &r->unit.track;
    assert_int_equal(t->state, LM_TRACK_HELD);
    assert_true(t->has_target && t->is_live);
    assert_int_equal(t->index, 0);
    assert_in_range(t->seen.speed_mm_s, 4990, 5010); /* 100 times 0.05 m/s */
    assert_int_equal(t->seen.elevation_m_q10, 300 * 1024);
    for (int i = 0; i < 200 && r->unit.live.live.count != 0; i++) {
        run(r, 0.1);
    }
    assert_int_equal(r->unit.live.live.count, 0);
    run(r, 0.5);
    assert_int_equal(t->state, LM_TRACK_COASTING);
    assert_int_equal(t->loss, LM_TRACK_NOTHING);
    run(r, LM_TRACK_COAST_US / 1e6 + 0.5);
    assert_int_equal(t->state, LM_TRACK_OFF);
    assert_int_equal(t->loss, LM_TRACK_NOTHING);
    free_rig(r);
}
