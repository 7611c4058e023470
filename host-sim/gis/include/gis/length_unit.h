/* Units of length by their names, as raster bands and coordinate reference systems call them. */
#ifndef GIS_LENGTH_UNIT_H
#define GIS_LENGTH_UNIT_H

#include <gdal.h>
#include <stdbool.h>

/* Metres in the unit called `name`, whatever its case: a common name or abbreviation ("m", "ft",
 * "us-ft", "cm"), or a unit of PROJ's EPSG database ("US survey foot", "fathom"). False when there
 * is none. */
bool db_length_unit(const char *name, double *metres);

/* Metres in a unit of the band, from its unit type; 1 when it has none. Returns 0, or -1 with the
 * error reported: the unit is not known. `path` is for messages, `option` the one that overrides
 * it, NULL when there is none. */
int db_band_unit(GDALRasterBandH band, const char *path, const char *option, double *metres);

#endif
