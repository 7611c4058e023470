/* Complex chip as a file for SAR tools: gis/complex_raster.h, with notes of how it came about. */
#ifndef TARGET_COMPLEX_FILE_H
#define TARGET_COMPLEX_FILE_H

#include "tracer/setup.h"

/* Where the target stands, and where its nose points: degrees of WGS84, clockwise from north. */
struct complex_site {
    double latitude_deg, longitude_deg, heading_deg;
};

/* Write `chip`, near row first, of setup_complex_chip: far range on top in the file. `site` may be
 * NULL: no place on earth. Returns 0, or -1 with the error reported. */
int complex_file_write(const struct setup *s, const struct trace_records *r,
                       enum focus_weighting weighting, const struct complex_site *site,
                       const char *path, const float complex *chip);

#endif
