#include "hs/output_path.h"

#include "hs/error.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

int hs_output_folder_check(const char *folder)
{
    struct stat status;
    if (stat(folder, &status) == 0) {
        return !S_ISDIR(status.st_mode) ? hs_error(folder, "name another folder", "is no folder")
               : access(folder, W_OK | X_OK) == 0
                   ? 0
                   : hs_error(folder, "name another folder", "cannot be written to: %s",
                              strerror(errno));
    }
    char above[PATH_MAX + 8];
    size_t length = strlen(folder);
    while (length > 1 && folder[length - 1] == '/') {
        length--;
    }
    while (length > 0 && folder[length - 1] != '/') {
        length--;
    }
    snprintf(above, sizeof above, "%.*s", length > 0 ? (int)length : 1, length > 0 ? folder : ".");
    return access(above, W_OK | X_OK) == 0 ? 0
                                           : hs_error(folder, "check the folder above it",
                                                      "cannot be made: %s", strerror(errno));
}
