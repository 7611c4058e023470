/* Rain and jammers: EQUATIONS.md, "Rain", "Noise" and "Rain over a patch". */
#include "reference/reference.h"

#include <math.h>

static const double pi = 3.14159265358979323846, rad = 3.14159265358979323846 / 180;

double ref_rain_loss_db_km(double mm_per_h)
{
    return 0.01217 * pow(mm_per_h, 1.2571);
}

double ref_rain_eta(double mm_per_h, double wavelength_m)
{
    const double z_m3 = 200 * pow(mm_per_h, 1.6) * 1e-18; /* mm^6 / m^3 */
    return pow(pi, 5) * 0.93 * z_m3 / pow(wavelength_m, 4);
}

double ref_jam(const struct ref_jammer *j, double beam_deg)
{
    const double x = j->off_deg / beam_deg;
    return pow(10, (j->ratio_db - 20 * log10(j->distance_m / 18520)) / 10) * pow(2, -4 * x * x);
}

bool ref_rain_chord(const struct ref_rain *rain, double *from_m, double *to_m)
{
    const double off = rain->off_deg * rad;
    const double along_m = rain->distance_m * cos(off), across_m = rain->distance_m * sin(off);
    const double square = rain->radius_m * rain->radius_m - across_m * across_m;
    *from_m = fmax(along_m - sqrt(fmax(square, 0)), 0);
    *to_m = along_m + sqrt(fmax(square, 0));
    return square > 0 && *to_m > 0;
}

/* How much of from..to lies before `range_m`. */
static double depth_m(double from_m, double to_m, double range_m)
{
    return fmin(fmax(range_m, from_m), to_m) - from_m;
}

void ref_weather_at(const struct ref_environment *e, double wavelength_m, double elevation_beam_deg,
                    double height_m, const struct ref_bins *bins, size_t i, double *pass,
                    double *rain)
{
    const double slant_m = bins->first_m + (double)i * bins->step_m;
    const double near_m = slant_m - bins->step_m / 2, far_m = slant_m + bins->step_m / 2;
    double loss_db = 0, gamma = 0, from_m, to_m;
    for (size_t n = 0; n < e->rain_count; n++) {
        if (!ref_rain_chord(&e->rain[n], &from_m, &to_m)) {
            continue;
        }
        const double before_m = depth_m(from_m, to_m, near_m);
        const double through_m = depth_m(from_m, to_m, far_m) - before_m;
        loss_db += 2 * ref_rain_loss_db_km(e->rain[n].mm_per_h) * (before_m + through_m / 2) / 1000;
        gamma += ref_rain_eta(e->rain[n].mm_per_h, wavelength_m) * slant_m * elevation_beam_deg *
                 rad / ref_slant_grazing(slant_m, height_m) * through_m / bins->step_m;
    }
    *pass = pow(10, -loss_db / 10);
    *rain = gamma * *pass;
}

void ref_weather(const struct ref_environment *e, double wavelength_m, double azimuth_beam_deg,
                 double elevation_beam_deg, double height_m, const struct ref_bins *bins,
                 struct ref_weather_line *weather)
{
    weather->jam = 0;
    for (size_t n = 0; n < e->jammer_count; n++) {
        weather->jam += ref_jam(&e->jammer[n], azimuth_beam_deg);
    }
    for (size_t i = 0; i < bins->count; i++) {
        ref_weather_at(e, wavelength_m, elevation_beam_deg, height_m, bins, i, &weather->pass[i],
                       &weather->rain[i]);
    }
}

/* Loss, there and back, of a cell from `near_m` to `far_m` along the ground, on the ray `aside_deg`
 * of the line of sight; and in *echo what its own rain scatters, by the cubic metre of the cell. */
static double ray_loss_db(const struct ref_patch_rain *w, double aside_deg, double near_m,
                          double far_m, double *echo)
{
    double loss_db = 0, from_m, to_m;
    *echo = 0;
    for (size_t n = 0; n < w->environment.rain_count; n++) {
        struct ref_rain rain = w->environment.rain[n];
        rain.off_deg -= aside_deg;
        if (ref_rain_chord(&rain, &from_m, &to_m)) {
            const double before_m = depth_m(from_m, to_m, near_m);
            const double until_m = depth_m(from_m, to_m, far_m);
            loss_db +=
                2 * ref_rain_loss_db_km(rain.mm_per_h) * w->slant * (before_m + until_m) / 2 / 1000;
            *echo += ref_rain_eta(rain.mm_per_h, w->wavelength_m) * (until_m - before_m) /
                     (far_m - near_m);
        }
    }
    return loss_db;
}

/* Range along the ray in direction aside_deg of what lies range_m along the line of sight. */
static double on_ray_m(double aside_deg, double range_m)
{
    return range_m / cos(aside_deg * rad);
}

double ref_patch_loss_db(const struct ref_patch_rain *w, double aside_deg, double range_m,
                         double cell_m)
{
    double echo;
    return ray_loss_db(w, aside_deg, on_ray_m(aside_deg, range_m - cell_m / 2),
                       on_ray_m(aside_deg, range_m + cell_m / 2), &echo);
}

double ref_patch_veil(const struct ref_patch_rain *w, const struct ref_view *view, double range_m,
                      double aside_deg)
{
    enum { IN_BEAM = 200, REACH = 5 * IN_BEAM / 4 };
    const double near_m = on_ray_m(aside_deg, range_m - view->cell_m / 2);
    const double far_m = on_ray_m(aside_deg, range_m + view->cell_m / 2);
    const double height_m = range_m * w->elevation_beam_deg * rad * sqrt(pi / (8 * log(2.0))) / 2;
    double sum = 0, weights = 0;
    for (int k = -REACH; k < REACH; k++) {
        double echo;
        const double x = (k + 0.5) / IN_BEAM, weight = pow(2, -8 * x * x);
        const double loss_db =
            ray_loss_db(w, aside_deg + x * w->azimuth_beam_deg, near_m, far_m, &echo);
        sum += weight * echo * pow(10, -loss_db / 10);
        weights += weight;
    }
    return sum / weights * height_m / ref_grazing(view, range_m, range_m - view->cell_m);
}
