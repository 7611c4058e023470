/* Radar table as text (docs/FORMATS.md, 7): one line for each field of struct lm_radar, named as
 * lm_radar_field names it, with numbers in the units of people. */
#ifndef RADAR_TEXT_H
#define RADAR_TEXT_H

#include "lm/radar.h"

#include <stdio.h>

/* Write a table that lm_radar_check has passed. Reading it gives the same table, bit for bit. */
void radar_text_print(FILE *out, const struct lm_radar *radar);

/* Read and check a table. A wavelength outside the band that the table says is warned of.
 *
 * Returns 0, or -1 with file, line, field, cause and remedy reported, and *radar unspecified:
 * - the file cannot be read,
 * - a line is no `field = numbers unit`, names no field or one that stood before, or a field is
 *   missing,
 * - a number is none, is not whole where it counts, or lies outside the field's range, or there are
 *   too many or too few,
 * - the unit is missing or another,
 * - a rule between fields is broken. */
int radar_text_read(struct lm_radar *radar, const char *path);

#endif
