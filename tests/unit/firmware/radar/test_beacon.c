/* Beacons in whole sweeps of the beacon mode: where the pulses of a reply stand, how wide they are,
 * and what keeps a reply away. Ranges are worked out in double precision; times are those of the
 * DO-172 format (docs/EQUATIONS.md, "Beacons"). */
#include "check.h"
#include "lm/level.h"
#include "scales.h"
#include "sector_world.h"
#include "target_support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LINES = 256, BINS = 256, HEIGHT_M = 2000 };

static const double light_m_us = 299.792458 / 2;

static bool has_wall;

/* Soil with a bright town, and perhaps a wall 300 m high 3 km north of the radar. */
static struct tiny_cell country(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return p->east_m > 2000 ? (struct tiny_cell){10, TINY_STRUCTURE, 4}
                            : (struct tiny_cell){-20, TINY_SOIL, 0};
}

static double relief_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return has_wall && fabs(p->north_m - 3000) < 400 ? 1500 : 0;
}

static struct sector_world *world_of(bool has_relief)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    has_wall = has_relief;
    spec.cell = country;
    spec.elevation_m = relief_m;
    spec.shift0 = 12;
    spec.rows = spec.columns = 11;
    struct sector_world *w = make_sector_world(&spec);
    w->platform =
        (struct lm_platform){.position = {w->map.db.centre_latitude, w->map.db.centre_longitude},
                             .height_m_q10 = HEIGHT_M * 1024};
    return w;
}

static struct lm_target beacon_at(const struct sector_world *w, double azimuth_deg,
                                  double distance_m, uint8_t reply)
{
    const struct lm_position at = place_at(w, azimuth_deg, distance_m);
    struct lm_target t = {.id = 3,
                          .latitude = at.latitude,
                          .longitude = at.longitude,
                          .elevation_m_q6 = 2 * 64,
                          .flags = LM_TARGET_ABOVE_GROUND | LM_TARGET_IS_BEACON,
                          .signature = reply};
    seal_target(&t);
    assert_int_equal(lm_target_check(&t), LM_OK);
    return t;
}

/* What a sweep shows: 1 where a reply is. */
struct picture {
    uint8_t is_lit[LINES][BINS];
    double azimuth_deg[LINES];
    uint32_t lines;
    int lit, grey_most;
};

static struct lm_sector_command command_of(uint8_t mode)
{
    return (struct lm_sector_command){.mode = mode, .range_index = scale_of(10)};
}

static void begin_sweep(struct sector_world *w, const struct lm_sector_command *command,
                        const struct lm_target_set *set)
{
    start_sector(w, command, NULL, set);
}

static void end_sweep(struct sector_world *w, struct picture *p)
{
    memset(p, 0, sizeof *p);
    do {
        const uint32_t line = draw_line(w);
        p->azimuth_deg[line] = line_azimuth_deg(&w->sector, line);
        for (uint32_t i = 0; i < BINS; i++) {
            const bool is_lit = w->sector.level_db_q8[i] > LM_LEVEL_SHADOW;
            p->is_lit[line][i] = is_lit;
            p->lit += is_lit;
            p->grey_most = w->line.grey[i] > p->grey_most ? w->line.grey[i] : p->grey_most;
        }
    } while (!lm_sector_is_at_edge(&w->sector));
    p->lines = w->sector.lines;
}

static void take(struct sector_world *w, const struct lm_target_set *set, struct picture *p)
{
    const struct lm_sector_command command = command_of(LM_SECTOR_BEACON);
    begin_sweep(w, &command, set);
    end_sweep(w, p);
}

/* Bins lit on the line nearest to an azimuth, one after another. */
static int bins_at(const struct picture *p, double azimuth_deg, int bins[BINS])
{
    uint32_t line = 0;
    int count = 0;
    for (uint32_t k = 0; k < p->lines; k++) {
        line = fabs(p->azimuth_deg[k] - azimuth_deg) < fabs(p->azimuth_deg[line] - azimuth_deg)
                   ? k
                   : line;
    }
    for (int i = 0; i < BINS; i++) {
        if (p->is_lit[line][i]) {
            bins[count++] = i;
        }
    }
    return count;
}

/* Width and middle of what is lit, degrees. */
static double width_deg(const struct picture *p, double *middle_deg)
{
    double first = 1e3, last = -1e3;
    for (uint32_t k = 0; k < p->lines; k++) {
        for (int i = 0; i < BINS; i++) {
            first = p->is_lit[k][i] ? fmin(first, p->azimuth_deg[k]) : first;
            last = p->is_lit[k][i] ? fmax(last, p->azimuth_deg[k]) : last;
        }
    }
    *middle_deg = (first + last) / 2;
    return last - first + fabs(p->azimuth_deg[1] - p->azimuth_deg[0]);
}

TEST(a_reply_has_its_frames_and_the_bits_of_its_code_where_their_time_puts_them)
{
    static struct picture p;
    struct sector_world *w = world_of(false);
    const double bin_m = 18520.0 / BINS;
    for (int code = 0; code < 16; code++) {
        for (int late_us = 0; late_us < 16; late_us += 5) {
            const double away_m = 5000 + 311.7 * code, slant_m = hypot(away_m, HEIGHT_M);
            const struct lm_target t = beacon_at(w, -17.3, away_m, (uint8_t)(late_us << 4 | code));
            const struct lm_target_set set = {.items = &t, .count = 1};
            int bins[BINS], wanted = 0;
            take(w, &set, &p);
            const int count = bins_at(&p, -17.3, bins);
            for (int us = 0; us <= 15; us += 3) {
                const bool is_frame = us == 0 || us == 15;
                if (is_frame || code >> (us / 3 - 1) & 1) {
                    const double at = (slant_m + (late_us + us) * light_m_us) / bin_m;
                    assert_true(wanted < count && fabs(bins[wanted] + 0.5 - at) < 0.6);
                    wanted++;
                }
            }
            assert_int_equal(count, wanted);
            assert_int_equal(p.grey_most, 255);
        }
    }
    free_sector_world(w);
}

TEST(an_arc_is_as_wide_as_the_beam_and_stands_at_the_beacons_bearing)
{
    static struct picture p;
    struct sector_world *w = world_of(false);
    const double beam_deg = hs_degrees(w->radar.antenna.azimuth_beam);
    for (double azimuth_deg = -40; azimuth_deg < 40; azimuth_deg += 7.77) {
        const struct lm_target t = beacon_at(w, azimuth_deg, 9000, 5);
        const struct lm_target_set set = {.items = &t, .count = 1};
        double middle_deg;
        take(w, &set, &p);
        const double width = width_deg(&p, &middle_deg);
        assert_true(fabs(width - beam_deg) < 0.6);
        assert_true(fabs(middle_deg - azimuth_deg) < 0.4);
    }
    free_sector_world(w);
}

TEST(nothing_but_beacons_answers)
{
    static struct picture p;
    struct sector_world *w = world_of(false);
    struct lm_target t = point_at(46.05, 11, 2, 60);
    struct lm_target_set set = {0};
    const struct lm_environment storm = {
        .rain_count = 1,
        .rain[0] = {.centre = {hs_bam(46.05), hs_bam(11)}, .radius_m = 4000, .mm_per_h = 60},
        .jammer_count = 1,
        .jammer[0] = {.position = {hs_bam(46.08), hs_bam(11)}, .noise_ratio_db_q8 = LM_DB_Q8(60)}};
    take(w, &set, &p);
    assert_int_equal(p.lit, 0);
    assert_int_equal(p.grey_most, 0);
    set = (struct lm_target_set){.items = &t, .count = 1};
    const struct lm_sector_command command = command_of(LM_SECTOR_BEACON);
    begin_sweep(w, &command, &set);
    w->sector.environment = &storm;
    end_sweep(w, &p);
    assert_int_equal(p.lit, 0);
    free_sector_world(w);
}

TEST(terrain_before_a_beacon_hides_it)
{
    static struct picture p;
    struct sector_world *w = world_of(true);
    for (int is_hidden = 0; is_hidden < 2; is_hidden++) {
        /* 1,500 m high at 3.4 km: the shadow reaches to 13.6 km. */
        const struct lm_target t = beacon_at(w, 0, is_hidden ? 9000 : 14500, 15);
        const struct lm_target_set set = {.items = &t, .count = 1};
        take(w, &set, &p);
        assert_int_equal(p.lit == 0, is_hidden);
    }
    free_sector_world(w);
}

static int lit_with(struct sector_world *w, enum lm_malfunction what, double amount,
                    double tilt_deg)
{
    static struct picture p;
    const struct lm_target t = beacon_at(w, 10, 9000, 15);
    const struct lm_target_set set = {.items = &t, .count = 1};
    struct lm_malfunctions broken = {0};
    struct lm_sector_command command = command_of(LM_SECTOR_BEACON);
    broken.set = 1u << what;
    broken.amount_q8[what] = (int32_t)lround(amount * 256);
    command.beam.is_tilt_manual = true;
    command.beam.tilt = (int32_t)hs_bam(tilt_deg);
    start_sector(w, &command, NULL, &set);
    lm_sector_start(&w->sector, &w->radar, &command, 0);
    w->sector.targets = &set;
    w->sector.malfunctions = &broken;
    end_sweep(w, &p);
    return p.lit;
}

/* A beacon answers whoever reaches it with a hundredth of the power of the beam's middle. */
TEST(a_beacon_that_is_not_reached_does_not_answer)
{
    struct sector_world *w = world_of(false);
    const int lit = lit_with(w, LM_MALFUNCTION_FROZEN, 0, -12);
    assert_true(lit > 0);
    assert_int_equal(lit_with(w, LM_MALFUNCTION_WEAK_TRANSMIT, 20, -12), lit);
    assert_int_equal(lit_with(w, LM_MALFUNCTION_WEAK_TRANSMIT, 60, -12), 0);
    assert_int_equal(lit_with(w, LM_MALFUNCTION_NO_TRANSMIT, 0, -12), 0);
    assert_int_equal(lit_with(w, LM_MALFUNCTION_FROZEN, 0, 30), 0);
    free_sector_world(w);
}

static struct lm_live live;

static void tell(uint32_t number, struct lm_position at, uint8_t kind, uint8_t signature,
                 double rcs_db)
{
    live.count += !live.target[number].is_there;
    live.target[number] = (struct lm_live_target){.position = at,
                                                  .kind = kind,
                                                  .signature = signature,
                                                  .reckoning = LM_LIVE_STATIC,
                                                  .rcs_dbsm_q8 = (int16_t)lround(rcs_db * 256),
                                                  .height_m_q6 = 2 * 64,
                                                  .has_height = true,
                                                  .is_there = true};
}

/* 200 ships in the beacon's beam, each stronger than it. */
TEST(a_live_beacon_answers_as_one_of_the_image_among_whatever_ships)
{
    static struct picture image, told;
    struct sector_world *w = world_of(false);
    const struct lm_target t = beacon_at(w, 5, 8000, 0x2a);
    const struct lm_target_set of_image = {.items = &t, .count = 1}, of_bus = {.live = &live};
    memset(&live, 0, sizeof live);
    for (uint32_t i = 0; i < 200; i++) {
        tell(i, place_at(w, 5 + i % 5 * 0.1, 4000 + 20 * i), LM_LIVE_LARGE_SHIP, 0, 43);
    }
    tell(255, place_at(w, 5, 8000), LM_LIVE_BEACON, 0x2a, 0);
    take(w, &of_image, &image);
    take(w, &of_bus, &told);
    assert_true(image.lit > 0);
    assert_memory_equal(image.is_lit, told.is_lit, sizeof image.is_lit);
    free_sector_world(w);
}

/* In the other modes a beacon is a point of its cross section, whatever it would answer. */
TEST(a_beacon_is_an_ordinary_point_in_the_other_modes)
{
    static int16_t level_q8[2][LINES][BINS];
    struct sector_world *w = world_of(false);
    for (uint8_t mode = LM_SECTOR_GM; mode < LM_SECTOR_MODES; mode++) {
        for (int is_beacon = 0; is_beacon < 2; is_beacon++) {
            struct lm_target t = beacon_at(w, 5, 8000, 15);
            t.flags = LM_TARGET_ABOVE_GROUND | (is_beacon ? LM_TARGET_IS_BEACON : 0);
            t.mean_rcs_dbsm_q8 = LM_DB_Q8(40);
            const struct lm_target_set set = {.items = &t, .count = 1};
            const struct lm_sector_command command = command_of(mode);
            begin_sweep(w, &command, &set);
            do {
                const uint32_t line = draw_line(w);
                memcpy(level_q8[is_beacon][line], w->sector.level_db_q8,
                       sizeof level_q8[is_beacon][line]);
            } while (!lm_sector_is_at_edge(&w->sector));
        }
        assert_memory_equal(level_q8[0], level_q8[1], sizeof level_q8[0]);
    }
    free_sector_world(w);
}

TEST(a_record_is_a_beacon_or_has_a_signature_or_bodies)
{
    struct lm_target t = point_at(46, 11, 0, 0);
    t.signature = 255;
    seal_target(&t);
    assert_int_equal(lm_target_check(&t), LM_ERR_CORRUPT);
    t.flags = LM_TARGET_IS_BEACON;
    seal_target(&t);
    assert_int_equal(lm_target_check(&t), LM_OK);
    t.flags |= LM_TARGET_HAS_SIGNATURE;
    t.signature = 3;
    seal_target(&t);
    assert_int_equal(lm_target_check(&t), LM_ERR_CORRUPT);
    t.flags = LM_TARGET_IS_BEACON;
    add_scatterer(&t, LM_SHAPE_SPHERE, 1000, 0, 0, 0, 0, 0);
    seal_target(&t);
    assert_int_equal(lm_target_check(&t), LM_ERR_CORRUPT);
}
