/* A whole sector of the reference over a plain with one bright cell: where it is shown and how
 * wide, in real beam and sharpened, in fair weather and foul. */
#include "check.h"
#include "reference/reference.h"
#include "tiny_image.h"

#include <math.h>
#include <stdlib.h>

static const double rad = 0.017453292519943295, height_m = 3000, beacon_m = 9000;

enum { CELLS = 256 };

struct world {
    struct ref_db db;
    struct ref_params params;
    double noise_table_db[REF_SPECKLE_SLICES];
};

/* Soil of -20 dB, and 40 dB in two cells side by side at 9 km due north. */
static struct tiny_cell plain(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const bool is_beacon = fabs(p->east_m) < 38 && fabs(p->north_m - beacon_m) < 40;
    return (struct tiny_cell){is_beacon ? 40 : -20, TINY_SOIL, 0};
}

static int open_world(void **state)
{
    struct world *w = calloc(1, sizeof *w);
    struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_image image;
    spec.shift0 = 12; /* cells of 38 m */
    spec.rows = spec.columns = 16;
    spec.cell = plain;
    if (w == NULL || tiny_image_build(&image, &spec) != 0 ||
        ref_db_open_memory(&w->db, image.bytes, image.size, "plain") != 0) {
        return -1;
    }
    tiny_image_free(&image);
    w->params = ref_params_default();
    w->params.looks = 1;
    ref_speckle_table(16, w->noise_table_db);
    *state = w;
    return 0;
}

static int close_world(void **state)
{
    struct world *w = *state;
    ref_db_close(&w->db);
    free(w);
    return 0;
}

/* Ten nautical miles seen from 3,000 m, `half_deg` to either side of about north. */
static struct ref_sector sector_of(const struct world *w, double half_deg)
{
    return (struct ref_sector){
        .ground = {.antenna = {46, 11},
                   .antenna_m = height_m,
                   .cell_m = 18520.0 / CELLS,
                   .centre_azimuth_deg = 60.0 / 128, /* sample -1 looks north */
                   .half_angle_deg = half_deg,
                   .cell_count = CELLS,
                   .line_count = 128},
        .beam_deg = 3.3,
        .sample_deg = 120.0 / 128,
        .sharpening = 1,
        .dbs = {250, 3.3, 0.0313, 15},
        .antenna = {4.6, 60, 2.2},
        .tilt_deg = ref_auto_tilt_deg(height_m, 18520),
        .receiver = {.noise = {-50, 18520, height_m, 400e-9},
                     .noise_table_db = w->noise_table_db,
                     .stc_m = 20000,
                     .pulse_s = 400e-9}};
}

static struct ref_picture sweep(const struct world *w, const struct ref_sector *sector)
{
    struct ref_picture picture;
    assert_int_equal(ref_sector_sweep(&picture, &w->db, sector, &w->params), 0);
    return picture;
}

static double power_at(const struct ref_picture *p, unsigned line, unsigned bin)
{
    return pow(10, ref_picture_bin(p, line, (int)bin)->echo_db / 10);
}

static unsigned beacon_bin(void)
{
    return (unsigned)(hypot(beacon_m, height_m) / (18520.0 / CELLS));
}

/* Power, and its first and second moment over the azimuth in degrees. */
struct moments {
    double sum, first, second;
};

static double beacon_power(const struct ref_picture *p, unsigned line)
{
    double power = 0;
    for (unsigned bin = beacon_bin() - 1; bin <= beacon_bin() + 1; bin++) {
        power += power_at(p, line, bin);
    }
    return power;
}

/* Lines 30 dB below the strongest show the ground and noise around the beacon: they are far out,
 * and would weigh in the second moment. */
static void add_beacon(struct moments *m, const struct ref_picture *p, const struct ref_sector *s)
{
    double most = 0;
    for (unsigned line = 0; line < p->line_count; line++) {
        most = fmax(most, beacon_power(p, line));
    }
    for (unsigned line = 0; line < p->line_count; line++) {
        const double power = beacon_power(p, line) > most / 1000 ? beacon_power(p, line) : 0;
        const double a = ref_gm_azimuth_deg(&s->ground, line);
        m->sum += power;
        m->first += power * a;
        m->second += power * a * a;
    }
}

/* Mean azimuth of the beacon's power and its deviation, degrees. Two or three samples meet it, and
 * speckle draws the power of each: LOOKS sweeps are added. */
static void spread_of(const struct world *w, const struct ref_sector *s, double *middle_deg,
                      double *deviation_deg)
{
    enum { LOOKS = 16 };
    struct moments m = {0};
    struct ref_sector look = *s;
    for (look.ground.epoch = 0; look.ground.epoch < LOOKS; look.ground.epoch++) {
        struct ref_picture p = sweep(w, &look);
        add_beacon(&m, &p, &look);
        ref_picture_free(&p);
    }
    *middle_deg = m.first / m.sum;
    *deviation_deg = sqrt(m.second / m.sum - *middle_deg * *middle_deg);
}

/* What the beam makes of a beacon that shows `wide_m` of itself to the samples. */
static double expected_deviation_deg(const struct ref_sector *s, double ratio, double wide_m)
{
    const double beam_deg = s->beam_deg / sqrt(2) / ratio / (2 * sqrt(2 * log(2)));
    const double wide_deg = wide_m / beacon_m / rad;
    return sqrt(beam_deg * beam_deg + wide_deg * wide_deg / 12);
}

TEST(a_bright_cell_is_smeared_over_the_two_way_beam)
{
    const struct world *w = *state;
    const struct ref_sector s = sector_of(w, 10);
    double middle_deg, deviation_deg;
    const double expected_deg = expected_deviation_deg(&s, 1, 0); /* one sample meets it */
    spread_of(w, &s, &middle_deg, &deviation_deg);
    print_message("# real beam: at %.2f degrees, deviation %.3f of %.3f\n", middle_deg,
                  deviation_deg, expected_deg);
    assert_true(fabs(middle_deg) < 0.2);
    assert_true(fabs(deviation_deg / expected_deg - 1) < 0.06);
}

TEST(sharpened_it_is_a_beam_over_the_ratio_and_wide_again_in_the_notch)
{
    const struct world *w = *state;
    struct ref_sector s = sector_of(w, 6);
    s.sharpening = 8;
    /* The map is read from cells of 76.3 m, 53 m wide at 46 degrees: the beacon shares two. */
    const double wide_m = 2 * 76.3 * cos(46 * rad);
    double middle_deg, deviation_deg;
    for (int in_notch = 0; in_notch < 2; in_notch++) {
        s.track_deg = in_notch ? 0 : -40;
        s.dbs.speed_m_s = in_notch ? 30 : 250; /* slow: a notch of 9 degrees to either side */
        const double expected_deg =
            in_notch ? expected_deviation_deg(&s, 1, 0) : expected_deviation_deg(&s, 8, wide_m);
        spread_of(w, &s, &middle_deg, &deviation_deg);
        print_message("# %s: at %.2f degrees, deviation %.3f of %.3f\n", in_notch ? "notch" : "8:1",
                      middle_deg, deviation_deg, expected_deg);
        assert_true(fabs(middle_deg) < 0.2);
        assert_true(fabs(deviation_deg / expected_deg - 1) < 0.12);
    }
}

TEST(the_plain_is_as_bright_as_it_is_behind_the_hole)
{
    const struct world *w = *state;
    const struct ref_sector s = sector_of(w, 55);
    struct ref_picture p = sweep(w, &s);
    const double step_m = 18520.0 / CELLS;
    double sum = 0, squares = 0, across = 0, along = 0;
    int n = 0;
    for (unsigned line = 0; line + 1 < p.line_count; line++) {
        for (unsigned bin = 0; bin < CELLS - 40; bin++) {
            const double x = power_at(&p, line, bin) * 100;
            if ((bin + 0.5) * step_m < height_m) {
                assert_true(x < 1e-3);
            } else if (bin > 60 && (bin < 120 || bin > 140)) {
                n++;
                sum += x;
                squares += x * x;
                across += x * power_at(&p, line + 1, bin) * 100;
                along += x * power_at(&p, line, bin + 1) * 100;
            }
        }
    }
    const double mean = sum / n, variance = squares / n - mean * mean;
    print_message("# plain: mean %.3f, variance %.3f, correlation across lines %.2f, along %.2f\n",
                  mean, variance, (across / n - mean * mean) / variance,
                  (along / n - mean * mean) / variance);
    assert_true(fabs(10 * log10(mean)) < 0.3);
    /* Speckle is as wide as the beam: neighbouring lines look alike, neighbouring bins a little. */
    assert_true((across / n - mean * mean) / variance > 0.8);
    assert_true(fabs((along / n - mean * mean) / variance - 0.3) < 0.15);
    ref_picture_free(&p);
}

TEST(rain_and_a_jammer_are_where_they_are)
{
    const struct world *w = *state;
    struct ref_sector s = sector_of(w, 30);
    struct ref_picture fair = sweep(w, &s);
    s.environment.rain_count = s.environment.jammer_count = 1;
    s.environment.rain[0] = (struct ref_rain){.radius_m = 2000, .mm_per_h = 40};
    s.environment.jammer[0].ratio_db = 40;
    s.rain_centre[0] = ref_geo_direct(s.ground.antenna, -15, 7000);
    s.jammer_place[0] = ref_geo_direct(s.ground.antenna, 20, 18520);
    struct ref_picture foul = sweep(w, &s);
    const double loss_db = 2 * ref_rain_loss_db_km(40) * 4;
    for (unsigned line = 0; line < 128; line++) {
        const double a = ref_gm_azimuth_deg(&s.ground, line);
        const double far_db = 10 * log10(power_at(&foul, line, 200) / power_at(&fair, line, 200));
        const double hole_db = 10 * log10(power_at(&foul, line, 30) / power_at(&fair, line, 30));
        if (fabs(a + 15) < 1) {
            assert_true(fabs(far_db + loss_db) < 0.1);
        } else if (a > 4 && a < 9) {
            assert_true(fabs(far_db) < 0.05 && hole_db < 0.1);
        } else if (fabs(a - 20) < 1.6) {
            const double strobe_db = 40 - 40 * log10(2) * pow((a - 20) / 3.3, 2);
            assert_true(fabs(hole_db - strobe_db) < 0.1);
        }
    }
    ref_picture_free(&fair);
    ref_picture_free(&foul);
}

TEST_GROUP(open_world, close_world);
