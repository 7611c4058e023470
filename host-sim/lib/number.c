#include "hs/number.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char digits[] = "0123456789", blanks[] = " \t";

/* Behind the number that `text` begins with, or NULL. */
static const char *end_of(const char *text)
{
    text += *text == '+' || *text == '-';
    const size_t whole = strspn(text, digits);
    text += whole;
    const size_t part = *text == '.' ? strspn(text + 1, digits) : 0;
    text += *text == '.' && whole + part > 0 ? part + 1 : 0;
    if (*text == 'e' || *text == 'E') {
        const char *power = text + 1;
        power += *power == '+' || *power == '-';
        const size_t length = strspn(power, digits);
        text = length > 0 ? power + length : text;
    }
    return whole + part > 0 && *text != 'x' && *text != 'X' ? text : NULL;
}

const char *hs_number_begin(const char *text, double *number)
{
    text += strspn(text, blanks);
    const char *end = end_of(text);
    const double value = end ? strtod(text, NULL) : 0;
    if (!end || !isfinite(value)) {
        return NULL;
    }
    *number = value;
    return end;
}

bool hs_number(const char *text, double *number)
{
    double value;
    const char *end = hs_number_begin(text, &value);
    if (!end || end[strspn(end, blanks)] != '\0') {
        return false;
    }
    *number = value;
    return true;
}

bool hs_number_within(const char *text, double low, double high, double *number)
{
    double value;
    if (!hs_number(text, &value) || !(value >= low && value <= high)) {
        return false;
    }
    *number = value;
    return true;
}

int hs_numbers(const char *text, char separator, double *numbers, int most)
{
    int count = 0;
    for (;;) {
        const char *end = count < most ? hs_number_begin(text, &numbers[count]) : NULL;
        if (!end) {
            return -1;
        }
        count++;
        end += strspn(end, blanks);
        if (*end == '\0') {
            return count;
        }
        if (*end != separator) {
            return -1;
        }
        text = end + 1;
    }
}
