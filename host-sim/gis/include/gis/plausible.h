/* Plausibility of rasters: is a file what its option asks for? A doubt is an error with its reason,
 * or a warning when the user says that he means it (hs_doubt).
 *
 * Values are judged by a sample: up to 64 rows, spread evenly, of up to 512 pixels. The limits are
 * judgements (UNSOURCED), in plausible.c. */
#ifndef GIS_PLAUSIBLE_H
#define GIS_PLAUSIBLE_H

#include <gdal.h>
#include <stdbool.h>
#include <stddef.h>

/* Values in rows of the file's order, voids left out. */
struct db_band_sample {
    double *values; /* owned */
    size_t count;
};

/* Read a sample: value * scale. Returns 0, or -1 with the error reported and nothing to free. */
int db_band_sample(struct db_band_sample *s, GDALRasterBandH band, const char *path, double scale);
/* Harmless on a zeroed struct. */
void db_band_sample_free(struct db_band_sample *s);

/* Each returns 0, or -1 with a doubt or an error reported. Complex numbers are doubted in all, and
 * no value at all in reflectivity and heights. */

/* Terrain, `metres` a unit: it has the colours of a picture or classes; values are many that lie
 * nowhere on Earth (another unit); posts hold -9999 or -32767 that no nodata value declares. */
int db_plausible_terrain(GDALRasterBandH band, const char *path, double metres, bool is_trusted);

/* Reflectivity in dB: colours or classes; values beyond -100..60 dB; none below 0 dB (classes,
 * linear power). */
int db_plausible_reflectivity(GDALRasterBandH band, const char *path, bool is_trusted);

/* Radar imagery, linear power or dB: colours or classes; a band whose unit is one of length. Of
 * powers also: whole numbers alone (raw numbers, classes), or a mean that no ground returns. No
 * value, and powers below 0, are left to who reads them. */
int db_plausible_radar(GDALRasterBandH band, const char *path, bool is_linear, bool is_trusted);

/* Heights above ground, `metres` a unit: colours or classes; the class raster itself; more than a
 * twentieth below -2 m (reflectivity); more than half above 100 m (elevations above the sea). */
int db_plausible_heights(GDALRasterBandH band, const char *path, double metres,
                         GDALRasterBandH classes, bool is_trusted);

#endif
