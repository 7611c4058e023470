#include "gis/complex_raster.h"

#include "gis/gdal_start.h"
#include "gis/raster.h"
#include "hs/atomic_file.h"
#include "hs/error.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <math.h>
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

bool db_complex_is_nitf(const char *path)
{
    return ends_with(path, ".ntf") || ends_with(path, ".nitf");
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

/* Write the pixels of an open dataset, and close it whole. */
static int finish(struct db_raster_out *out, const float complex *pixels, int width, int height)
{
    if (!out->dataset || !write_bands(out->dataset, pixels, width, height)) {
        hs_error(out->path, "check that the folder can be written and has room",
                 "cannot be written: %s", db_gdal_complaint());
        db_raster_abort(out);
        return -1;
    }
    return db_raster_commit(out);
}

/* A raster of complex numbers that has no dataset yet; nor names, if memory is short. */
static struct db_raster_out begin(const char *path, int width)
{
    db_gdal_start();
    struct db_raster_out out = {.width = width, .type = GDT_CFloat32};
    out.path = strdup(path);
    out.temporary = hs_atomic_temporary_name(path);
    CPLErrorReset();
    return out;
}

int db_complex_write(const char *path, const float complex *pixels, int width, int height,
                     const struct db_complex_note *notes, int count,
                     const struct db_complex_place *place)
{
    const bool is_nitf = db_complex_is_nitf(path);
    if (!is_nitf && !ends_with(path, ".tif") && !ends_with(path, ".tiff")) {
        return hs_error(path, "call it FILE.tif or FILE.ntf", "has no known form");
    }
    if (is_nitf && place) {
        return hs_error(path, "call it FILE.tif", "a NITF without geometry has no place on earth");
    }
    struct db_raster_out out = begin(path, width);
    if (out.path && out.temporary) {
        out.dataset =
            (is_nitf ? create_nitf : create_tiff)(out.temporary, width, height, notes, count);
    }
    if (out.dataset && place && !set_place(out.dataset, place)) {
        GDALClose(out.dataset);
        out.dataset = NULL;
    }
    return finish(&out, pixels, width, height);
}

/* ---- SICD ---- */

/* Header of the segment: version, security and length, then the 773 characters that SICD puts
 * there, each field filled up with blanks. */
static void put_segment_head(FILE *out)
{
    const struct {
        const char *text;
        int size;
    } fields[] = {
        {"01", 2},
        {"U", 1},
        {"", 166},
        {"0773", 4},
        {"99999", 5},
        {"XML", 8},
        {"2000-01-01T00:00:00Z", 20},
        {"", 40},
        {"SICD Volume 1 Design & Implementation Description Document", 60},
        {"1.2.1", 10},
        {"2018-12-13T00:00:00Z", 20},
        {"urn:SICD:1.2.1", 120},
        {"", 125},
        {"", 25},
        {"", 20},
        {"", 120},
        {"", 200},
    };
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        fprintf(out, "%-*s", fields[i].size, fields[i].text);
    }
}

static char *segment_of(const char *text)
{
    char *segment = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&segment, &size);
    if (!out) {
        return NULL;
    }
    fputs("XML_DATA_CONTENT=", out);
    put_segment_head(out);
    fputs(text, out);
    if (fclose(out) != 0) {
        free(segment);
        return NULL;
    }
    return segment;
}

/* Degrees, minutes and seconds of a corner, with letters; 180 degrees at most. */
static void put_corner(FILE *out, const double corner[2])
{
    const long north = lrint(fabs(corner[0]) * 3600), east = lrint(fabs(corner[1]) * 3600);
    fprintf(out, "%02ld%02ld%02ld%c", north / 3600, north / 60 % 60, north % 60,
            corner[0] < 0 ? 'S' : 'N');
    fprintf(out, "%03ld%02ld%02ld%c", east / 3600, east / 60 % 60, east % 60,
            corner[1] < 0 ? 'W' : 'E');
}

static GDALDatasetH create_sicd(const char *name, int width, int height, const struct db_sicd *sicd)
{
    char *corners = NULL, *segment = segment_of(sicd->text), **options = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&corners, &size);
    for (int i = 0; out && i < 4; i++) {
        put_corner(out, sicd->corners[i]);
    }
    if (!segment || !out || fclose(out) != 0) {
        free(segment);
        free(corners);
        return NULL;
    }
    static const char *const words[][2] = {{"ICAT", "SAR"},
                                           {"IREP", "NODISPLY"},
                                           {"IREPBAND", ","},
                                           {"ISUBCAT", "I,Q"},
                                           {"IID1", "SICD000"},
                                           {"IID2", "SICD: simulated"},
                                           {"ICORDS", "G"},
                                           {"FTITLE", "SICD: simulated"},
                                           {"IDATIM", "20000101000000"},
                                           {"ISCLAS", "U"},
                                           {"FSCLAS", "U"},
                                           {"OSTAID", "landmass"},
                                           {"NUMDES", "1"}};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++) {
        options = CSLSetNameValue(options, words[i][0], words[i][1]);
    }
    options = CSLSetNameValue(options, "IGEOLO", corners);
    options = CSLSetNameValue(options, "DES", segment);
    const GDALDatasetH dataset = GDALCreate(GDALGetDriverByName("NITF"), name, width, height, 2,
                                            GDT_Float32, (void *)options);
    CSLDestroy(options);
    free(segment);
    free(corners);
    return dataset;
}

/* From one band after the other (IMODE B) to pixel after pixel (P). The file's header says at HL
 * where it ends and the image's begins; IMODE is at a fixed place of that, with corners, without
 * comments, with two bands. */
static bool interleave(const char *name)
{
    enum { HL = 354, HL_DIGITS = 6, IMODE = 463 };
    char digits[HL_DIGITS + 1] = "", mode = 0;
    VSILFILE *file = VSIFOpenL(name, "r+b");
    if (!file) {
        return false;
    }
    bool is_done =
        VSIFSeekL(file, HL, SEEK_SET) == 0 && VSIFReadL(digits, 1, HL_DIGITS, file) == HL_DIGITS;
    const unsigned long at = strtoul(digits, NULL, 10) + IMODE;
    is_done = is_done && VSIFSeekL(file, at, SEEK_SET) == 0 && VSIFReadL(&mode, 1, 1, file) == 1 &&
              mode == 'B' && VSIFSeekL(file, at, SEEK_SET) == 0 && VSIFWriteL("P", 1, 1, file) == 1;
    return VSIFCloseL(file) == 0 && is_done;
}

/* Made, closed, changed and opened again. NULL when any of it fails. */
static GDALDatasetH open_sicd(const char *name, int width, int height, const struct db_sicd *sicd)
{
    const GDALDatasetH made = create_sicd(name, width, height, sicd);
    if (!made) {
        return NULL;
    }
    GDALClose(made);
    return interleave(name) ? GDALOpen(name, GA_Update) : NULL;
}

int db_sicd_write(const char *path, const float complex *pixels, int width, int height,
                  const struct db_sicd *sicd)
{
    struct db_raster_out out = begin(path, width);
    if (out.path && out.temporary) {
        out.dataset = open_sicd(out.temporary, width, height, sicd);
    }
    return finish(&out, pixels, width, height);
}
