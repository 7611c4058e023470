/* RaySAR's law against RaySAR's engine: what each ray sends back, beside POV-Ray's picture of the
 * same model, surfaces, light and rays. */
#include "check.h"
#include "support.h"
#include "tracer/setup.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char folder[] = "/tmp/landmass-povray-XXXXXX";

static int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    return support_run("rm -rf %s", folder);
}

/* ---- the scene, in POV-Ray's words ---- */

static void put_vector(FILE *out, const char *before, struct vec v)
{
    fprintf(out, "%s<%.12g,%.12g,%.12g>", before, v.x, v.y, v.z);
}

static void put_materials(FILE *out, const struct reflect_law *law, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const struct reflect_material *m = &law->materials[i];
        fprintf(out,
                "#declare T%u = texture { pigment { rgb 1 } finish { ambient 0 diffuse %.9g "
                "brilliance %.9g specular %.9g roughness %.9g reflection %.9g } }\n",
                i, m->diffuse, m->brilliance, m->specular, m->roughness, m->specular);
    }
}

static void put_triangle(FILE *out, const struct vec corners[3], uint32_t material)
{
    put_vector(out, "triangle { ", corners[0]);
    put_vector(out, ", ", corners[1]);
    put_vector(out, ", ", corners[2]);
    fprintf(out, " texture { T%u } }\n", material);
}

static void put_mesh(FILE *out, const struct scene *s)
{
    const double g = s->ground_half_m;
    const struct vec ground[2][3] = {{{-g, -g, 0}, {g, -g, 0}, {g, g, 0}},
                                     {{-g, -g, 0}, {g, g, 0}, {-g, g, 0}}};
    fputs("mesh {\n", out);
    for (uint32_t t = 0; t < s->triangle_count; t++) {
        struct vec corners[3];
        scene_corners(s, t, corners);
        put_triangle(out, corners, s->facet_materials[t]);
    }
    for (int t = 0; t < 2; t++) {
        put_triangle(out, ground[t], s->facet_materials[s->triangle_count]);
    }
    fputs("}\n", out);
}

/* Parallel rays through the middles of the plane's pixels, and light from where the radar is. */
static void put_camera(FILE *out, const struct trace_records *r)
{
    const struct trace_axes a = trace_axes_of(&r->look);
    const struct trace_sensor *p = &r->sensor;
    const double width_m = p->columns * p->step_across_m, height_m = p->rows * p->step_up_m;
    struct vec at = vec_scale(a.sight, -30);
    at = vec_mad(at, a.across, p->low_across_m + width_m / 2);
    at = vec_mad(at, a.rise, p->low_up_m + height_m / 2);
    put_vector(out, "camera { orthographic location ", at);
    put_vector(out, " direction ", a.sight);
    put_vector(out, " right ", vec_scale(a.across, width_m));
    put_vector(out, " up ", vec_scale(a.rise, height_m));
    put_vector(out, " }\nlight_source { ", vec_scale(a.sight, -1000));
    fputs(" color rgb 1 parallel point_at 0 }\n", out);
}

static void write_scene(const struct scene *s, const struct trace_records *r,
                        const struct reflect_law *law)
{
    char path[256];
    snprintf(path, sizeof path, "%s/scene.pov", folder);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fprintf(out,
            "#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level %u adc_bailout 0 }\n",
            r->bounce_count);
    put_camera(out, r);
    put_materials(out, law, r->material_count);
    put_mesh(out, s);
    assert_int_equal(fclose(out), 0);
}

/* A number of a PPM's head, before which there may be remarks. */
static unsigned head_number(FILE *in)
{
    unsigned number = 0;
    while (fscanf(in, " #%*[^\n]") == 0 && fscanf(in, "%u", &number) != 1) {
    }
    return number;
}

/* Its picture, the lowest row first. */
static void run_povray(const struct trace_records *r, double *picture)
{
    const unsigned width = r->sensor.columns, height = r->sensor.rows;
    char path[256];
    assert_int_equal(support_run("povray +I%s/scene.pov +O%s/scene.ppm +FP16 File_Gamma=1.0 +W%u "
                                 "+H%u -D -A +WT2 2> %s/log || { tail %s/log; false; }",
                                 folder, folder, width, height, folder, folder),
                     0);
    snprintf(path, sizeof path, "%s/scene.ppm", folder);
    FILE *in = fopen(path, "rb");
    assert_non_null(in);
    assert_true(getc(in) == 'P' && getc(in) == '6');
    assert_int_equal(head_number(in), width);
    assert_int_equal(head_number(in), height);
    assert_int_equal(head_number(in), 65535);
    assert_int_equal(getc(in), '\n');
    for (unsigned i = 0; i < width * height; i++) {
        uint8_t pixel[6];
        assert_int_equal(fread(pixel, 1, sizeof pixel, in), sizeof pixel);
        picture[(height - 1 - i / width) * width + i % width] =
            (256 * pixel[0] + pixel[1]) / 65535.0;
    }
    fclose(in);
}

/* ---- ours ---- */

/* What each primary ray brings back, over all of its reflections: RaySAR's picture before echoes
 * are sorted by range. */
static void add_echoes(const struct trace_records *r, const struct reflect_law *law,
                       double *picture)
{
    double *in = NULL;
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        double *out = calloc(r->bounces[b].count + 1, sizeof *out);
        for (uint32_t i = 0; i < r->bounces[b].count; i++) {
            const struct trace_record *t = &r->bounces[b].records[i];
            const struct reflect_shares s = reflect_record(law, t);
            const double arriving = in ? in[t->parent] : 1;
            out[i] = arriving * (double)s.specular;
            picture[t->ray] += t->flags & TRACE_BLOCKED ? 0 : arriving * (double)s.back;
        }
        free(in);
        in = out;
    }
    free(in);
}

/* Means within 1e-4; all but three of ten thousand pixels, at edges that rays graze, within a step
 * of the picture and single precision. */
static void expect_alike(const struct setup *s, double azimuth_deg)
{
    struct scene scene;
    struct trace_records r;
    struct reflect_law law;
    assert_int_equal(setup_scene(s, &scene), 0);
    const struct trace_order order = setup_order(s, azimuth_deg);
    assert_int_equal(trace_run(&scene, &order, s->model, &r, NULL), 0);
    assert_int_equal(setup_law(s, &r, &law), 0);
    const size_t rays = (size_t)r.sensor.columns * r.sensor.rows;
    double *ours = calloc(rays, sizeof *ours), *theirs = calloc(rays, sizeof *theirs);
    write_scene(&scene, &r, &law);
    run_povray(&r, theirs);
    add_echoes(&r, &law, ours);
    double our_sum = 0, their_sum = 0;
    size_t far = 0;
    for (size_t i = 0; i < rays; i++) {
        our_sum += fmin(ours[i], 1);
        their_sum += theirs[i];
        far += fabs(fmin(ours[i], 1) - theirs[i]) > 1e-4;
    }
    printf("# %s from %.0f deg: means %.6f and %.6f, %zu of %zu pixels differ\n", s->model,
           azimuth_deg, our_sum / (double)rays, their_sum / (double)rays, far, rays);
    assert_true(fabs(our_sum - their_sum) < 1e-4 * (double)rays);
    assert_true(fabs(our_sum - their_sum) < 2e-3 * their_sum);
    assert_true((double)far < 3e-4 * (double)rays);
    free(ours);
    free(theirs);
    trace_records_free(&r);
    scene_close(&scene);
}

static void expect_model_alike(const char *model, const char *materials)
{
    char path[256];
    struct setup s = setup_default();
    if (support_run("command -v povray") != 0) {
        printf("# povray is not installed (make deps)\n");
        skip();
    }
    snprintf(path, sizeof path, "%s/materials", folder);
    FILE *out = fopen(path, "w");
    assert_non_null(out);
    fputs(materials, out);
    fclose(out);
    s.model = model;
    s.materials = path;
    expect_alike(&s, 20);
    expect_alike(&s, 115);
}

/* Mostly diffuse, brilliance below one: equation (11) alone, after mirrors. */
TEST(equation_11_is_povrays)
{
    expect_model_alike("tank",
                       "metal 1 1e7 0 0 0.4 0.0005 0.2 0.7\n"
                       "ground 6 1 0 0 0.3 0.0005 0.3 1\n"
                       "rubber 3 0.1 0 0 0.2 0.0005 0.1 0.4\n");
}

/* Both parts, lobes wide enough to be seen off their middle. */
TEST(equations_10_and_11_are_povrays)
{
    const char *const both =
        "metal 1 1e7 0 0 0.6 0.05 0.05 1\n"
        "ground 6 1 0 0 0.3 0.1 0.05 1\n"
        "rubber 3 0.1 0 0 0.2 0.02 0.02 1\n";
    expect_model_alike("tank", both);
    expect_model_alike("slicy", both);
}

TEST_GROUP(make_folder, remove_folder);
