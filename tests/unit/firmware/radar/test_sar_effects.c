/* The effects of a patch that can be switched: layover and the blur of unsteady flight, against
 * theory in double precision. */
#include "tiny_map.h"
#include "unit_rig.h"

#include "check.h"
#include "fx/log.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "target_support.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

enum { CELLS = 256, LINES = 2 * LM_DEFOCUS_REACH + 1 };

static double power_of(int32_t level_q8)
{
    return pow(10, level_q8 / 2560.0);
}

/* ---- layover in a line ---- */

static struct lm_scan_line ground;
static uint64_t scratch[LM_CELLS_ROOM];
static int16_t laid_q8[LM_LAYOVER_ROOM];

static const struct lm_layover_view lean = {.reference_m_q10 = 100 * 1024,
                                            .lean_q16 = 19661, /* 0.3 */
                                            .cell_m_q8 = 5 * 256,
                                            .cells = CELLS};

static void flat_ground(double elevation_m)
{
    for (int i = 0; i < LM_CELLS_ROOM; i++) {
        ground.cell[i] = 0;
        ground.elevation_m_q14[i] = (int32_t)lround(elevation_m * 16384);
    }
}

TEST(a_towers_top_is_nearer_by_y_tan_psi_and_keeps_its_power)
{
    const struct lm_classes *classes = tiny_classes();
    for (uint32_t code = 0; code < 16; code++) {
        int16_t level_q8[LM_CELLS_ROOM];
        struct lm_layover layover;
        flat_ground(100);
        for (int i = 0; i < CELLS; i++) {
            level_q8[i] = LM_LEVEL_SHADOW;
        }
        ground.cell[150] = code;
        level_q8[150] = 7 * 256;
        lm_layover_set(&layover, classes, &lean);
        const int16_t *shown_q8 = lm_layover_run(&layover, &ground, level_q8, laid_q8);
        double power = 0, moment = 0;
        for (int i = 0; i < CELLS; i++) {
            const double p = shown_q8[i] < LM_LEVEL_SHADOW / 2 ? 0 : power_of(shown_q8[i]);
            power += p;
            moment += p * i;
        }
        const double expected = 150 - classes->height_dm[code] / 10.0 * 0.3 / 5;
        assert_true(fabs(moment / power - expected) < 1.02 / 32); /* a sixteenth, rounded */
        assert_true(fabs(10 * log10(power) - 7) < 0.03);
    }
}

TEST(layover_of_any_line_is_the_sum_of_shared_powers)
{
    struct hs_rng rng;
    struct lm_layover layover;
    double worst = 0; /* against all power that the cell may have a share of */
    hs_rng_seed(&rng, 2);
    lm_layover_set(&layover, tiny_classes(), &lean);
    for (int n = 0; n < 50; n++) {
        int16_t level_q8[LM_CELLS_ROOM];
        double expected[CELLS] = {0}, around[CELLS] = {0};
        for (int i = 0; i < CELLS; i++) {
            /* Not half-way between two sixteenths of a cell. */
            const double nearer_16ths =
                (double)hs_rng_below(&rng, 86) - 38 + 0.8 * (hs_rng_uniform(&rng) - 0.5);
            const double top_m = 100 + nearer_16ths / 16 * 5 / 0.3;
            ground.elevation_m_q14[i] = (int32_t)lround(top_m * 16384);
            ground.cell[i] = 0;
            level_q8[i] = (int16_t)((int32_t)hs_rng_below(&rng, 80 * 256) - 50 * 256);
            const double at = i - round(nearer_16ths) / 16, part = at - floor(at);
            for (int side = -1; side <= 2; side++) {
                const int cell = (int)floor(at) + side;
                if (cell >= 0 && cell < CELLS) {
                    const double share = side == 0 ? 1 - part : side == 1 ? part : 0;
                    expected[cell] += share * power_of(level_q8[i]);
                    around[cell] += power_of(level_q8[i]);
                }
            }
        }
        const int16_t *shown_q8 = lm_layover_run(&layover, &ground, level_q8, laid_q8);
        for (int i = 0; i < CELLS; i++) {
            const double got = shown_q8[i] < LM_LEVEL_SHADOW / 2 ? 0 : power_of(shown_q8[i]);
            if (around[i] > 0) {
                worst = fmax(worst, fabs(got - expected[i]) / around[i]);
            } else {
                assert_true(got == 0);
            }
        }
    }
    print_message("# worst cell off by %.4f\n", worst);
    assert_true(worst < 0.01);
}

/* ---- layover in a patch ---- */

static struct tiny_map map;
static struct lm_sar sar;
static struct lm_line line;
static struct lm_tone tone;
static int16_t picture[CELLS][LM_CELLS_ROOM];

/* Soil, and in its middle a tower of 80 m. */
static struct tiny_cell tower(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const int is_tower = fabs(p->east_m) < 12 && fabs(p->north_m) < 12;
    return is_tower ? (struct tiny_cell){10, TINY_STRUCTURE, 14}
                    : (struct tiny_cell){-20, TINY_SOIL, 0};
}

static void open_map(void)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 9;
    spec.rows = spec.columns = 6;
    spec.cell = tower;
    tiny_map_open(&map, &spec, 200);
    assert_int_equal(lm_tone_set(&tone, &lm_radar_default.sar.tone), LM_OK);
}

static void draw(const struct lm_sar_command *command, const struct lm_sar_setup *scene)
{
    assert_int_equal(lm_sar_start(&sar, &lm_radar_default, &map.db, command, scene), LM_OK);
    for (uint32_t k = 0; k < sar.lines; k++) {
        lm_sar_prefetch(&sar, &map.tiles, k);
        tiny_map_read_tiles(&map);
    }
    /* Of the lines, which are more than cells, those in the middle. */
    const int beside = ((int)sar.lines - CELLS) / 2;
    for (int k = -beside; k < CELLS + beside; k++) {
        const int16_t *level_q8 = lm_sar_draw_line(&sar, &map.tiles, &tone, &line);
        if (k >= 0 && k < CELLS) {
            memcpy(picture[k], level_q8, sizeof picture[k]);
        }
    }
}

static const struct lm_sar_command from_the_south = {.centre = {FX_BAM_DEG(46), FX_BAM_DEG(11)},
                                                     .cell_mm = 5000,
                                                     .range_m = 9000,
                                                     .height_m_q6 = 3000 * 64};

static uint32_t grain_of(struct lm_sar_command command, uint32_t epoch)
{
    const struct lm_sar_setup scene = {.epoch = epoch, .sea_state = LM_SEA_STATE_OF_IMAGE};
    assert_int_equal(lm_sar_start(&sar, &lm_radar_default, &map.db, &command, &scene), LM_OK);
    return sar.grain.row << 16 | sar.grain.column;
}

TEST(a_patch_has_grain_of_its_own_and_the_same_when_it_is_made_again)
{
    open_map();
    struct lm_sar_command c[5];
    for (int i = 0; i < 5; i++) {
        c[i] = from_the_south;
    }
    c[1].centre.latitude += 1;
    c[2].centre.longitude += 1;
    c[3].look_azimuth += 1;
    c[4].cell_mm += 1;
    const uint32_t grain = grain_of(c[0], 5);
    for (int i = 1; i < 5; i++) {
        assert_int_not_equal(grain_of(c[i], 5), grain);
    }
    assert_int_not_equal(grain_of(c[0], 6), grain);
    assert_int_equal(grain_of(c[0], 5), grain);
    tiny_map_close(&map);
}

/* Middle of what is brighter than soil ever is on the lines of the tower, cells. */
static double middle_of_the_bright(void)
{
    double power = 0, moment = 0;
    for (int k = CELLS / 2 - 3; k < CELLS / 2 + 3; k++) {
        for (int i = 0; i < CELLS; i++) {
            const double p = power_of(picture[k][i]);
            power += p > 3 ? p : 0;
            moment += p > 3 ? p * i : 0;
        }
    }
    return moment / power;
}

TEST(a_tower_in_a_patch_leans_towards_the_radar_when_layover_is_on)
{
    const struct lm_sar_setup scene = {.epoch = 3, .sea_state = LM_SEA_STATE_OF_IMAGE};
    struct lm_sar_command command = from_the_south;
    open_map();
    command.is_plan = true;
    draw(&command, &scene);
    const double upright = middle_of_the_bright();
    command.is_plan = false;
    draw(&command, &scene);
    const double tan_psi = 3000.0 / 9000 - 9000 / (2 * 4.0 / 3 * 6371000);
    print_message("# the tower leans by %.2f cells\n", upright - middle_of_the_bright());
    assert_true(fabs(upright - middle_of_the_bright() - 80 * tan_psi / 5) < 1);
    tiny_map_close(&map);
}

/* Ground that rises by 30 % towards the north; all of it soil. */
static double rising_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 500 + 0.3 * p->north_m;
}

static struct tiny_cell soil(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-20, TINY_SOIL, 0};
}

/* Mean of a range of cells over all lines. */
static double mean_db_of_cells(int first, int end)
{
    double power = 0;
    for (int k = 0; k < CELLS; k++) {
        for (int i = first; i < end; i++) {
            power += power_of(picture[k][i]);
        }
    }
    return 10 * log10(power / CELLS / (end - first));
}

/* The far end is 192 m above the centre and appears 12.5 cells nearer: without overscan there would
 * be a strip of noise. The near end likewise. */
TEST(what_layover_takes_from_the_ends_of_a_patch_is_traced_beyond_them)
{
    struct lm_sar_setup scene = {.epoch = 3, .sea_state = LM_SEA_STATE_OF_IMAGE};
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 9;
    spec.rows = spec.columns = 6;
    spec.cell = soil;
    spec.elevation_m = rising_m;
    tiny_map_open(&map, &spec, 200);
    assert_int_equal(lm_tone_set(&tone, &lm_radar_default.sar.tone), LM_OK);
    (void)lm_sar_relief_of(&map.tiles, &lm_radar_default, &from_the_south);
    tiny_map_read_tiles(&map);
    scene.relief = lm_sar_relief_of(&map.tiles, &lm_radar_default, &from_the_south);
    assert_true(abs(scene.relief.reference_m_q10 - 500 * 1024) < 2 * 1024);
    draw(&from_the_south, &scene);
    print_message("# %u cells traced, %u of them before the patch\n", sar.traced, sar.overscan);
    assert_in_range(sar.overscan, 12, 24);
    assert_in_range(sar.traced - sar.overscan - CELLS, 12, 24);
    const double middle_db = mean_db_of_cells(100, 156);
    print_message("# near end %+.1f dB, far end %+.1f dB\n", mean_db_of_cells(0, 8) - middle_db,
                  mean_db_of_cells(CELLS - 8, CELLS) - middle_db);
    assert_true(fabs(mean_db_of_cells(0, 8) - middle_db) < 2);
    assert_true(fabs(mean_db_of_cells(CELLS - 8, CELLS) - middle_db) < 2);
    struct lm_sar_command plan = from_the_south;
    plan.is_plan = true;
    scene.relief = lm_sar_relief_of(&map.tiles, &lm_radar_default, &plan);
    draw(&plan, &scene);
    assert_int_equal(sar.traced, CELLS);
    tiny_map_close(&map);
}

/* ---- unsteady flight ---- */

TEST(the_blur_is_as_wide_as_the_quadratic_phase_makes_it)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 7);
    for (int i = 0; i < 20000; i++) {
        const double lateral = pow(10, 2 * hs_rng_uniform(&rng)),
                     permille = 1 + hs_rng_below(&rng, 50);
        const double dwell_s = pow(10, 2.7 * hs_rng_uniform(&rng) - 1), wavelength = 0.031228;
        const double f = pi * lateral * permille / 1000 * dwell_s * dwell_s / (2 * wavelength);
        const double q = fmin(sqrt(1 + pow(0.42 * f, 2)), LINES);
        const uint32_t got = lm_defocus_lines_q8(
            (uint32_t)lround(lateral * 1000), (uint32_t)permille, 31228, (uint64_t)(dwell_s * 1e6));
        assert_true(fabs(got / 256.0 - q) < 0.02 * q + 0.01);
    }
    assert_int_equal(lm_defocus_lines_q8(0, 10, 31228, 60000000), 256);
    assert_int_equal(lm_defocus_lines_q8(20000, 0, 31228, 60000000), 256);
    assert_int_equal(lm_defocus_lines_q8(UINT32_MAX >> 8, 1000, 1000, UINT64_MAX), LINES * 256);
}

TEST(the_shares_are_those_of_a_smear_of_that_width_and_add_up_to_one)
{
    for (uint32_t width_q8 = 256; width_q8 <= LINES * 256; width_q8++) {
        uint32_t share_q16[LINES], sum = 0;
        lm_defocus_shares(width_q8, share_q16);
        for (int m = -LM_DEFOCUS_REACH; m <= LM_DEFOCUS_REACH; m++) {
            const double q = width_q8 / 256.0;
            const double overlap = fmin(m + 0.5, q / 2) - fmax(m - 0.5, -q / 2);
            assert_true(fabs(share_q16[m + LM_DEFOCUS_REACH] / 65536.0 - fmax(overlap, 0) / q) <
                        2e-4);
            sum += share_q16[m + LM_DEFOCUS_REACH];
        }
        assert_int_equal(sum, 65536);
    }
}

TEST(smeared_lines_hold_the_mean_power)
{
    struct hs_rng rng;
    static int16_t lines[LINES][CELLS];
    int16_t level_q8[CELLS];
    const int16_t *near_lines[LINES];
    uint32_t share_q16[LINES];
    double worst_db = 0;
    hs_rng_seed(&rng, 8);
    for (int m = 0; m < LINES; m++) {
        near_lines[m] = lines[m];
        for (int i = 0; i < CELLS; i++) {
            lines[m][i] = (int16_t)((int32_t)hs_rng_below(&rng, 110 * 256) - 50 * 256);
        }
    }
    for (uint32_t width_q8 = 300; width_q8 <= LINES * 256; width_q8 += 199) {
        lm_defocus_shares(width_q8, share_q16);
        lm_defocus_run(near_lines, share_q16, level_q8, scratch, CELLS);
        for (int i = 0; i < CELLS; i++) {
            double power = 0;
            for (int m = 0; m < LINES; m++) {
                power += share_q16[m] / 65536.0 * power_of(lines[m][i]);
            }
            worst_db = fmax(worst_db, fabs(level_q8[i] / 256.0 - 10 * log10(power)));
        }
    }
    print_message("# worst cell %.3f dB\n", worst_db);
    assert_true(worst_db < 0.05);
}

/* A bright point in the middle of a line, 30 dB over everything: how many lines is it wide at
 * half its power, and how much power has it? */
static double width_of_point(const struct lm_sar_flight *flight, bool is_steady, double *power)
{
    struct lm_target t =
        point_at(46, 11 + 202.5 / 77470, 0, 70); /* 40.5 lines right of the tower */
    const struct lm_target_set set = {.items = &t, .count = 1};
    const struct lm_sar_setup scene = {
        .flight = flight, .targets = &set, .epoch = 3, .sea_state = LM_SEA_STATE_OF_IMAGE};
    struct lm_sar_command command = from_the_south;
    command.is_steady = is_steady;
    draw(&command, &scene);
    double across[CELLS] = {0}, most = 0, wide = 0;
    *power = 0;
    for (int k = 0; k < CELLS; k++) {
        for (int i = 0; i < CELLS; i++) {
            across[k] += power_of(picture[k][i]);
        }
        most = fmax(most, across[k]);
        *power += across[k];
    }
    for (int k = 1; k < CELLS; k++) { /* where the half is crossed, between lines */
        const double before = across[k - 1] / most - 0.5, here = across[k] / most - 0.5;
        if (before * here < 0) {
            wide += (k - 1 - before / (here - before)) * (here < 0 ? 1 : -1);
        }
    }
    return wide;
}

TEST(a_point_in_a_turn_is_q_lines_wide_and_keeps_its_power)
{
    open_map();
    const struct lm_sar_flight straight = {
        .speed_mm_s = 100000, .track = FX_BAM_DEG(45), .heading = FX_BAM_DEG(45)};
    double sharp_power, power;
    const double sharp = width_of_point(&straight, false, &sharp_power);
    const double dwell_s = 0.031228 * hypot(9000, 3000) / (2 * 100 * 5 * sin(pi / 4));
    for (double q = 3; q <= 8; q += 1.25) {
        struct lm_sar_flight turning = straight;
        const double f = sqrt(q * q - 1) / 0.42;
        const double residual = f * 2 * 0.031228 / (pi * dwell_s * dwell_s);
        turning.lateral_mm_s2 = (uint32_t)lround(residual * 1000 * 1000 /
                                                 lm_radar_default.sar.mocomp_residual_permille);
        const double width = width_of_point(&turning, false, &power);
        print_message("# q = %.2f: %.2f lines wide, power %+.2f dB\n", q, width,
                      10 * log10(power / sharp_power));
        assert_true(fabs(width - q) < 0.3);
        assert_true(fabs(10 * log10(power / sharp_power)) < 0.1);
        assert_true(width_of_point(&turning, true, &power) == sharp); /* switched off */
    }
    assert_true(sharp < 2);
    tiny_map_close(&map);
}

/* ---- in flight ---- */

TEST(a_turning_aircraft_blurs_its_patch_and_a_commanded_place_does_not)
{
    for (int is_turning = 0; is_turning < 2; is_turning++) {
        struct rig *r = start_rig();
        r->bus.turn_deg_s = is_turning ? 6 : 0;
        run(r, 1);
        struct lm_control control = patch_here;
        control.sar.cell_mm = 1000;
        command(r, control);
        run(r, 0.1);
        assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
        const double lateral = 6 * pi / 180 * 150;
        const double dwell_s =
            (double)(r->unit.picture.sar.line_us * r->unit.picture.sar.lines) / 1e6;
        const double f = pi * lateral * 0.01 * dwell_s * dwell_s / (2 * 0.031228);
        const double q = fmin(sqrt(1 + pow(0.42 * f, 2)), LINES);
        const double width = r->unit.picture.sar.defocus_lines_q8 / 256.0;
        assert_true(is_turning ? q > 1.3 && fabs(width - q) < 0.03 * q : width == 1);
        control.sar.is_from_ownship = false;
        control.sar.range_m = 20000;
        control.sar.height_m_q6 = 2000 * 64;
        command(r, control);
        run(r, 0.1);
        assert_int_equal(r->unit.picture.sar.defocus_lines_q8, 256);
        free_rig(r);
    }
}

/* ---- jammers ---- */

static struct lm_position place_from(struct lm_position from, double azimuth_deg, double metres)
{
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, from);
    return lm_geo_direct(&origin, hs_bam(azimuth_deg), (uint32_t)lround(metres * 256));
}

/* EQUATIONS.md, "Noise": on the axis at ten nautical miles it is what it is said to be; it falls
 * with the square of the distance and by the one-way pattern off the axis, and adds to the noise.
 */
TEST(a_jammer_raises_the_noise_of_a_patch_by_its_distance_and_bearing)
{
    const struct {
        double ratio_db, distance_m, off_deg;
    } cases[] = {{20, 18520, 0}, {20, 37040, 0},  {20, 18520, 1.65},
                 {30, 9000, -3}, {-10, 50000, 0}, {60, 60000, 20}};
    struct rig *r = start_rig();
    const struct lm_radar *radar = &lm_radar_default;
    struct lm_sar_command command = patch_here.sar;
    command.is_from_ownship = false;
    command.look_azimuth = hs_bam(30);
    command.range_m = 12000;
    command.height_m_q6 = 2000 * 64;
    const struct lm_position antenna = place_from(command.centre, 210, 12000);
    uint32_t distance_q8;
    fx_bam_t bearing;
    lm_geo_inverse(antenna, command.centre, &distance_q8, &bearing);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct lm_environment e = {
            .jammer = {{place_from(antenna, hs_degrees(bearing) + cases[i].off_deg,
                                   cases[i].distance_m),
                        (int16_t)(cases[i].ratio_db * 256)}},
            .jammer_count = 1};
        const struct lm_sar_setup scene = {.environment = &e};
        assert_int_equal(
            lm_sar_start(&r->unit.picture.sar, radar, &r->unit.map.db, &command, &scene), LM_OK);
        const double beams = cases[i].off_deg / hs_degrees(radar->antenna.azimuth_beam);
        const double jam_db = cases[i].ratio_db - 20 * log10(cases[i].distance_m / 18520) -
                              40 * log10(2) * beams * beams;
        const double rise_db =
            (r->unit.picture.sar.floor_db_q8 - radar->sar.noise_floor_db_q8) / 256.0;
        assert_true(fabs(rise_db - 10 * log10(1 + pow(10, jam_db / 10))) < 0.1);
    }
    const struct lm_sar_setup fair = {.environment = NULL};
    assert_int_equal(lm_sar_start(&r->unit.picture.sar, radar, &r->unit.map.db, &command, &fair),
                     LM_OK);
    assert_int_equal(r->unit.picture.sar.floor_db_q8, radar->sar.noise_floor_db_q8);
    free_rig(r);
}

/* Seen through the unit: what was dark is as bright as the noise. */
TEST(a_jammed_patch_has_no_dark_left)
{
    uint32_t lit[2], pixels = 0;
    for (int is_jammed = 0; is_jammed < 2; is_jammed++) {
        struct rig *r = start_rig();
        struct lm_control jam = {.kind = LM_CONTROL_ENVIRONMENT};
        jam.environment.sea_state = LM_SEA_STATE_OF_IMAGE;
        jam.environment.jammer_count = (uint8_t)is_jammed;
        jam.environment.jammer[0] = (struct lm_jammer){patch_here.sar.centre, 30 * 256};
        command(r, jam);
        command(r, patch_here);
        run(r, 4);
        assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
        lit[is_jammed] = lit_pixels(r);
        const struct lm_frame square = lm_patch_square(&r->unit.picture.frame);
        pixels = (uint32_t)square.width_px * square.height_px;
        free_rig(r);
    }
    print_message("# lit pixels: %u, jammed %u of %u\n", lit[0], lit[1], pixels);
    assert_true(lit[1] * 1000ull > pixels * 999ull && lit[0] * 100 < pixels * 98);
}

TEST(cells_before_the_first_one_that_is_shown_are_in_shadow)
{
    int16_t level_q8[LM_CELLS_ROOM];
    struct lm_layover layover;
    struct lm_layover_view view = lean;
    view.first = 7;
    flat_ground(100);
    for (int i = 0; i < CELLS; i++) {
        level_q8[i] = 5 * 256;
    }
    lm_layover_set(&layover, tiny_classes(), &view);
    const int16_t *shown_q8 = lm_layover_run(&layover, &ground, level_q8, laid_q8);
    for (int i = 0; i < 20; i++) {
        assert_true(i < 7 ? shown_q8[i] == LM_LEVEL_SHADOW : shown_q8[i] > 0);
    }
}
