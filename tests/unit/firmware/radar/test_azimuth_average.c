/* The ground across a sample: how well a few azimuths stand for all that the beam sees, against the
 * double-precision reference sampled 32 times as densely, and against theory where strips of ground
 * run along the line of sight. */
#include "lm/azimuth_average.h"

#include "check.h"
#include "hs/angle.h"
#include "hs/rng.h"
#include "reference_support.h"
#include "scales.h"
#include "sector_world.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- the mean ---- */

TEST(the_azimuths_are_the_middles_of_equal_parts_and_the_last_is_next_to_the_middle)
{
    const fx_bam_t spacing = FX_BAM_DEG(120) / 128;
    for (uint32_t log2 = 0; log2 <= LM_AZIMUTH_AVERAGE_LOG2_MAX; log2++) {
        const uint32_t azimuths = 1u << log2;
        uint32_t met = 0;
        for (uint32_t turn = 0; turn < azimuths; turn++) {
            const double off = (double)lm_azimuth_average_offset(spacing, log2, turn) / spacing;
            const double part = (off + 0.5) * azimuths - 0.5;
            assert_true(fabs(part - round(part)) < 1e-6);
            assert_in_range((uint32_t)lround(part), 0, azimuths - 1);
            met |= 1u << lround(part);
            assert_true(turn + 1 < azimuths || fabs(off) <= 0.5 / azimuths);
        }
        assert_int_equal(met, (1u << azimuths) - 1);
    }
}

TEST(the_mean_is_that_of_the_powers)
{
    static struct lm_azimuth_average f;
    static int16_t level_q8[8][LM_CELLS_ROOM], mean_q8[LM_CELLS_ROOM];
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    for (uint32_t log2 = 1; log2 <= LM_AZIMUTH_AVERAGE_LOG2_MAX; log2++) {
        for (uint32_t k = 0; k < 1u << log2; k++) {
            for (uint32_t i = 0; i < LM_CELLS_MAX; i++) {
                const bool is_dark = i < 10 || hs_rng_below(&rng, 4) == 0;
                const int32_t any_q8 = (int32_t)hs_rng_below(&rng, 70 * 256) - 50 * 256;
                level_q8[k][i] = is_dark ? LM_LEVEL_SHADOW : (int16_t)any_q8;
            }
            if (k == 0) {
                lm_azimuth_average_begin(&f, level_q8[k], LM_CELLS_MAX);
            } else if (k + 1 < 1u << log2) {
                lm_azimuth_average_add(&f, level_q8[k], LM_CELLS_MAX);
            }
        }
        memcpy(mean_q8, level_q8[(1u << log2) - 1], sizeof mean_q8);
        lm_azimuth_average_mean(&f, log2, mean_q8, LM_CELLS_MAX);
        for (uint32_t i = 0; i < LM_CELLS_MAX; i++) {
            double power = 0;
            for (uint32_t k = 0; k < 1u << log2; k++) {
                power += level_q8[k][i] == LM_LEVEL_SHADOW ? 0 : pow(10, level_q8[k][i] / 2560.0);
            }
            if (power == 0) {
                assert_in_range(mean_q8[i] - LM_LEVEL_SHADOW, 0, 32); /* 1/8 dB */
            } else {
                const double wanted_db = 10 * log10(power / (1u << log2));
                assert_true(fabs(mean_q8[i] / 256.0 - wanted_db) < 0.15);
            }
        }
    }
}

/* ---- what the beam sees ---- */

/* A country of 26 km of the test's content, flown over from south to north. */
static struct sector_world *make_country(const struct tiny_spec *content)
{
    struct tiny_spec spec = *content;
    spec.shift0 = 12;
    spec.rows = spec.columns = 12;
    struct sector_world *w = make_sector_world(&spec);
    w->platform = (struct lm_platform){
        .position = {w->map.db.centre_latitude - (fx_bam_t)lround(0.11 / 360 * 0x1p32),
                     w->map.db.centre_longitude},
        .height_m_q10 = 4000 * 1024,
        .track = FX_BAM_90, /* fast and across: as little speckle as there is */
        .speed_mm_s = 2000000};
    return w;
}

/* The reference's power in each bin along one azimuth from the sector's middle. */
static void look_along(const struct sector_world *w, const struct ref_db *db, double azimuth_deg,
                       const struct ref_params *params, double *power)
{
    const struct lm_sector *s = &w->sector;
    const uint32_t cells = s->grid.cells;
    const struct ref_place from = {hs_degrees(w->platform.position.latitude),
                                   hs_degrees(w->platform.position.longitude)};
    const double cell_m = s->grid.cell_m_q8 / 256.0, edge_m = s->ground_edge_m_q8 / 256.0;
    const struct ref_view view = {s->grid.height_m_q10 / 1024.0, s->grid.reference_m_q10 / 1024.0,
                                  cell_m};
    const struct ref_antenna antenna = {.elevation_beam_deg =
                                            hs_degrees(w->radar.antenna.elevation_beam),
                                        .fan_deg = hs_degrees(w->radar.antenna.fan)};
    const struct ref_bins bins = {s->slant.first_m_q8 / 256.0, s->slant.cell_m_q8 / 256.0,
                                  s->slant.cells};
    struct ref_bin ground[LM_CELLS_MAX] = {0};
    double of_cells[LM_CELLS_MAX];
    for (uint32_t i = 0; i < cells; i++) {
        struct ref_bin *g = &ground[i];
        g->range_m = edge_m + (i + 0.5) * cell_m;
        g->place = ref_geo_direct(from, hs_degrees(s->up) + azimuth_deg, g->range_m);
        ref_db_cell(db, s->lod, g->place, g);
        (void)ref_db_elevation(db, s->lod, g->place, true, &g->elevation_m);
    }
    const size_t first = ref_first_shown(ground, cells, &view);
    ref_illuminate(ground, cells, &view, params, ref_gm_horizon(&ground[first], &view));
    for (uint32_t i = 0; i < cells; i++) {
        ground[i].echo_db = ground[i].level_db;
    }
    ref_sample_power(ground, cells, &antenna, hs_degrees((fx_bam_t)s->tilt), of_cells);
    ref_slant_power(&bins, view.antenna_m - view.reference_m, edge_m, cell_m, of_cells, cells,
                    power);
}

enum { DENSER = 32, LINES_MAX = 256 };

/* What the beam sees on each line: the whole of its pattern, azimuths 1/32 of a sample apart. */
static void see_all(const struct sector_world *w, const struct ref_db *db,
                    const struct ref_params *params, double seen[LINES_MAX][LM_CELLS_MAX])
{
    const struct lm_sector *s = &w->sector;
    const double sample_deg = hs_degrees(w->radar.sample), step_deg = sample_deg / DENSER;
    const struct ref_beam beam = {hs_degrees(w->radar.antenna.azimuth_beam), sample_deg, 1};
    const double from_deg = hs_degrees((fx_bam_t)s->left) - 4 * sample_deg;
    const long steps = lround((s->lines * hs_degrees(s->width) + 8 * sample_deg) / step_deg);
    static double weights[LINES_MAX];
    memset(weights, 0, sizeof weights);
    memset(seen, 0, LINES_MAX * sizeof *seen);
    for (long n = 0; n < steps; n++) {
        double power[LM_CELLS_MAX];
        const double azimuth_deg = from_deg + ((double)n + 0.5) * step_deg;
        look_along(w, db, azimuth_deg, params, power);
        for (uint32_t k = 0; k < s->lines; k++) {
            const double off_deg = line_azimuth_deg(s, k) - azimuth_deg;
            const double weight =
                fabs(off_deg) < 4 * sample_deg ? ref_beam_pattern(&beam, off_deg) : 0;
            weights[k] += weight;
            for (uint32_t i = 0; i < s->slant.cells && weight > 0; i++) {
                seen[k][i] += weight * power[i];
            }
        }
    }
    for (uint32_t k = 0; k < s->lines; k++) {
        for (uint32_t i = 0; i < s->slant.cells; i++) {
            seen[k][i] /= weights[k];
        }
        ref_pulse(
            seen[k], s->slant.cells,
            ref_pulse_m(w->radar.range[s->command.range_index].pulse_ns[s->command.fov] * 1e-9) /
                (s->slant.cell_m_q8 / 256.0));
    }
}

/* The rms of what a sweep with 2^azimuths_log2 azimuths a sample is off, dB, where there is
 * anything to see. */
static double rms_of_sweep(struct sector_world *w, const struct lm_sector_command *command,
                           uint8_t azimuths_log2, double seen[LINES_MAX][LM_CELLS_MAX])
{
    double squares = 0, values = 0;
    w->radar.fov[command->fov].azimuths_log2 = azimuths_log2;
    start_sector(w, command, NULL, NULL);
    do {
        const uint32_t line = draw_line(w);
        for (uint32_t i = 0; i < w->sector.slant.cells; i++) {
            if (seen[line][i] > 1e-5) {
                const double power = fmax(ldexp(w->sector.power_q24[i], -24), 1e-6);
                squares += pow(10 * log10(power / seen[line][i]), 2);
                values++;
            }
        }
    } while (!lm_sector_is_at_edge(&w->sector));
    assert_true(values > 5000);
    return sqrt(squares / values);
}

TEST(the_table_brings_samples_near_to_what_the_beam_sees)
{
    /* Lakes, woods and blocks of houses 190 m apart over hills. */
    double scale = 2.1;
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = scene_cell;
    spec.elevation_m = scene_elevation_m;
    spec.ctx = &scale;
    struct sector_world *w = make_country(&spec);
    const struct lm_sector_command commands[] = {
        {.mode = LM_SECTOR_GM, .range_index = scale_of(10), .azimuth_index = 2},
        {.mode = LM_SECTOR_GM,
         .range_index = scale_of(10),
         .fov = LM_FOV_EXP,
         .centre = place_at(w, 0, 14000)}};
    struct ref_db db;
    assert_int_equal(ref_db_open_memory(&db, w->map.image.bytes, w->map.image.size, "country"), 0);
    static double seen[LINES_MAX][LM_CELLS_MAX];
    for (size_t i = 0; i < 2; i++) {
        const struct lm_sector_command *command = &commands[i];
        const uint8_t table = lm_radar_default.fov[command->fov].azimuths_log2;
        struct ref_params params =
            params_of(&w->radar, -INFINITY, &w->radar.mode[0].tone, &w->radar.sar.speckle);
        start_sector(w, command, NULL, NULL);
        draw_line(w);
        see_all(w, &db, &params, seen);
        double rms_db[LM_AZIMUTH_AVERAGE_LOG2_MAX + 1];
        for (int log2 = 0; log2 <= LM_AZIMUTH_AVERAGE_LOG2_MAX; log2++) {
            rms_db[log2] = rms_of_sweep(w, command, (uint8_t)log2, seen);
        }
        print_message("# field %d: rms %.2f, %.2f, %.2f, %.2f dB by 1, 2, 4, 8 azimuths a sample\n",
                      command->fov, rms_db[0], rms_db[1], rms_db[2], rms_db[3]);
        assert_true(rms_db[table] < 0.6 * rms_db[0]);
    }
    ref_db_close(&db);
    free_sector_world(w);
}

/* ---- strips along the line of sight ---- */

struct strips {
    double apart_m, wide_m, off_m; /* of strips that run north */
};

static struct tiny_cell strip_cell(void *ctx, const struct tiny_place *p)
{
    const struct strips *s = ctx;
    const bool is_strip = fabs(remainder(p->east_m - s->off_m, s->apart_m)) < s->wide_m / 2;
    return (struct tiny_cell){is_strip ? 0 : -40, TINY_SOIL, 0};
}

/* Power of a strip, added up over the lines, in units of what its width is worth. */
static double worth_of_strip(double off_m, uint8_t azimuths_log2)
{
    struct strips strips = {.apart_m = 60000, .wide_m = 160, .off_m = off_m};
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = strip_cell;
    spec.ctx = &strips;
    struct sector_world *w = make_country(&spec);
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM,
                                              .range_index = scale_of(10),
                                              .fov = LM_FOV_EXP,
                                              .centre = place_at(w, 0, 15000)};
    double sum = 0, expected = 0;
    w->radar.fov[LM_FOV_EXP].azimuths_log2 = azimuths_log2;
    start_sector(w, &command, NULL, NULL);
    do {
        draw_line(w);
        for (uint32_t i = 180; i < 200; i++) { /* 350 m about the middle */
            const double slant_m =
                (w->sector.slant.first_m_q8 + i * w->sector.slant.cell_m_q8) / 256.0;
            sum += (ldexp(w->sector.power_q24[i], -24) - 1e-4) * hs_degrees(w->sector.width);
            expected += strips.wide_m / sqrt(slant_m * slant_m - 16e6) * 57.29578 / w->sector.lines;
        }
    } while (!lm_sector_is_at_edge(&w->sector));
    free_sector_world(w);
    return sum / expected;
}

/* Theory: a strip w wide at range s, along the line of sight, is w / s radians of the beam's sweep
 * over it, so that the power added up over the lines is gamma w / s, wherever it lies. Parts of a
 * quarter of a sample, 61 m, count it within one of them, and so does the map's cell of 27 m; a
 * whole sample, 245 m, meets it or does not. */
TEST(a_strip_along_the_line_of_sight_counts_by_its_width_wherever_it_lies)
{
    enum { PLACES = 8 };
    double least[2] = {INFINITY, INFINITY}, most[2] = {0, 0};
    const uint8_t log2[2] = {0, lm_radar_default.fov[LM_FOV_EXP].azimuths_log2};
    for (int k = 0; k < PLACES; k++) {
        for (int i = 0; i < 2; i++) {
            const double worth = worth_of_strip(31 * k, log2[i]);
            least[i] = fmin(least[i], worth), most[i] = fmax(most[i], worth);
        }
    }
    for (int i = 0; i < 2; i++) {
        print_message("# %d azimuths a sample: strips count %.2f to %.2f of their width\n",
                      1 << log2[i], least[i], most[i]);
    }
    assert_true(least[0] < 0.1);
    assert_true(least[1] > 0.7 && most[1] < 1.3);
}
