/* Focusing of coherent echoes into a complex chip: each echo becomes the impulse response of a
 * radar of that band and weighting, at its exact place and with its phase. Side lobes of
 * neighbours interfere, and so do the scatterers of one resolution cell: that is speckle.
 *
 * The band is a rectangle in range and across, as after polar formatting of a small angle. One
 * direction is traced: a facet's return may not change over the aperture, wavelength / 2
 * resolution, but by its phase. */
#ifndef TRACER_FOCUS_H
#define TRACER_FOCUS_H

#include "tracer/coherent.h"

enum focus_weighting {
    FOCUS_UNIFORM, /* first side lobe -13.3 dB */
    FOCUS_HAMMING, /* 0.54 + 0.46 cos: -42.7 dB */
    FOCUS_TAYLOR,  /* -35 dB, nbar 4 */
    FOCUS_WEIGHTINGS
};
extern const char *const focus_weighting_names[FOCUS_WEIGHTINGS];

/* The same words for a table of options. */
#define FOCUS_WEIGHTING_WORDS "uniform|hamming|taylor"

struct focus_order {
    enum focus_weighting weighting;
    double resolution_m; /* between -3 dB points, either way */
    uint32_t ratio;      /* cells a pixel */
    uint64_t seed;       /* of the phases of rough surfaces */
};

/* Cycles a metre: width of the band that has that resolution under that weighting. */
double focus_band(enum focus_weighting weighting, double resolution_m);

/* Weights of the band's `count` frequencies, low to high. */
void focus_window(enum focus_weighting weighting, double *window, int count);

/* The chip of cells_across / ratio by cells_range / ratio pixels, near row first; pixel (column,
 * row) is the middle of its cells. A point of cross section s has |pixel|^2 = s at its peak.
 * Returns it, free() it, or NULL with the error reported: pixels too coarse for the band, a
 * resolution as large as the picture, out of memory. Cost: two FFTs of 2.5 times the cells either
 * way, 36 additions an echo. */
float complex *focus_chip(const struct trace_records *r, const struct reflect_law *law,
                          const struct focus_order *o);

/* The same with `count` echoes more, such as those of edges. */
float complex *focus_chip_with(const struct trace_records *r, const struct reflect_law *law,
                               const struct focus_order *o, const struct coherent_echo *more,
                               size_t count);

#endif
