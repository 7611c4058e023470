/* Picture of histograms. */
#ifndef TARGET_HISTOGRAM_PICTURE_H
#define TARGET_HISTOGRAM_PICTURE_H

#include "tracer/histogram.h"

/* Draw all of them on a logarithmic scale of shares. Returns 0, or -1 reported. */
int histogram_picture(const struct histogram h[HISTOGRAM_CHANNELS], const char *path);

#endif
