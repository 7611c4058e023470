#include "infrared/weather.h"

#include "infrared/planck.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Cooper, "The absorption of radiation in solar stills", 1969. */
double ir_declination(int day_of_year)
{
    return 23.45 * pi / 180 * sin(2 * pi * (284 + day_of_year) / 365);
}

void ir_sun(const struct ir_weather *w, double hour, double sun[3])
{
    const double declination = ir_declination(w->day_of_year), turn = (hour - 12) * pi / 12;
    const double outward = cos(declination) * cos(turn), axial = sin(declination);
    sun[0] = -cos(declination) * sin(turn);
    sun[1] = axial * cos(w->latitude) - outward * sin(w->latitude);
    sun[2] = axial * sin(w->latitude) + outward * cos(w->latitude);
}

/* On level ground: Haurwitz (1945), as pvlib has it; below clouds after Kasten and Czeplak (1980).
 * The sky's share under a clear sky, and that clouds take the beam by their share of the sky, are
 * UNSOURCED. */
static void add_sun(struct ir_air *a, const struct ir_weather *w, double hour)
{
    static const double diffuse_share = 0.15;
    ir_sun(w, hour, a->sun);
    const double c = a->sun[2];
    if (c > 0) {
        const double clear = 1098 * exp(-0.059 / c);
        a->beam_w_m2 = (1 - w->cloud) * (1 - diffuse_share) * clear;
        a->diffuse_w_m2 = c * ((1 - 0.75 * pow(w->cloud, 3.4)) * clear - a->beam_w_m2);
    }
}

/* Bolton (1980). */
double ir_saturation_hpa(double kelvin)
{
    return 6.112 * exp(17.67 * (kelvin - 273.15) / (kelvin - 29.65));
}

/* Emissivity of the clear sky: Brutsaert (1975); with clouds: Unsworth and Monteith (1975). */
static double sky_emissivity(const struct ir_air *a, double cloud)
{
    const double clear = 1.24 * pow(a->vapour_hpa / a->kelvin, 1.0 / 7);
    return fmin(1, (1 - 0.84 * cloud) * clear + 0.84 * cloud);
}

/* Idso (1981) for the window, vapour in kPa; clouds are black. */
static double window_emissivity(const struct ir_air *a, double cloud)
{
    const double kpa = a->vapour_hpa / 10;
    const double clear = fmin(1, 0.24 + 2.98e-6 * kpa * kpa * exp(3000 / a->kelvin));
    return clear + (1 - clear) * cloud;
}

struct ir_air ir_weather_at(const struct ir_weather *w, double hour)
{
    struct ir_air a = {.wind_m_s = w->wind_m_s};
    add_sun(&a, w, hour);
    a.kelvin = w->air_kelvin + w->air_range_kelvin / 2 * cos((hour - 15) * pi / 12);
    a.vapour_hpa =
        fmin(w->humidity * ir_saturation_hpa(w->air_kelvin), ir_saturation_hpa(a.kelvin));
    a.density_kg_m3 = 101325 / (287.05 * a.kelvin);
    a.sky_w_m2 = sky_emissivity(&a, w->cloud) * ir_radiation_w_m2(a.kelvin);
    a.sky_window = window_emissivity(&a, w->cloud);
    return a;
}
