/* Dump of a picture: every stage of it in a file, for comparison with something else. */
#ifndef REFERENCE_DUMP_H
#define REFERENCE_DUMP_H

#include "reference/reference.h"

/* Write one row a range cell, guard cells included, line by line: as CSV with a heading, or, when
 * the path ends in ".f64", as raw doubles of this machine in the same columns. The file appears
 * whole or not at all. Returns 0, or -1 with the error reported. */
int ref_dump(const struct ref_picture *picture, const char *path);

/* The columns, separated by commas. */
extern const char ref_dump_columns[];

#endif
