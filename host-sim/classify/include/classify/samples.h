/* Samples: the inputs of the network for a pixel. These are its bands and, with a context window,
 * also their mean and standard deviation over the window around it. */
#ifndef CLASSIFY_SAMPLES_H
#define CLASSIFY_SAMPLES_H

#include "classify/exemplars.h"
#include "gis/raster.h"

enum { DB_CONTEXT_MAX = 31, DB_INPUT_MAX = 1024 };

/* `context` is the side of the window in pixels, odd; 1 means the bands alone. */
static inline int db_feature_count(int band_count, int context)
{
    return context > 1 ? 3 * band_count : band_count;
}

/* Bytes a pixel that db_features_read needs while it works, for db_raster_block_rows. */
size_t db_feature_bytes(int band_count, int context);

/* The features of rows y .. y + rows - 1 into planes of rows * width each: all bands, then all
 * means, then all deviations. The window is cut at the image's edge, and its nodata pixels do not
 * count. `valid` as in db_raster_read. Returns 0, or -1 with the error reported. */
int db_features_read(const struct db_raster *r, int context, int y, int rows, float *planes,
                     uint8_t *valid);

/* The features of exemplars, one row of `input_count` an exemplar. */
struct db_samples {
    float *inputs;             /* owned; row-major */
    struct db_exemplar *items; /* owned */
    size_t count;
    int input_count;
    uint64_t without_data; /* exemplars left out because the image has no data there */
};

/* Read the features of all exemplars, block by block. Returns 0, or -1 with the error reported and
 * nothing to free. Memory: 4 bytes an input an exemplar, beside the block. */
int db_samples_read(struct db_samples *s, const struct db_raster *r, int context,
                    const struct db_exemplars *e);

/* Harmless on a zeroed struct. */
void db_samples_free(struct db_samples *s);

#endif
