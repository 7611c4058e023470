#include "netem/chip.h"

#include "gis/gdal_start.h"
#include "hs/error.h"
#include "hs/input_file.h"

#include <errno.h>
#include <gdal.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { FILE_MAX = 64 << 20 };

static const char remedy[] = "copy the chip again";

/* The whole file and a zero behind it. Returns 0, or -1 with the error reported. */
static int read_bytes(const char *path, unsigned char **bytes, size_t *size)
{
    FILE *stream = hs_input_open(path, "rb");
    if (!stream) {
        return hs_error(path, "check the name", "cannot be opened: %s", strerror(errno));
    }
    *bytes = malloc(FILE_MAX + 1);
    *size = *bytes ? fread(*bytes, 1, FILE_MAX, stream) : 0;
    const int is_whole = *bytes && !ferror(stream) && fgetc(stream) == EOF && *size > 0;
    fclose(stream);
    if (!is_whole) {
        free(*bytes);
        return hs_error(path, remedy, "is empty, cannot be read, or has more than %d MiB",
                        FILE_MAX >> 20);
    }
    (*bytes)[*size] = 0;
    return 0;
}

static int take_raster(struct nm_chip *chip, const char *path, GDALDatasetH file)
{
    const int width = GDALGetRasterXSize(file), height = GDALGetRasterYSize(file);
    if (width > NM_PICTURE_SIDE_MAX || height > NM_PICTURE_SIDE_MAX) {
        return hs_error(path, "cut the target out", "has %d x %d pixels, more than %d a side",
                        width, height, NM_PICTURE_SIDE_MAX);
    }
    const GDALRasterBandH band = GDALGetRasterBand(file, 1);
    if (nm_picture_open(&chip->picture, width, height) != 0) {
        return -1;
    }
    double *pixels = chip->picture.pixels;
    if (GDALRasterIO(band, GF_Read, 0, 0, width, height, pixels, width, height, GDT_Float64, 0,
                     0) != CE_None) {
        nm_picture_close(&chip->picture);
        return hs_error(path, remedy, "cannot be read: %s", db_gdal_complaint());
    }
    const double scale = GDALGetRasterDataType(band) == GDT_Byte ? 1 / 255.0 : 1;
    for (int i = 0; i < width * height; i++) {
        if (!(pixels[i] >= 0 && pixels[i] <= 1e9)) {
            nm_picture_close(&chip->picture);
            return hs_error(path, "give amplitudes", "pixel %d of row %d is no amplitude",
                            i % width + 1, i / width + 1);
        }
        pixels[i] *= scale;
    }
    return 0;
}

static int read_raster(struct nm_chip *chip, const char *path)
{
    static const char *const drivers[] = {"PNG", "JPEG", "GTiff", NULL};
    const GDALDatasetH file =
        db_gdal_note(GDALOpenEx(path, GDAL_OF_RASTER | GDAL_OF_READONLY, drivers, NULL, NULL));
    if (!file) {
        return hs_error(path, "give raw MSTAR, .csv, PNG, JPEG or TIFF", "is no chip: %s",
                        db_gdal_complaint());
    }
    const int result = take_raster(chip, path, file);
    GDALClose(file);
    return result;
}

static int has_ending(const char *path, const char *ending)
{
    const size_t length = strlen(path), tail = strlen(ending);
    return length >= tail && strcasecmp(path + length - tail, ending) == 0;
}

static const char mstar_start[] = "[PhoenixHeaderVer";

int nm_chip_seems(const char *path)
{
    static const char *const endings[] = {".csv", ".png", ".jpg", ".jpeg", ".tif", ".tiff"};
    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        if (has_ending(path, endings[i])) {
            return 1;
        }
    }
    char start[sizeof mstar_start] = "";
    FILE *stream = hs_input_open(path, "rb");
    const size_t size = stream ? fread(start, 1, sizeof start - 1, stream) : 0;
    if (stream) {
        fclose(stream);
    }
    return size == sizeof start - 1 && strcmp(start, mstar_start) == 0;
}

int nm_chip_read(struct nm_chip *chip, const char *path)
{
    *chip = (struct nm_chip){.azimuth_deg = NAN, .depression_deg = NAN};
    const char *slash = strrchr(path, '/');
    snprintf(chip->name, sizeof chip->name, "%s", slash ? slash + 1 : path);
    unsigned char *bytes = NULL;
    size_t size = 0;
    if (read_bytes(path, &bytes, &size) != 0) {
        return -1;
    }
    int result;
    if (strncmp((const char *)bytes, mstar_start, sizeof mstar_start - 1) == 0) {
        result = nm_chip_parse_mstar(chip, path, bytes, size);
    } else if (has_ending(path, ".csv")) {
        result = nm_chip_parse_csv(chip, path, (const char *)bytes, size);
    } else {
        result = read_raster(chip, path);
    }
    free(bytes);
    return result;
}
