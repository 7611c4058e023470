/* Complex chip as a file for SAR tools: gis/complex_raster.h, with notes of how it came about. */
#ifndef TARGET_COMPLEX_FILE_H
#define TARGET_COMPLEX_FILE_H

#include "tracer/setup.h"

/* Write `chip`, near row first, of setup_complex_chip: far range on top in the file. Returns 0, or
 * -1 with the error reported. */
int complex_file_write(const struct setup *s, const struct trace_records *r,
                       enum focus_weighting weighting, const char *path, const float complex *chip);

#endif
