/* From model to radar picture: things are where theory puts them. */
#include "check.h"
#include "known_records.h"
#include "shapes.h"
#include "support.h"
#include "tracer/accumulate.h"
#include "tracer/materials.h"
#include "tracer/models.h"
#include "tracer/pix.h"
#include "tracer/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELLS = TRACE_CHIP_CELLS };

static const double pi = 3.14159265358979323846;

/* Only the last reflection's specular share counts: half goes on each time, a quarter comes back.
 */
static struct reflect_law plain_law(void)
{
    struct reflect_law law = {.kind = REFLECT_RAYSAR, .wavelength_m = TRACE_WAVELENGTH_M};
    for (int i = 0; i < TRACE_MATERIALS_MAX; i++) {
        law.materials[i] =
            (struct reflect_material){"plain", 2, 0, 0, 0, 0.5, 1, 0.25, 0, REFLECT_GAUSSIAN, 0};
    }
    return law;
}

/* By hand: of the plate every cell that it fills gets what its area of plane holds. */
TEST(a_plates_power_is_its_area_times_its_share)
{
    struct trace_records r;
    known_plate(&r, 2, 30, 80);
    struct reflect_law law = plain_law();
    law.materials[0].specular = 0; /* diffuse only, alike at all angles (F_b = 0) */
    float *picture = malloc(r.grid.cells_across * r.grid.cells_range * sizeof *picture);
    assert_int_equal(accumulate(&r, &law, picture), 0);
    double sum = 0;
    for (uint32_t i = 0; i < r.grid.cells_across * r.grid.cells_range; i++) {
        sum += (double)picture[i];
    }
    assert_true(fabs(sum - 0.25 * 2 * 2 * sin(pi / 6)) < 1e-5);
    const uint32_t middle = r.grid.cells_range / 2 * r.grid.cells_across + r.grid.cells_across / 2;
    assert_true(picture[middle] > 0);
    free(picture);
    trace_records_free(&r);
}

/* Two shares multiplied, then the second surface's own: all of it in the seam. */
TEST(shares_multiply_along_the_bounces)
{
    struct trace_records r;
    known_dihedral(&r, 1, 0.5, 15, 40);
    struct reflect_law law = plain_law();
    law.materials[0].diffuse = law.materials[1].diffuse = 0; /* specular lobes only */
    law.materials[0].specular = 0.8;
    law.materials[1].specular = 0.4;
    law.materials[0].roughness = law.materials[1].roughness = 1e-4; /* nothing off the lobe */
    float *picture = malloc(r.grid.cells_across * r.grid.cells_range * sizeof *picture);
    assert_int_equal(accumulate(&r, &law, picture), 0);
    double sum = 0, seam = 0;
    for (uint32_t i = 0; i < r.grid.cells_across * r.grid.cells_range; i++) {
        sum += (double)picture[i];
        seam += i / r.grid.cells_across == r.grid.cells_range / 2 ? (double)picture[i] : 0;
    }
    const double aperture_m2 = 1 * 2 * 0.5 * cos(15 * pi / 180);
    assert_true(fabs(sum - 0.8 * 0.4 * aperture_m2) < 1e-4);
    assert_true(fabs(seam - sum) < 1e-6);
    free(picture);
    trace_records_free(&r);
}

/* Three times the share of a mirror, from the aperture of a square trihedral, a^2 sqrt 3. */
TEST(a_trihedral_returns_the_share_of_three_mirrors)
{
    struct mesh m = {0};
    struct scene s;
    struct trace_records r;
    model_find("trihedral")->build(&m);
    const struct trace_order o = {
        .look = {0, atan(sqrt(0.5)) * 180 / pi, TRACE_WAVELENGTH_M},
        .grid = {CELLS, CELLS, 0.05},
        .rays_per_cell = 8,
        .bounces = TRACE_BOUNCES_MAX,
        .threads = 2,
    };
    assert_int_equal(scene_open(&s, &m, 0, "trihedral"), 0);
    assert_int_equal(trace_run(&s, &o, "trihedral", &r, NULL), 0);
    struct reflect_law law = plain_law();
    law.materials[0].diffuse = 0;
    law.materials[0].specular = 0.6;
    law.materials[0].roughness = 1e-4;
    float *picture = malloc(CELLS * CELLS * sizeof *picture);
    assert_int_equal(accumulate(&r, &law, picture), 0);
    double sum = 0;
    for (int i = 0; i < CELLS * CELLS; i++) {
        sum += (double)picture[i];
    }
    assert_true(fabs(sum - pow(0.6, 3) * sqrt(3)) < 0.005);
    free(picture);
    trace_records_free(&r);
    scene_close(&s);
    mesh_free(&m);
}

/* Trace a built-in model on its ground and add up its echoes by RaySAR's law. */
static float *picture_of(const char *name, double azimuth_deg, double depression_deg,
                         struct trace_records *r)
{
    struct mesh m = {0};
    struct scene s;
    model_find(name)->build(&m);
    const struct trace_order o = {.look = {azimuth_deg, depression_deg, TRACE_WAVELENGTH_M},
                                  .grid = {CELLS, CELLS, TRACE_CHIP_CELL_M},
                                  .rays_per_cell = 3,
                                  .bounces = TRACE_BOUNCES_MAX,
                                  .threads = 2};
    assert_int_equal(scene_open(&s, &m, trace_ground_half_m(&o.grid, depression_deg), name), 0);
    assert_int_equal(trace_run(&s, &o, name, r, NULL), 0);
    struct reflect_law law = {.kind = REFLECT_RAYSAR, .wavelength_m = TRACE_WAVELENGTH_M};
    assert_int_equal(materials_for(r, NULL, NULL, &law), 0);
    float *picture = malloc(CELLS * CELLS * sizeof *picture);
    assert_int_equal(accumulate(r, &law, picture), 0);
    mesh_free(&m);
    scene_close(&s);
    return picture;
}

static int brightest(const float *picture)
{
    int best = 0;
    for (int i = 1; i < CELLS * CELLS; i++) {
        best = picture[i] > picture[best] ? i : best;
    }
    return best;
}

TEST(a_trihedral_is_brightest_at_its_apex)
{
    for (double azimuth = 350; azimuth <= 370; azimuth += 10) {
        struct trace_records r;
        float *picture = picture_of("trihedral", fmod(azimuth, 360), 35, &r);
        const int cell = brightest(picture);
        /* The apex stands in the origin, 2 cm high: the lower corner of the middle cell. */
        assert_in_range(cell % CELLS, CELLS / 2 - 1, CELLS / 2);
        assert_in_range(cell / CELLS, CELLS / 2 - 1, CELLS / 2);
        free(picture);
        trace_records_free(&r);
    }
}

TEST(a_dihedral_is_brightest_along_its_seam)
{
    struct trace_records r;
    float *picture = picture_of("dihedral", 0, 30, &r);
    const int cell = brightest(picture);
    assert_in_range(cell / CELLS, CELLS / 2 - 1, CELLS / 2);
    const float peak = picture[cell];
    for (int column = CELLS / 2 - 4; column < CELLS / 2 + 4; column++) { /* 1 m wide */
        assert_true(picture[cell / CELLS * CELLS + column] > 0.9f * peak);
    }
    assert_true(picture[cell / CELLS * CELLS + CELLS / 2 + 7] < 0.01f * peak);
    free(picture);
    trace_records_free(&r);
}

/* Crown and brim meet in a circle of 0.5 m: double bounces are focused on its near half. */
TEST(a_top_hat_is_an_arc_around_its_crown)
{
    struct trace_records r;
    float *picture = picture_of("tophat", 77, 30, &r);
    const double psi = 30 * pi / 180;
    const int cell = brightest(picture);
    const double across = (cell % CELLS - CELLS / 2 + 0.5) * 0.1;
    const double away = (cell / CELLS - CELLS / 2 + 0.5) * 0.1 / cos(psi);
    assert_true(away < 0 && fabs(hypot(across, away) - 0.5) < 0.12);
    /* The crown shades the ground behind it, as far as its height over tan psi. */
    const int row = CELLS / 2 + (int)((1.5 + 0.3) * cos(psi) / 0.1);
    assert_true(picture[row * CELLS + CELLS / 2] == 0);
    free(picture);
    trace_records_free(&r);
}

/* No light is made: with shares that add up to one, what comes back is at most what was sent. */
TEST(no_more_power_comes_back_than_was_sent)
{
    struct trace_records r;
    float *picture = picture_of("slicy", 25, 30, &r);
    struct reflect_law law = plain_law();
    for (int i = 0; i < TRACE_MATERIALS_MAX; i++) {
        law.materials[i].specular = 0.5;
        law.materials[i].diffuse = 0.5;
        law.materials[i].roughness = 1e-6; /* no lobe */
    }
    assert_int_equal(accumulate(&r, &law, picture), 0);
    double sum = 0;
    for (int i = 0; i < CELLS * CELLS; i++) {
        sum += (double)picture[i];
    }
    const double sent_m2 = r.bounces[0].count * r.sensor.step_across_m * r.sensor.step_up_m;
    assert_true(sum > 0.3 * sent_m2 && sum <= sent_m2);
    free(picture);
    trace_records_free(&r);
}

TEST(level_ground_is_even)
{
    struct trace_records r;
    float *picture = picture_of("plate", 90, 15, &r); /* edge on: next to nothing */
    const float ground = picture[5 * CELLS + 5];
    for (int row = 1; row < 20; row++) {
        for (int column = 1; column < CELLS - 1; column++) {
            assert_true(fabsf(picture[row * CELLS + column] / ground - 1) < 1e-3f);
        }
    }
    free(picture);
    trace_records_free(&r);
}
