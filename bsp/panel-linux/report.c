#include "report.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

/* The journal takes a line's importance from a number before it (sd-daemon(3)). */
static int begin(char *line, size_t size, enum report_level level)
{
    const char *const name = "landmass-panel: ";
    return getenv("JOURNAL_STREAM") != NULL ? snprintf(line, size, "<%d>%s", (int)level, name)
                                            : snprintf(line, size, "%s", name);
}

void report(enum report_level level, const char *format, ...)
{
    char line[400];
    const int start = begin(line, sizeof line, level);
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(line + start, sizeof line - (size_t)start, format, arguments);
    va_end(arguments);
    length = length < 0 ? start : start + length;
    if (length > (int)sizeof line - 1) {
        length = (int)sizeof line - 1;
    }
    line[length] = '\n'; /* in the place of the terminating zero */
    if (write(STDERR_FILENO, line, (size_t)length + 1) < 0) {
        return; /* nobody is left to be told */
    }
}
