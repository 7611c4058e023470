#include "infrared/weather.h"

#include "infrared/planck.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Cooper, "The absorption of solar radiation in solar stills", 1969. */
double ir_declination(int day_of_year)
{
    return 23.45 * pi / 180 * sin(2 * pi * (284 + day_of_year) / 365);
}

double ir_sun_cosine(const struct ir_weather *w, double hour)
{
    const double declination = ir_declination(w->day_of_year);
    return sin(w->latitude) * sin(declination) +
           cos(w->latitude) * cos(declination) * cos((hour - 12) * pi / 12);
}

/* Haurwitz (1945), as pvlib has it; below clouds after Kasten and Czeplak (1980). */
static double sun_w_m2(const struct ir_weather *w, double hour)
{
    const double c = ir_sun_cosine(w, hour);
    return c <= 0 ? 0 : 1098 * c * exp(-0.059 / c) * (1 - 0.75 * pow(w->cloud, 3.4));
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
    struct ir_air a = {.sun_w_m2 = sun_w_m2(w, hour), .wind_m_s = w->wind_m_s};
    a.kelvin = w->air_kelvin + w->air_range_kelvin / 2 * cos((hour - 15) * pi / 12);
    a.vapour_hpa =
        fmin(w->humidity * ir_saturation_hpa(w->air_kelvin), ir_saturation_hpa(a.kelvin));
    a.density_kg_m3 = 101325 / (287.05 * a.kelvin);
    a.sky_w_m2 = sky_emissivity(&a, w->cloud) * ir_radiation_w_m2(a.kelvin);
    a.sky_window = window_emissivity(&a, w->cloud);
    return a;
}
