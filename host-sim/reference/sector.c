/* A sector in real beam or sharpened: sampled lines, and what the display makes of them.
 * EQUATIONS.md, "Real beam". */
#include "hs/error.h"
#include "hs/progress.h"
#include "lm/grain.h"
#include "reference/reference.h"

#include <math.h>
#include <stdlib.h>

double ref_dbs_looks(double had, double used)
{
    return fmax(1, had / used);
}

unsigned ref_leak_lines(double beam_deg, double line_deg)
{
    return (unsigned)fmax(1, floor(beam_deg / line_deg));
}

double ref_grain_rows(const struct ref_beam *beam, double width_deg)
{
    return width_deg * beam->ratio * sqrt(2) / beam->beam_deg;
}

void ref_line_speckle(double looks, uint32_t sweep, double grain_row, double pulse_bins,
                      double *speckle, size_t count)
{
    const struct lm_grain_place start = lm_grain_start(LM_GRAIN_SPECKLE, sweep);
    const double step = fmin(1, 1 / pulse_bins);
    double half_db[REF_GRAIN_HALVES];
    ref_grain_halves(looks, half_db);
    for (size_t i = 0; i < count; i++) {
        speckle[i] = ref_grain_power(half_db, start.row, start.column, grain_row, (double)i * step);
    }
}

void ref_sector_line(const struct ref_sector_line *s, const struct ref_bin *const samples[],
                     size_t cells, const struct ref_weather_line *weather, double *level_db)
{
    double power[REF_BEAM_SAMPLES][REF_CELLS_MAX], ground[REF_CELLS_MAX], sum[REF_CELLS_MAX];
    const double *lines[REF_BEAM_SAMPLES];
    for (int j = 0; j < REF_BEAM_SAMPLES; j++) {
        ref_sample_power(samples[j], cells, &s->antenna, s->tilt_deg, ground);
        ref_slant_power(&s->receiver.bins, s->receiver.height_m, s->near_edge_m, s->cell_m, ground,
                        cells, power[j]);
        lines[j] = power[j];
    }
    double speckle[REF_CELLS_MAX];
    struct ref_receiver receiver = s->receiver;
    receiver.unlit_m = ref_unlit_m(&s->antenna, s->tilt_deg, receiver.height_m);
    ref_beam_sum(&s->look, lines, sum, s->receiver.bins.count);
    if (s->looks > 0) {
        const double pulse_bins = ref_pulse_m(receiver.pulse_s) / receiver.bins.step_m;
        ref_line_speckle(s->looks, s->sweep, s->grain_row, pulse_bins, speckle,
                         receiver.bins.count);
        receiver.speckle = speckle;
    }
    ref_receive(&receiver, weather, s->line, s->sweep, sum, level_db);
}

/* The lines sampled last: sample n of a spacing is in slot n mod 8. */
struct samples {
    struct ref_bin *bins; /* owned: 8 lines */
    double spacing_deg[REF_BEAM_SAMPLES];
    long number[REF_BEAM_SAMPLES];
};

/* Azimuths across a sample: half as many for each doubling of the sharpness. */
static unsigned azimuths_of(const struct ref_sector *s, const struct ref_beam *beam)
{
    const double fewer = ref_beam_fineness(beam);
    return s->azimuths > fewer ? (unsigned)(s->azimuths / fewer) : 1;
}

/* The ground about the azimuth of a sample: everything that of the last azimuth traced, but the
 * levels those of the mean power. */
static void look_across(struct ref_bin *bins, const struct ref_db *db,
                        const struct ref_sector *sector, const struct ref_params *params,
                        const struct ref_tables *tables, const struct ref_beam *beam, long number)
{
    const double azimuth_deg =
        sector->ground.centre_azimuth_deg + ref_beam_azimuth_deg(beam, number);
    const unsigned azimuths = azimuths_of(sector, beam);
    double power[REF_CELLS_MAX] = {0};
    for (unsigned turn = 0; turn < azimuths; turn++) {
        const unsigned part = (turn + azimuths / 2 + 1) % azimuths;
        const double off_deg = ((part + 0.5) / azimuths - 0.5) * ref_beam_spacing_deg(beam);
        ref_gm_line(bins, db, &sector->ground, params, tables, azimuth_deg + off_deg,
                    (uint32_t)number);
        for (unsigned i = 0; i < sector->ground.cell_count; i++) {
            const double level_db = bins[i].level_db + bins[i].class_gain_db;
            power[i] += bins[i].is_lit ? pow(10, level_db / 10) / azimuths : 0;
        }
    }
    for (unsigned i = 0; i < sector->ground.cell_count; i++) {
        bins[i].is_lit = power[i] > 0;
        bins[i].echo_db = 10 * log10(power[i]);
    }
}

/* The bins of a sample, from the ground if they are not there any more. */
static const struct ref_bin *sample(struct samples *s, const struct ref_db *db,
                                    const struct ref_sector *sector,
                                    const struct ref_params *params,
                                    const struct ref_tables *tables, const struct ref_beam *beam,
                                    long number)
{
    const long slot = (number % REF_BEAM_SAMPLES + REF_BEAM_SAMPLES) % REF_BEAM_SAMPLES;
    struct ref_bin *bins = s->bins + (size_t)slot * sector->ground.cell_count;
    const double spacing_deg = ref_beam_spacing_deg(beam);
    if (s->spacing_deg[slot] != spacing_deg || s->number[slot] != number) {
        s->spacing_deg[slot] = spacing_deg;
        s->number[slot] = number;
        look_across(bins, db, sector, params, tables, beam, number);
    }
    return bins;
}

/* How sharp the picture is at an azimuth. */
static double ratio_at(const struct ref_sector *s, double azimuth_deg)
{
    const double line_deg = 2 * s->ground.half_angle_deg / s->ground.line_count;
    return s->sharpening > 1
               ? ref_dbs_used(&s->dbs, azimuth_deg - s->track_deg, line_deg, s->sharpening)
               : 1;
}

/* The weather along an azimuth. */
static void look_at_weather(const struct ref_sector *s, const struct ref_receiver *receiver,
                            double azimuth_deg, struct ref_weather_line *weather)
{
    struct ref_environment e = s->environment;
    double bearing_deg;
    for (size_t n = 0; n < e.rain_count; n++) {
        ref_geo_inverse(s->ground.antenna, s->rain_centre[n], &bearing_deg, &e.rain[n].distance_m);
        e.rain[n].off_deg = remainder(bearing_deg - azimuth_deg, 360);
    }
    for (size_t n = 0; n < e.jammer_count; n++) {
        ref_geo_inverse(s->ground.antenna, s->jammer_place[n], &bearing_deg,
                        &e.jammer[n].distance_m);
        e.jammer[n].off_deg = remainder(bearing_deg - azimuth_deg, 360);
    }
    ref_weather(&e, s->dbs.wavelength_m, s->beam_deg, s->antenna.elevation_beam_deg,
                receiver->height_m, &receiver->bins, weather);
}

static void fill_line(struct ref_bin *bins, const struct ref_receiver *r, const double *level_db,
                      const struct ref_params *params)
{
    for (size_t i = 0; i < r->bins.count; i++) {
        bins[i].range_m = r->bins.first_m + (double)i * r->bins.step_m;
        bins[i].echo_db = level_db[i];
    }
    ref_tone(bins, r->bins.count, params);
}

static void draw(struct ref_picture *picture, struct samples *samples, const struct ref_db *db,
                 const struct ref_sector *sector, const struct ref_params *params)
{
    struct ref_tables tables;
    struct ref_weather_line weather;
    double level_db[REF_CELLS_MAX];
    const struct ref_gm *ground = &sector->ground;
    struct ref_sector_line line = {.antenna = sector->antenna,
                                   .tilt_deg = sector->tilt_deg,
                                   .cell_m = ground->cell_m,
                                   .receiver = sector->receiver,
                                   .sweep = ground->epoch};
    line.receiver.bins = (struct ref_bins){ground->cell_m / 2, ground->cell_m, ground->cell_count};
    line.receiver.height_m = picture->view.antenna_m - picture->view.reference_m;
    struct ref_leak leak[REF_LEAK_STRETCHES] = {{0}};
    line.receiver.leak = leak;
    line.receiver.leak_db = params->leak_db;
    line.receiver.leak_most_db = params->leak_most_db;
    line.receiver.leak_lines =
        ref_leak_lines(sector->beam_deg, 2 * ground->half_angle_deg / ground->line_count);
    ref_tables_set(&tables, params);
    struct hs_progress progress;
    hs_progress_begin(&progress, "lines", ground->line_count);
    for (line.line = 0; line.line < ground->line_count; line.line++) {
        hs_progress_update(&progress, line.line);
        const double azimuth_deg = ref_gm_azimuth_deg(ground, line.line);
        const struct ref_beam beam = {sector->beam_deg, sector->sample_deg,
                                      ratio_at(sector, azimuth_deg)};
        const struct ref_bin *lines[REF_BEAM_SAMPLES];
        const double from_middle_deg = azimuth_deg - ground->centre_azimuth_deg;
        line.look = ref_beam_look(&beam, from_middle_deg);
        for (int j = 0; j < REF_BEAM_SAMPLES; j++) {
            lines[j] = sample(samples, db, sector, params, &tables, &beam, line.look.first + j);
            line.look.weight[j] *=
                ref_dbs_scallop(beam.beam_deg, sector->beam_step_deg, beam.ratio, from_middle_deg);
        }
        look_at_weather(sector, &line.receiver, azimuth_deg, &weather);
        line.looks =
            ref_dbs_looks(ref_dbs_ratio(&sector->dbs, azimuth_deg - sector->track_deg), beam.ratio);
        ref_sector_line(&line, lines, ground->cell_count, &weather, level_db);
        line.grain_row += ref_grain_rows(&beam, 2 * ground->half_angle_deg / ground->line_count);
        fill_line(ref_picture_bin(picture, line.line, 0), &line.receiver, level_db, params);
    }
    hs_progress_end(&progress);
}

int ref_sector_sweep(struct ref_picture *picture, const struct ref_db *db,
                     const struct ref_sector *sector, const struct ref_params *params)
{
    struct ref_params quiet = *params;
    quiet.noise_floor_db = -INFINITY;
    *picture = (struct ref_picture){.line_count = sector->ground.line_count,
                                    .cell_count = sector->ground.cell_count,
                                    .view = ref_gm_view(db, &sector->ground, params),
                                    .level = ref_db_level_for(db, sector->ground.cell_m)};
    if (ref_picture_allocate(picture) != 0) {
        return -1;
    }
    struct samples samples = {
        .bins = calloc(REF_BEAM_SAMPLES * (size_t)picture->cell_count, sizeof *samples.bins)};
    if (samples.bins == NULL) {
        ref_picture_free(picture);
        return hs_error("picture", "ask for fewer cells", "not enough memory for 8 lines");
    }
    draw(picture, &samples, db, sector, &quiet);
    free(samples.bins);
    return 0;
}
