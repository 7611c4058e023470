#include "nav/parse.h"

#include "hs/number.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

char *nav_next_line(char **text)
{
    char *line = *text;
    if (*line == '\0') {
        return NULL;
    }
    char *end = line + strcspn(line, "\n");
    *text = *end ? end + 1 : end;
    if (end > line && end[-1] == '\r') {
        end--;
    }
    *end = '\0';
    return line;
}

/* Hours and minutes of an offset from UTC, in seconds; `text` is what follows the seconds. */
static bool parse_offset(const char *text, long *offset_s)
{
    int hours = 0, minutes = 0, used = 0;
    *offset_s = 0;
    if (*text == '\0' || strcmp(text, "Z") == 0) {
        return true;
    }
    if ((*text != '+' && *text != '-') ||
        (sscanf(text + 1, "%2d:%2d%n", &hours, &minutes, &used) < 2 &&
         sscanf(text + 1, "%2d%2d%n", &hours, &minutes, &used) < 2) ||
        text[1 + used] != '\0') {
        return false;
    }
    *offset_s = (*text == '-' ? -1L : 1L) * (hours * 3600L + minutes * 60L);
    return true;
}

static bool parse_iso_time(const char *text, int64_t *time_us)
{
    int year, month, day, hour, minute, used = 0;
    double second;
    char separator;
    if (sscanf(text, "%4d-%2d-%2d%c%2d:%2d:%n", &year, &month, &day, &separator, &hour, &minute,
               &used) < 6 ||
        used == 0 || (separator != 'T' && separator != ' ') || !isdigit(text[used])) {
        return false;
    }
    char *end;
    second = strtod(text + used, &end);
    long offset_s;
    struct tm utc = {.tm_year = year - 1900, .tm_mon = month - 1, .tm_mday = day};
    const time_t midnight = timegm(&utc);
    /* timegm carries 31 June over to 1 July; such a date is a mistake here. */
    if (utc.tm_mon != month - 1 || utc.tm_mday != day || hour > 23 || minute > 59 ||
        !(second < 61) || hour < 0 || minute < 0 || !parse_offset(end, &offset_s)) {
        return false;
    }
    *time_us = ((int64_t)midnight + hour * 3600 + minute * 60 - offset_s) * 1000000 +
               llround(second * 1e6);
    return *time_us >= 0;
}

bool nav_parse_time(const char *text, int64_t *time_us)
{
    double count;
    if (!hs_number(text, &count)) {
        return parse_iso_time(text, time_us);
    }
    const double unit_us = count < 1e11 ? 1e6 : count < 1e14 ? 1e3 : 1;
    if (count < 0 || count > 4e15) {
        return false;
    }
    *time_us = llround(count * unit_us);
    return true;
}
