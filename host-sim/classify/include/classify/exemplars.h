/* Exemplars: the pixels of an image whose class is known, from polygons or from a label raster.
 *
 * Each exemplar belongs to a region, and a region to one class: a polygon, or in a label raster the
 * 8-connected patch of one label. A hold-out by regions keeps neighbouring pixels on one side.
 *
 * A label raster covers the same extent as the image, at any whole or broken ratio of resolution.
 * The image's grid rules: a pixel takes the most frequent label among the label cells whose centres
 * lie in it (the smallest of equals), or, where labels are coarser, the label at its centre. */
#ifndef CLASSIFY_EXEMPLARS_H
#define CLASSIFY_EXEMPLARS_H

#include "gis/label_map.h"
#include "gis/raster.h"

enum db_part { DB_PART_TRAIN, DB_PART_VALIDATE, DB_PART_HELD_OUT, DB_PART_UNKNOWN };

struct db_exemplar {
    int32_t x, y;
    uint32_t region; /* index into the regions */
    uint8_t class_index;
    uint8_t part; /* enum db_part */
};

struct db_region {
    long id; /* number of the polygon in its file, from 1; or of the patch, in reading order */
    char label[DB_LABEL_SIZE];
    uint8_t class_index;
    int32_t first_x, first_y; /* its first exemplar in reading order */
    uint32_t count;           /* exemplars taken from it */
};

struct db_exemplars {
    struct db_exemplar *items; /* owned; by row, then column; no pixel twice */
    size_t count;
    struct db_region *regions; /* owned */
    size_t region_count;
    uint64_t available[DB_CLASS_MAX]; /* pixels of each class before the cap, each once */
    uint64_t conflicting;             /* pixels left out because two classes claim them */
};

struct db_exemplar_source {
    const char *polygons_path; /* either this */
    const char *field;
    const char *labels_path; /* or this */
    const struct db_label_map *map;
    const struct db_class_table *table;
    long per_class; /* at most so many pixels of a class, drawn evenly from all of them */
    uint64_t seed;
};

/* Find the exemplars on `grid`. Pixels under an ignored polygon are nobody's. Labels that the map
 * leaves out or ignores are reported with their counts on standard output, and one that is nearly a
 * label of the map is warned of. A polygon whose label is no class when there is no map, a mapped
 * class without a pixel, polygons that all lie outside and labels of another shape are errors.
 * Returns 0, or -1 with the error reported and nothing to free. Memory: 16 bytes an exemplar kept,
 * 4 bytes a patch of a label raster, one bit a pixel of the image when a polygon is ignored. */
int db_exemplars_find(struct db_exemplars *e, const struct db_exemplar_source *source,
                      const struct db_grid *grid);

/* Harmless on a zeroed struct. */
void db_exemplars_free(struct db_exemplars *e);

/* A label raster seen on the image's grid. */
struct db_label_rows {
    struct db_raster raster;
    int width, height; /* of the image */
    float *pixels;     /* owned */
    uint8_t *valid;    /* owned */
};

/* Returns 0, or -1 with the error reported and nothing to close. */
int db_label_rows_open(struct db_label_rows *l, const char *path, const struct db_grid *grid);

/* The labels of image row y, `width` of them; -1 where there is none. Returns 0, or -1 reported. */
int db_label_rows_read(struct db_label_rows *l, int y, int32_t *labels);

/* Harmless on a zeroed struct. */
void db_label_rows_close(struct db_label_rows *l);

#endif
