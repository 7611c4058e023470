/* What a sweep shows of points, movers, noise and sea: how sharp it is where, and what GMT and SEA
 * make of it. Measured on the lines behind the receiver, before the tone. */
#include "check.h"
#include "reference/reference.h"
#include "sector_world.h"
#include "target_support.h"

#include "hs/angle.h"
#include "scales.h"

#include <math.h>

enum { POINTS_MAX = LM_TARGET_CANDIDATES_MAX, LINES_MAX = LM_SECTOR_LINES_MAX };

static struct tiny_cell sea(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    (void)p;
    return (struct tiny_cell){-40, TINY_WATER, 0};
}

/* Flat country of 65 km, 2,000 m below a radar that flies north with its nose to the north. */
static struct sector_world *make_flat(bool is_sea)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = is_sea ? sea : spec.cell;
    spec.shift0 = 13;
    spec.rows = spec.columns = 14;
    struct sector_world *w = make_sector_world(&spec);
    w->radar.fov[LM_FOV_DBS1].beam_step = w->radar.fov[LM_FOV_DBS2].beam_step = 0;
    w->platform = (struct lm_platform){
        .position = {w->map.db.centre_latitude - FX_BAM_DEG(1) / 4, w->map.db.centre_longitude},
        .height_m_q10 = 2000 * 1024};
    return w;
}

struct points {
    struct lm_target items[POINTS_MAX];
    double azimuth_deg[POINTS_MAX];
    uint32_t count;
};

/* A steady point; returns it, for what else it is to be. */
static struct lm_target *add_point(struct points *p, const struct sector_world *w,
                                   double azimuth_deg, double ground_m, double rcs_db)
{
    const struct lm_position at = place_at(w, azimuth_deg, ground_m);
    assert_true(p->count < POINTS_MAX);
    p->azimuth_deg[p->count] = azimuth_deg;
    p->items[p->count] = point_at(hs_degrees(at.latitude), hs_degrees(at.longitude), 10, rcs_db);
    return &p->items[p->count++];
}

static struct lm_target_set set_of(const struct points *p)
{
    return (struct lm_target_set){.items = p->items, .count = p->count};
}

/* The largest level of the line drawn last within two bins of a ground range. */
static double level_near(const struct sector_world *w, double ground_m)
{
    const struct lm_sector *s = &w->sector;
    const double slant_m = hypot(ground_m, w->platform.height_m_q10 / 1024.0);
    const int32_t bin =
        (int32_t)lround((slant_m - s->slant.first_m_q8 / 256.0) * 256 / s->slant.cell_m_q8);
    int32_t level_q8 = INT32_MIN;
    assert_true(bin >= 2 && bin + 2 < (int32_t)s->slant.cells);
    for (int32_t i = bin - 2; i <= bin + 2; i++) {
        level_q8 = s->level_db_q8[i] > level_q8 ? s->level_db_q8[i] : level_q8;
    }
    return level_q8 / 256.0;
}

static struct ref_dbs dbs_of(const struct sector_world *w, double rate_deg_s)
{
    return (struct ref_dbs){.speed_m_s = w->platform.speed_mm_s / 1000.0,
                            .beam_deg = hs_degrees(w->radar.antenna.azimuth_beam),
                            .wavelength_m = w->radar.wavelength_um * 1e-6,
                            .rate_deg_s = rate_deg_s};
}

/* ---- how sharp ---- */

/* -3 dB width of what is drawn around an azimuth: half power at both ends of a parabola through
 * the brightest line and one to either side of it, about half as far away as it should be wide. */
static double width_at(const struct sector_world *w, const double *level_db, uint32_t lines,
                       double azimuth_deg, double wanted_deg)
{
    const double line_deg = hs_degrees(w->sector.width);
    const double half_deg = fmin(wanted_deg, 0.3);
    const uint32_t apart = (uint32_t)fmax(1, floor(wanted_deg / 2 / line_deg));
    uint32_t best = apart;
    for (uint32_t k = apart; k + apart < lines; k++) {
        const bool is_of_point = fabs(line_azimuth_deg(&w->sector, k) - azimuth_deg) < half_deg;
        best = is_of_point && level_db[k] > level_db[best] ? k : best;
    }
    assert_true(level_db[best] > -15 && level_db[best] < 20); /* of the point, and not saturated */
    const double fall_db = level_db[best - apart] - 2 * level_db[best] + level_db[best + apart];
    const double step_deg = apart * line_deg;
    return 2 * step_deg * sqrt(10 * log10(2) * 2 / -fall_db);
}

/* A point between two samples is made of two beams side by side, by theory up to 13 % less curved
 * at its top than one. */
static void judge_width(enum lm_fov field, double azimuth_deg, double rcs_db, double spacing_deg,
                        uint32_t points, uint32_t speed_m_s, double ratio)
{
    const double ground_m = 15000;
    struct sector_world *w = make_flat(true);
    struct points p = {.count = 0};
    w->platform.speed_mm_s = speed_m_s * 1000;
    for (uint32_t i = 0; i < points; i++) {
        add_point(&p, w, azimuth_deg + (i - (points - 1) / 2.0) * spacing_deg, ground_m, rcs_db);
    }
    const struct lm_target_set set = set_of(&p);
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM,
                                              .range_index = scale_of(10),
                                              .fov = (uint8_t)field,
                                              .centre = place_at(w, azimuth_deg, ground_m)};
    start_sector(w, &command, NULL, &set);
    static double level_db[LINES_MAX];
    do {
        const uint32_t line = draw_line(w);
        assert_true(line < LINES_MAX);
        level_db[line] = level_near(w, ground_m);
    } while (!lm_sector_is_at_edge(&w->sector));
    const double wanted_deg = hs_degrees(w->radar.antenna.azimuth_beam) / (sqrt(2) * ratio);
    for (uint32_t i = 0; i < p.count; i++) {
        const double width_deg =
            width_at(w, level_db, w->sector.lines, p.azimuth_deg[i], wanted_deg);
        const bool is_right = width_deg > 0.95 * wanted_deg && width_deg < 1.15 * wanted_deg;
        if (i == 0 || !is_right) {
            print_message("# field %d, %.2f degrees off: %.4f degrees wide, wanted %.4f\n", field,
                          p.azimuth_deg[i], width_deg, wanted_deg);
        }
        assert_true(is_right);
    }
    free_sector_world(w);
}

TEST(a_point_is_as_wide_as_the_sharpened_beam_and_as_the_real_one_in_the_notch)
{
    judge_width(LM_FOV_DBS1, 45, 20, 0.71, 16, 180, 8);
    judge_width(LM_FOV_DBS1, -30, 20, 0.71, 16, 180, 8);
    judge_width(LM_FOV_DBS2, 45, 10, 0.31, 16, 180, 64);
    /* On a sampled azimuth: half a sample right of the nose. */
    judge_width(LM_FOV_DBS1, 0.46875, 30, 0, 1, 30, 1);
    judge_width(LM_FOV_DBS2, 0.46875, 30, 0, 1, 8, 1);
}

/* ---- where ---- */

enum { SWEEPS_OF_OFFSETS = 4 };

/* Powers of the line drawn last, added up over the bins about a ground range. */
static double power_near(const struct sector_world *w, double ground_m)
{
    const struct lm_slant *slant = &w->sector.slant;
    const double slant_m = hypot(ground_m, w->platform.height_m_q10 / 1024.0);
    const int32_t bin = (int32_t)lround((slant_m * 256 - slant->first_m_q8) / slant->cell_m_q8);
    double power = 0;
    for (int32_t i = bin - 8; i <= bin + 8; i++) {
        power += pow(10, w->sector.level_db_q8[i] / 2560.0);
    }
    return power;
}

static void take_powers(struct sector_world *w, const struct lm_sector_command *command,
                        const struct lm_target_set *set, double ground_m, double power[LINES_MAX])
{
    start_sector(w, command, NULL, set);
    do {
        const uint32_t line = draw_line(w);
        assert_true(line < LINES_MAX);
        power[line] = power_near(w, ground_m);
    } while (!lm_sector_is_at_edge(&w->sector));
}

struct spread {
    enum lm_fov field;
    double azimuth_deg, ratio; /* of the middle; how much sharper than the beam */
    double spacing_deg, rcs_db;
    uint32_t points;
    double ground_m;
};

/* Middle and sum of the power that one point adds to a sweep, by lines within half the points'
 * spacing. */
static void measure_point(const struct sector_world *w, const double *with, const double *without,
                          double azimuth_deg, double spacing_deg, double *middle_deg, double *sum)
{
    double moment = 0;
    *sum = 0;
    for (uint32_t k = 0; k < w->sector.lines; k++) {
        const double line_deg = line_azimuth_deg(&w->sector, k);
        if (fabs(line_deg + hs_degrees(w->sector.up) - azimuth_deg) < spacing_deg / 2) {
            *sum += with[k] - without[k];
            moment += (with[k] - without[k]) * (line_deg + hs_degrees(w->sector.up));
        }
    }
    *middle_deg = moment / *sum;
    *sum *= hs_degrees(w->sector.width);
}

/* The points of one sweep, each a little farther from the sampled azimuths than the one before;
 * `shift_deg` moves all of them. Sweeps with and without them have the same speckle and noise. */
static void judge_places(struct sector_world *w, const struct spread *s, double shift_deg,
                         double *worst_beams, double *least, double *most)
{
    const double ground_m = s->ground_m;
    static double with[LINES_MAX], without[LINES_MAX];
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM,
                                              .range_index = scale_of(10),
                                              .fov = (uint8_t)s->field,
                                              .centre = place_at(w, s->azimuth_deg, ground_m)};
    struct points p = {.count = 0};
    for (uint32_t i = 0; i < s->points; i++) {
        add_point(&p, w, s->azimuth_deg + (i - (s->points - 1) / 2.0) * s->spacing_deg + shift_deg,
                  ground_m, s->rcs_db);
    }
    const struct lm_target_set set = set_of(&p);
    take_powers(w, &command, &set, ground_m, with);
    take_powers(w, &command, NULL, ground_m, without);
    const double beam_deg = hs_degrees(w->radar.antenna.azimuth_beam) / (sqrt(2) * s->ratio);
    for (uint32_t i = 0; i < p.count; i++) {
        double middle_deg, sum;
        measure_point(w, with, without, p.azimuth_deg[i], s->spacing_deg, &middle_deg, &sum);
        *worst_beams = fmax(*worst_beams, fabs(middle_deg - p.azimuth_deg[i]) / beam_deg);
        *least = fmin(*least, sum), *most = fmax(*most, sum);
    }
}

/* Theory: the beam's mean of a point stands where it does, and the power that it spreads over the
 * lines is that of the point, wherever it is between the azimuths that are sampled. */
TEST(a_point_stands_where_it_is_between_any_two_samples)
{
    const struct spread cases[] = {
        {LM_FOV_NORM, 0, 1, 10.17, 40, 10, 16000}, {LM_FOV_EXP, 30, 1, 8, 32, 1, 16000},
        {LM_FOV_DBS1, 45, 8, 1.53, 25, 9, 16000},  {LM_FOV_DBS2, 45, 64, 0.31, 12, 12, 16000},
        {LM_FOV_DBS2, 45, 64, 0.57, 8, 12, 9000},  {LM_FOV_DBS2, 45, 64, 0.57, 6, 12, 6000}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct sector_world *w = make_flat(true);
        const double sample_deg = hs_degrees(w->radar.sample) / cases[i].ratio;
        double worst_beams = 0, least = INFINITY, most = 0;
        w->platform.speed_mm_s = 180000;
        for (int k = 0; k < SWEEPS_OF_OFFSETS; k++) {
            judge_places(w, &cases[i], sample_deg * k / SWEEPS_OF_OFFSETS, &worst_beams, &least,
                         &most);
        }
        const double spread_db = 10 * log10(most / least);
        print_message("# field %d, %.0f m: at most %.4f of the beam aside, powers within %.3f dB\n",
                      cases[i].field, cases[i].ground_m, worst_beams, spread_db);
        assert_true(worst_beams < 0.02);
        assert_true(spread_db < 0.2);
        free_sector_world(w);
    }
}

/* ---- the notch ---- */

/* Sharpening ratio of the line drawn last, from the weights of its samples: their deviation in
 * samples is that of the two-way beam, B / (N sqrt 2) wide at half power. */
static double ratio_of_line(const struct sector_world *w, uint32_t line)
{
    const struct lm_sector *s = &w->sector;
    const struct lm_beam_taps *taps = &s->taps[line % 2].taps;
    double sum = 0, first = 0, second = 0;
    for (int j = 0; j < LM_BEAM_TAPS; j++) {
        sum += taps->weight_q16[j];
        first += j * (double)taps->weight_q16[j];
        second += j * j * (double)taps->weight_q16[j];
    }
    const double deviation = sqrt(second / sum - first * first / (sum * sum));
    const double width_bam = deviation * 2 * sqrt(2 * log(2)) * lm_beam_spacing(&s->beam, s->radar);
    return w->radar.antenna.azimuth_beam / sqrt(2) / width_bam;
}

/* The ratios of a sweep straight ahead, by line. Ends of the beam that eight samples do not hold
 * make it up to 6 % sharper. */
static uint32_t take_ratios(struct sector_world *w, enum lm_fov field, double ratio[LINES_MAX])
{
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM,
                                              .range_index = scale_of(10),
                                              .fov = (uint8_t)field,
                                              .centre = place_at(w, 0, 9260)};
    start_sector(w, &command, NULL, NULL);
    do {
        const uint32_t line = draw_line(w);
        ratio[line] = ratio_of_line(w, line);
    } while (!lm_sector_is_at_edge(&w->sector));
    return w->sector.lines;
}

/* Angle off the velocity within which lines are less sharp than wanted. */
static double notch_deg(const struct sector_world *w, const double *ratio, double wanted,
                        bool is_right)
{
    double deg = 0;
    for (uint32_t k = 0; k < w->sector.lines; k++) {
        const double off_deg = line_azimuth_deg(&w->sector, k);
        deg +=
            (off_deg > 0) == is_right && ratio[k] < 0.97 * wanted ? hs_degrees(w->sector.width) : 0;
    }
    return deg;
}

TEST(sharpening_runs_out_where_the_formula_says_and_without_a_step)
{
    const struct {
        enum lm_fov field;
        double rate_deg_s;
        uint32_t speed_m_s;
    } cases[] = {{LM_FOV_DBS1, 15, 60},  {LM_FOV_DBS1, 15, 100}, {LM_FOV_DBS1, 15, 200},
                 {LM_FOV_DBS1, 15, 350}, {LM_FOV_DBS2, 3, 200},  {LM_FOV_DBS2, 3, 250},
                 {LM_FOV_DBS2, 3, 350}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct sector_world *w = make_flat(true);
        static double ratio[LINES_MAX];
        const double wanted = w->radar.fov[cases[i].field].sharpening;
        double worst_step = 0, least = wanted;
        w->platform.speed_mm_s = cases[i].speed_m_s * 1000;
        const uint32_t lines = take_ratios(w, cases[i].field, ratio);
        for (uint32_t k = 0; k < lines; k++) {
            worst_step = fmax(worst_step, k > 0 ? fabs(log(ratio[k] / ratio[k - 1])) : 0);
            least = fmin(least, ratio[k]);
        }
        const struct ref_dbs dbs = dbs_of(w, cases[i].rate_deg_s);
        const double wanted_deg = ref_dbs_notch_deg(&dbs, wanted);
        const double left_deg = notch_deg(w, ratio, wanted, false),
                     right_deg = notch_deg(w, ratio, wanted, true);
        print_message(
            "# field %d at %u m/s: below %.0f:1 to %.2f and %.2f degrees, wanted %.2f; "
            "%.2f:1 ahead; steps of at most %.3f\n",
            cases[i].field, cases[i].speed_m_s, wanted, left_deg, right_deg, wanted_deg, least,
            exp(worst_step) - 1);
        assert_true(fabs(left_deg - wanted_deg) < 0.5);
        assert_true(fabs(right_deg - wanted_deg) < 0.5);
        assert_true(least < 3);
        assert_true(exp(worst_step) - 1 < 0.2); /* a tenth, and what the samples make of it */
        free_sector_world(w);
    }
}

/* Lines that look between two beam positions, 2/5 of a beam apart, are weaker than those that look
 * along one by its pattern: 0.96 dB. */
TEST(a_sharpened_sea_is_scalloped_between_beam_positions)
{
    struct sector_world *w = make_flat(true);
    const double ground_m = 9260, beam_deg = hs_degrees(w->radar.antenna.azimuth_beam);
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM,
                                              .range_index = scale_of(10),
                                              .fov = LM_FOV_DBS1,
                                              .centre = place_at(w, 40, ground_m)};
    double sum[2] = {0}, count[2] = {0};
    w->radar.fov[LM_FOV_DBS1].beam_step = lm_radar_default.fov[LM_FOV_DBS1].beam_step;
    const double step_deg = hs_degrees(w->radar.fov[LM_FOV_DBS1].beam_step);
    w->platform.speed_mm_s = 200000;
    start_sector(w, &command, NULL, NULL);
    for (int sweep = 0; sweep < 4; sweep++) {
        do {
            const uint32_t line = draw_line(w);
            const double off_deg = fabs(remainder(line_azimuth_deg(&w->sector, line), step_deg));
            const int is_between = off_deg > 0.4 * step_deg;
            if (is_between || off_deg < 0.1 * step_deg) {
                sum[is_between] += power_near(w, ground_m);
                count[is_between]++;
            }
        } while (!lm_sector_is_at_edge(&w->sector));
    }
    const double depth_db = 10 * log10(sum[0] / count[0] / (sum[1] / count[1]));
    /* Means of x^2 over the two parts of half a step: 0.2033 and 0.0033 of its square. */
    const double wanted_db =
        80 * log10(2) * 0.2 * step_deg * step_deg / (beam_deg * beam_deg) * (1 - 1 / 64.0);
    print_message("# scalloping of %.2f dB, wanted %.2f\n", depth_db, wanted_db);
    assert_true(fabs(depth_db - wanted_db) < 0.25);
    free_sector_world(w);
}

/* ---- speckle ---- */

enum { FIRST_BIN = 60, END_BIN = 240, SECTOR_LINES = 256 };

/* Levels of a sweep by line and bin, less each bin's mean over the lines. */
static void take_sweep(struct sector_world *w, double level_db[SECTOR_LINES][END_BIN])
{
    do {
        const uint32_t line = draw_line(w);
        for (int i = FIRST_BIN; i < END_BIN; i++) {
            level_db[line][i] = w->sector.level_db_q8[i] / 256.0;
        }
    } while (!lm_sector_is_at_edge(&w->sector));
    for (int i = FIRST_BIN; i < END_BIN; i++) {
        double sum = 0;
        for (int line = 0; line < SECTOR_LINES; line++) {
            sum += level_db[line][i];
        }
        for (int line = 0; line < SECTOR_LINES; line++) {
            level_db[line][i] -= sum / SECTOR_LINES;
        }
    }
}

static double correlation(double a[SECTOR_LINES][END_BIN], double b[SECTOR_LINES][END_BIN])
{
    double aa = 0, bb = 0, ab = 0;
    for (int line = 0; line < SECTOR_LINES; line++) {
        for (int i = FIRST_BIN; i < END_BIN; i++) {
            aa += a[line][i] * a[line][i];
            bb += b[line][i] * b[line][i];
            ab += a[line][i] * b[line][i];
        }
    }
    assert_true(aa > 0.1 * SECTOR_LINES * (END_BIN - FIRST_BIN)); /* there is speckle at all */
    return ab / sqrt(aa * bb);
}

TEST(speckle_is_another_one_in_each_sweep_of_real_beam)
{
    static double first[SECTOR_LINES][END_BIN], second[SECTOR_LINES][END_BIN];
    struct sector_world *w = make_flat(false);
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM, .range_index = scale_of(10)};
    start_sector(w, &command, NULL, NULL);
    take_sweep(w, first);
    assert_int_equal(w->sector.lines, SECTOR_LINES);
    take_sweep(w, second);
    const double r = correlation(first, second);
    print_message("# correlation %.4f\n", r);
    assert_true(fabs(r) < 0.1);
    free_sector_world(w);
}

/* ---- movers and the sea ---- */

static void set_in_motion(struct lm_target *t, double heading_deg, uint32_t speed_mm_s)
{
    t->heading = hs_bam(heading_deg);
    t->speed_mm_s = speed_mm_s;
    t->leg_m = speed_mm_s ? 10000 : 0;
    seal_target(t);
}

/* The largest level about a point in the four bars of GMT. */
static double brightest_of_bars(struct sector_world *w, double azimuth_deg, double ground_m)
{
    double level_db = -INFINITY;
    for (int bar = 0; bar < 4; bar++) {
        do {
            const uint32_t line = draw_line(w);
            if (fabs(line_azimuth_deg(&w->sector, line) - azimuth_deg) < 1) {
                level_db = fmax(level_db, level_near(w, ground_m));
            }
        } while (!lm_sector_is_at_edge(&w->sector));
    }
    return level_db;
}

/* The table's gates are 3 and 100 knots: 1.543 and 51.44 m/s. */
TEST(gmt_shows_what_moves_within_its_gates_and_nothing_else)
{
    const struct {
        double azimuth_deg;
        bool is_closing;
        uint32_t speed_mm_s;
        bool is_shown;
    } cases[] = {{-40, true, 10000, true},  {-30, false, 10000, true}, {-20, true, 1400, false},
                 {-10, true, 1700, true},   {0, true, 50000, true},    {10, true, 53000, false},
                 {20, false, 53000, false}, {30, true, 0, false}};
    const uint32_t count = sizeof cases / sizeof *cases;
    struct sector_world *w = make_flat(false);
    struct points p = {.count = 0};
    for (uint32_t i = 0; i < count; i++) {
        struct lm_target *t = add_point(&p, w, cases[i].azimuth_deg, 9000 + 700.0 * i, 40);
        set_in_motion(t, cases[i].azimuth_deg + (cases[i].is_closing ? 180 : 0),
                      cases[i].speed_mm_s);
    }
    const struct lm_target_set set = set_of(&p);
    const struct lm_sector_command command = {.mode = LM_SECTOR_GMT, .range_index = scale_of(10)};
    start_sector(w, &command, NULL, &set);
    for (uint32_t i = 0; i < count; i++) {
        const double level_db = brightest_of_bars(w, cases[i].azimuth_deg, 9000 + 700.0 * i);
        print_message("# %u mm/s: %.1f dB\n", cases[i].speed_mm_s, level_db);
        assert_true(cases[i].is_shown ? level_db > -5 : level_db < -30);
    }
    free_sector_world(w);
}

/* At 180 m/s the beam of 3.3 degrees sees the ground 8.7 knots to either side of its own speed 60
 * degrees off the track, and 0.9 knot 10 degrees off it. */
TEST(a_mover_of_5_knots_is_seen_ahead_and_lost_in_the_clutter_aside)
{
    const double azimuths_deg[] = {-58, -40, -10, 0, 10, 40, 58};
    const uint32_t count = sizeof azimuths_deg / sizeof *azimuths_deg;
    struct sector_world *w = make_flat(false);
    struct points p = {.count = 0};
    w->platform.speed_mm_s = 180000;
    for (uint32_t i = 0; i < count; i++) {
        struct lm_target *t = add_point(&p, w, azimuths_deg[i], 12000, 40);
        set_in_motion(t, azimuths_deg[i] + 180, 2572);
    }
    const struct lm_target_set set = set_of(&p);
    const struct lm_sector_command command = {.mode = LM_SECTOR_GMT, .range_index = scale_of(10)};
    start_sector(w, &command, NULL, &set);
    for (uint32_t i = 0; i < count; i++) {
        const double level_db = brightest_of_bars(w, azimuths_deg[i], 12000);
        print_message("# %.0f degrees off: %.1f dB\n", azimuths_deg[i], level_db);
        assert_true(fabs(azimuths_deg[i]) <= 10 ? level_db > -5 : level_db < -30);
    }
    free_sector_world(w);
}

/* Mean power of the sea between 3 and 5 km, dB. */
static double mean_sea_db(struct sector_world *w)
{
    double sum = 0, count = 0;
    do {
        draw_line(w);
        for (uint32_t i = 0; i < w->sector.slant.cells; i++) {
            const double slant_m =
                (w->sector.slant.first_m_q8 + i * w->sector.slant.cell_m_q8) / 256.0;
            if (slant_m > 3000 && slant_m < 5000) {
                sum += pow(10, w->sector.level_db_q8[i] / 2560.0);
                count++;
            }
        }
    } while (!lm_sector_is_at_edge(&w->sector));
    return 10 * log10(sum / count);
}

TEST(the_sea_brightens_by_5_dB_a_state)
{
    const struct lm_sector_command command = {
        .mode = LM_SECTOR_SEA, .range_index = scale_of(10), .azimuth_index = 1};
    struct sector_world *w = make_flat(true);
    double before_db = 0;
    for (uint8_t sea_state = 1; sea_state <= LM_SEA_STATE_MAX; sea_state++) {
        const struct lm_environment e = {.sea_state = sea_state};
        start_sector(w, &command, &e, NULL);
        const double level_db = mean_sea_db(w);
        print_message("# state %u: %.2f dB\n", sea_state, level_db);
        if (sea_state > 1) {
            assert_true(fabs(level_db - before_db - 5) < 0.5);
        }
        before_db = level_db;
    }
    free_sector_world(w);
}
