/* OpenStreetMap as people have cut it, with nodes that are missing and elements out of order: every
 * element of four files is accounted for, and Monaco's sea is where SRTM has it. The counts of
 * elements are osmium's. */
#include "check.h"
#include "real_scene.h"
#include "support.h"

#include <gdal.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TABLES "host-sim/programs/db/classes/"

enum { KINDS = 3, WATER_CLASS = 5 };

static const char *const kinds[KINDS] = {"nodes", "ways", "relations"};

static const struct town {
    const char *name;
    long elements[KINDS]; /* osmium fileinfo --extended */
    long missing;         /* osmium check-refs, nodes in ways; -1: it refuses the file */
    long buildings;       /* osmium tags-filter w/building: less than that may be made */
} towns[] = {
    {"monaco", {180118, 27377, 212}, 0, 23370},
    {"liechtenstein", {270635, 28047, 871}, 0, 14020},
    {"helsinki", {24260, 5130, 620}, 4525, 433},
    {"baltimore", {51385, 7230, 167}, -1, 1731},
};

enum { TOWNS = sizeof towns / sizeof *towns };

/* What the program printed of one file. */
struct report {
    long read[KINDS], accounted[KINDS], missing, buildings, lost;
};

static void read_row(struct report *r, const char *row, int *kind)
{
    char word[64];
    long count;
    if (sscanf(row, "%*[^:]: %ld %63s", &count, word) == 2 && row[0] != ' ') {
        for (int i = 0; i < KINDS; i++) {
            if (strcmp(word, kinds[i]) == 0) {
                *kind = i;
                r->read[i] = count;
            }
        }
        r->missing += strstr(row, "references lead to nodes") ? count : 0;
    } else if (*kind >= 0 && strncmp(row, "    ", 4) == 0 && strlen(row) > 43) {
        const long of_fate = strtol(row + 33, NULL, 10);
        r->accounted[*kind] += of_fate;
        r->lost += strncmp(row, "    lost", 8) == 0 ? of_fate : 0;
    } else if (sscanf(row, "rule %63s %ld", word, &count) == 2) {
        *kind = -1; /* rows below are of rules */
        r->buildings += strstr(word, "building") && !strstr(word, "part") ? count : 0;
    }
}

static const char *folder(void)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/tmp/real-vectors", support_build_dir());
    assert_int_equal(support_run("mkdir -p %s", path), 0);
    return path;
}

static int import(const struct town *t, struct report *r)
{
    char data[1024], name[128], row[512];
    memset(r, 0, sizeof *r);
    snprintf(name, sizeof name, "osm_%s/%s.osm.pbf", t->name, t->name);
    if (!support_data_path(name, data, sizeof data)) {
        return 0;
    }
    assert_int_equal(support_run("%s/bin/landmass-db vectors --vectors %s --rules " TABLES
                                 "osm.rules --classes " TABLES
                                 "landcover.classes --cell 10 --out %s/%s.tif "
                                 "--detail %s/%s.detail >%s/%s.log 2>&1",
                                 support_build_dir(), data, folder(), t->name, folder(), t->name,
                                 folder(), t->name),
                     0);
    snprintf(data, sizeof data, "%s/%s.log", folder(), t->name);
    FILE *log = fopen(data, "r");
    assert_non_null(log);
    int kind = -1;
    while (fgets(row, sizeof row, log)) {
        read_row(r, row, &kind);
    }
    fclose(log);
    return 1;
}

TEST(every_element_that_osmium_counts_has_one_fate)
{
    int here = 0;
    for (int i = 0; i < TOWNS; i++) {
        struct report r;
        if (!import(&towns[i], &r)) {
            continue;
        }
        here++;
        for (int k = 0; k < KINDS; k++) {
            assert_int_equal(r.read[k], towns[i].elements[k]);
            assert_int_equal(r.accounted[k], towns[i].elements[k]);
        }
        assert_true(towns[i].missing < 0 || r.missing == towns[i].missing);
        printf("# %s: %ld buildings of %ld ways that have the tag; %ld elements lost by name\n",
               towns[i].name, r.buildings, towns[i].buildings, r.lost);
        assert_true((double)r.buildings > 0.98 * (double)towns[i].buildings);
    }
    if (here == 0) {
        skip();
    }
}

/* SRTM knows nothing of the coastline: what it has well above the sea is land, what it has at the
 * sea's level is sea, a few hundred metres about. */
TEST(the_sea_of_monaco_is_where_srtm_has_it)
{
    char points[1024], path[1024];
    struct report r;
    struct real_raster classes, terrain;
    double transform[6];
    int sea = 0, water = 0, land = 0, dry = 0;
    if (!support_data_path("srtm_hgt/N43E007.hgt.zip", points, sizeof points) ||
        !import(&towns[0], &r)) {
        skip();
    }
    GDALAllRegister();
    snprintf(path, sizeof path, "%s/monaco.tif", folder());
    assert_int_equal(real_raster_read(&classes, path), 0);
    assert_int_equal(real_raster_read(&terrain, points), 0);
    GDALDatasetH file = GDALOpen(path, GA_ReadOnly);
    OGRSpatialReferenceH utm = OSRClone(GDALGetSpatialRef(file)),
                         wgs = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(wgs, 4326);
    OSRSetAxisMappingStrategy(wgs, OAMS_TRADITIONAL_GIS_ORDER);
    OSRSetAxisMappingStrategy(utm, OAMS_TRADITIONAL_GIS_ORDER);
    OGRCoordinateTransformationH way = OCTNewCoordinateTransformation(utm, wgs);
    GDALGetGeoTransform(file, transform);
    for (int row = 3; row < classes.height; row += 7) {
        for (int column = 3; column < classes.width; column += 7) {
            double x = transform[0] + (column + 0.5) * transform[1],
                   y = transform[3] + (row + 0.5) * transform[5];
            const int is_water = real_raster_nearest(&classes, x, y) == WATER_CLASS;
            assert_true(OCTTransform(way, 1, &x, &y, NULL));
            const double z = real_raster_bilinear(&terrain, x, y);
            sea += z <= 0;
            water += z <= 0 && is_water;
            land += z >= 25;
            dry += z >= 25 && !is_water;
        }
    }
    OCTDestroyCoordinateTransformation(way);
    OSRDestroySpatialReference(utm);
    OSRDestroySpatialReference(wgs);
    GDALClose(file);
    real_raster_free(&classes);
    real_raster_free(&terrain);
    printf("# sea %d, water %d; land %d, dry %d\n", sea, water, land, dry);
    assert_true(sea > 1000 && land > 1000);
    assert_true(water > 0.98 * sea && dry > 0.99 * land);
}

/* The pictures: Port Hercule is dark, the town round it bright, from the sea and from the land. */
TEST(the_harbour_of_monaco_is_dark_in_its_town)
{
    static const struct {
        double latitude, longitude;
        int is_water;
    } places[] = {{43.7346, 7.4250, 1}, {43.7335, 7.4262, 1}, {43.7400, 7.4330, 1},
                  {43.7330, 7.4180, 0}, {43.7400, 7.4270, 0}, {43.7310, 7.4230, 0}};
    struct real_scene scene;
    char name[17];
    assert_int_equal(real_scene_make(&scene, "monaco", "osm_monaco/monaco.osm.pbf"), 0);
    if (!scene.is_here) {
        skip();
    }
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        const struct real_place p = {places[i].latitude, places[i].longitude};
        const int is_water = strcmp(real_image_class(&scene, p, name), "water") == 0;
        assert_int_equal(is_water, places[i].is_water);
    }
    static struct real_picture picture;
    assert_int_equal(real_patch_read(&picture, &scene, "patch-8m-look-000"), 0);
    double grey[2] = {0, 0};
    int count[2] = {0, 0};
    for (int line = 4; line < REAL_CELLS - 4; line += 4) {
        for (int cell = 4; cell < REAL_CELLS - 4; cell += 4) {
            const struct real_place p =
                real_patch_place((struct real_place){43.7365, 7.4240}, 0, 8, line, cell);
            const int g = picture.grey[line][cell];
            const char *class_name = real_image_class(&scene, p, name);
            const int is_water = strcmp(class_name, "water") == 0;
            if (g != REAL_NO_PIXEL && (is_water || strcmp(class_name, "structure") == 0)) {
                grey[is_water] += g;
                count[is_water]++;
            }
        }
    }
    printf("# mean grey: structures %.0f of %d cells, water %.0f of %d\n", grey[0] / count[0],
           count[0], grey[1] / count[1], count[1]);
    assert_true(count[0] > 500 && count[1] > 500);
    assert_true(grey[0] / count[0] > 4 * grey[1] / count[1]);
}
