#include "gis/complex_raster.h"

#include "gis/gdal_start.h"
#include "gis/raster.h"
#include "hs/atomic_file.h"
#include "hs/error.h"

#include <cpl_string.h>
#include <ogr_srs_api.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { COMMENT = 80, COMMENTS = 9 /* that NITF takes */ };

static bool ends_with(const char *path, const char *end)
{
    const size_t length = strlen(path), tail = strlen(end);
    return length > tail && strcasecmp(path + length - tail, end) == 0;
}

/* NITF keeps the notes as lines of 80 characters. */
static GDALDatasetH create_nitf(const char *name, int width, int height,
                                const struct db_complex_note *notes, int count)
{
    char comments[COMMENTS * COMMENT + 1] = "", note[COMMENT + 1], **options = NULL;
    char title[COMMENT + 1] = "simulated complex radar picture";
    if (count > COMMENTS) {
        const struct db_complex_note *last = &notes[COMMENTS];
        snprintf(title, sizeof title, "simulated; %.8s=%.60s", last->name, last->value);
    }
    for (int i = 0; i < count && i < COMMENTS; i++) {
        snprintf(note, sizeof note, "%s=%s", notes[i].name, notes[i].value);
        snprintf(comments + i * COMMENT, COMMENT + 1, "%-80s", note);
    }
    options = CSLSetNameValue(options, "ICAT", "SAR");
    options = CSLSetNameValue(options, "IREPBAND", ",");
    options = CSLSetNameValue(options, "ISUBCAT", "I,Q");
    options = CSLSetNameValue(options, "FTITLE", title);
    options = CSLSetNameValue(options, "ICOM", comments);
    const GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("NITF"), name, width, height, 2,
                                            GDT_Float32, (void *)options);
    CSLDestroy(options);
    return dataset;
}

static GDALDatasetH create_tiff(const char *name, int width, int height,
                                const struct db_complex_note *notes, int count)
{
    const GDALDatasetH dataset =
        GDALCreate(GDALGetDriverByName("GTiff"), name, width, height, 1, GDT_CFloat32, NULL);
    for (int i = 0; dataset && i < count; i++) {
        GDALSetMetadataItem(dataset, notes[i].name, notes[i].value, NULL);
    }
    return dataset;
}

/* Band by band: one of complex numbers, or their halves. */
static bool write_bands(GDALDatasetH dataset, const float complex *pixels, int width, int height)
{
    const int bands = GDALGetRasterCount(dataset), pixel = (int)sizeof *pixels;
    const GDALDataType type = bands == 1 ? GDT_CFloat32 : GDT_Float32;
    for (int b = 0; b < bands; b++) {
        float *first = (float *)pixels + b;
        if (GDALRasterIO(GDALGetRasterBand(dataset, b + 1), GF_Write, 0, 0, width, height, first,
                         width, height, type, pixel, pixel * width) != CE_None) {
            return false;
        }
    }
    return true;
}

static bool set_place(GDALDatasetH dataset, const struct db_complex_place *place)
{
    double degrees[6];
    memcpy(degrees, place->degrees, sizeof degrees);
    const OGRSpatialReferenceH crs = OSRNewSpatialReference(NULL);
    OSRSetAxisMappingStrategy(crs, OAMS_TRADITIONAL_GIS_ORDER);
    const bool is_set = OSRImportFromEPSG(crs, 4326) == OGRERR_NONE &&
                        GDALSetSpatialRef(dataset, crs) == CE_None &&
                        GDALSetGeoTransform(dataset, degrees) == CE_None;
    OSRDestroySpatialReference(crs);
    return is_set;
}

int db_complex_write(const char *path, const float complex *pixels, int width, int height,
                     const struct db_complex_note *notes, int count,
                     const struct db_complex_place *place)
{
    const bool is_nitf = ends_with(path, ".ntf") || ends_with(path, ".nitf");
    if (!is_nitf && !ends_with(path, ".tif") && !ends_with(path, ".tiff")) {
        return hs_error(path, "call it FILE.tif or FILE.ntf", "has no known form");
    }
    if (is_nitf && place) {
        return hs_error(path, "call it FILE.tif", "a NITF has no place on earth for it");
    }
    db_gdal_start();
    struct db_raster_out out = {.width = width, .type = GDT_CFloat32};
    out.path = strdup(path);
    out.temporary = hs_atomic_temporary_name(path);
    CPLErrorReset();
    if (out.path && out.temporary) {
        out.dataset =
            (is_nitf ? create_nitf : create_tiff)(out.temporary, width, height, notes, count);
    }
    if (!out.dataset || (place && !set_place(out.dataset, place)) ||
        !write_bands(out.dataset, pixels, width, height)) {
        hs_error(path, "check that the folder can be written and has room", "cannot be written: %s",
                 db_gdal_complaint());
        db_raster_abort(&out);
        return -1;
    }
    return db_raster_commit(&out);
}
