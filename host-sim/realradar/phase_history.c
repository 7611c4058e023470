#include "realradar/phase_history.h"

#include "hs/error.h"
#include "hs/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double rr_light_m_s = 299792458.0;

static const double pi = 3.14159265358979323846;

double rr_distance_m(struct rr_place a, struct rr_place b)
{
    const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return sqrt(x * x + y * y + z * z);
}

struct rr_place rr_place_along(struct rr_place from, struct rr_place direction, double length_m)
{
    return (struct rr_place){from.x + direction.x * length_m, from.y + direction.y * length_m,
                             from.z + direction.z * length_m};
}

int rr_phase_history_alloc(struct rr_phase_history *ph, int frequencies, int pulses)
{
    *ph = (struct rr_phase_history){.frequencies = frequencies, .pulses = pulses};
    const size_t n = (size_t)pulses;
    ph->echo = calloc(n * (size_t)frequencies, sizeof *ph->echo);
    ph->antenna = calloc(n, sizeof *ph->antenna);
    ph->reference_m = calloc(n, sizeof *ph->reference_m);
    if (!ph->echo || !ph->antenna || !ph->reference_m) {
        rr_phase_history_free(ph);
        return hs_error("phase history", NULL, "out of memory");
    }
    return 0;
}

int rr_phase_history_alike(struct rr_phase_history *ph, const struct rr_phase_history *model)
{
    if (rr_phase_history_alloc(ph, model->frequencies, model->pulses) != 0) {
        return -1;
    }
    ph->first_hz = model->first_hz;
    ph->step_hz = model->step_hz;
    memcpy(ph->antenna, model->antenna, (size_t)model->pulses * sizeof *ph->antenna);
    memcpy(ph->reference_m, model->reference_m, (size_t)model->pulses * sizeof *ph->reference_m);
    return 0;
}

void rr_phase_history_add_point(struct rr_phase_history *ph, struct rr_place place,
                                double amplitude)
{
    for (int p = 0; p < ph->pulses; p++) {
        const double range_m = rr_distance_m(ph->antenna[p], place) - ph->reference_m[p];
        for (int n = 0; n < ph->frequencies; n++) {
            const double frequency_hz = ph->first_hz + n * ph->step_hz;
            const double phase = -4 * pi * frequency_hz * range_m / rr_light_m_s;
            ph->echo[(size_t)p * (size_t)ph->frequencies + (size_t)n] +=
                amplitude * cexp(I * phase);
        }
    }
}

void rr_phase_history_fill_noise(struct rr_phase_history *ph, unsigned seed)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, seed);
    for (size_t i = 0; i < (size_t)ph->pulses * (size_t)ph->frequencies; i++) {
        const double real = hs_rng_normal(&rng);
        ph->echo[i] = real + I * hs_rng_normal(&rng);
    }
}

void rr_phase_history_free(struct rr_phase_history *ph)
{
    free(ph->echo);
    free(ph->antenna);
    free(ph->reference_m);
    *ph = (struct rr_phase_history){0};
}

struct rr_resolution rr_resolution_of(const struct rr_phase_history *ph)
{
    struct rr_resolution r;
    const struct rr_place first = ph->antenna[0], last = ph->antenna[ph->pulses - 1];
    const struct rr_place middle = ph->antenna[ph->pulses / 2];
    const double level_m = hypot(middle.x, middle.y);
    const double distance_m = rr_distance_m(middle, (struct rr_place){0, 0, 0});
    /* The angle between the outer pulses, and one step more: each pulse stands for a step. */
    const double cosine =
        (first.x * last.x + first.y * last.y) / (hypot(first.x, first.y) * hypot(last.x, last.y));
    r.aperture_rad = acos(fmin(cosine, 1)) * ph->pulses / (ph->pulses - 1);
    r.range = (struct rr_place){-middle.x / level_m, -middle.y / level_m, 0};
    r.cross = (struct rr_place){-r.range.y, r.range.x, 0};
    r.grazing_rad = acos(level_m / distance_m);
    r.bandwidth_hz = ph->frequencies * ph->step_hz;
    r.wavelength_m = rr_light_m_s / (ph->first_hz + ph->step_hz * (ph->frequencies - 1) / 2);
    r.range_m = rr_light_m_s / (2 * r.bandwidth_hz * cos(r.grazing_rad));
    r.cross_m = r.wavelength_m / (2 * r.aperture_rad * cos(r.grazing_rad));
    return r;
}
