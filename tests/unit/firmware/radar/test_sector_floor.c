/* The floor of a sector: the running mean of its ground, and a shadow as it shows beside grass in
 * each field of view. docs/EQUATIONS.md, "Floor" of the real beam. */
#include "check.h"
#include "hs/rng.h"
#include "lm/sector_floor.h"
#include "reference_support.h"
#include "scales.h"
#include "sector_world.h"

#include <math.h>
#include <string.h>

enum { BINS = 256, LINE = 1 << 20 };

/* Levels, dB, that the ground leaves in each bin. */
static void run(struct lm_sector_floor *f, uint32_t number, const uint32_t *power_q24,
                uint32_t bins, double *left_db)
{
    uint32_t filled_q24[LM_CELLS_ROOM];
    memcpy(filled_q24, power_q24, sizeof filled_q24);
    lm_sector_floor_run(f, number, filled_q24, bins);
    for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
        const double left = ldexp(filled_q24[i] - power_q24[i], -24);
        assert_true(i < bins || left == 0);
        left_db[i] = 10 * log10(left);
    }
}

static void set(struct lm_sector_floor *f, double leak_db, double most_db, uint32_t lines,
                double cell_m)
{
    lm_sector_floor_set(f, &(struct lm_sector_floor_setting){(int32_t)(leak_db * 256),
                                                             (int32_t)(most_db * 256), lines * LINE,
                                                             LINE, (uint32_t)(cell_m * 256)});
}

/* Of bins of 72 m, as those of a sector over 10 nautical miles. */
static struct lm_sector_floor floor_of(double leak_db, uint32_t lines)
{
    struct lm_sector_floor f = {.bins_log2 = 0};
    set(&f, leak_db, -10, lines, 72);
    return f;
}

static void fill_q24(uint32_t power_q24[LM_CELLS_ROOM], double level_db)
{
    for (int i = 0; i < LM_CELLS_ROOM; i++) {
        power_q24[i] = (uint32_t)ldexp(pow(10, level_db / 10), 24);
    }
}

TEST(even_ground_leaves_its_level_less_the_leak)
{
    for (int db = -30; db <= 20; db += 5) {
        struct lm_sector_floor f = floor_of(-16, 200);
        uint32_t power_q24[LM_CELLS_ROOM];
        fill_q24(power_q24, db);
        for (uint32_t line = 0; line < 50; line++) {
            double left_db[LM_CELLS_ROOM];
            run(&f, line, power_q24, BINS, left_db);
            for (uint32_t i = 0; i < BINS; i++) {
                assert_true(fabs(left_db[i] - (fmin(db, -10) - 16)) < 0.02);
            }
        }
    }
}

TEST(leaks_of_the_ends_of_the_table_neither_overflow_nor_add_power)
{
    uint32_t power_q24[LM_CELLS_ROOM];
    double left_db[LM_CELLS_ROOM];
    fill_q24(power_q24, 20);
    struct lm_sector_floor f = {.bins_log2 = 0};
    set(&f, 0, 20, 1, 72);
    for (uint32_t line = 0; line < 10; line++) {
        run(&f, line, power_q24, LM_CELLS_MAX, left_db);
        for (uint32_t i = 0; i < LM_CELLS_MAX; i++) {
            assert_true(fabs(left_db[i] - 6.02) < 0.01);
        }
    }
    memset(power_q24, 0xff, sizeof power_q24); /* there is no more */
    lm_sector_floor_run(&f, 0, power_q24, LM_CELLS_MAX);
    assert_int_equal(power_q24[0], UINT32_MAX);
    assert_int_equal(power_q24[LM_CELLS_MAX - 1], UINT32_MAX);
    fill_q24(power_q24, 20);
    set(&f, -100, 20, 1, 72);
    run(&f, 0, power_q24, LM_CELLS_MAX, left_db);
    assert_true(left_db[0] < -200 && left_db[LM_CELLS_MAX - 1] < -200);
    set(&f, 0, 20, 0, 72);
    assert_int_equal(f.lines_max, 1);
}

TEST(the_means_of_any_lines_are_those_of_the_reference)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 12);
    for (uint32_t bins = 0; bins <= LM_CELLS_MAX; bins += 37) {
        const uint32_t lines = 1 + hs_rng_below(&rng, 250);
        const double cell_m = 4 + hs_rng_below(&rng, 70);
        struct lm_sector_floor f = floor_of(-20, lines);
        set(&f, -20, -10, lines, cell_m);
        struct ref_leak leak[REF_LEAK_STRETCHES] = {{0}};
        for (uint32_t line = 3; line < 300; line++) {
            uint32_t power_q24[LM_CELLS_ROOM];
            double power[LM_CELLS_ROOM], mean[LM_CELLS_ROOM], left_db[LM_CELLS_ROOM];
            double about_db = 0;
            for (uint32_t i = 0; i < LM_CELLS_ROOM; i++) {
                about_db = i % 50 ? about_db : -(double)hs_rng_below(&rng, 30);
                power_q24[i] =
                    (uint32_t)ldexp(pow(10, (about_db + hs_rng_below(&rng, 20)) / 10), 24);
                power[i] = ldexp(power_q24[i], -24);
            }
            ref_leak_sector(leak, ref_leak_bins(cell_m), -10, lines, line, power, bins, mean);
            run(&f, line, power_q24, bins, left_db);
            for (uint32_t i = 0; i < bins; i++) {
                const double wanted_db = fmax(10 * log10(mean[i]) - 20, -60);
                assert_true(fabs(fmax(left_db[i], -60) - wanted_db) < 0.1);
            }
        }
    }
}

TEST(stretches_of_another_length_begin_anew)
{
    uint32_t power_q24[LM_CELLS_ROOM];
    double left_db[LM_CELLS_ROOM];
    struct lm_sector_floor f = floor_of(-16, 20);
    fill_q24(power_q24, -12);
    run(&f, 0, power_q24, BINS, left_db);
    set(&f, -16, -10, 20, 36);
    assert_int_equal(f.bins_log2, 6);
    fill_q24(power_q24, -42);
    run(&f, 1, power_q24, BINS, left_db);
    assert_true(fabs(left_db[0] - -58) < 0.3);
    set(&f, -16, -10, 20, 0.01); /* the line is one stretch */
    run(&f, 2, power_q24, LM_CELLS_MAX, left_db);
    assert_true(fabs(left_db[LM_CELLS_MAX - 1] - -58) < 0.3);
}

/* Land of -12 dB up to bin 96, and water of -45 dB behind it. */
TEST(land_leaks_into_water_near_it_and_not_into_water_far_from_it)
{
    struct lm_sector_floor f = floor_of(-16, 20);
    uint32_t power_q24[LM_CELLS_ROOM], water_q24[LM_CELLS_ROOM];
    double left_db[LM_CELLS_ROOM];
    fill_q24(power_q24, -12);
    fill_q24(water_q24, -45);
    memcpy(power_q24 + 96, water_q24 + 96, sizeof power_q24 - 96 * sizeof *power_q24);
    for (uint32_t line = 0; line < 40; line++) {
        run(&f, line, power_q24, BINS, left_db);
    }
    assert_true(fabs(left_db[10] - -28) < 0.1 && fabs(left_db[80] - -28) < 0.1);
    assert_true(fabs(left_db[96] - (10 * log10(0.5) - 28)) < 0.1);
    for (uint32_t i = 96 + 16; i < BINS; i++) {
        assert_true(fabs(left_db[i] - -61) < 0.5);
    }
}

/* Grass of -15 dB, and a wall 60 m high that runs across the look for 16 km. */
static struct tiny_cell grass_and_wall(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return fabs(p->north_m) < 100 ? (struct tiny_cell){-15, TINY_STRUCTURE, 13}
                                  : (struct tiny_cell){-15, TINY_SOIL, 0};
}

/* Mean power, in dB, of the bins between two ground ranges, on the lines within a degree of the
 * middle, of a second sweep. */
struct depth {
    double shadow_db, grass_db;
};

static struct depth depth_of(struct sector_world *w, const struct lm_sector_command *command)
{
    double shadow = 0, grass = 0, in_shadow = 0, on_grass = 0;
    start_sector(w, command, NULL, NULL);
    draw_sweep(w);
    do {
        const struct lm_sector *s = &w->sector;
        const uint32_t line = draw_line(w);
        const bool is_in = fabs(line_azimuth_deg(s, line)) < 1;
        for (uint32_t i = 0; is_in && i < s->slant.cells; i++) {
            const double slant_m = (s->slant.first_m_q8 + i * s->slant.cell_m_q8) / 256.0;
            const double ground_m = sqrt(slant_m * slant_m - 1000.0 * 1000);
            const double power = pow(10, decibels(s->level_db_q8[i]) / 10);
            const bool is_shadow = ground_m > 10250 && ground_m < 10450;
            const bool is_grass = ground_m > 9500 && ground_m < 9800;
            shadow += is_shadow ? power : 0;
            grass += is_grass ? power : 0;
            in_shadow += is_shadow;
            on_grass += is_grass;
        }
    } while (!lm_sector_is_at_edge(&w->sector));
    assert_true(in_shadow > 2 && on_grass > 2);
    return (struct depth){10 * log10(shadow / in_shadow), 10 * log10(grass / on_grass)};
}

/* The wall is 10 km away, seen from 1,000 m: its shadow is 600 m long, and as wide as the beam of
 * any field of view. It is filled with the grass less the leak and with the noise. The noise of DBS
 * at 10 nautical miles is 31 dB under grass. */
TEST(a_shadow_is_under_the_grass_by_the_leak_of_its_field_of_view)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = grass_and_wall;
    spec.shift0 = 11;
    spec.rows = spec.columns = 24;
    struct sector_world *w = make_sector_world(&spec);
    w->radar.antenna.fan = FX_BAM_DEG(60);
    w->platform =
        (struct lm_platform){.position = {w->map.db.centre_latitude, w->map.db.centre_longitude},
                             .height_m_q10 = 1000 * 1024,
                             .track = FX_BAM_DEG(50),
                             .speed_mm_s = 250000};
    w->platform.position = place_at(w, 180, 10000);
    const struct {
        enum lm_fov fov;
        double least_db, most_db;
    } want[] = {
        {LM_FOV_NORM, 26, 32}, {LM_FOV_EXP, 18, 22}, {LM_FOV_DBS1, 14, 18}, {LM_FOV_DBS2, 14, 18}};
    for (size_t n = 0; n < sizeof want / sizeof want[0]; n++) {
        const struct lm_sector_command command = {.mode = LM_SECTOR_GM,
                                                  .fov = (uint8_t)want[n].fov,
                                                  .range_index = scale_of(10),
                                                  .centre = place_at(w, 0, 10000)};
        const struct depth d = depth_of(w, &command);
        print_message("# %s: shadow %.1f dB, grass %.1f, %.1f under it\n",
                      w->radar.fov[want[n].fov].name, d.shadow_db, d.grass_db,
                      d.grass_db - d.shadow_db);
        assert_true(d.grass_db - d.shadow_db > want[n].least_db);
        assert_true(d.grass_db - d.shadow_db < want[n].most_db);
    }
    free_sector_world(w);
}

/* Even grass 10 km around, seen from 3,000 m with a beam that looks 20 to 28 degrees down. It
 * lights the ground from 5.6 km on, and its pattern is down by 40 dB at 4.6 km. */
static struct tiny_cell grass(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-15, TINY_SOIL, 0};
}

static struct sector_world *make_meadow(fx_bam_t fan, fx_bam_t elevation_beam)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = grass;
    spec.shift0 = 11;
    spec.rows = spec.columns = 24;
    struct sector_world *w = make_sector_world(&spec);
    w->radar.antenna.fan = fan;
    w->radar.antenna.elevation_beam = elevation_beam;
    w->platform =
        (struct lm_platform){.position = {w->map.db.centre_latitude, w->map.db.centre_longitude},
                             .height_m_q10 = 3000 * 1024,
                             .track = FX_BAM_DEG(50),
                             .speed_mm_s = 250000};
    return w;
}

TEST(nothing_leaks_into_ground_that_lies_below_the_beam)
{
    struct sector_world *w = make_meadow(FX_BAM_DEG(8), FX_BAM_DEG(3));
    for (int fov = LM_FOV_EXP; fov <= LM_FOV_DBS1; fov++) {
        const struct lm_sector_command command = {
            .mode = LM_SECTOR_GM,
            .fov = (uint8_t)fov,
            .range_index = scale_of(10),
            .centre = place_at(w, 0, 5500),
            .beam = {.is_tilt_manual = true, .tilt = -(int32_t)FX_BAM_DEG(20)}};
        start_sector(w, &command, NULL, NULL);
        draw_sweep(w);
        draw_line(w);
        const struct lm_sector *s = &w->sector;
        double sum[2] = {0, 0};
        int count[2] = {0, 0};
        for (uint32_t i = 0; i < s->slant.cells; i++) {
            const double slant_m = (s->slant.first_m_q8 + i * s->slant.cell_m_q8) / 256.0;
            const bool is_lit = slant_m > 6600 && slant_m < 7600;
            if (is_lit || (slant_m > 4300 && slant_m < 5300)) {
                sum[is_lit] += pow(10, decibels(s->level_db_q8[i]) / 10);
                count[is_lit]++;
            }
        }
        const double under_db = 10 * log10(sum[1] / count[1] / (sum[0] / count[0]));
        print_message("# %s: %.1f dB under the grass\n", w->radar.fov[fov].name, under_db);
        assert_true(under_db > 35);
    }
    free_sector_world(w);
}

/* Bars and a malfunction of 30 degrees bring the lower edge of the widest fan to 225 degrees below
 * the horizon. It lights what lies straight below, as one does that reaches no farther than there.
 */
TEST(a_beam_turned_past_straight_down_lights_what_lies_below)
{
    struct sector_world *w = make_meadow(FX_BAM_DEG(60), FX_BAM_DEG(60));
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM, .range_index = scale_of(10)};
    start_sector(w, &command, NULL, NULL);
    draw_line(w);
    const int tilt_deg[] = {70, 0, -60, -90, -91, -135};
    uint32_t unlit[6];
    for (int i = 0; i < 6; i++) {
        const struct lm_beam_setting beam = {.is_tilt_manual = true,
                                             .tilt = (int32_t)(tilt_deg[i] * (1LL << 32) / 360)};
        lm_sector_set_beam(&w->sector, &beam);
        unlit[i] = w->sector.receiver.unlit;
    }
    assert_true(unlit[0] > unlit[1]);
    for (int i = 2; i < 6; i++) {
        assert_int_equal(unlit[i], unlit[1]);
    }
    free_sector_world(w);
}
