#include "terrain/vertical.h"

#include "gis/gdal_start.h"
#include "gis/length_unit.h"
#include "hs/error.h"

#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { NODES2 = TERRAIN_NODES * TERRAIN_NODES, EGM96_HEIGHT = 5773, EGM2008_HEIGHT = 3855 };

/* ---- unit ---- */

static bool is_vertical(OGRSpatialReferenceH crs)
{
    return crs && OSRIsCompound(crs);
}

static bool is_ellipsoidal(OGRSpatialReferenceH crs)
{
    return crs && !OSRIsCompound(crs) && OSRGetAxesCount(crs) == 3;
}

/* What a unit is called, and where that was read; false with the error reported. */
static bool read_unit(struct terrain_vertical *v, OGRSpatialReferenceH crs, GDALRasterBandH band,
                      const char *path, const char **source)
{
    double of_band = 1;
    char *name = NULL;
    const bool has_crs = is_vertical(crs), has_band = GDALGetRasterUnitType(band)[0] != '\0';
    v->metres = has_crs ? OSRGetTargetLinearUnits(crs, "VERT_CS", &name) : 1;
    if (db_band_unit(band, path, "--terrain-unit", &of_band) != 0) {
        return false;
    }
    if (has_crs && has_band && fabs(of_band - v->metres) > 1e-9 * v->metres) {
        hs_error(path, "name the right one with --terrain-unit",
                 "its band is in units of %.9g m, its vertical CRS in units of %.9g m", of_band,
                 v->metres);
        return false;
    }
    v->metres = has_crs ? v->metres : of_band;
    *source = has_crs ? "by its CRS" : has_band ? "by its band" : "assumed";
    return true;
}

static bool is_depth(OGRSpatialReferenceH crs)
{
    OGRAxisOrientation up = OAO_Up;
    return is_vertical(crs) && OSRGetAxis(crs, "VERT_CS", 0, &up) && up == OAO_Down;
}

/* ---- datum ---- */

/* Of horizontal and vertical part; the caller frees it. NULL when there is none. */
static OGRSpatialReferenceH compound(OGRSpatialReferenceH horizontal, int vertical_code)
{
    OGRSpatialReferenceH up = OSRNewSpatialReference(NULL), both = OSRNewSpatialReference(NULL);
    const bool is_made = OSRImportFromEPSG(up, vertical_code) == OGRERR_NONE &&
                         OSRSetCompoundCS(both, "compound", horizontal, up) == OGRERR_NONE;
    OSRDestroySpatialReference(up);
    if (!is_made) {
        OSRDestroySpatialReference(both);
        return NULL;
    }
    OSRSetAxisMappingStrategy(both, OAMS_TRADITIONAL_GIS_ORDER);
    return both;
}

/* What the model's heights are above, with metres along the axis unless the file says otherwise;
 * the caller frees it. NULL: mean sea level. */
static OGRSpatialReferenceH source_crs(OGRSpatialReferenceH declared, const char *datum)
{
    if (!declared || (datum && strcmp(datum, "msl") == 0)) {
        return NULL;
    }
    if (!datum) {
        return is_vertical(declared) || is_ellipsoidal(declared) ? OSRClone(declared) : NULL;
    }
    OGRSpatialReferenceH crs = OSRClone(declared);
    OSRStripVertical(crs);
    OSRDemoteTo2D(crs, NULL);
    if (strcmp(datum, "ellipsoid") == 0) {
        OSRPromoteTo3D(crs, NULL);
        return crs;
    }
    OGRSpatialReferenceH both =
        compound(crs, strcmp(datum, "egm2008") == 0 ? EGM2008_HEIGHT : EGM96_HEIGHT);
    OSRDestroySpatialReference(crs);
    return both;
}

/* From there to degrees and EGM96, exactly or not at all. NULL when PROJ has no way. */
static OGRCoordinateTransformationH way_to_egm96(OGRSpatialReferenceH from)
{
    OGRSpatialReferenceH wgs84 = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(wgs84, 4326);
    OGRSpatialReferenceH to = compound(wgs84, EGM96_HEIGHT);
    OSRDestroySpatialReference(wgs84);
    OGRCoordinateTransformationOptionsH options = OCTNewCoordinateTransformationOptions();
    OCTCoordinateTransformationOptionsSetBallparkAllowed(options, FALSE);
    OGRCoordinateTransformationH way =
        to ? OCTNewCoordinateTransformationEx(from, to, options) : NULL;
    OCTDestroyCoordinateTransformationOptions(options);
    if (to) {
        OSRDestroySpatialReference(to);
    }
    return way;
}

/* Heights of 0 at the nodes, above EGM96. Returns whether PROJ found all of them. */
static bool find_shifts(struct terrain_vertical *v, OGRCoordinateTransformationH way,
                        const double *geotransform, int width, int height)
{
    double *x = malloc(3 * NODES2 * sizeof *x), *y = x ? x + NODES2 : NULL;
    double *z = x ? y + NODES2 : NULL;
    int *is_found = malloc(NODES2 * sizeof *is_found);
    bool are_found = x && is_found;
    for (int i = 0; are_found && i < NODES2; i++) {
        const double u = (double)(i % TERRAIN_NODES) / (TERRAIN_NODES - 1) * width;
        const double w = (double)(i / TERRAIN_NODES) / (TERRAIN_NODES - 1) * height;
        const double *t = geotransform;
        x[i] = t[0] + u * t[1] + w * t[2];
        y[i] = t[3] + u * t[4] + w * t[5];
        z[i] = 0;
        is_found[i] = 0;
    }
    if (are_found) {
        OCTTransformEx(way, NODES2, x, y, z, is_found);
    }
    for (int i = 0; are_found && i < NODES2; i++) {
        are_found = is_found[i] && fabs(z[i]) < 1000;
        v->shift[i] = (float)z[i];
    }
    free(x);
    free(is_found);
    return are_found;
}

static const char *datum_name(OGRSpatialReferenceH crs)
{
    const char *name = is_vertical(crs) ? OSRGetAttrValue(crs, "VERT_CS", 0) : NULL;
    return name ? name : "the ellipsoid";
}

static bool is_egm96(OGRSpatialReferenceH crs)
{
    const char *code = is_vertical(crs) ? OSRGetAuthorityCode(crs, "VERT_CS") : NULL;
    return code && atoi(code) == EGM96_HEIGHT;
}

/* Returns 1 when the heights were shifted, 0 when PROJ cannot, or -1 with the error reported. */
static int shift(struct terrain_vertical *v, OGRSpatialReferenceH crs, GDALRasterBandH band,
                 const char *path)
{
    double geotransform[6];
    const GDALDatasetH file = GDALGetBandDataset(band);
    OGRCoordinateTransformationH way =
        GDALGetGeoTransform(file, geotransform) == CE_None ? way_to_egm96(crs) : NULL;
    v->shift = malloc(NODES2 * sizeof *v->shift);
    if (!v->shift) {
        return hs_error(path, NULL, "out of memory");
    }
    const bool is_done = way && find_shifts(v, way, geotransform, GDALGetRasterXSize(file),
                                            GDALGetRasterYSize(file));
    if (way) {
        OCTDestroyCoordinateTransformation(way);
    }
    if (!is_done) {
        terrain_vertical_free(v);
    }
    return is_done;
}

/* Write what the heights are above into `text`. Returns 0, or -1 with the error reported. */
static int settle_datum(struct terrain_vertical *v, OGRSpatialReferenceH crs, GDALRasterBandH band,
                        const char *path, char *text, size_t size)
{
    if (!crs || is_egm96(crs)) {
        snprintf(text, size, crs ? "above EGM96" : "above mean sea level");
        return 0;
    }
    const int shifted = shift(v, crs, band, path);
    if (shifted > 0) {
        snprintf(text, size, "above %s, brought to EGM96 by %+.1f m in the middle", datum_name(crs),
                 (double)v->shift[NODES2 / 2]);
        return 0;
    }
    if (shifted < 0) {
        return -1;
    }
    if (is_ellipsoidal(crs)) {
        return hs_error(path,
                        "install the package proj-data, or say --terrain-datum msl if they are "
                        "above mean sea level",
                        "its heights are above the ellipsoid, and PROJ has no geoid grid for them");
    }
    snprintf(text, size, "above %s, taken for mean sea level", datum_name(crs));
    return hs_warn(path, "some metres may be missing; install PROJ's grids for it (proj.org)",
                   "its heights are above %s, which PROJ has no grid for: taken for mean sea level",
                   datum_name(crs));
}

/* ---- both ---- */

int terrain_vertical_read(struct terrain_vertical *v, GDALRasterBandH band, const char *path,
                          const struct terrain_vertical_options *options)
{
    const OGRSpatialReferenceH declared = GDALGetSpatialRef(GDALGetBandDataset(band));
    const char *source = "as told";
    char above[160];
    *v = (struct terrain_vertical){.metres = 1};
    if (options->unit) {
        if (!db_length_unit(options->unit, &v->metres)) {
            return hs_error("--terrain-unit", "name one such as m, cm, ft or us-ft",
                            "`%s` is no unit of length that is known", options->unit);
        }
    } else if (!read_unit(v, declared, band, path, &source)) {
        return -1;
    }
    OGRSpatialReferenceH crs = source_crs(declared, options->datum);
    const bool is_down = is_depth(declared);
    const int result = settle_datum(v, crs, band, path, above, sizeof above);
    snprintf(v->said, sizeof v->said, "%s of %.9g m (%s), %s (%s)", is_down ? "depths" : "heights",
             v->metres, source, above,
             options->datum ? "as told"
             : crs          ? "by its CRS"
                            : "assumed");
    v->metres = is_down ? -v->metres : v->metres;
    if (crs) {
        OSRDestroySpatialReference(crs);
    }
    return result;
}

double terrain_vertical_shift(const struct terrain_vertical *v, int width, int height, double x,
                              double y)
{
    if (!v->shift) {
        return 0;
    }
    const double u = fmin(fmax(x / width, 0), 1) * (TERRAIN_NODES - 1);
    const double w = fmin(fmax(y / height, 0), 1) * (TERRAIN_NODES - 1);
    const int i = (int)fmin(u, TERRAIN_NODES - 2), k = (int)fmin(w, TERRAIN_NODES - 2);
    const float *s = v->shift + k * TERRAIN_NODES + i;
    const double a = u - i, b = w - k;
    return (1 - b) * ((1 - a) * (double)s[0] + a * (double)s[1]) +
           b * ((1 - a) * (double)s[TERRAIN_NODES] + a * (double)s[TERRAIN_NODES + 1]);
}

void terrain_vertical_free(struct terrain_vertical *v)
{
    free(v->shift);
    v->shift = NULL;
}
