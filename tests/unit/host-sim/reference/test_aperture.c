/* The synthetic aperture of the reference against the closed forms of dwell and of Taylor
 * weighting, and against a transform of the aperture itself. */
#include "check.h"
#include "reference/reference.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

static double power_db(const struct ref_taylor *t, double x)
{
    return 20 * log10(fabs(ref_taylor_amplitude(t, x) / ref_taylor_amplitude(t, 0)));
}

/* Half-power width, highest side lobe, energy of side lobes to that of the main one. */
struct shape {
    double width, side_lobe_db, integrated_db;
};

static struct shape shape_of(const struct ref_taylor *t)
{
    struct shape s = {0, -INFINITY, 0};
    double near = 0, far = 1;
    for (int i = 0; i < 60; i++) {
        const double x = (near + far) / 2;
        *(power_db(t, x) > 10 * log10(0.5) ? &near : &far) = x;
    }
    s.width = 2 * near;
    const double step = 1.0 / 512;
    double x = 0, main_lobe = 0, side_lobes = 0;
    /* The main lobe ends at the first minimum. */
    for (; power_db(t, x + step) < power_db(t, x) || x < 0.5; x += step) {
        main_lobe += pow(ref_taylor_amplitude(t, x), 2);
    }
    for (; x < 60; x += step) {
        s.side_lobe_db = fmax(s.side_lobe_db, power_db(t, x));
        side_lobes += pow(ref_taylor_amplitude(t, x), 2);
    }
    s.integrated_db = 10 * log10(side_lobes / main_lobe);
    return s;
}

TEST(point_responses_are_those_of_the_table)
{
    static const struct {
        struct ref_taylor taylor;
        double width, side_lobe_db, integrated_db, loss_db;
    } rows[] = {{{30, 1}, 0.886, -13.26, -9.7, 0},
                {{30, 4}, 1.125, -30.3, -23.4, 0.69},
                {{35, 4}, 1.184, -35.2, -27.1, 0.91},
                {{35, 5}, 1.187, -35.2, -27.4, 0.93},
                {{40, 6}, 1.248, -40.2, -31.6, 1.15}};
    for (int n = 0; n < 5; n++) {
        const struct ref_taylor *t = &rows[n].taylor;
        const struct shape s = shape_of(t);
        double sum = 0, squares = 0;
        for (int i = 0; i < 4000; i++) {
            const double w = ref_taylor_weight(t, (i + 0.5) / 4000 - 0.5);
            sum += w / 4000;
            squares += w * w / 4000;
        }
        const double loss_db = 10 * log10(squares / (sum * sum));
        print_message(
            "# -%.0f dB, nbar %d: width %.3f, side lobes %.2f dB, all %.1f dB, loss "
            "%.2f dB\n",
            t->side_lobe_db, t->nbar, s.width, s.side_lobe_db, s.integrated_db, loss_db);
        assert_true(fabs(s.width / rows[n].width - 1) < 0.05);
        assert_true(fabs(s.side_lobe_db - rows[n].side_lobe_db) < 1);
        assert_true(fabs(s.integrated_db - rows[n].integrated_db) < 1);
        assert_true(fabs(loss_db - rows[n].loss_db) < 0.02);
    }
}

/* The response is the transform of the weighting. */
TEST(the_response_is_the_transform_of_the_weights)
{
    const struct ref_taylor t = {35, 4};
    enum { PIECES = 2000 };
    for (double x = 0; x < 8; x += 0.31) {
        double sum = 0;
        for (int i = 0; i < PIECES; i++) {
            const double u = (i + 0.5) / PIECES - 0.5;
            sum += ref_taylor_weight(&t, u) * cos(2 * pi * x * u) / PIECES;
        }
        assert_true(fabs(sum - ref_taylor_amplitude(&t, x)) < 1e-5);
    }
}

/* The response is band limited to one cell, so that its samples have its energy wherever they lie.
 */
TEST(a_point_keeps_its_power_wherever_it_lies_in_a_cell)
{
    for (double place = 0; place < 1; place += 0.09) {
        double sum = 0;
        for (int cell = -4000; cell <= 4000; cell++) {
            sum += pow(ref_point_response(cell - place), 2);
        }
        assert_true(fabs(sum - 1) < 1e-4);
    }
    /* The peak is down by the weighting's loss. */
    assert_true(fabs(20 * log10(ref_point_response(0)) + 0.91) < 0.01);
}

/* T = l R / (2 V d sin o) by hand: 20 nautical miles, 45 degrees of squint, 250 m/s, 31.3 mm. */
TEST(dwells_are_those_of_the_list)
{
    static const double cells_m[] = {0.6, 1, 3, 5}, dwells_s[] = {5.5, 3.3, 1.1, 0.7};
    for (int n = 0; n < 4; n++) {
        const double dwell_s = ref_sar_dwell_s(0.0313, 37040, 250, cells_m[n], 45);
        print_message("# cells of %.1f m: %.3f s\n", cells_m[n], dwell_s);
        assert_true(fabs(dwell_s - dwells_s[n]) < 0.05); /* as printed */
        /* Over that dwell a neighbouring cell's phase turns once more. */
        const double sine = sin(pi / 4), turns = 2 * 250 * sine * cells_m[n] / 37040 / 0.0313;
        assert_true(fabs(turns * dwell_s - 1) < 1e-12);
    }
    assert_true(isinf(ref_sar_dwell_s(0.0313, 37040, 250, 1, 0)));
}

/* Power at x cells of a point seen through the patch's weighting with a quadratic phase of f at the
 * aperture's ends: the transform of both. */
static double defocused(double f, double x)
{
    enum { PIECES = 1000 };
    const struct ref_taylor t = {35, 4};
    double re = 0, im = 0;
    for (int i = 0; i < PIECES; i++) {
        const double u = (i + 0.5) / PIECES - 0.5, w = ref_taylor_weight(&t, u) / PIECES;
        re += w * cos(f * 4 * u * u + 2 * pi * u * x);
        im += w * sin(f * 4 * u * u + 2 * pi * u * x);
    }
    return re * re + im * im;
}

/* Between the outermost places at half power. */
static double defocused_width(double f)
{
    enum { STEPS = 400 };
    double power[STEPS], peak = 0;
    for (int i = 0; i < STEPS; i++) {
        power[i] = defocused(f, i / 50.0);
        peak = fmax(peak, power[i]);
    }
    int last = STEPS - 1;
    while (power[last] < peak / 2) {
        last--;
    }
    return 2 * last / 50.0;
}

TEST(unsteady_flight_spreads_a_point_as_its_quadratic_phase_does)
{
    const double wavelength_m = 0.0312, dwell_s = 3, focused = defocused_width(0);
    assert_true(fabs(focused - 1.184) < 0.05);
    for (double f = 0; f < 14; f += 1.4) {
        const double residual_m_s2 = f * 2 * wavelength_m / (pi * dwell_s * dwell_s);
        const double spread = ref_mocomp_cells(wavelength_m, residual_m_s2, dwell_s);
        const double transformed = defocused_width(f) / focused;
        print_message("# %4.1f rad at the ends: %.2f, transform %.2f\n", f, spread, transformed);
        assert_true(fabs(spread / transformed - 1) < 0.15);
        /* The phase: half A' (T/2)^2 off the line, there and back. */
        const double off_m = residual_m_s2 * pow(dwell_s / 2, 2) / 2;
        assert_true(fabs(4 * pi * off_m / wavelength_m - f) < 1e-9);
    }
}

TEST(lines_are_spread_with_their_energy)
{
    enum { LINES = 31 };
    double power[LINES][2] = {{0}};
    const double *lines[LINES];
    power[15][0] = 1;
    for (int k = 0; k < LINES; k++) {
        power[k][1] = 2;
        lines[k] = power[k];
    }
    for (double width = 1; width < 9; width += 0.37) {
        double sum = 0, highest = 0;
        for (size_t k = 0; k < LINES; k++) {
            double mean[2];
            ref_mocomp(lines, LINES, k, width, mean, 2);
            sum += mean[0];
            highest = fmax(highest, mean[0]);
            assert_true(fabs(mean[1] - 2) < 1e-12);
        }
        assert_true(fabs(sum - 1) < 1e-12);
        assert_true(fabs(1 / highest / width - 1) < 1e-9);
    }
}

/* A mast of 30 m at a grazing angle of 20 degrees, cells of 2 m: its top lies 30 tan 20 nearer. */
TEST(layover_moves_a_top_nearer_and_keeps_the_energy)
{
    enum { CELLS = 64 };
    double power[CELLS] = {0}, nearer[CELLS] = {0}, laid[CELLS];
    const double shift = tan(20 * pi / 180) / 2, moved = 30 * shift;
    power[40] = 3;
    nearer[40] = moved;
    power[10] = 1;
    ref_layover(power, nearer, CELLS, laid);
    double sum = 0, place = 0;
    for (int i = 0; i < CELLS; i++) {
        sum += laid[i];
        place += i > 10 ? laid[i] * i / 3 : 0;
    }
    assert_true(fabs(sum - 4) < 1e-12);
    assert_true(fabs(place - (40 - moved)) < 1e-12);
    assert_true(laid[10] == 1);
    /* Slant ranges say the same: the top's is as long as that of the ground where it is shown. */
    const double slant_m = hypot(20000 * sin(20 * pi / 180) - 30, 20000 * cos(20 * pi / 180));
    const double nearer_m = 20000 * cos(20 * pi / 180) - 2 * moved;
    assert_true(fabs(hypot(20000 * sin(20 * pi / 180), nearer_m) - slant_m) < 0.05);
    nearer[0] = 1000; /* out of the patch */
    power[0] = 9;
    ref_layover(power, nearer, CELLS, laid);
    assert_true(laid[0] == 0);
}
