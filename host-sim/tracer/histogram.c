#include "tracer/histogram.h"

#include <math.h>

static const double degrees = 180 / 3.14159265358979323846;

static void count(struct histogram *h, double value)
{
    const double bin = floor((value - h->low) / (h->high - h->low) * HISTOGRAM_BINS);
    h->total++;
    if (value == h->high) {
        h->counts[HISTOGRAM_BINS - 1]++;
    } else if (bin >= 0 && bin < HISTOGRAM_BINS) {
        h->counts[(int)bin]++;
    } else {
        h->beyond++;
    }
}

void histograms_of(const struct trace_records *r, struct histogram h[HISTOGRAM_CHANNELS])
{
    const double half_across_m = r->grid.cells_across * r->grid.cell_m / 2;
    const double half_range_m = r->grid.cells_range * r->grid.cell_m / 2;
    const struct histogram empty[HISTOGRAM_CHANNELS] = {
        {.name = "incidence_deg", .low = 0, .high = 90},
        {.name = "echo_deg", .low = 0, .high = 180},
        {.name = "turn_deg", .low = 0, .high = 180},
        {.name = "phase_deg", .low = -180, .high = 180},
        {.name = "across_m", .low = -half_across_m, .high = half_across_m},
        {.name = "range_m", .low = -half_range_m, .high = half_range_m},
    };
    for (int i = 0; i < HISTOGRAM_CHANNELS; i++) {
        h[i] = empty[i];
    }
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        for (uint32_t i = 0; i < r->bounces[b].count; i++) {
            const struct trace_record *t = &r->bounces[b].records[i];
            count(&h[0], fmin((double)t->incidence_rad * degrees, 90));
            count(&h[1], fmin((double)t->echo_rad * degrees, 180));
            count(&h[2], fmin((double)t->turn_rad * degrees, 180));
            count(&h[3], fmin(fmax((double)t->phase_rad * degrees, -180), 180));
            count(&h[4], (double)t->across_m);
            count(&h[5], (double)t->range_m);
        }
    }
}
