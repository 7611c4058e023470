/* SICD text: the geometry of a complex chip in the words of NGA's Sensor Independent Complex Data,
 * version 1.2.1 (NGA.STND.0024-1), for SAR tools that measure.
 *
 * WHAT A MODEL HAS NOT is made up, and only for this text: a radar SICD_RANGE_M away that flies
 * level at SICD_SPEED_M_S, square to its sight, the target on its left, for as long as the
 * resolution across takes; on SICD_START. Angles, places, wavelength, bands, weights and the scale
 * are those of the chip. The target's ground is at a height of 0 on WGS84. */
#ifndef TARGET_SICD_H
#define TARGET_SICD_H

#include "complex_file.h"

#define SICD_RANGE_M   10000.0
#define SICD_SPEED_M_S 100.0
#define SICD_START     "2000-01-01T00:00:00.000000Z"

/* What the text is about. Rows go away from the radar, columns to the left of its sight: so the
 * picture is seen from above, as the form wants it. */
struct sicd {
    const struct setup *setup;
    const struct trace_records *records;
    enum focus_weighting weighting;
    const struct complex_site *site;
    int width, height;
    /* Degrees of a pixel that is counted from the outer corner of the far left one. */
    const double *degrees; /* of struct db_complex_place */
};

/* Returns the text, free() it, or NULL out of memory, reported. Corners of the picture's ground are
 * in corners[], latitude first: first row and column, first row and last column, and on around. */
char *sicd_text(const struct sicd *s, double corners[4][2]);

#endif
