/* Split of the exemplars into those that the network learns from and those that are kept to judge
 * it by. */
#ifndef CLASSIFY_SPLIT_H
#define CLASSIFY_SPLIT_H

#include "classify/samples.h"

#include <stdbool.h>

/* Give about `fraction` of the training exemplars of each class the part `part`.
 *
 * By regions: whole regions, drawn at random until the fraction is reached; one that would
 * overshoot half as much again is passed over while others are left. Every class keeps a region to
 * train on, so a class of one region gives none away: it is warned of, unless `quiet`. By pixels:
 * at random, neighbours and all; the result flatters, because neighbours are alike. Returns 0, or
 * -1 out of memory, reported. */
int db_split(struct db_samples *s, size_t region_count, const struct db_class_table *table,
             bool by_regions, double fraction, uint64_t seed, enum db_part part, bool quiet);

/* Drop all but one of each set of training exemplars of a class that are alike: whose inputs fall
 * in the same cell of `cell` standard deviations in every band. `scale` holds the deviation of each
 * input. Returns how many were dropped, or -1 out of memory, reported. */
long db_thin(struct db_samples *s, const float *scale, double cell);

#endif
