/* Numbers written in decimal, as options and text files have them.
 *
 * A number is a sign if need be, digits with one point at most, and a power of ten if need be:
 * "-12", ".5", "+1.25e-3". Blanks and tabs around it are passed over. Hexadecimal, "inf", "nan",
 * "1,5" and "0x10" are no numbers. One that is too large for a double is refused, and one that is
 * too small becomes the nearest: a denormal number or 0. The locale must be the C locale, as it is
 * in all programs here. */
#ifndef HS_NUMBER_H
#define HS_NUMBER_H

#include <stdbool.h>

/* The whole of `text`. Returns false, and leaves *number alone, when it is no number. */
bool hs_number(const char *text, double *number);

/* The same of a number within low..high, ends included. */
bool hs_number_within(const char *text, double low, double high, double *number);

/* The number that `text` begins with. Returns what stands behind it, or NULL with *number alone.
 * What looks like a longer number, "0x10", is none. */
const char *hs_number_begin(const char *text, double *number);

/* Numbers parted by `separator`, "36.5,14.2": the whole of `text` into at most `most` places.
 * Returns how many, or -1 when there are more, or one is no number. */
int hs_numbers(const char *text, char separator, double *numbers, int most);

#endif
