#include "hs/error.h"

#include "hs/input_file.h"

#include <stdarg.h>
#include <stdio.h>

static const char *program_name = "landmass";

void hs_set_program(const char *name)
{
    program_name = name;
    hs_input_guard();
}

const char *hs_program(void)
{
    return program_name;
}

static void report(const char *place, const char *severity, const char *remedy, const char *cause,
                   va_list arguments)
{
    fflush(stdout);
    fprintf(stderr, "%s: %s: %s", program_name, place, severity);
    vfprintf(stderr, cause, arguments);
    if (remedy) {
        fprintf(stderr, "; %s", remedy);
    }
    fputc('\n', stderr);
}

int hs_error(const char *place, const char *remedy, const char *cause, ...)
{
    va_list arguments;
    va_start(arguments, cause);
    report(place, "", remedy, cause, arguments);
    va_end(arguments);
    return -1;
}

int hs_warn(const char *place, const char *remedy, const char *cause, ...)
{
    va_list arguments;
    va_start(arguments, cause);
    report(place, "warning: ", remedy, cause, arguments);
    va_end(arguments);
    return 0;
}

int hs_doubt(bool is_trusted, const char *place, const char *remedy, const char *cause, ...)
{
    char whole[512];
    snprintf(whole, sizeof whole, "%s, or say --trust-inputs if it is right", remedy);
    va_list arguments;
    va_start(arguments, cause);
    report(place, is_trusted ? "warning: " : "", is_trusted ? NULL : whole, cause, arguments);
    va_end(arguments);
    return is_trusted ? 0 : -1;
}
