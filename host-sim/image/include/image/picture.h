/* Pictures of an image: each of its planes drawn as RGB pixels. */
#ifndef IMAGE_PICTURE_H
#define IMAGE_PICTURE_H

#include "image/grid.h"
#include "image/reader.h"

#include <stdbool.h>

/* What a picture shows of each cell: gamma in dB, class, elevation in metres, height of what stands
 * on the ground in metres, or elevation as shaded relief. */
enum image_plane {
    IMAGE_PLANE_REFLECTIVITY,
    IMAGE_PLANE_CLASS,
    IMAGE_PLANE_ELEVATION,
    IMAGE_PLANE_HEIGHT,
    IMAGE_PLANE_SHADE,
    IMAGE_PLANES
};
extern const char *const image_plane_names[IMAGE_PLANES];

enum { IMAGE_SHADE_FLAT = 180 }; /* grey of level ground */

struct image_view {
    enum image_plane plane;
    struct image_area area; /* width 0: all that the level covers */
    int level;
    int width, height; /* pixels */
    double pixel_m;
    double black, white; /* dB or metres; equal: to be chosen from what is seen */
    unsigned damaged_tiles;
    bool has_data; /* not all of it is black */
};

/* Settle area, level (`level` -1: the finest of which `max_size` pixels show every cell) and size;
 * the longer side has at most `max_size` pixels. Returns 0, or -1 with the error reported. */
int image_view_fit(const struct image *image, struct image_view *view, int level, int max_size);

/* Settle area and size so that each pixel is one cell of `level`: the area, or all that the level
 * covers, is widened to whole cells, of the finest zone where the level has several. black and
 * white are left alone. Returns 0, or -1 with the error reported: the level has no tile. */
int image_view_cells(const struct image *image, struct image_view *view, int level);

/* The plane's values at the centres of rows y .. y + rows - 1 into rows * width floats, NAN where
 * there is no data; cells as image_view_draw takes them. Adds to damaged_tiles. Returns 0, or -1
 * with the error reported (no memory). */
int image_view_read(const struct image *image, struct image_view *view, int y, int rows,
                    float *values);

/* Draw into width * height RGB pixels, row 0 north. Each pixel shows the cell under its centre,
 * from the view's level or the next coarser one that has it. Settles black and white. Tiles whose
 * checksum fails are left black and counted. Returns 0, or -1 with the error reported. */
int image_view_draw(const struct image *image, struct image_view *view, uint8_t *pixels);

/* ---- single places ---- */

/* What a drawing remembers of the tiles it has met. */
struct image_look {
    const struct image *image;
    uint8_t *checked; /* of each entry: 0 not yet, 1 sound, 2 damaged, 3 without a tile */
    unsigned damaged; /* tiles whose checksum fails */
};

/* A place in the image: the tile and the cell. The tile is valid as image_entry_tile says. */
struct image_spot {
    const struct lm_tile *tile;
    uint8_t shift, zone;
    int row, column;
    double north, east; /* position in the cell, 0..1 */
};

/* Begin to look at an image, which must outlive it; and end. Returns 0, or -1 with the error
 * reported (no memory). */
int image_look_begin(struct image_look *look, const struct image *image);
void image_look_end(struct image_look *look);

/* Find a place at the finest level that has it from `level` up. False if none has. */
bool image_look_at(struct image_look *look, int level, int64_t latitude, uint32_t longitude,
                   struct image_spot *spot);

/* The value of a plane at a place; NAN where there is no data. */
double image_spot_value(const struct image *image, enum image_plane plane,
                        const struct image_spot *spot, int64_t latitude);

#endif
