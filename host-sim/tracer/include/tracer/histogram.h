/* How often each value was recorded: [Niu], Figure 13. Says whether what a network is trained on
 * covers its range. */
#ifndef TRACER_HISTOGRAM_H
#define TRACER_HISTOGRAM_H

#include "tracer/records.h"

enum { HISTOGRAM_BINS = 60, HISTOGRAM_CHANNELS = 6 };

struct histogram {
    const char *name; /* "incidence_deg", "echo_deg", "turn_deg", "phase_deg", "across_m" or
                         "range_m" */
    double low, high; /* of all bins, which are of one width */
    uint64_t counts[HISTOGRAM_BINS];
    uint64_t beyond, total; /* places may lie beyond the picture */
};

/* Of all reflections. Angles are 0 to 90, 0 to 180 and -180 to 180 degrees; places are those of the
 * picture. */
void histograms_of(const struct trace_records *r, struct histogram h[HISTOGRAM_CHANNELS]);

#endif
