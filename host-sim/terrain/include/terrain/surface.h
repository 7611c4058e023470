/* Terrain surface: the elevation models of a build as one surface, which gives the height of any
 * post of the image.
 *
 * A post's elevation depends on where it lies and on nothing else, not on the level or tile that
 * asks: so tiles share their edges exactly, and the levels agree. */
#ifndef TERRAIN_SURFACE_H
#define TERRAIN_SURFACE_H

#include "hs/options.h"
#include "image/grid.h"
#include "lm/db.h"
#include "terrain/voids.h"

/* How posts are fitted to a model whose pixels are hardly larger than the image's cells
 * (terrain/fit.h). */
enum { TERRAIN_FIT_CELLS = 5, TERRAIN_FIT_PARTS = 4 };
struct terrain_fit {
    bool is_on;
    double cell_x, cell_y; /* the image's cell, in pixels: at most 1 */
    double tap[2 * TERRAIN_FIT_CELLS * TERRAIN_FIT_PARTS - 1]; /* in steps of 1/4 cell */
};

/* Models on one grid. */
struct terrain_layer {
    struct terrain_mosaic mosaic;
    struct terrain_voids voids;
    struct resample_lattice lattice; /* once the cell is set */
    struct image_area area;
    double pixel_latitude_bam, pixel_longitude_bam;
    double blur_x, blur_y; /* pixels over which the bilinear surface is averaged; 0: not at all */
    struct terrain_fit fit;
};

struct terrain_options {
    double sea_level_m;
    bool voids_are_sea; /* whatever their rim says */
    struct terrain_vertical_options vertical;
    bool are_trusted;   /* doubts are warnings (hs_doubt) */
    bool are_judged;    /* by an earlier run: doubts are not looked for */
    bool have_no_voids; /* likewise */
};

struct terrain {
    struct terrain_layer *layers; /* owned; in the order of their first file on the command line */
    int layer_count;
    struct terrain_options options;
    uint64_t posts_beyond; /* posts asked for where no model reaches */
};

/* Open the models and fill their voids. With no path at all everything lies at sea level.
 * `path.zip` is opened through /vsizip/. Returns 0, or -1 with the error reported and nothing to
 * close. Prints what was found or assumed of their heights. Reads every model once or twice. */
int terrain_open(struct terrain *t, const struct hs_list *paths,
                 const struct terrain_options *options);
void terrain_close(struct terrain *t);

/* Say how large the image's finest cells are. Posts are fitted to the model's bilinear surface
 * where its pixels are up to four cells long, samples of it where they are longer, and means of it
 * over a cell less a pixel where they are shorter. Call once before terrain_posts. */
void terrain_set_cell(struct terrain *t, uint8_t shift0);

struct terrain_posts {
    int32_t q6[LM_TILE_POSTS][LM_TILE_POSTS];  /* metres x 64 */
    uint8_t has[LM_TILE_POSTS][LM_TILE_POSTS]; /* 1 where a model reaches */
};

/* Elevations of a tile's posts. Of several layers the first that has measured the place counts,
 * then the first that filled a void there. A post that no model reaches takes the height of the
 * nearest layer's edge, so that no cliff stands where the terrain ends, or sea level. Returns how
 * many posts a model reaches, or -1 with the error reported. */
int terrain_posts(struct terrain *t, const struct image_frame *frame, struct terrain_posts *posts);

#endif
