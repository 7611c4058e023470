#include "hs/error.h"

#include "hs/input_file.h"
#include "hs/report.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static const char *program_name = "landmass";
static hs_error_listener *error_listener;
static void *error_listener_ctx;

void hs_error_listen(hs_error_listener *listener, void *ctx)
{
    error_listener = listener;
    error_listener_ctx = ctx;
}

void hs_set_program(const char *name)
{
    program_name = name;
    hs_input_guard();
}

const char *hs_program(void)
{
    return program_name;
}

static void report(const char *place, bool is_error, const char *remedy, const char *cause,
                   va_list arguments)
{
    char *text = NULL;
    if (vasprintf(&text, cause, arguments) < 0) {
        text = NULL;
    }
    const char *said = text ? text : cause;
    fflush(stdout);
    fprintf(stderr, "%s: %s: %s%s%s%s\n", program_name, place, is_error ? "" : "warning: ", said,
            remedy ? "; " : "", remedy ? remedy : "");
    if (is_error && error_listener) {
        error_listener(error_listener_ctx, place, said, remedy);
    }
    hs_report_message(is_error ? "error" : "warning", place, said, remedy);
    free(text);
}

int hs_error(const char *place, const char *remedy, const char *cause, ...)
{
    va_list arguments;
    va_start(arguments, cause);
    report(place, true, remedy, cause, arguments);
    va_end(arguments);
    return -1;
}

int hs_warn(const char *place, const char *remedy, const char *cause, ...)
{
    va_list arguments;
    va_start(arguments, cause);
    report(place, false, remedy, cause, arguments);
    va_end(arguments);
    return 0;
}

int hs_doubt(bool is_trusted, const char *place, const char *remedy, const char *cause, ...)
{
    char whole[512];
    snprintf(whole, sizeof whole, "%s, or say --trust-inputs if it is right", remedy);
    va_list arguments;
    va_start(arguments, cause);
    report(place, !is_trusted, is_trusted ? NULL : whole, cause, arguments);
    va_end(arguments);
    return is_trusted ? 0 : -1;
}
