#include "number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

int64_t radar_number_value(const struct radar_unit *unit, double number)
{
    return llround(number * unit->one);
}

void radar_number_write(char text[RADAR_NUMBER_SIZE], const struct radar_unit *unit, int64_t value)
{
    enum { DIGITS_MAX = 16 };
    const double number = (double)value / unit->one;
    for (int digits = 0; digits <= DIGITS_MAX; digits++) {
        snprintf(text, RADAR_NUMBER_SIZE, "%.*f", digits, number);
        if (radar_number_value(unit, strtod(text, NULL)) == value) {
            return;
        }
    }
}
