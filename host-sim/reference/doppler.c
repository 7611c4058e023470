/* Doppler beam sharpening and movers: EQUATIONS.md, "Doppler beam sharpening" and "Movers". */
#include "reference/reference.h"

#include <math.h>

static const double rad = 3.14159265358979323846 / 180;

double ref_dbs_ratio(const struct ref_dbs *d, double off_deg)
{
    const double beam = d->beam_deg * rad, rate = d->rate_deg_s * rad;
    return 2 * d->speed_m_s * beam * beam * fabs(sin(off_deg * rad)) / (d->wavelength_m * rate);
}

double ref_dbs_notch_deg(const struct ref_dbs *d, double ratio)
{
    return asin(ratio / ref_dbs_ratio(d, 90)) / rad;
}

double ref_dbs_used(const struct ref_dbs *d, double off_deg, double line_deg, double wanted)
{
    const double fade_deg = fmin(11 * line_deg, 90);
    const double to_deg = asin(fabs(sin(off_deg * rad))) / rad;
    const double had = to_deg >= fade_deg
                           ? ref_dbs_ratio(d, to_deg)
                           : ref_dbs_ratio(d, fade_deg) * exp((to_deg - fade_deg) / fade_deg);
    return fmax(fmin(had, wanted), 1);
}

double ref_dbs_scallop(double beam_deg, double step_deg, double ratio, double azimuth_deg)
{
    const double x = step_deg > 0 ? remainder(azimuth_deg, step_deg) / beam_deg : 0;
    return pow(2, -8 * x * x * (1 - 1 / (ratio * ratio)));
}

double ref_mover_shift_deg(double closing_m_s, double speed_m_s, double off_deg)
{
    return fabs(off_deg) - acos(cos(off_deg * rad) + closing_m_s / speed_m_s) / rad;
}

double ref_mover_shift_m(double closing_m_s, double speed_m_s, double off_deg, double range_m)
{
    return range_m * closing_m_s / (speed_m_s * fabs(sin(off_deg * rad)));
}

double ref_gmt_least_m_s(double gate_m_s, double speed_m_s, double beam_deg, double off_deg)
{
    return fmax(gate_m_s, speed_m_s * beam_deg * rad * fabs(sin(off_deg * rad)) / 2);
}
