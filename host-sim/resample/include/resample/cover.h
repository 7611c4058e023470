/* Land cover of a database: class, reflectivity and height rasters, resampled to the cells of a
 * tile. */
#ifndef RESAMPLE_COVER_H
#define RESAMPLE_COVER_H

#include "gis/class_numbers.h"
#include "gis/code_map.h"
#include "hs/class_table.h"
#include "image/grid.h"
#include "lm/db.h"
#include "resample/georef.h"
#include "resample/mesh.h"

#include <gdal.h>
#include <stdbool.h>
#include <stdint.h>

/* One band of one file. */
struct resample_plane {
    GDALDatasetH dataset; /* owned; NULL: not given */
    GDALRasterBandH band;
    const char *path; /* borrowed */
    bool has_nodata;
    double nodata;
    double scale, offset; /* metres of heights = value * scale + offset */
    struct resample_georef georef;
    struct resample_lattice lattice; /* once the cell is set */
};

struct resample_cover {
    struct resample_plane classes, reflectivity, heights;
    const struct db_class_table *table; /* borrowed */
    const struct db_code_map *codes;    /* borrowed; NULL: the pixels are class numbers */
    struct db_class_numbers numbers;    /* of these, once they are set */
    struct image_area area;
    double pixel_latitude_bam, pixel_longitude_bam;
};

/* Open the rasters. Paths are borrowed until close and may be NULL; without `classes` the cover is
 * empty, whatever the other two. Returns 0, or -1 with the error reported and nothing to close:
 * - the middle of the class raster lies nowhere on Earth,
 * - a file cannot be opened, has more than one band, or no georeference,
 * - classes and reflectivity lie on different grids (heights may lie on their own). */
int resample_cover_open(struct resample_cover *c, const struct db_class_table *table,
                        const char *classes, const char *reflectivity, const char *heights);
/* Harmless on a zeroed struct. */
void resample_cover_close(struct resample_cover *c);

/* Judge whether reflectivity and heights are what they should be (gis/plausible.h). Returns 0, or
 * -1 with a doubt or an error reported. */
int resample_cover_judge(const struct resample_cover *c, bool is_trusted);

/* From here on the class raster's pixels are codes of somebody's land cover. Prints which occur.
 * Returns 0, or -1 with the error reported (db_code_map_survey). */
int resample_cover_set_codes(struct resample_cover *c, const struct db_code_map *codes);

/* From here on the class raster's pixels are class numbers, matched by name where the raster has
 * names. `is_known`: all of them were looked at before, and are not read once more. Returns 0, or
 * -1 with the error reported (db_class_numbers_read). */
int resample_cover_set_numbers(struct resample_cover *c, bool ignores_names, bool is_known);

/* Say how large the image's finest cells are. Call once before resample_cover_tile. */
void resample_cover_set_cell(struct resample_cover *c, uint8_t shift0);

/* One sample of a tile. */
struct resample_sample {
    uint8_t class_number; /* LM_DB_CLASS_NONE: no data */
    bool has_gamma, has_height;
    float gamma_db, height_m;
};

/* The samples of a tile, each cell cut into `parts` x `parts`, nearest pixel, row by row from the
 * south-west: (64 parts)^2 of them. A tile that the rasters do not touch gives samples without
 * data. Returns how many hold data, or -1 with the error reported (a file cut short, a class that
 * the table has not). */
int resample_cover_tile(const struct resample_cover *c, const struct image_frame *frame, int parts,
                        struct resample_sample *samples);

#endif
