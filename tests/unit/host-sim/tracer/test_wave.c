/* Polarisation followed through reflections, against scattering matrices of the textbooks. */
#include "check.h"
#include "metal.h"
#include "shapes.h"
#include "tracer/coherent.h"
#include "tracer/edges.h"
#include "tracer/models.h"
#include "tracer/trace.h"
#include "tracer/wave.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static const double lambda = TRACE_WAVELENGTH_M;
static const struct trace_look look = {0, 30, TRACE_WAVELENGTH_M};

static void assert_near(double found, double expected, double most)
{
    if (!(fabs(found - expected) <= most)) {
        print_error("%g is not within %g of %g\n", found, most, expected);
        fail();
    }
}

static void assert_close(double complex found, double complex expected, double most)
{
    if (!(cabs(found - expected) <= most)) {
        print_error("%g%+gi is not within %g of %g%+gi\n", creal(found), cimag(found), most,
                    creal(expected), cimag(expected));
        fail();
    }
}

/* Without ground. The mesh is freed. */
static struct trace_records traced(struct mesh *m, const struct trace_look *l, double cell_m,
                                   uint32_t rays)
{
    const struct trace_order o = {.look = *l,
                                  .grid = {128, 128, cell_m},
                                  .rays_per_cell = rays,
                                  .bounces = TRACE_BOUNCES_MAX,
                                  .threads = 2};
    struct scene s;
    struct trace_records r;
    assert_int_equal(scene_open(&s, m, 0, "test"), 0);
    assert_int_equal(trace_run(&s, &o, "test", &r, NULL), 0);
    scene_close(&s);
    mesh_free(m);
    return r;
}

struct matrix {
    double complex hh, hv, vh, vv;
};

static double complex channel_of(const struct trace_records *r, struct reflect_law law,
                                 enum reflect_channel channel)
{
    law.channel = channel;
    return coherent_total(r, &law, 1);
}

/* The records are freed. */
static struct matrix matrix_of(struct trace_records *r, const struct reflect_law *law)
{
    const struct matrix s = {channel_of(r, *law, REFLECT_HH), channel_of(r, *law, REFLECT_HV),
                             channel_of(r, *law, REFLECT_VH), channel_of(r, *law, REFLECT_VV)};
    trace_records_free(r);
    return s;
}

/* ---- reflectors ---- */

/* A dihedral that looks at the radar, its seam turned by `turn` about the line of sight; H lies
 * along the seam at 0. The other layers are blocked: a face alone has a side lobe. */
static struct trace_records dihedral(double turn, double side_m)
{
    const struct trace_axes x = trace_axes_of(&look);
    const struct vec seam = vec_mad(vec_scale(x.across, cos(turn)), x.rise, sin(turn));
    const struct vec beside = vec_mad(vec_scale(x.rise, cos(turn)), x.across, -sin(turn));
    const struct vec toward = vec_scale(x.sight, -1);
    const struct vec one = vec_scale(vec_add(toward, beside), side_m * sqrt(0.5));
    const struct vec other = vec_scale(vec_sub(toward, beside), side_m * sqrt(0.5));
    const struct vec along = vec_scale(seam, side_m), from = vec_scale(seam, -side_m / 2);
    struct mesh m = {0};
    shape_plate(&m, from, along, one, mesh_material(&m, "metal"));
    shape_plate(&m, from, along, other, 0);
    struct trace_records r = traced(&m, &look, 0.01, 4);
    for (uint32_t i = 0; i < r.bounces[0].count; i++) {
        r.bounces[0].records[i].flags |= TRACE_BLOCKED;
    }
    return r;
}

/* Of metal, [cos 2t, sin 2t; sin 2t, -cos 2t] (Lee and Pottier, Polarimetric Radar Imaging, 2009,
 * chapter 6), at the textbook's 8 pi a^4 / wavelength^2. At 45 degrees it is pure HV, at 22.5 half
 * of the power. */
TEST(a_dihedral_turned_about_the_line_of_sight_crosses_polarisations)
{
    const double a = 0.3, peak = sqrt(8 * pi) * a * a / lambda;
    const struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    for (double turn_deg = -90; turn_deg <= 90; turn_deg += 7.5) {
        const double turn = turn_deg * pi / 180;
        struct trace_records r = dihedral(turn, a);
        const struct matrix s = matrix_of(&r, &law);
        const double complex whole = s.hh * cos(2 * turn) + s.hv * sin(2 * turn);
        assert_near(cabs(whole) / peak, 1, 0.02);
        assert_close(s.hh / whole, cos(2 * turn), 2e-3);
        assert_close(s.hv / whole, sin(2 * turn), 2e-3);
        assert_close(s.vh / whole, sin(2 * turn), 2e-3);
        assert_close(s.vv / whole, -cos(2 * turn), 2e-3);
    }
    struct trace_records at_45 = dihedral(pi / 4, a), at_22 = dihedral(pi / 8, a);
    const struct matrix crossed = matrix_of(&at_45, &law), half = matrix_of(&at_22, &law);
    assert_true(cabs(crossed.hh) < 2e-3 * cabs(crossed.hv));
    assert_true(cabs(crossed.vv) < 2e-3 * cabs(crossed.hv));
    const double hv = pow(cabs(half.hv), 2);
    assert_near(hv / (hv + pow(cabs(half.hh), 2)), 0.5, 2e-3);
}

/* Both faces are met at 45 degrees: H along the seam is reflected by R_h twice, V by R_v, and
 * turned over. Concrete loses V, and is then no pure HV at 45 degrees of turn. */
TEST(a_dihedral_of_concrete_has_the_squares_of_fresnels_coefficients)
{
    const double a = 0.3;
    const double complex permittivity = 5.24 - 0.5 * I;
    const double complex h = cpow(reflect_fresnel_hh(permittivity, pi / 4), 2);
    const double complex v = cpow(reflect_fresnel_vv(permittivity, pi / 4), 2);
    struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    const struct reflect_law metal = law;
    law.materials[0].permittivity = 5.24;
    law.materials[0].loss = 0.5;
    for (double turn_deg = 0; turn_deg <= 90; turn_deg += 22.5) {
        const double c = cos(turn_deg * pi / 180), s = sin(turn_deg * pi / 180);
        struct trace_records straight = dihedral(0, a), turned = dihedral(turn_deg * pi / 180, a);
        const double complex unit = matrix_of(&straight, &metal).hh;
        const struct matrix found = matrix_of(&turned, &law);
        assert_close(found.hh / unit, h * c * c - v * s * s, 0.02);
        assert_close(found.hv / unit, (h + v) * c * s, 0.02);
        assert_close(found.vh / unit, (h + v) * c * s, 0.02);
        assert_close(found.vv / unit, h * s * s - v * c * c, 0.02);
    }
}

/* Three mirrors send back what came, wherever it stands. Rays that end in two of them are left out:
 * they are no trihedral. */
TEST(a_trihedral_and_a_plate_do_not_cross_polarisations)
{
    static const double aside_deg[] = {0, 12, -20};
    const struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    for (int i = 0; i < 3; i++) {
        const double a = 0.5;
        const struct trace_look l = {fmod(360 + aside_deg[i], 360), 35.264 + aside_deg[i] / 2,
                                     lambda};
        const struct vec s = {a * sqrt(0.5), a * sqrt(0.5), 0}, o = {0, 0, 0};
        const struct vec p = {a * sqrt(0.5), -a * sqrt(0.5), 0}, up = {0, 0, a};
        struct mesh m = {0};
        shape_plate(&m, o, p, s, mesh_material(&m, "metal"));
        shape_plate(&m, o, up, s, 0);
        shape_plate(&m, o, p, up, 0);
        struct trace_records r = traced(&m, &l, 0.01, 4);
        for (uint32_t b = 0; b < 2; b++) {
            for (uint32_t k = 0; k < r.bounces[b].count; k++) {
                r.bounces[b].records[k].flags |= TRACE_BLOCKED;
            }
        }
        const struct matrix corner = matrix_of(&r, &law);
        assert_close(corner.vv / corner.hh, 1, 1e-5);
        assert_true(cabs(corner.hv) < 1e-5 * cabs(corner.hh));
        assert_true(cabs(corner.vh) < 1e-5 * cabs(corner.hh));
    }
    const struct trace_axes x = trace_axes_of(&look);
    struct mesh m = {0};
    const struct vec u = vec_mad(vec_scale(x.across, 0.4), x.sight, 0.02);
    shape_plate(&m, vec_scale(vec_add(u, x.rise), -0.2), u, vec_mad(vec_scale(x.rise, 0.4), u, 0.1),
                mesh_material(&m, "metal"));
    struct trace_records r = traced(&m, &look, 0.01, 2);
    const double alone = cabs(coherent_total(&r, &law, 1));
    const struct matrix plate = matrix_of(&r, &law);
    assert_close(plate.vv / plate.hh, 1, 1e-5);
    assert_near(cabs(plate.hh) / alone, 1, 1e-5); /* as the law without a channel has it */
    assert_true(cabs(plate.hv) < 1e-5 * cabs(plate.hh));
}

/* Physical optics of a dielectric plane: fields on it are e + reflected, both currents radiate.
 * Seen along the mirror's way it is the reflected wave, for either polarisation, at any angle. */
TEST(optics_returns_the_reflected_wave_along_the_mirrors_way)
{
    const struct reflect_pair pair = {-0.4 + 0.2 * I, 0.3 - 0.1 * I};
    const struct vec normal = {0, 0, 1};
    for (double t = 0; t < 1.5; t += 0.1) {
        const struct vec along = {sin(t), 0, -cos(t)}, on = {sin(t), 0, cos(t)};
        for (int h = 0; h < 2; h++) {
            const struct vec level = {0, 1, 0};
            const struct wave e = wave_of(h ? level : vec_cross(level, along));
            const struct wave mirror = wave_reflected(&e, along, normal, &pair);
            const struct wave seen = wave_optics(&e, along, normal, on, &pair);
            assert_close(seen.x, mirror.x, 1e-12);
            assert_close(seen.y, mirror.y, 1e-12);
            assert_close(seen.z, mirror.z, 1e-12);
            assert_near(cabs(wave_dot(&mirror, h ? level : vec_cross(level, on))),
                        cabs(h ? pair.hh : pair.vv), 1e-12);
        }
    }
}

/* ---- rough places ---- */

static struct trace_record place_at(struct vec along, struct vec normal, struct vec back)
{
    return (struct trace_record){.incidence_rad = (float)acos(fmin(-vec_dot(along, normal), 1)),
                                 .echo_rad = (float)acos(fmin(vec_dot(back, normal), 1)),
                                 .turn_rad = (float)acos(fmax(fmin(-vec_dot(along, back), 1), -1))};
}

/* As the permittivity goes to one, a rough surface is a thin sheet of dipoles, each of which
 * radiates the part of e that is square to the way: all four of small perturbation, with signs. */
TEST(small_perturbation_of_thin_matter_radiates_as_dipoles_do)
{
    struct reflect_law law = metal_law(REFLECT_SPM_HH);
    law.channel = REFLECT_HH;
    law.materials[0] = (struct reflect_material){.permittivity = 1.0001,
                                                 .rms_height_m = 0.001,
                                                 .correlation_m = 0.02,
                                                 .specular = 1,
                                                 .roughness = 1};
    const struct vec normal = {0, 0, 1};
    for (int i = 0; i < 60; i++) {
        const double t1 = 0.1 + 0.02 * i, t2 = 1.3 - 0.015 * i, phi = 0.3 * i;
        const struct vec along = {sin(t1), 0, -cos(t1)};
        const struct vec back = {sin(t2) * cos(phi), sin(t2) * sin(phi), cos(t2)};
        const struct vec slant = vec_cross((struct vec){0.6, 0.8, 0.3}, along);
        const struct trace_record t = place_at(along, normal, back);
        const struct wave e = wave_of(slant);
        const struct wave found = wave_scattered(&e, along, normal, back, &law, &t, 1, 0);
        const struct vec square = vec_mad(slant, back, -vec_dot(slant, back));
        const double complex k = wave_dot(&found, square) / vec_dot(square, square);
        assert_true(cabs(k) > 0);
        assert_close(found.x / k, square.x, 1e-3);
        assert_close(found.y / k, square.y, 1e-3);
        assert_close(found.z / k, square.z, 1e-3);
    }
}

/* Straight back it is the law of intensities, in HH and in VV; and exchanging sender and receiver
 * changes nothing: hv one way is vh the other. */
TEST(small_perturbation_keeps_its_shares_and_is_reciprocal)
{
    struct reflect_law law = metal_law(REFLECT_SPM_HH);
    law.materials[0] = (struct reflect_material){.permittivity = 6,
                                                 .loss = 1,
                                                 .rms_height_m = 0.0015,
                                                 .correlation_m = 0.02,
                                                 .spectrum = REFLECT_EXPONENTIAL,
                                                 .specular = 1,
                                                 .roughness = 1};
    for (double t = 0.1; t < 1.5; t += 0.1) {
        const struct trace_record r = {.incidence_rad = (float)t, .echo_rad = (float)t};
        const struct reflect_rough back = reflect_rough_of(&law, &r, -1, 0);
        law.kind = REFLECT_SPM_HH;
        assert_near(pow(cabs(back.hh), 2) / reflect_field_of(&law, &r).scattered, 1, 1e-5);
        law.kind = REFLECT_SPM_VV;
        assert_near(pow(cabs(back.vv), 2) / reflect_field_of(&law, &r).scattered, 1, 1e-5);
        assert_near(cabs(back.hv) + cabs(back.vh), 0, 1e-12);
        const struct trace_record one = {.incidence_rad = (float)t, .echo_rad = 0.7F};
        const struct trace_record two = {.incidence_rad = 0.7F, .echo_rad = (float)t};
        const double flux = sqrt(cos(0.7) / cos(t)); /* shares count what meets the place */
        const struct reflect_rough out = reflect_rough_of(&law, &one, cos(2.0), sin(2.0));
        const struct reflect_rough in = reflect_rough_of(&law, &two, cos(-2.0), sin(-2.0));
        assert_near(cabs(out.hv) / (cabs(in.vh) * flux), 1, 1e-5);
        assert_near(cabs(out.vh) / (cabs(in.hv) * flux), 1, 1e-5);
        assert_near(cabs(out.hh) / (cabs(in.hh) * flux), 1, 1e-5);
    }
}

static double mean_power(const struct wave waves[], int count, struct vec axis)
{
    double sum = 0;
    for (int i = 0; i < count; i++) {
        sum += pow(cabs(wave_dot(&waves[i], axis)), 2) / count;
    }
    return sum;
}

/* Level ground seen at 60 degrees: HV over VV is Oh's q, of a soil of permittivity 8 with k s of
 * 0.67: 0.23 * 0.478 * 0.488 = -12.7 dB. HV and VH are one number. */
TEST(rough_ground_crosses_as_much_as_was_measured)
{
    enum { DRAWS = 400 };
    static struct wave of_v[DRAWS], of_h[DRAWS];
    struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    law.channel = REFLECT_HV;
    law.materials[0] = (struct reflect_material){.permittivity = 8,
                                                 .rms_height_m = 0.67 * lambda / (2 * pi),
                                                 .diffuse = 0.05,
                                                 .brilliance = 1,
                                                 .specular = 1,
                                                 .roughness = 1};
    assert_near(10 * log10(reflect_crossed_share(&law, &law.materials[0])), -12.71, 0.02);
    const struct vec normal = {0, 0, 1}, along = {sin(pi / 3), 0, -cos(pi / 3)};
    const struct vec back = vec_scale(along, -1), h = {0, 1, 0}, v = vec_cross(h, along);
    const struct trace_record t = place_at(along, normal, back);
    const struct wave sent_h = wave_of(h), sent_v = wave_of(v);
    for (int i = 0; i < DRAWS; i++) {
        const double complex kept = cexp(I * 2 * pi * 0.618034 * i);
        const double complex crossed = cexp(I * 2 * pi * 0.414214 * i);
        of_v[i] = wave_scattered(&sent_v, along, normal, back, &law, &t, kept, crossed);
        of_h[i] = wave_scattered(&sent_h, along, normal, back, &law, &t, kept, crossed);
        assert_close(wave_dot(&of_v[i], h), wave_dot(&of_h[i], v), 1e-9);
    }
    const double hv = mean_power(of_v, DRAWS, h), vv = mean_power(of_v, DRAWS, v);
    assert_near(10 * log10(hv / vv), -12.71, 0.02);
    assert_near(vv, 0.05 * cos(pi / 3), 1e-6);
}

/* Two scales (Valenzuela, Radio Science 13, 1978): a place tilted about the line of sight by d
 * crosses (hh - vv) sin d cos d of its own two. */
TEST(tilted_ground_crosses_by_geometry)
{
    struct reflect_law law = metal_law(REFLECT_SPM_HH);
    law.channel = REFLECT_HV;
    law.materials[0] = (struct reflect_material){.permittivity = 8,
                                                 .loss = 2,
                                                 .rms_height_m = 0.001,
                                                 .correlation_m = 0.02,
                                                 .spectrum = REFLECT_EXPONENTIAL,
                                                 .specular = 1,
                                                 .roughness = 1};
    const struct vec along = {sin(1.1), 0, -cos(1.1)}, back = vec_scale(along, -1);
    const struct vec h = {0, 1, 0}, v = vec_cross(h, along);
    for (double d = -0.6; d <= 0.6; d += 0.1) {
        /* the level normal, turned about the line of sight */
        const struct vec up = vec_mad((struct vec){0, 0, 1}, along, cos(1.1));
        const struct vec normal =
            vec_mad(vec_mad(vec_scale(along, -cos(1.1)), up, cos(d)), h, sin(1.1) * sin(d));
        const struct trace_record t = place_at(along, normal, back);
        const struct reflect_rough own = reflect_rough_of(&law, &t, -1, 0);
        const struct wave e = wave_of(v);
        const struct wave found = wave_scattered(&e, along, normal, back, &law, &t, 1, 0);
        const double complex level = -own.hh, upright = own.vv; /* level_back = -level */
        const double most = 1e-6 * cabs(upright);
        assert_near(cabs(wave_dot(&found, h)), cabs(level - upright) * fabs(sin(d) * cos(d)), most);
        assert_near(cabs(wave_dot(&found, v)),
                    cabs(level * sin(d) * sin(d) + upright * cos(d) * cos(d)), most);
    }
}

/* ---- whole targets ---- */

/* Sender and receiver may be exchanged: HV and VH of a whole target are one number. Rays are
 * followed one way alone, but they meet each seam from both of its faces. */
TEST(a_tank_returns_as_much_hv_as_vh)
{
    enum { LOOKS = 24 };
    const struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    double hv = 0, vh = 0, hh = 0;
    double complex both = 0;
    struct mesh m = {0};
    struct scene s;
    model_find("tank")->build(&m);
    for (int i = 0; i < LOOKS; i++) {
        struct trace_records r;
        const struct trace_order o = {.look = {i * 360.0 / LOOKS + 5, 15, lambda},
                                      .grid = {160, 160, 0.1},
                                      .rays_per_cell = 2,
                                      .bounces = TRACE_BOUNCES_MAX,
                                      .threads = 2};
        assert_int_equal(scene_open(&s, &m, trace_ground_half_m(&o.grid, 15), "tank"), 0);
        assert_int_equal(trace_run(&s, &o, "tank", &r, NULL), 0);
        scene_close(&s);
        const struct matrix t = matrix_of(&r, &law);
        hv += pow(cabs(t.hv), 2);
        vh += pow(cabs(t.vh), 2);
        hh += pow(cabs(t.hh), 2);
        both += t.hv * conj(t.vh);
    }
    mesh_free(&m);
    assert_near(10 * log10(hv / vh), 0, 2);
    assert_true(cabs(both) > 0.8 * sqrt(hv * vh));
    assert_true(hv > 0 && hv < hh);
}

/* A strip's edges, turned about the line of sight: the soft and the hard wave, each by its share of
 * both vectors. At 45 degrees HV is half of their difference. */
TEST(edges_cross_by_the_difference_of_their_waves)
{
    const struct trace_axes x = trace_axes_of(&look);
    struct reflect_law law = metal_law(REFLECT_FRESNEL_HH);
    double complex sums[REFLECT_CHANNELS] = {0}, straight[REFLECT_CHANNELS] = {0};
    for (int turned = 0; turned < 2; turned++) {
        const double d = turned * pi / 4;
        const struct vec u = vec_mad(vec_scale(x.across, cos(d)), x.rise, sin(d));
        const struct vec v = vec_mad(vec_scale(x.rise, cos(d)), x.across, -sin(d));
        const struct vec away = vec_mad(vec_scale(v, 0.1 * cos(0.6)), x.sight, 0.1 * sin(0.6));
        for (int c = REFLECT_HH; c < REFLECT_CHANNELS; c++) {
            struct mesh m = {0};
            struct scene s;
            struct edge_echoes e;
            law.channel = (enum reflect_channel)c;
            shape_plate(&m, vec_scale(u, -0.2), vec_scale(u, 0.4), away,
                        mesh_material(&m, "metal"));
            assert_int_equal(scene_open(&s, &m, 0, "test"), 0);
            assert_int_equal(edges_make(&e, &m, &s, &look, &law, 0.01), 0);
            for (size_t i = 0; i < e.count; i++) {
                (turned ? sums : straight)[c] += e.echoes[i].field;
            }
            edges_free(&e);
            scene_close(&s);
            mesh_free(&m);
        }
    }
    const double most = cabs(straight[REFLECT_HH]);
    assert_true(cabs(straight[REFLECT_HV]) < 1e-6 * most);
    assert_true(cabs(straight[REFLECT_HH] - straight[REFLECT_VV]) > 0.1 * most);
    assert_close(sums[REFLECT_HV], (straight[REFLECT_HH] - straight[REFLECT_VV]) / 2, 1e-3 * most);
    assert_close(sums[REFLECT_VH], sums[REFLECT_HV], 1e-6 * most);
    assert_close(sums[REFLECT_HH], (straight[REFLECT_HH] + straight[REFLECT_VV]) / 2, 1e-3 * most);
}
