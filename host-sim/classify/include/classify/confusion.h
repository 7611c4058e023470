/* Confusion matrix: how well each class is recognised, and the figures that follow from it. */
#ifndef CLASSIFY_CONFUSION_H
#define CLASSIFY_CONFUSION_H

#include "hs/class_table.h"

#include <stdint.h>
#include <stdio.h>

/* counts[t][p]: pixels of class t that were given class p, by index into the class table. */
struct db_confusion {
    uint64_t counts[DB_CLASS_MAX][DB_CLASS_MAX];
};

/* Number of pixels. */
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

/* The same as the object `key` of the report (hs/report.h). "given" of a class are the pixels that
 * were given each class of the list. */
void db_confusion_report(const char *key, const struct db_confusion *c,
                         const struct db_class_table *table);

/* The same as CSV: a heading, then one row a true class. Returns 0, or -1 reported. */
int db_confusion_write(const char *path, const struct db_confusion *c,
                       const struct db_class_table *table);

#endif
