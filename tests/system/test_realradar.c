/* The comparison with real radar. Echoes of points and noise show that the measuring is right; the
 * real data are held to what physics allows, loosely. */
#include "gis/gdal_start.h"
#include "realradar/class_order.h"
#include "realradar/point_response.h"
#include "realradar/speckle_statistics.h"

#include "check.h"
#include "hs/rng.h"
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

static const char gotcha_file[] = "gotcha_xband/data_3dsar_pass1_az001_HH.mat";
static const double pi = 3.14159265358979323846;

/* One degree of a circle of 7 km at 7.2 km height, in the north-east, X band, 600 MHz. */
static void make_flight(struct rr_phase_history *ph)
{
    assert_int_equal(rr_phase_history_alloc(ph, 400, 110), 0);
    ph->first_hz = 9.3e9;
    ph->step_hz = 1.5e6;
    for (int p = 0; p < ph->pulses; p++) {
        const double azimuth = (40 + p / 110.0) * pi / 180;
        ph->antenna[p] = (struct rr_place){7000 * cos(azimuth), 7000 * sin(azimuth), 7200};
        ph->reference_m[p] = hypot(7000, 7200) + 0.01 * p; /* not the distance to the centre */
    }
}

static void make_image(struct rr_image *image, const struct rr_phase_history *ph, double side_m)
{
    struct rr_profiles profiles;
    assert_int_equal(rr_compress(&profiles, ph, 0), 0);
    assert_int_equal(rr_image_make(image, &profiles, side_m, 0.2), 0);
    rr_profiles_free(&profiles);
}

static const struct rr_place point = {12.34, -7.77, 0};

TEST(a_point_is_found_in_the_picture_within_a_tenth_of_a_metre)
{
    struct rr_phase_history ph;
    struct rr_profiles profiles;
    struct rr_image image;
    struct rr_place found[3];
    struct rr_response response;
    make_flight(&ph);
    rr_phase_history_add_point(&ph, point, 3);
    make_image(&image, &ph, 44);
    const struct rr_resolution resolution = rr_resolution_of(&ph);
    assert_int_equal(rr_find_reflectors(&image, &resolution, found, 3), 1);
    assert_int_equal(rr_compress(&profiles, &ph, 0), 0);
    rr_response_measure(&response, &profiles, &resolution, found[0]);
    assert_true(rr_distance_m(response.place, point) < 0.1);
    /* And without refinement, to a pixel: the picture's columns and rows are where they should be.
     */
    assert_true(rr_distance_m(found[0], point) < 0.3);
    assert_true(fabs(response.power / 9 - 1) < 0.01);
    /* North is up and east is right. */
    const size_t row = (size_t)lround(109.5 - point.y / 0.2),
                 column = (size_t)lround(109.5 + point.x / 0.2);
    assert_true(image.power[row * 220 + column] > 9 * 0.5);
    rr_profiles_free(&profiles);
    rr_image_free(&image);
    rr_phase_history_free(&ph);
}

static void measure_point(struct rr_response *response, double taylor_db)
{
    struct rr_phase_history ph;
    struct rr_profiles profiles;
    make_flight(&ph);
    rr_phase_history_add_point(&ph, point, 1);
    const struct rr_resolution resolution = rr_resolution_of(&ph);
    assert_int_equal(rr_compress(&profiles, &ph, taylor_db), 0);
    rr_response_measure(response, &profiles, &resolution, point);
    rr_profiles_free(&profiles);
    rr_phase_history_free(&ph);
}

static void assert_cut(const struct rr_cut *cut, double irw_cells, double pslr_db)
{
    print_message("# IRW %.4f cells, PSLR %.2f dB, ISLR %.2f dB\n", cut->irw_cells, cut->pslr_db,
                  cut->islr_db);
    assert_true(fabs(cut->irw_cells / irw_cells - 1) < 0.05);
    assert_true(fabs(cut->pslr_db - pslr_db) < 1);
}

TEST(an_unweighted_point_has_the_width_and_sidelobes_of_the_sinc)
{
    struct rr_response response;
    measure_point(&response, 0);
    assert_cut(&response.range, 0.886, -13.26);
    assert_cut(&response.cross, 0.886, -13.26);
    /* The sinc's -9.7 dB, less what lies beyond the eight cells of the cut: 10 log10(0.0844 /
     * 0.9028). */
    assert_true(fabs(response.range.islr_db - -10.3) < 0.3);
}

TEST(a_weighted_point_has_those_of_taylors_table)
{
    struct rr_response response;
    measure_point(&response, 35);
    assert_cut(&response.range, 1.187, -35.2);
    assert_cut(&response.cross, 1.187, -35.2);
    measure_point(&response, 40);
    assert_true(response.range.irw_cells > 1.22 && response.range.pslr_db < -38.5);
}

/* The definition, term by term: no FFT, no interpolation. */
static double complex exact_focus(const struct rr_phase_history *ph, struct rr_place place)
{
    double complex sum = 0;
    for (int p = 0; p < ph->pulses; p++) {
        const double range_m = rr_distance_m(ph->antenna[p], place) - ph->reference_m[p];
        for (int n = 0; n < ph->frequencies; n++) {
            const double phase = 4 * pi * (ph->first_hz + n * ph->step_hz) * range_m / 299792458.0;
            sum += ph->echo[p * ph->frequencies + n] * cexp(I * phase);
        }
    }
    return sum / (ph->pulses * ph->frequencies);
}

TEST(back_projection_is_the_matched_filter_to_60_dB)
{
    struct rr_phase_history ph;
    struct rr_profiles profiles;
    struct hs_rng rng;
    make_flight(&ph);
    rr_phase_history_add_point(&ph, point, 1);
    rr_phase_history_add_point(&ph, (struct rr_place){-14, 9, 0}, 0.5);
    assert_int_equal(rr_compress(&profiles, &ph, 0), 0);
    double worst = 0;
    hs_rng_seed(&rng, 1);
    for (int i = 0; i < 24; i++) {
        const struct rr_place at = {point.x + 4 * hs_rng_uniform(&rng) - 2,
                                    point.y + 4 * hs_rng_uniform(&rng) - 2, 0};
        double complex fast;
        rr_focus(&profiles, &at, 1, &fast);
        worst = fmax(worst, cabs(fast - exact_focus(&ph, at)));
    }
    print_message("# worst difference %.5f of the brightest point\n", worst);
    assert_true(worst < 0.001);
    rr_profiles_free(&profiles);
    rr_phase_history_free(&ph);
}

TEST(noise_seen_through_the_processing_keeps_one_looks_statistics)
{
    struct rr_phase_history ph;
    struct rr_image image;
    static struct rr_ground ground;
    make_flight(&ph);
    rr_phase_history_fill_noise(&ph, 7);
    make_image(&image, &ph, 52);
    const struct rr_resolution resolution = rr_resolution_of(&ph);
    assert_int_equal(rr_ground_measure(&ground, &image, &resolution), 0);
    const struct rr_statistics *s = &ground.pooled;
    const double cells = ground.cells * ground.bright;
    print_message("# %.0f cells: CV %.3f, amplitude %.3f, %.2f dB, KS %.4f\n", cells,
                  s->cv_intensity, s->cv_amplitude, s->db_std, s->ks);
    assert_true(ground.bright >= 8);
    assert_true(fabs(s->cv_intensity - 1) < 3 / sqrt(cells) + 0.01);
    assert_true(fabs(s->cv_amplitude - 0.523) < 0.02 && fabs(s->db_std - 5.57) < 0.2);
    rr_image_free(&image);
    rr_phase_history_free(&ph);
}

TEST(a_bright_corner_is_no_even_ground)
{
    struct rr_image image = {.side_px = 2 * RR_WINDOW_PX, .pixel_m = 0.2};
    struct rr_window windows[8];
    const size_t count = (size_t)image.side_px * (size_t)image.side_px;
    image.power = malloc(count * sizeof *image.power);
    assert_non_null(image.power);
    for (size_t i = 0; i < count; i++) {
        image.power[i] = 1;
    }
    image.power[0] = 1e4;
    const int kept = rr_choose_windows(&image, 0.3, windows, 8);
    assert_true(kept >= 1);
    for (int i = 0; i < kept; i++) {
        assert_true(windows[i].column > 0 || windows[i].row > 0);
    }
    rr_image_free(&image);
}

TEST(statistics_of_known_numbers_are_as_computed_by_hand)
{
    struct rr_statistics s;
    double pair[] = {9, 1};
    rr_statistics_of(&s, pair, 2);
    assert_true(fabs(s.mean - 5) < 1e-12);
    assert_true(fabs(s.cv_intensity - sqrt(32) / 5) < 1e-12);
    assert_true(fabs(s.cv_amplitude - sqrt(2) / 2) < 1e-12);
    assert_true(fabs(s.db_std - 10 * log10(9) / sqrt(2)) < 1e-12);
    assert_true(fabs(s.enl - 25.0 / 32) < 1e-12);
    /* The law is 0.1813 at 1 and 0.8347 at 9, the steps go 0, 1/2, 1. */
    assert_true(fabs(s.ks - (exp(-9.0 / 5) * -1 + 1 - 0.5)) < 1e-12);
}

TEST(the_firmwares_speckle_is_one_look_where_it_says_one_and_not_where_it_says_four)
{
    enum { SIDE = 512, CELLS = SIDE * SIDE };
    static double power[CELLS];
    struct rr_statistics s;
    rr_firmware_speckle(power, SIDE, 0, 3);
    rr_statistics_of(&s, power, CELLS);
    assert_true(fabs(s.mean - 1) < 0.01 && fabs(s.cv_intensity - 1) < 0.03);
    assert_true(fabs(s.cv_amplitude - 0.523) < 0.01 && fabs(s.db_std - 5.57) < 0.06);
    assert_true(s.ks < 0.01); /* a step of the grain has up to 1/80 */
    rr_firmware_speckle(power, SIDE, 2, 3);
    rr_statistics_of(&s, power, CELLS);
    assert_true(fabs(s.enl / 4 - 1) < 0.1 && fabs(s.db_std - 2.31) < 0.05);
    assert_true(s.ks > 0.1);
}

TEST(rank_correlation_agrees_with_a_worked_example)
{
    /* Ten pairs without ties whose squared differences of rank add up to 194: 1 - 6 * 194 / 990. */
    const float a[] = {106, 100, 86, 101, 99, 103, 97, 113, 112, 110};
    const float b[] = {7, 27, 2, 50, 28, 29, 20, 12, 6, 17};
    assert_true(fabs(rr_rank_correlation(a, b, 10) - -29.0 / 165) < 1e-6);
    const float tied[] = {1, 1, 2}, rising[] = {1, 2, 3}, flat[] = {4, 4, 4};
    assert_true(fabs(rr_rank_correlation(tied, rising, 3) - sqrt(0.75)) < 1e-6);
    assert_true(isnan(rr_rank_correlation(flat, rising, 3)));
}

/* What a MATLAB file of the tests shall have wrong. */
enum flaw { NO_FLAW, PACKED, NO_RANGES, UNEVEN, NOT_FINITE, SHORT_ANTENNA, NO_STRUCT, FLAWS };

/* A growing file in memory, and the elements of which MATLAB files are made. */
struct bytes {
    uint8_t at[4096];
    size_t size;
};

static void add(struct bytes *b, const void *data, size_t size)
{
    assert_true(b->size + size <= sizeof b->at);
    memcpy(b->at + b->size, data, size);
    b->size += size;
}

static void add_element(struct bytes *b, uint32_t type, const void *data, size_t size)
{
    static const uint8_t zeros[8] = {0};
    const uint32_t tag[] = {type, (uint32_t)size};
    add(b, tag, sizeof tag);
    add(b, data, size);
    add(b, zeros, (8 - size % 8) % 8);
}

enum {
    MI_INT8 = 1,
    MI_INT16 = 3,
    MI_INT32 = 5,
    MI_UINT32,
    MI_DOUBLE = 9,
    MI_MATRIX = 14,
    MI_COMPRESSED
};

static void begin_matrix(struct bytes *b, uint32_t flags, int32_t rows, int32_t columns,
                         const char *name)
{
    const uint32_t both[] = {flags, 0};
    const int32_t size[] = {rows, columns};
    add_element(b, MI_UINT32, both, sizeof both);
    add_element(b, MI_INT32, size, sizeof size);
    add_element(b, MI_INT8, name, strlen(name));
}

static void add_array(struct bytes *b, int32_t rows, int32_t columns, const double *values)
{
    struct bytes m = {.size = 0};
    begin_matrix(&m, 6, rows, columns, "");
    add_element(&m, MI_DOUBLE, values, (size_t)(rows * columns) * sizeof *values);
    add_element(b, MI_MATRIX, m.at, m.size);
}

/* Four frequencies and three pulses; the real part packed into 16-bit numbers, as MATLAB does. */
static void add_echo(struct bytes *b)
{
    struct bytes m = {.size = 0};
    int16_t real[12];
    double imaginary[12];
    for (int i = 0; i < 12; i++) {
        real[i] = (int16_t)i;
        imaginary[i] = -i - 0.5;
    }
    begin_matrix(&m, 6 | 0x08 << 8, 4, 3, "");
    add_element(&m, MI_INT16, real, sizeof real);
    add_element(&m, MI_DOUBLE, imaginary, sizeof imaginary);
    add_element(b, MI_MATRIX, m.at, m.size);
}

static void make_struct(struct bytes *b, enum flaw flaw)
{
    static const char names[6][8] = {"fp", "freq", "x", "y", "z", "r0"};
    double freq[] = {9e9, 9.1e9, 9.2e9, 9.3e9};
    double x[] = {100, 101, 102}, y[] = {-1, 0, 1}, z[] = {50, 50, 51}, r0[] = {110, 111, 112};
    freq[1] += flaw == UNEVEN ? 5e7 : 0;
    y[1] = flaw == NOT_FINITE ? NAN : y[1];
    begin_matrix(b, 2, 1, 1, flaw == NO_STRUCT ? "other" : "data");
    const uint32_t small_element[] = {4u << 16 | MI_INT32, sizeof names[0]};
    add(b, small_element, sizeof small_element);
    add_element(b, MI_INT8, names, flaw == NO_RANGES ? 5 * sizeof names[0] : sizeof names);
    add_echo(b);
    add_array(b, 4, 1, freq);
    add_array(b, 1, flaw == SHORT_ANTENNA ? 2 : 3, x);
    add_array(b, 1, 3, y);
    add_array(b, 1, 3, z);
    add_array(b, 1, 3, r0);
}

static void make_mat(struct bytes *file, enum flaw flaw)
{
    static const uint16_t version_and_order[] = {0x0100, 0x4d49};
    struct bytes data = {.size = 0};
    *file = (struct bytes){.size = 124};
    memset(file->at, ' ', file->size);
    add(file, version_and_order, sizeof version_and_order);
    make_struct(&data, flaw);
    if (flaw != PACKED) {
        add_element(file, MI_MATRIX, data.at, data.size);
        return;
    }
    struct bytes whole = {.size = 0};
    uint8_t packed[4096];
    uLongf size = sizeof packed;
    add_element(&whole, MI_MATRIX, data.at, data.size);
    assert_int_equal(compress(packed, &size, whole.at, whole.size), Z_OK);
    const uint32_t tag[] = {MI_COMPRESSED, (uint32_t)size};
    add(file, tag, sizeof tag);
    add(file, packed, size);
}

static void write_bytes(const char *path, const struct bytes *b)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(b->at, 1, b->size, f), b->size);
    assert_int_equal(fclose(f), 0);
}

static void write_mat(const char *path, enum flaw flaw)
{
    struct bytes file;
    make_mat(&file, flaw);
    write_bytes(path, &file);
}

static void mat_path(char *path, size_t size, const char *name)
{
    assert_int_equal(support_run("mkdir -p %s/tmp/realradar", support_build_dir()), 0);
    snprintf(path, size, "%s/tmp/realradar/%s", support_build_dir(), name);
}

TEST(a_matlab_file_is_read_value_for_value_plain_or_packed)
{
    char path[512];
    struct rr_phase_history ph;
    mat_path(path, sizeof path, "good.mat");
    for (int flaw = NO_FLAW; flaw <= PACKED; flaw++) {
        write_mat(path, (enum flaw)flaw);
        assert_int_equal(rr_phase_history_read(&ph, path), 0);
        assert_int_equal(ph.frequencies, 4);
        assert_int_equal(ph.pulses, 3);
        assert_true(fabs(ph.first_hz - 9e9) < 1 && fabs(ph.step_hz - 1e8) < 1);
        assert_true(fabs(ph.antenna[2].x - 102) < 1e-9 && fabs(ph.antenna[2].z - 51) < 1e-9);
        assert_true(fabs(ph.reference_m[1] - 111) < 1e-9);
        assert_true(cabs(ph.echo[4 * 1 + 2] - (6 - 6.5 * I)) < 1e-9);
        rr_phase_history_free(&ph);
    }
}

/* Torn anywhere and with any byte changed, the file is read or refused; a wild read would end the
 * test. */
TEST(a_damaged_matlab_file_is_read_or_refused)
{
    char path[512];
    int refused = 0, saved = dup(STDERR_FILENO);
    struct rr_phase_history ph;
    struct hs_rng rng;
    mat_path(path, sizeof path, "damaged.mat");
    hs_rng_seed(&rng, 5);
    assert_non_null(freopen("/dev/null", "w", stderr));
    for (int i = 0; i < 2000; i++) {
        struct bytes file;
        make_mat(&file, i % 4 ? NO_FLAW : PACKED);
        for (int k = 0; k < 1 + i % 3; k++) {
            const uint32_t place = 124 + hs_rng_below(&rng, (uint32_t)file.size - 124);
            file.at[place] = (uint8_t)hs_rng_u64(&rng);
        }
        file.size = i % 5 ? file.size : hs_rng_below(&rng, (uint32_t)file.size);
        write_bytes(path, &file);
        const int status = rr_phase_history_read(&ph, path);
        refused += status != 0;
        rr_phase_history_free(&ph);
    }
    int cut_short_and_read = 0;
    struct bytes whole;
    make_mat(&whole, NO_FLAW);
    for (struct bytes cut = whole; cut.size > 0;) {
        cut.size--;
        write_bytes(path, &cut);
        cut_short_and_read += rr_phase_history_read(&ph, path) == 0;
        rr_phase_history_free(&ph);
    }
    fflush(stderr);
    dup2(saved, STDERR_FILENO);
    close(saved);
    print_message("# %d of 2000 refused\n", refused);
    assert_in_range(refused, 800, 1999);
    assert_int_equal(cut_short_and_read, 0);
}

TEST(a_file_that_is_no_phase_history_is_refused_by_name)
{
    char path[512];
    mat_path(path, sizeof path, "bad.mat");
    for (int flaw = NO_RANGES; flaw < FLAWS; flaw++) {
        write_mat(path, (enum flaw)flaw);
        assert_int_equal(support_run("%s/bin/landmass-realradar focus %s >%s.out 2>%s.err",
                                     support_build_dir(), path, path, path),
                         1);
        assert_int_equal(support_run("test ! -s %s.out && grep -q 'bad.mat: ' %s.err", path, path),
                         0);
    }
    assert_int_equal(support_run("echo text >%s; %s/bin/landmass-realradar focus %s 2>%s.err", path,
                                 support_build_dir(), path, path),
                     1);
    assert_int_equal(support_run("grep -q 'bad.mat: is not a MATLAB file' %s.err", path), 0);
}

TEST(the_real_speckle_is_one_look_and_the_road_darker_than_the_grass)
{
    char path[1024];
    if (!support_data_path(gotcha_file, path, sizeof path)) {
        skip();
    }
    struct rr_phase_history ph;
    struct rr_image image;
    static struct rr_ground ground;
    assert_int_equal(rr_phase_history_read(&ph, path), 0);
    make_image(&image, &ph, 100);
    const struct rr_resolution resolution = rr_resolution_of(&ph);
    assert_int_equal(rr_ground_measure(&ground, &image, &resolution), 0);
    const struct rr_statistics *s = &ground.pooled;
    print_message("# %d windows: CV %.3f, amplitude %.3f, %.2f dB, KS %.4f\n", ground.bright,
                  s->cv_intensity, s->cv_amplitude, s->db_std, s->ks);
    assert_true(ground.bright >= 5 && ground.count > ground.bright);
    assert_true(s->cv_intensity > 0.9 && s->cv_intensity < 1.15);
    assert_true(s->cv_amplitude > 0.49 && s->cv_amplitude < 0.57);
    assert_true(s->db_std > 5.2 && s->db_std < 6 && s->ks < 0.04);
    const double darkest = ground.windows[ground.count - 1].mean / ground.windows[0].mean;
    assert_true(darkest < 0.4);
    rr_image_free(&image);
    rr_phase_history_free(&ph);
}

/* Every degree of the pass that is at hand. Without weighting, side lobes of cars lie over the
 * grass of some. The cells are those of the unweighted aperture, so the limit of Stephens is
 * strict. */
TEST(grass_of_each_degree_is_exponential_when_side_lobes_are_held_down)
{
    int degrees = 0;
    for (int degree = 1; degree <= 4; degree++) {
        char name[64], path[1024];
        snprintf(name, sizeof name, "gotcha_xband/data_3dsar_pass1_az%03d_HH.mat", degree);
        if (!support_data_path(name, path, sizeof path)) {
            continue;
        }
        struct rr_phase_history ph;
        struct rr_profiles profiles;
        struct rr_image image;
        static struct rr_ground ground;
        assert_int_equal(rr_phase_history_read(&ph, path), 0);
        const struct rr_resolution resolution = rr_resolution_of(&ph);
        assert_int_equal(rr_compress(&profiles, &ph, 35), 0);
        assert_int_equal(rr_image_make(&image, &profiles, 100, 0.2), 0);
        assert_int_equal(rr_ground_measure(&ground, &image, &resolution), 0);
        const double limit = 1.094 / sqrt(ground.cells * ground.bright);
        print_message("# degree %d: %d windows, KS %.4f, limit %.4f\n", degree, ground.bright,
                      ground.pooled.ks, limit);
        assert_true(ground.pooled.ks < limit);
        degrees++;
        rr_image_free(&image);
        rr_profiles_free(&profiles);
        rr_phase_history_free(&ph);
    }
    if (degrees == 0) {
        skip();
    }
}

TEST(real_reflectors_are_as_sharp_as_band_and_aperture_allow)
{
    char path[1024];
    if (!support_data_path(gotcha_file, path, sizeof path)) {
        skip();
    }
    struct rr_phase_history ph;
    struct rr_profiles profiles;
    struct rr_image image;
    struct rr_place found[5];
    assert_int_equal(rr_phase_history_read(&ph, path), 0);
    const struct rr_resolution resolution = rr_resolution_of(&ph);
    assert_int_equal(rr_compress(&profiles, &ph, 0), 0);
    assert_int_equal(rr_image_make(&image, &profiles, 100, 0.2), 0);
    const int count = rr_find_reflectors(&image, &resolution, found, 5);
    assert_true(count >= 2);
    for (int i = 0; i < count; i++) {
        struct rr_response r;
        rr_response_measure(&r, &profiles, &resolution, found[i]);
        assert_true(fabs(r.range.irw_cells / 0.886 - 1) < 0.05);
        assert_true(fabs(r.cross.irw_cells / 0.886 - 1) < 0.05);
        assert_true(fabs(r.range.pslr_db - -13.26) < 2.5 && fabs(r.cross.pslr_db - -13.26) < 1.5);
    }
    rr_image_free(&image);
    rr_profiles_free(&profiles);
    rr_phase_history_free(&ph);
}

TEST(a_torn_copy_of_the_real_file_is_refused_by_name)
{
    char real[1024], torn[512];
    if (!support_data_path(gotcha_file, real, sizeof real)) {
        skip();
    }
    mat_path(torn, sizeof torn, "torn.mat");
    assert_int_equal(support_run("head -c 200000 %s >%s", real, torn), 0);
    assert_int_equal(support_run("%s/bin/landmass-realradar focus %s >%s.out 2>%s.err",
                                 support_build_dir(), torn, torn, torn),
                     1);
    assert_int_equal(
        support_run("test ! -s %s.out && grep -q '^landmass-realradar: .*torn.mat: ' %s.err", torn,
                    torn),
        0);
}

static void compare_classes(struct rr_class_order *order, const char *folder, const char *raster,
                            const char *radar)
{
    struct db_class_table table;
    char classes[1024], reflectivity[1024];
    snprintf(classes, sizeof classes, "%s/%s", folder, raster);
    snprintf(reflectivity, sizeof reflectivity, "%s/reflectivity.tif", folder);
    assert_int_equal(db_class_table_read(&table, "host-sim/programs/db/classes/heaton6.classes"),
                     0);
    assert_int_equal(rr_class_order_compare(
                         order, &(struct rr_class_source){&table, classes, reflectivity, radar}),
                     0);
    print_message("# %s: rank correlation %.2f of classes, %.2f of pixels\n", raster,
                  order->class_correlation, order->pixel_correlation);
}

TEST(classes_rank_as_a_real_radar_ranks_them)
{
    enum { SOIL, ASPHALT, CONCRETE, STRUCTURE, VEGETATION, WATER };
    char radar[1024], data[1024], folder[512];
    struct rr_class_order order;
    if (!support_data_path("sen1floods11_spain_s1_s2/Spain_7370579_S1Hand.tif", radar,
                           sizeof radar) ||
        !support_data_path("", data, sizeof data)) {
        skip();
    }
    mat_path(folder, sizeof folder, "orihuela");
    assert_int_equal(
        support_run("sh host-sim/programs/realradar/realradar.sh %s/bin %s %s orihuela >%s.log "
                    "2>&1 || { cat %s.log; exit 1; }",
                    support_build_dir(), data, folder, folder, folder),
        0);
    db_gdal_start();
    compare_classes(&order, folder, "classes.tif", radar);
    assert_int_equal(order.count, 5);
    assert_int_equal(order.rows[0].class_index, WATER);
    assert_int_equal(order.rows[4].class_index, STRUCTURE);
    assert_true(order.class_correlation >= 0.6);
    compare_classes(&order, folder, "exemplars.tif", radar);
    assert_int_equal(order.rows[0].class_index, WATER);
    assert_int_equal(order.rows[1].class_index, ASPHALT);
    assert_int_equal(order.rows[2].class_index, SOIL);
    assert_int_equal(order.rows[3].class_index, VEGETATION);
    assert_int_equal(order.rows[4].class_index, STRUCTURE);
    assert_true(order.class_correlation > 0.99 && order.pixel_correlation > 0.6);
}
