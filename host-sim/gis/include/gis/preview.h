/* Previews: small pictures of large rasters. Every n-th pixel is kept while the blocks pass by. */
#ifndef GIS_PREVIEW_H
#define GIS_PREVIEW_H

#include "gis/raster.h"
#include "hs/class_table.h"

enum { DB_PREVIEW_SIDE = 1024 }; /* no picture is larger either way */

struct db_preview {
    int width, height, step;
    int plane_count;
    float *values; /* owned: plane_count planes; NAN where there is no data */
};

/* Choose the step, so that no side exceeds DB_PREVIEW_SIDE, and take memory for `plane_count`
 * planes of NAN. Returns 0, or -1 with the error reported (no memory). */
int db_preview_init(struct db_preview *p, const struct db_grid *grid, int plane_count);

void db_preview_free(struct db_preview *p);

/* Take what is needed of rows y .. y + rows - 1 of one plane, `width` values each; `valid` as from
 * db_raster_read. */
void db_preview_add(struct db_preview *p, int plane, int y, int rows, int width,
                    const float *values, const uint8_t *valid);

/* Part `panel` of `panels` side by side of a picture p->width * panels wide, 3 bytes a pixel. The
 * planes (1 or 3) are stretched from their 2nd to their 98th percentile; no data is black. Returns
 * 0, or -1 with the error reported (no memory). */
int db_preview_paint_stretched(const struct db_preview *p, uint8_t *rgb, int panel, int panels);

/* The same of class indices in plane 0, in the colours of the table. */
void db_preview_paint_classes(const struct db_preview *p, const struct db_class_table *table,
                              uint8_t *rgb, int panel, int panels);

/* The same of plane 0 in grey, from black at `low` to white at `high`. */
void db_preview_paint_grey(const struct db_preview *p, double low, double high, uint8_t *rgb,
                           int panel, int panels);

#endif
