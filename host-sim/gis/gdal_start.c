#include "gis/gdal_start.h"

#include "hs/input_file.h"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_vsi.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { CACHE_BYTES = 128 << 20 };

void db_gdal_start(void)
{
    GDALAllRegister();
    CPLSetErrorHandler(CPLQuietErrorHandler);
    GDALSetCacheMax64(CACHE_BYTES);
}

/* "/vsizip/folder/a.zip/b.hgt" lies in the file folder/a.zip: the longest part that is a file. */
static void note_file(const char *name)
{
    char path[PATH_MAX];
    struct stat status;
    const char *prefixes[] = {"/vsizip/", "/vsigzip/", "/vsitar/"};
    for (int i = 0; i < 3; i++) {
        const size_t length = strlen(prefixes[i]);
        name += strncmp(name, prefixes[i], length) == 0 ? length : 0;
    }
    snprintf(path, sizeof path, "%s", name);
    char *slash = NULL;
    while (stat(path, &status) != 0 && (slash = strrchr(path, '/')) && slash != path) {
        *slash = '\0';
    }
    hs_input_note(path);
    if (!slash) {
        hs_input_note_folder(path);
    }
}

GDALDatasetH db_gdal_note(GDALDatasetH dataset)
{
    char **files = dataset ? GDALGetFileList(dataset) : NULL;
    for (int i = 0; files && files[i]; i++) {
        note_file(files[i]);
    }
    CSLDestroy(files);
    return dataset;
}

bool db_gdal_is_data(const char *path)
{
    VSIStatBufL status;
    return !EQUAL(CPLGetExtension(path), "xml") && VSIStatL(path, &status) == 0 &&
           !VSI_ISDIR(status.st_mode);
}

const char *db_gdal_complaint(void)
{
    const char *message = CPLGetLastErrorMsg();
    return message[0] ? message : "unknown cause";
}
