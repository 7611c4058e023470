/* Error regions: the parts of an image in which classes are mistaken, worst first. */
#ifndef CLASSIFY_ERROR_REGIONS_H
#define CLASSIFY_ERROR_REGIONS_H

#include "classify/exemplars.h"

#include <stddef.h>
#include <stdint.h>

/* What happened to the exemplars of one region, or of one square of the image. */
struct db_error_region {
    size_t index; /* of the region, or of the square in reading order */
    uint8_t class_index;
    uint8_t part;
    uint8_t mistaken_for; /* the commonest wrong class; DB_CLASS_NODATA when there is none */
    uint64_t count, right;
};

/* The exemplars with `given` classes (DB_CLASS_NODATA counts as wrong), gathered by region, worst
 * first: by the part recognised, then by size. Returns an array of *count elements that the caller
 * frees, or NULL out of memory. */
struct db_error_region *db_error_regions_by_region(const struct db_exemplar *items,
                                                   const uint8_t *given, size_t item_count,
                                                   size_t region_count, size_t *count);

/* The same gathered by squares of `side` pixels; class_index is the commonest true class among the
 * mistaken. */
struct db_error_region *db_error_regions_by_square(const struct db_exemplar *items,
                                                   const uint8_t *given, size_t item_count,
                                                   int side, const struct db_grid *grid,
                                                   size_t *count);

/* Write regions.csv, squares.csv and worst.txt into `folder`: where systematic errors lie. */
int db_error_regions_write(const char *folder, const struct db_exemplar *items,
                           const uint8_t *given, size_t item_count, const struct db_region *regions,
                           size_t region_count, int side, const struct db_grid *grid,
                           const struct db_class_table *table);

/* "folder/name" in `path`; makes the folder when it is missing. Returns 0, or -1 reported. */
int db_report_path(char *path, size_t size, const char *folder, const char *name);

#endif
