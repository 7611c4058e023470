/* Numbers of the text: exact decimals of what the table holds. */
#ifndef RADAR_NUMBER_H
#define RADAR_NUMBER_H

#include "keys.h"

enum { RADAR_NUMBER_SIZE = 32 };

/* The shortest decimal that reads back as `value` of the table. */
void radar_number_write(char text[RADAR_NUMBER_SIZE], const struct radar_unit *unit, int64_t value);

/* The value of the table that is nearest to a number of people's unit, |number| <= 1e9. */
int64_t radar_number_value(const struct radar_unit *unit, double number);

#endif
