/* A sweep against the double-precision reference, stage by stage: what a sample shows, what the
 * antenna leaves of it, slant range, beam, receiver. Each stage is judged on what the firmware's
 * stage before it handed on, so that no error hides behind another. */
#include "check.h"
#include "reference_support.h"
#include "sector_world.h"

#include "hs/angle.h"
#include "scales.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum stage { SAMPLE, ELEVATION, SLANT, BEAM, RECEIVER, STAGES };

/* Of power, that a pulse over nine bins may lose (receiver.c); 20 dB below what is black. */
enum { PULSE_STEPS = 9 };

static const char *const stage_names[STAGES] = {"sample", "elevation", "slant", "beam", "receiver"};

struct score {
    uint32_t values, beyond_half_db;
    double squares, worst_db;
};

/* A sweep that is being judged. */
struct trial {
    struct sector_world *w;
    struct ref_params params;
    double noise_db[REF_SPECKLE_SLICES];
    double grain_row;                         /* of the line, from where the sweep's grain begins */
    struct ref_leak leak[REF_LEAK_STRETCHES]; /* of the lines so far */
    struct ref_environment environment;
    const struct lm_environment *weather; /* NULL: fair */
    struct score score[STAGES];
    uint32_t pixels, beyond_1_grey;
};

static double metres(uint32_t q8)
{
    return q8 / 256.0;
}

/* What lies below the least power that the firmware tells from none is all the same. */
static double shown(double level_db)
{
    return fmax(level_db, -72);
}

static void note(struct score *s, double error_db)
{
    s->values++;
    s->squares += error_db * error_db;
    s->worst_db = fmax(s->worst_db, fabs(error_db));
    s->beyond_half_db += fabs(error_db) > 0.5;
}

/* Powers are whole steps of 2^-24, of which a stage may lose `steps`: what differs by no more is as
 * good as it gets. */
static void note_power(struct score *s, double power, double wanted, int steps)
{
    const double step = ldexp(1, -24);
    const bool is_within = fabs(power - wanted) <= steps * step;
    note(s, is_within ? 0 : 10 * log10(fmax(power, step) / fmax(wanted, step)));
}

static double height_m(const struct lm_sector *s)
{
    return (s->grid.height_m_q10 - s->grid.reference_m_q10) / 1024.0;
}

/* ---- what a sample shows ---- */

static double horizon_of(const struct lm_sector *s, const struct ref_bin *bins, size_t cells,
                         const struct ref_view *view)
{
    const size_t first = ref_first_shown(bins, cells, view);
    const bool is_open = s->foreground.grid.cells == 0 || s->foreground_horizon == LM_HORIZON_OPEN;
    return is_open ? ref_gm_horizon(&bins[first], view)
                   : ref_behind_foreground(bins, cells, view,
                                           ldexp((double)s->foreground_horizon, -40));
}

static struct ref_antenna antenna_of(const struct lm_radar *radar)
{
    return (struct ref_antenna){.elevation_beam_deg = hs_degrees(radar->antenna.elevation_beam),
                                .fan_deg = hs_degrees(radar->antenna.fan)};
}

/* The levels that the reference finds on the firmware's ground, before the antenna. */
static void see(const struct trial *t, struct ref_bin *bins, uint32_t cells, fx_bam_t azimuth)
{
    const struct sector_world *w = t->w;
    const struct lm_sector *s = &w->sector;
    const struct ref_view view = {s->grid.height_m_q10 / 1024.0, s->grid.reference_m_q10 / 1024.0,
                                  metres(s->grid.cell_m_q8)};
    for (uint32_t i = 0; i < cells; i++) {
        bins[i].range_m =
            metres(s->ground_edge_m_q8 + s->grid.cell_m_q8 / 2 + i * s->grid.cell_m_q8);
    }
    take_ground(&w->line.ground, &w->map.db.classes, bins, cells);
    ref_illuminate(bins, cells, &view, &t->params, horizon_of(s, bins, cells, &view));
    ref_class_gain(bins, cells, &t->params, hs_degrees(azimuth));
    ref_sea(bins, cells, &view, &t->params, hs_degrees(azimuth));
    for (uint32_t i = 0; i < cells; i++) {
        bins[i].echo_db = bins[i].is_lit ? bins[i].level_db + bins[i].class_gain_db : -INFINITY;
    }
}

/* The sample taken last, whose ground and levels are still in the line. */
static void judge_sample(struct trial *t, int32_t sample)
{
    const struct sector_world *w = t->w;
    const struct lm_sector *s = &w->sector;
    const uint32_t cells = s->grid.cells;
    struct ref_bin bins[LM_CELLS_MAX] = {0};
    struct lm_lit_line gain = w->line.lit;
    memset(gain.level_db_q8, 0, sizeof gain.level_db_q8);
    lm_antenna_pattern_apply(&s->pattern, &s->fan, &s->grid, &gain);
    see(t, bins, cells, s->up + (fx_bam_t)lm_beam_azimuth(&s->beam, s->radar, sample));
    const struct ref_antenna antenna = antenna_of(&w->radar);
    for (uint32_t i = 0; i < cells; i++) {
        const int32_t level_q8 = w->line.lit.level_db_q8[i];
        /* A level that is held at its lowest says no more than that it is no higher. */
        const double most_db = decibels(level_q8 - gain.level_db_q8[i]);
        const bool is_held = level_q8 == LM_LEVEL_SHADOW;
        const double before_db = is_held ? fmin(most_db, bins[i].echo_db) : most_db;
        const double tangent = ldexp(gain.horizon[i + 1], -(int)s->grid.tangent_bits);
        const double left_db = ref_elevation_db(&antenna, hs_degrees((fx_bam_t)s->tilt), tangent);
        note(&t->score[SAMPLE], shown(before_db) - shown(bins[i].echo_db));
        note(&t->score[ELEVATION], shown(decibels(level_q8)) - shown(before_db + left_db));
    }
}

/* ---- what becomes of samples ---- */

static struct ref_bins bins_of(const struct lm_sector *s)
{
    return (struct ref_bins){metres(s->slant.first_m_q8), metres(s->slant.cell_m_q8),
                             s->slant.cells};
}

/* The slant range of the sample taken last, `sample`. */
static void judge_slant(struct trial *t, long sample)
{
    const struct lm_sector *s = &t->w->sector;
    const struct ref_bins bins = bins_of(s);
    double ground[REF_CELLS_MAX], power[REF_CELLS_MAX];
    for (uint32_t i = 0; i < s->grid.cells; i++) {
        ground[i] = pow(10, decibels(t->w->line.lit.level_db_q8[i]) / 10);
    }
    ref_slant_power(&bins, height_m(s), metres(s->ground_edge_m_q8), metres(s->grid.cell_m_q8),
                    ground, s->grid.cells, power);
    for (uint32_t i = 0; i < s->slant.cells; i++) {
        const uint32_t slot = (uint32_t)sample % LM_BEAM_TAPS;
        note_power(&t->score[SLANT], ldexp(s->beam.power_q24[slot][i], -24), fmin(power[i], 255),
                   1);
    }
}

static struct ref_beam beam_of(const struct lm_sector *s, double azimuth_deg, double *looks)
{
    const struct lm_fov_row *fov = &s->radar->fov[s->command.fov];
    const uint32_t rate = fov->bam_per_s ? fov->bam_per_s : s->radar->mode[0].bam_per_s;
    const struct ref_dbs dbs = {.speed_m_s = s->platform.speed_mm_s / 1000.0,
                                .beam_deg = hs_degrees(s->radar->antenna.azimuth_beam),
                                .wavelength_m = s->radar->wavelength_um * 1e-6,
                                .rate_deg_s = hs_degrees(rate)};
    const double off_deg = hs_degrees(s->up - s->platform.track) + azimuth_deg;
    const struct ref_beam beam = {
        .beam_deg = dbs.beam_deg,
        .line_deg = hs_degrees(s->radar->sample),
        .ratio = fov->sharpening > 1
                     ? ref_dbs_used(&dbs, off_deg, hs_degrees(s->width), fov->sharpening)
                     : 1};
    *looks = ref_dbs_looks(ref_dbs_ratio(&dbs, off_deg), beam.ratio);
    return beam;
}

/* The firmware's line behind the beam is made once more: the receiver has changed its own. */
static void judge_beam(struct trial *t, uint32_t line, uint32_t *drawn_q24)
{
    const struct lm_sector *s = &t->w->sector;
    const double azimuth_deg = line_azimuth_deg(s, line);
    double looks;
    const struct ref_beam beam = beam_of(s, azimuth_deg, &looks);
    const struct ref_beam_look look = ref_beam_look(&beam, azimuth_deg);
    double power[REF_BEAM_SAMPLES][REF_CELLS_MAX], sum[REF_CELLS_MAX];
    const double *samples[REF_BEAM_SAMPLES];
    for (int j = 0; j < REF_BEAM_SAMPLES; j++) {
        const uint32_t slot = (uint32_t)(look.first + j) % LM_BEAM_TAPS;
        assert_true(lm_beam_has(&s->beam, (int32_t)look.first + j));
        for (uint32_t i = 0; i < s->slant.cells; i++) {
            power[j][i] = ldexp(s->beam.power_q24[slot][i], -24);
        }
        samples[j] = power[j];
    }
    const double step_deg = hs_degrees(s->radar->fov[s->command.fov].beam_step);
    const double scallop = ref_dbs_scallop(beam.beam_deg, step_deg, beam.ratio, azimuth_deg);
    ref_beam_sum(&look, samples, sum, s->slant.cells);
    for (uint32_t i = 0; i < s->slant.cells; i++) {
        sum[i] *= scallop;
    }
    struct lm_beam_taps own;
    lm_beam_set_taps(&t->w->sector.beam, s->radar,
                     (int32_t)lround(azimuth_deg / 360 * 4294967296.0),
                     (uint32_t)lround(beam.ratio * 256), &own);
    lm_beam_weaken(&own, (uint32_t)lround(scallop * 65536));
    lm_beam_sum(&s->beam, &own, drawn_q24, s->slant.cells);
    for (uint32_t i = 0; i < s->slant.cells; i++) {
        note_power(&t->score[BEAM], ldexp(drawn_q24[i], -24), sum[i], 1);
    }
}

static struct ref_receiver receiver_of(const struct trial *t)
{
    const struct lm_sector *s = &t->w->sector;
    return ref_receiver_of(s->radar, s->command.range_index, (enum lm_fov)s->command.fov,
                           bins_of(s), height_m(s), t->noise_db);
}

/* The environment as the line at an azimuth from north meets it. */
static void look_at_weather(struct trial *t, const struct ref_receiver *r, double azimuth_deg,
                            struct ref_weather_line *weather)
{
    const struct lm_environment *e = t->weather;
    struct ref_environment *ref = &t->environment;
    const struct lm_position *own = &t->w->platform.position;
    const struct ref_place from = {hs_degrees(own->latitude), hs_degrees(own->longitude)};
    double bearing_deg;
    ref->rain_count = e->rain_count;
    ref->jammer_count = e->jammer_count;
    for (size_t n = 0; n < e->rain_count; n++) {
        const struct lm_position *at = &e->rain[n].centre;
        ref_geo_inverse(from,
                        (struct ref_place){hs_degrees(at->latitude), hs_degrees(at->longitude)},
                        &bearing_deg, &ref->rain[n].distance_m);
        ref->rain[n].off_deg = remainder(bearing_deg - azimuth_deg, 360);
        ref->rain[n].radius_m = e->rain[n].radius_m;
        ref->rain[n].mm_per_h = e->rain[n].mm_per_h;
    }
    for (size_t n = 0; n < e->jammer_count; n++) {
        const struct lm_position *at = &e->jammer[n].position;
        ref_geo_inverse(from,
                        (struct ref_place){hs_degrees(at->latitude), hs_degrees(at->longitude)},
                        &bearing_deg, &ref->jammer[n].distance_m);
        ref->jammer[n].off_deg = remainder(bearing_deg - azimuth_deg, 360);
        ref->jammer[n].ratio_db = decibels(e->jammer[n].noise_ratio_db_q8);
    }
    const struct lm_radar *radar = &t->w->radar;
    ref_weather(ref, radar->wavelength_um * 1e-6, hs_degrees(radar->antenna.azimuth_beam),
                hs_degrees(radar->antenna.elevation_beam), r->height_m, &r->bins, weather);
}

static void judge_receiver(struct trial *t, uint32_t line, uint32_t sweep,
                           const uint32_t *drawn_q24)
{
    const struct lm_sector *s = &t->w->sector;
    struct ref_receiver receiver = receiver_of(t);
    const struct ref_antenna antenna = antenna_of(&t->w->radar);
    receiver.unlit_m =
        ref_unlit_m(&antenna, hs_degrees((fx_bam_t)t->w->sector.tilt), height_m(&t->w->sector));
    struct ref_weather_line weather;
    receiver.leak = t->leak;
    receiver.leak_lines =
        ref_leak_lines(hs_degrees(s->radar->antenna.azimuth_beam), hs_degrees(s->width));
    double power[REF_CELLS_MAX], level_db[REF_CELLS_MAX], speckle[REF_CELLS_MAX], looks;
    const struct ref_beam beam = beam_of(s, line_azimuth_deg(s, line), &looks);
    ref_line_speckle(looks, sweep, t->grain_row,
                     ref_pulse_m(receiver.pulse_s) / receiver.bins.step_m, speckle, s->slant.cells);
    receiver.speckle = speckle;
    t->grain_row += ref_grain_rows(&beam, hs_degrees(s->width));
    for (uint32_t i = 0; i < s->slant.cells; i++) {
        power[i] = ldexp(drawn_q24[i], -24);
    }
    if (t->weather) {
        look_at_weather(t, &receiver, hs_degrees(s->up) + line_azimuth_deg(s, line), &weather);
    }
    ref_receive(&receiver, t->weather ? &weather : NULL, line, sweep, power, level_db);
    for (uint32_t i = 0; i < s->slant.cells; i++) {
        const double brightness = ref_brightness(level_db[i], &t->params);
        const double fall_db =
            ref_stc_fall_db(&receiver, receiver.bins.first_m + i * receiver.bins.step_m);
        note_power(&t->score[RECEIVER], pow(10, (decibels(s->level_db_q8[i]) + fall_db) / 10),
                   pow(10, (level_db[i] + fall_db) / 10), PULSE_STEPS);
        t->pixels++;
        t->beyond_1_grey += abs(t->w->line.grey[i] - ref_grey(brightness, &t->params)) > 1;
    }
}

/* ---- sweeps ---- */

static void judge_line(struct trial *t)
{
    struct lm_sector *s = &t->w->sector;
    const uint32_t samples = s->samples, sweep = s->sweep, line = draw_line(t->w);
    uint32_t drawn_q24[LM_CELLS_ROOM];
    /* To the right, the sample taken last is the outermost. */
    const double azimuth_deg = line_azimuth_deg(s, line);
    double looks;
    const struct ref_beam beam = beam_of(s, azimuth_deg, &looks);
    const long last = ref_beam_look(&beam, azimuth_deg).first + REF_BEAM_SAMPLES - 1;
    if (s->samples != samples) {
        judge_sample(t, (int32_t)last);
        judge_slant(t, last);
    }
    judge_beam(t, line, drawn_q24);
    judge_receiver(t, line, sweep, drawn_q24);
}

static void report(const char *what, const struct trial *t)
{
    for (int stage = 0; stage < STAGES; stage++) {
        const struct score *s = &t->score[stage];
        print_message("# %s, %s: %u values, rms %.3f dB, worst %.2f dB, beyond 0.5 dB: %u\n", what,
                      stage_names[stage], s->values, sqrt(s->squares / s->values), s->worst_db,
                      s->beyond_half_db);
    }
    print_message("# %s: beyond one grey level %.4f %%\n", what,
                  100.0 * t->beyond_1_grey / t->pixels);
}

/* At most one value in ten thousand beyond half a decibel. Behind the speckle it is one in four
 * thousand, and 32 pixels in ten thousand more than one grey level off: with one or two looks, a
 * step of the grain, 1/32 of a deviation, is up to half a decibel in a deep fade. Shadows have that
 * grain, too, where the ground leaks into them. */
static void judge(const struct trial *t)
{
    for (int stage = 0; stage < STAGES; stage++) {
        assert_true(t->score[stage].values > 10000);
        const double most = stage == RECEIVER ? 4000 : 10000;
        assert_true(t->score[stage].beyond_half_db * most <= t->score[stage].values);
    }
    assert_true(t->beyond_1_grey * 10000.0 <= 32 * t->pixels);
}

static void judge_sweep(struct sector_world *w, const char *what,
                        const struct lm_sector_command *command, const struct lm_environment *e)
{
    struct trial *t = calloc(1, sizeof *t);
    const struct lm_sector_mode_row *mode = &w->radar.mode[command->mode];
    t->w = w;
    w->map.db.classes.entry[TINY_STRUCTURE].facing = 3;
    t->weather = e;
    t->params = params_of(&w->radar, -INFINITY, &mode->tone, &w->radar.sar.speckle);
    t->params.sea_db = e ? ref_sea_db(e->sea_state) : 0;
    t->params.sea.critical =
        ref_sea_critical(e ? e->sea_state : LM_SEA_STATE_OF_IMAGE, w->radar.wavelength_um * 1e-6);
    t->params.sea.has_wind = e && e->has_wind;
    t->params.sea.wind_from_deg = e ? hs_degrees(e->wind_from) : 0;
    ref_speckle_table(1u << w->radar.receiver.noise_looks_log2, t->noise_db);
    start_sector(w, command, e, NULL);
    do {
        judge_line(t);
    } while (!lm_sector_is_at_edge(&w->sector));
    report(what, t);
    judge(t);
    free(t);
}

/* 65 km of country, with the aircraft above its southern part. */
static struct sector_world *make_country(void)
{
    double scale = 8;
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.cell = scene_cell;
    spec.elevation_m = scene_elevation_m;
    spec.ctx = &scale;
    spec.shift0 = 13;
    spec.rows = spec.columns = 14;
    struct sector_world *w = make_sector_world(&spec);
    /* The mean across a sample is proved by test_azimuth_average: here a sample is the azimuth in
     * the line. */
    for (int field = 0; field < LM_FOVS; field++) {
        w->radar.fov[field].azimuths_log2 = 0;
    }
    w->platform = (struct lm_platform){
        .position = {w->map.db.centre_latitude - FX_BAM_DEG(1) / 4, w->map.db.centre_longitude},
        .height_m_q10 = 2500 * 1024,
        .heading = FX_BAM_DEG(7),
        .speed_mm_s = 180000};
    return w;
}

TEST(real_beam_sweeps_agree_with_the_reference_at_every_stage)
{
    struct sector_world *w = make_country();
    struct lm_sector_command command = {.mode = LM_SECTOR_GM, .range_index = scale_of(10)};
    judge_sweep(w, "GM, 10 nm", &command, NULL);
    command.range_index = scale_of(40);
    judge_sweep(w, "GM, 40 nm", &command, NULL);
    free_sector_world(w);
}

TEST(rain_jammer_and_sea_agree_with_the_reference)
{
    struct sector_world *w = make_country();
    const struct lm_sector_command command = {.mode = LM_SECTOR_GM, .range_index = scale_of(20)};
    const struct lm_environment e = {
        .rain = {{place_at(w, 12, 17000), 5000, 25}, {place_at(w, -20, 24000), 7000, 4}},
        .jammer = {{place_at(w, 30, 50000), 25 * 256}},
        .rain_count = 2,
        .jammer_count = 1,
        .sea_state = 2,
        .has_wind = true,
        .wind_from = FX_BAM_DEG(70)};
    judge_sweep(w, "GM, 20 nm, rain and jammer", &command, &e);
    free_sector_world(w);
}

TEST(windows_agree_with_the_reference_at_every_stage)
{
    struct sector_world *w = make_country();
    struct lm_sector_command command = {.mode = LM_SECTOR_GM,
                                        .fov = LM_FOV_EXP,
                                        .range_index = scale_of(20),
                                        .centre = place_at(w, 25, 25000)};
    judge_sweep(w, "EXP, 20 nm", &command, NULL);
    command.fov = LM_FOV_DBS1;
    command.centre = place_at(w, 45, 25000);
    judge_sweep(w, "DBS1, 20 nm", &command, NULL);
    free_sector_world(w);
}
