#include "report.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

/* The journal takes a line's importance from a number before it (sd-daemon(3)). */
static int begin(char *line, size_t size, enum report_level level)
{
    const char *const name = "landmass-panel: ";
    return getenv("JOURNAL_STREAM") != NULL ? snprintf(line, size, "<%d>%s", (int)level, name)
                                            : snprintf(line, size, "%s", name);
}

/* The journal is a socket: a journal that does not read must not stop the loop. An error of
 * printing cannot be reported anywhere. */
static void print_line(const char *line, size_t size)
{
    if (send(STDERR_FILENO, line, size, MSG_DONTWAIT | MSG_NOSIGNAL) < 0 && errno == ENOTSOCK &&
        write(STDERR_FILENO, line, size) < 0) {
        return;
    }
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
    print_line(line, (size_t)length + 1);
}
