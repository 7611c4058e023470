#include "support.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

int support_data_path(const char *relative, char *path, size_t size)
{
    const char *root = getenv("LANDMASS_DATA");
    snprintf(path, size, "%s/%s", root ? root : "../shared/data", relative);
    if (access(path, R_OK) == 0) {
        return 1;
    }
    printf("# skipped: no %s here\n", path);
    return 0;
}

const char *support_build_dir(void)
{
    const char *build = getenv("BUILD");
    return build ? build : "build/bench-linux";
}

unsigned long support_number(const char *variable, unsigned long usual)
{
    const char *text = getenv(variable);
    return text ? strtoul(text, NULL, 10) : usual;
}

int support_run(const char *format, ...)
{
    char command[4096];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(command, sizeof command, format, arguments);
    va_end(arguments);
    if (length < 0 || length >= (int)sizeof command) {
        return -1;
    }
    fflush(stdout);
    const int status = system(command);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
