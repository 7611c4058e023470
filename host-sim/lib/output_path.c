#include "hs/output_path.h"

#include "hs/error.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

int hs_output_path(char *path, size_t size, const char *folder, const char *name)
{
    if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
        return hs_error(folder, "check the folder above it", "cannot be made: %s", strerror(errno));
    }
    const int length = snprintf(path, size, "%s/%s", folder, name);
    return length > 0 && (size_t)length < size
               ? 0
               : hs_error(folder, "use a shorter name", "the path is too long");
}
