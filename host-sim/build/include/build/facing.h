/* Facing of structures: which way the walls of a place look, and the class numbers that say so.
 *
 * Walls stand at right angles and along streets, so that a place has one direction modulo 90
 * degrees, or none. It is found from the borders of structures in the class raster, in surroundings
 * of some 400 m. A class of structures becomes several that differ in nothing but their facing, as
 * many as there are free class numbers. */
#ifndef BUILD_FACING_H
#define BUILD_FACING_H

#include "build/plan.h"
#include "image/grid.h"
#include "lm/db.h"
#include "resample/cover.h"

#include <stdint.h>

struct build_facing {
    int facings;                  /* of each class of structures: 8, 4, 2 or 0 */
    uint8_t first[LM_DB_CLASSES]; /* class number of a class's first facing; 0: it has none */
    /* Blocks of the ground, row 0 southernmost: sum of border lengths times (cos 4f, sin 4f), and
     * of border lengths. */
    struct build_facing_sum {
        float cos4, sin4, length;
    } * blocks;        /* owned */
    int row0, column0; /* of the first block, in blocks from the corner of the class raster */
    int rows, columns;
    int64_t south;
    uint32_t west;
    int latitude_shift, longitude_shift; /* log2 of a block's size in BAM */
};

/* Give each class of structures of the table its facings: copies behind the `count` classes in use.
 * Returns the classes in use then. */
int build_facing_classes(struct build_facing *f, struct lm_classes *classes, int count);

/* Survey the borders in the class raster; after build_facing_classes. `within` is where facings
 * will be asked for, NULL: everywhere. What is found at a place there does not depend on it.
 * Memory: 24 bytes for each 60 m square there. Returns 0, or -1 with the error reported. */
int build_facing_survey(struct build_facing *f, const struct lm_classes *classes,
                        const struct resample_cover *cover, const struct build_plan *plan,
                        const struct image_area *within);
/* Harmless on a zeroed struct. */
void build_facing_free(struct build_facing *f);

/* Direction of the walls around a place, in degrees from north, 0..90; -1 where there is none. */
double build_facing_at(const struct build_facing *f, double latitude_bam, double longitude_bam);

/* The class number of a class for walls that face some degrees from north. */
uint8_t build_facing_number(const struct build_facing *f, uint8_t class_number, double degrees);

/* The class number of a cell of a class at a place. */
uint8_t build_facing_class(const struct build_facing *f, uint8_t class_number, double latitude_bam,
                           double longitude_bam);

#endif
