/* hs/error.h without the noise: a fuzzer provokes a million messages. Each is still formatted, so
 * that a format that reads too far is seen. */
#include "hs/error.h"

#include <stdarg.h>
#include <stdio.h>

void hs_set_program(const char *name)
{
    (void)name;
}

const char *hs_program(void)
{
    return "fuzz";
}

static void format(const char *place, const char *remedy, const char *cause, va_list arguments)
{
    char text[4096];
    snprintf(text, sizeof text, "%s %s", place, remedy ? remedy : "");
    vsnprintf(text, sizeof text, cause, arguments);
}

int hs_error(const char *place, const char *remedy, const char *cause, ...)
{
    va_list arguments;
    va_start(arguments, cause);
    format(place, remedy, cause, arguments);
    va_end(arguments);
    return -1;
}

int hs_warn(const char *place, const char *remedy, const char *cause, ...)
{
    va_list arguments;
    va_start(arguments, cause);
    format(place, remedy, cause, arguments);
    va_end(arguments);
    return 0;
}

int hs_doubt(bool is_trusted, const char *place, const char *remedy, const char *cause, ...)
{
    va_list arguments;
    va_start(arguments, cause);
    format(place, remedy, cause, arguments);
    va_end(arguments);
    return is_trusted ? 0 : -1;
}
