/* The Gotcha files: a struct `data` of arrays in a MATLAB file. */
#include "mat_file.h"

#include "hs/error.h"
#include "realradar/phase_history.h"

#include <math.h>

enum { FP, FREQ, X, Y, Z, R0, FIELDS };

enum { VALUES_MOST = 1 << 24 }; /* 256 MiB of echo: three hundred times what one degree holds */

static size_t count_of(const struct rr_mat_array *a)
{
    return a->rows * a->columns;
}

static int check_finite(const struct rr_phase_history *ph, const char *path)
{
    double sum = ph->first_hz + ph->step_hz;
    for (int p = 0; p < ph->pulses; p++) {
        const struct rr_place *a = &ph->antenna[p];
        sum += fabs(a->x) + fabs(a->y) + fabs(a->z) + fabs(ph->reference_m[p]);
    }
    for (size_t i = 0; i < (size_t)ph->pulses * (size_t)ph->frequencies; i++) {
        sum += cabs(ph->echo[i]);
    }
    return isfinite(sum) ? 0
                         : hs_error(path, "copy the file again from its source",
                                    "holds a value that is not a finite number");
}

/* Sizes that a picture can be made of: an antenna within 10,000 km and cells of 1 mm to 1 km. A
 * flight that never moves, or passes overhead, has no cell. */
static int check_flight(const struct rr_phase_history *ph, const char *path)
{
    const struct rr_place origin = {0, 0, 0};
    const struct rr_resolution r = rr_resolution_of(ph);
    bool is_sane = r.cross_m > 1e-3 && r.cross_m < 1e3 && r.range_m > 1e-3 && r.range_m < 1e3;
    for (int p = 0; p < ph->pulses; p++) {
        is_sane = is_sane && rr_distance_m(ph->antenna[p], origin) < 1e7 &&
                  fabs(ph->reference_m[p]) < 1e7;
    }
    return is_sane ? 0
                   : hs_error(path, "copy the file again from its source",
                              "its antenna does not fly past the scene");
}

static int take_frequencies(struct rr_phase_history *ph, const char *path,
                            const struct rr_mat_array *freq)
{
    const size_t last = (size_t)ph->frequencies - 1;
    ph->first_hz = rr_mat_real(freq, 0);
    ph->step_hz = (rr_mat_real(freq, last) - ph->first_hz) / (double)last;
    for (size_t n = 0; n <= last; n++) {
        const double even_hz = ph->first_hz + (double)n * ph->step_hz;
        /* Single precision near 10 GHz comes in steps of 1024 Hz. */
        if (!(ph->first_hz > 0 && ph->step_hz > 0 &&
              fabs(rr_mat_real(freq, n) - even_hz) <= ph->step_hz / 100)) {
            return hs_error(path, "copy the file again from its source",
                            "its frequencies are not evenly spaced and rising");
        }
    }
    return 0;
}

static int take_values(struct rr_phase_history *ph, const char *path,
                       const struct rr_mat_array *field)
{
    for (size_t p = 0; p < (size_t)ph->pulses; p++) {
        ph->antenna[p] = (struct rr_place){rr_mat_real(&field[X], p), rr_mat_real(&field[Y], p),
                                           rr_mat_real(&field[Z], p)};
        ph->reference_m[p] = rr_mat_real(&field[R0], p);
    }
    for (size_t i = 0; i < count_of(&field[FP]); i++) {
        ph->echo[i] = rr_mat_real(&field[FP], i) + I * rr_mat_imaginary(&field[FP], i);
    }
    if (take_frequencies(ph, path, &field[FREQ]) != 0 || check_finite(ph, path) != 0) {
        return -1;
    }
    return check_flight(ph, path);
}

static int take_all(struct rr_phase_history *ph, const char *path, const struct rr_mat_array *field)
{
    const size_t frequencies = field[FP].rows, pulses = field[FP].columns;
    bool fits = count_of(&field[FREQ]) == frequencies && frequencies > 1 && pulses > 1 &&
                count_of(&field[FP]) <= VALUES_MOST;
    for (int i = X; i <= R0; i++) {
        fits = fits && count_of(&field[i]) == pulses;
    }
    if (!fits) {
        return hs_error(path, "give a phase history file of the Gotcha data set",
                        "the sizes of its fields do not agree");
    }
    if (rr_phase_history_alloc(ph, (int)frequencies, (int)pulses) != 0) {
        return -1;
    }
    const int status = take_values(ph, path, field);
    if (status != 0) {
        rr_phase_history_free(ph);
    }
    return status;
}

int rr_phase_history_read(struct rr_phase_history *ph, const char *path)
{
    static const char *const names[FIELDS] = {"fp", "freq", "x", "y", "z", "r0"};
    struct rr_mat_array field[FIELDS];
    struct rr_mat_file file;
    *ph = (struct rr_phase_history){0};
    if (rr_mat_open(&file, path, "data") != 0) {
        return -1;
    }
    int status = 0;
    for (int i = 0; i < FIELDS && status == 0; i++) {
        status = rr_mat_field(&file, names[i], &field[i]);
    }
    if (status == 0) {
        status = take_all(ph, path, field);
    }
    rr_mat_close(&file);
    return status;
}
