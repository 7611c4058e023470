/* How well classes are recognised: the confusion matrix and what follows from it, and where in the
 * image the errors lie. */
#ifndef DB_EVALUATE_H
#define DB_EVALUATE_H

#include "exemplars.h"

#include <stdio.h>

/* counts[t][p]: pixels of class t that were given class p, by index into the class table. */
struct db_confusion {
    uint64_t counts[DB_CLASS_MAX][DB_CLASS_MAX];
};

uint64_t db_confusion_total(const struct db_confusion *c);

/* Part of all pixels that were given their class; NaN without pixels. */
double db_confusion_accuracy(const struct db_confusion *c);

/* Cohen's kappa, the agreement beyond that of chance (Educational and Psychological Measurement 20,
 * 1960, p. 40); NaN without pixels or when chance alone agrees fully. */
double db_confusion_kappa(const struct db_confusion *c);

/* Part of the pixels of class t that were given it; NaN without any. */
double db_confusion_recall(const struct db_confusion *c, int t);

/* Part of the pixels given class p that belong to it; NaN without any. */
double db_confusion_precision(const struct db_confusion *c, int p);

/* Mean of the recall over the classes that occur; NaN without any. */
double db_confusion_mean_recall(const struct db_confusion *c);

/* The matrix as a table to read, rows the true classes; classes that occur in neither way are left
 * out. */
void db_confusion_print(FILE *out, const struct db_confusion *c,
                        const struct db_class_table *table);

/* The same as CSV: a heading, then one row a true class. Returns 0, or -1 reported. */
int db_confusion_write(const char *path, const struct db_confusion *c,
                       const struct db_class_table *table);

/* What happened to the exemplars of one region, or of one square of the image. */
struct db_place {
    size_t index; /* of the region, or of the square in reading order */
    uint8_t class_index;
    uint8_t part;
    uint8_t mistaken_for; /* the commonest wrong class; DB_CLASS_NODATA when there is none */
    uint64_t count, right;
};

/* The exemplars with `given` classes (DB_CLASS_NODATA counts as wrong), gathered by region, worst
 * first: by the part recognised, then by size. Returns an array of *count places that the caller
 * frees, or NULL out of memory. */
struct db_place *db_places_by_region(const struct db_exemplar *items, const uint8_t *given,
                                     size_t item_count, size_t region_count, size_t *count);

/* The same gathered by squares of `side` pixels; class_index is the commonest true class among the
 * mistaken. */
struct db_place *db_places_by_square(const struct db_exemplar *items, const uint8_t *given,
                                     size_t item_count, int side, const struct db_grid *grid,
                                     size_t *count);

/* Write regions.csv, squares.csv and worst.txt into `folder`: where systematic errors lie. */
int db_places_write(const char *folder, const struct db_exemplar *items, const uint8_t *given,
                    size_t item_count, const struct db_region *regions, size_t region_count,
                    int side, const struct db_grid *grid, const struct db_class_table *table);

/* "folder/name" in `path`; makes the folder when it is missing. Returns 0, or -1 reported. */
int db_report_path(char *path, size_t size, const char *folder, const char *name);

#endif
