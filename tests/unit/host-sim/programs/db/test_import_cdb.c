/* Import of CDB trees: a small one written here, bad ones, and pieces of the real San Diego. */
#include "check.h"
#include "fixture.h"
#include "gis/raster.h"
#include "support.h"

#include <cpl_conv.h>
#include <math.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A tile of the geocell N10E020. `name` is what follows N10E020_ in the file's name. */
static const char *tile_path(const char *dataset, const char *level, const char *name)
{
    static char path[2 * FIXTURE_PATH];
    char folder[FIXTURE_PATH];
    snprintf(folder, sizeof folder, "tree/Tiles/N10/E020/%s/%s/U0", dataset, level);
    support_run("mkdir -p %s", fixture_path(folder));
    snprintf(path, sizeof path, "%s/N10E020_%s", fixture_path(folder), name);
    return path;
}

static void write_tile(const char *path, int side, int bands,
                       float (*value)(int band, int x, int y))
{
    float *row = malloc((size_t)side * sizeof *row);
    GDALDatasetH file = GDALCreate(GDALGetDriverByName("GTiff"), path, side, side, bands,
                                   bands == 3 ? GDT_Byte : GDT_Float32, NULL);
    assert_non_null(file);
    for (int b = 0; b < bands; b++) {
        for (int y = 0; y < side; y++) {
            for (int x = 0; x < side; x++) {
                row[x] = value(b, x, y);
            }
            assert_int_equal(GDALRasterIO(GDALGetRasterBand(file, b + 1), GF_Write, 0, y, side, 1,
                                          row, side, 1, GDT_Float32, 0, 0),
                             CE_None);
        }
    }
    GDALClose(file);
    free(row);
}

/* The coarse picture: each pixel tells its place. */
static float coarse(int band, int x, int y)
{
    return (float)(band == 0 ? 1 + x % 200 : band == 1 ? 1 + y % 200 : 77);
}

/* The fine one: a tile of level 1 in the south-west; its west half is black, where it has no
 * picture. */
static float fine(int band, int x, int y)
{
    return x < 512 ? 0 : (float)(band == 0 ? 1 + x % 100 : band == 1 ? 1 + y % 100 : 200);
}

/* Level -2: 256 posts a degree; level -1: 512, with a hole. */
static float posts_256(int band, int x, int y)
{
    (void)band;
    return (float)(x * 4 + y);
}

static float posts_512(int band, int x, int y)
{
    (void)band;
    return x >= 100 && x < 110 && y >= 100 && y < 110 ? NAN : (float)(x * 2) + (float)y / 2 + 0.25f;
}

static float material(int band, int x, int y)
{
    (void)band, (void)y;
    return x < 300 ? 1 : x < 600 ? 2 : 0;
}

static void write_features(void)
{
    const char *path = tile_path("100_GSFeature", "L00", "D100_S001_T001_L00_U0_R0.shp");
    GDALDatasetH file =
        GDALCreate(GDALGetDriverByName("ESRI Shapefile"), path, 0, 0, 0, GDT_Unknown, NULL);
    OGRLayerH layer =
        GDALDatasetCreateLayer(file, "N10E020_D100_S001_T001_L00_U0_R0", NULL, wkbPoint25D, NULL);
    static const char *const words[] = {"CNAM", "FACC", "MODL"};
    static const char *const numbers[] = {"AO1", "HGT", "BBL", "BBW"};
    for (int i = 0; i < 3; i++) {
        OGRFieldDefnH field = OGR_Fld_Create(words[i], OFTString);
        OGR_L_CreateField(layer, field, 1);
        OGR_Fld_Destroy(field);
    }
    for (int i = 0; i < 4; i++) {
        OGRFieldDefnH field = OGR_Fld_Create(numbers[i], OFTReal);
        OGR_L_CreateField(layer, field, 1);
        OGR_Fld_Destroy(field);
    }
    OGRFeatureH f = OGR_F_Create(OGR_L_GetLayerDefn(layer));
    OGR_F_SetFieldString(f, 0, "one");
    OGR_F_SetFieldString(f, 1, "AL015");
    OGR_F_SetFieldString(f, 2, "tower");
    OGR_F_SetFieldDouble(f, 3, 30); /* the long side, along x, points to 120 degrees */
    OGR_F_SetFieldDouble(f, 4, 45);
    OGR_F_SetFieldDouble(f, 5, 2000);
    OGR_F_SetFieldDouble(f, 6, 500);
    OGRGeometryH at = OGR_G_CreateGeometry(wkbPoint25D);
    OGR_G_SetPoint(at, 0, 20.75, 10.25, 0);
    OGR_F_SetGeometry(f, at);
    assert_int_equal(OGR_L_CreateFeature(layer, f), OGRERR_NONE);
    OGR_G_DestroyGeometry(at);
    OGR_F_Destroy(f);
    GDALClose(file);
}

static void write_tree(void)
{
    support_run("rm -rf %s", fixture_path("tree"));
    write_tile(tile_path("004_Imagery", "L00", "D004_S001_T001_L00_U0_R0.tif"), 1024, 3, coarse);
    write_tile(tile_path("004_Imagery", "L01", "D004_S001_T001_L01_U0_R0.tif"), 1024, 3, fine);
    write_tile(tile_path("001_Elevation", "LC", "D001_S001_T001_LC02_U0_R0.tif"), 256, 1,
               posts_256);
    write_tile(tile_path("001_Elevation", "LC", "D001_S001_T001_LC01_U0_R0.tif"), 512, 1,
               posts_512);
    write_tile(tile_path("005_RMTexture", "L00", "D005_S001_T001_L00_U0_R0.tif"), 1024, 1,
               material);
    FILE *f = fopen(tile_path("006_RMDescriptor", "L00", "D006_S001_T001_L00_U0_R0.xml"), "w");
    fputs(
        "<?xml version=\"1.0\"?><Composite_Material_Table>"
        "<Composite_Material index=\"1\"><Name>quay</Name><Primary_Substrate><Material><Name>\n"
        "BM_CONCRETE </Name><Weight>100</Weight></Material></Primary_Substrate>"
        "</Composite_Material><Composite_Material index=\"2\"><Name>odd</Name>"
        "<Primary_Substrate><Material><Name>BM_UNKNOWN</Name></Material></Primary_Substrate>"
        "</Composite_Material></Composite_Material_Table>",
        f);
    fclose(f);
    write_features();
    fixture_write("tree.classes",
                  "[quay]\ncolour = 1 1 1\nkind = ground\ngamma_db = -20\nspread_db = 3\nlimits_db "
                  "= -60 20\n[house]\ncolour = 3 3 3\nkind = structure\ngamma_db = 0\nspread_db = "
                  "5\nlimits_db = -6 6\n");
    fixture_write("tree.map", "BM_CONCRETE = quay\nAL015 = house\n");
}

#define TREE_OUT                                                                                   \
    "--out-image %s --out-mask %s --out-classes %s --out-terrain %s --out-heights %s "             \
    "--classes %s --map %s"
#define TREE_PATHS                                                                                 \
    fixture_path("image.tif"), fixture_path("mask.tif"), fixture_path("classes.tif"),              \
        fixture_path("terrain.tif"), fixture_path("heights.tif"), fixture_path("tree.classes"),    \
        fixture_path("tree.map")

static float *read_band(const char *name, int band, struct db_raster *r)
{
    assert_int_equal(db_raster_open_one(r, fixture_path(name)), 0);
    float *values = malloc((size_t)r->grid.width * (size_t)r->grid.height * sizeof *values);
    assert_int_equal(GDALRasterIO(r->bands[band].handle, GF_Read, 0, 0, r->grid.width,
                                  r->grid.height, values, r->grid.width, r->grid.height,
                                  GDT_Float32, 0, 0),
                     CE_None);
    return values;
}

static void import_tree(char *said, size_t size)
{
    assert_int_equal(fixture_run(said, size, "import --cdb %s --boxes " TREE_OUT,
                                 fixture_path("tree"), TREE_PATHS),
                     0);
}

TEST(finer_imagery_covers_coarser_and_black_is_a_hole)
{
    char said[4096];
    struct db_raster r;
    write_tree();
    import_tree(said, sizeof said);
    for (int b = 0; b < 3; b++) {
        float *image = read_band("image.tif", b, &r);
        assert_int_equal(r.grid.width, 2048);
        assert_int_equal(r.grid.height, 2048);
        assert_true(r.grid.geotransform[0] == 20 && r.grid.geotransform[3] == 11);
        for (int i = 0; i < 2048 * 2048; i += 7) {
            const int x = i % 2048, y = i / 2048;
            const bool is_fine = x >= 512 && x < 1024 && y >= 1024;
            const float wanted = is_fine ? fine(b, x, y - 1024) : coarse(b, x / 2, y / 2);
            const bool is_tower = image[i] == 128;
            assert_true(is_tower || image[i] == wanted);
        }
        free(image);
        db_raster_close(&r);
    }
}

TEST(posts_are_those_of_the_finest_tile_and_holes_are_between_those_of_the_next)
{
    char said[4096];
    struct db_raster r;
    write_tree();
    import_tree(said, sizeof said);
    float *z = read_band("terrain.tif", 0, &r);
    assert_int_equal(r.grid.width, 512);
    assert_true(r.grid.geotransform[0] == 20 - 0.5 / 512 && r.grid.geotransform[1] == 1.0 / 512);
    /* The middle of the last row's first pixel is the post on the south-west corner. */
    assert_true(r.grid.geotransform[3] - 511.5 / 512 == 10);
    for (int i = 0; i < 512 * 512; i++) {
        const int x = i % 512, y = i / 512;
        const bool is_hole = isnan(posts_512(0, x, y));
        /* Posts of both levels lie on south-west corners: row y of 512 is row (y - 1) / 2 of 256.
         */
        const double between = 2.0 * x + (y - 1) / 2.0;
        assert_true(fabs((double)z[i] - (is_hole ? between : (double)posts_512(0, x, y))) < 1e-3);
    }
    free(z);
    db_raster_close(&r);
}

TEST(named_materials_become_classes_and_the_others_nothing)
{
    char said[4096];
    struct db_raster r;
    write_tree();
    import_tree(said, sizeof said);
    float *c = read_band("classes.tif", 0, &r);
    for (int i = 0; i < 2048 * 2048; i += 5) {
        const int x = i % 2048 / 2;
        assert_true(c[i] == 1 || c[i] == (float)(x < 300 ? 0 : 255));
    }
    free(c);
    db_raster_close(&r);
}

TEST(a_feature_without_its_model_is_a_box_of_its_table_or_counted)
{
    char said[4096];
    struct db_raster r;
    write_tree();
    import_tree(said, sizeof said);
    assert_non_null(strstr(said, "1 points; 0 with models, 1 as boxes, 0 left out"));
    float *h = read_band("heights.tif", 0, &r);
    const double cell_y = 110613.0 / 2048, cell_x = 109560.0 / 2048; /* metres at 10.25 N */
    int wrong = 0, high = 0;
    for (int i = 0; i < 2048 * 2048; i++) {
        const double east = (i % 2048 + 0.5 - 1536) * cell_x,
                     north = (1536 - i / 2048 - 0.5) * cell_y;
        const double x = 0.8660254 * east - 0.5 * north, y = 0.5 * east + 0.8660254 * north;
        const bool is_inside = fabs(x) < 1000 && fabs(y) < 250;
        const bool is_near = fabs(fabs(x) - 1000) < 2 || fabs(fabs(y) - 250) < 2;
        wrong += !is_near && h[i] != (float)(is_inside ? 45 : -9999);
        high += h[i] == 45;
    }
    assert_int_equal(wrong, 0);
    assert_in_range(high, 300, 390); /* 1 km2 in cells of 54 m */
    free(h);
    db_raster_close(&r);
    assert_int_equal(fixture_run(said, sizeof said, "import --cdb %s --out-heights %s",
                                 fixture_path("tree"), fixture_path("heights.tif")),
                     0);
    assert_non_null(strstr(said,
                           "1 features are left out: their models are not in the tree "
                           "(AL015 tower the first)"));
}

TEST(each_cell_names_the_tile_that_it_came_from)
{
    char said[4096];
    struct db_raster r;
    write_tree();
    import_tree(said, sizeof said);
    float *m = read_band("mask.tif", 0, &r);
    for (int i = 0; i < 2048 * 2048; i += 3) {
        const int x = i % 2048, y = i / 2048;
        assert_true(m[i] == 3 || m[i] == (float)(x >= 512 && x < 1024 && y >= 1024 ? 2 : 1));
    }
    free(m);
    db_raster_close(&r);
    assert_int_equal(support_run("grep -q N10E020_D004_S001_T001_L01_U0_R0.tif %s",
                                 fixture_path("mask.tif.aux.xml")),
                     0);
}

TEST(an_area_and_a_cell_choose_part_and_level)
{
    struct db_raster r;
    write_tree();
    assert_int_equal(fixture_run(NULL, 0,
                                 "import --cdb %s --area 10.25,20.25,10.5,20.75 --cell 220 "
                                 "--out-image %s",
                                 fixture_path("tree"), fixture_path("part.tif")),
                     0);
    float *image = read_band("part.tif", 2, &r);
    assert_int_equal(r.grid.width, 256); /* level -1: 512 in a degree, 217 m */
    assert_int_equal(r.grid.height, 128);
    assert_true(image[0] == 200); /* the mean of the fine tile's pixels there */
    assert_true(image[255] == 77);
    free(image);
    db_raster_close(&r);
    /* The mean of 4 x 4 pixels of the fine tile: rows 0 on, columns 512 on. */
    image = read_band("part.tif", 1, &r);
    for (int y = 0; y < 128; y++) {
        double sum = 0;
        for (int i = 0; i < 4; i++) {
            sum += (double)fine(1, 600, 4 * y + i);
        }
        assert_true(fabs((double)image[y * 256] - sum / 4) <= 0.5);
    }
    free(image);
    db_raster_close(&r);
}

TEST(trees_that_are_none_or_damaged_are_refused)
{
    const char *out = fixture_path("none.tif");
    write_tree();
    assert_true(fixture_fails(1, "holds no geocell", "import --cdb %s --out-image %s",
                              fixture_path("absent"), out));
    assert_true(fixture_fails(1, "holds no geocell",
                              "import --cdb %s --area 40,20,41,21 --out-image %s",
                              fixture_path("tree"), out));
    assert_true(fixture_fails(1, "choose a larger --cell or a smaller --area",
                              "import --cdb %s --cell 0.1 --out-image %s", fixture_path("tree"),
                              out));
    write_tile(tile_path("004_Imagery", "L00", "D004_S001_T001_L00_U0_R0.tif"), 100, 3, coarse);
    assert_true(fixture_fails(1, "is 100 x 100 pixels", "import --cdb %s --out-image %s",
                              fixture_path("tree"), out));
    assert_int_equal(truncate(tile_path("004_Imagery", "L00", "D004_S001_T001_L00_U0_R0.tif"), 50),
                     0);
    assert_true(fixture_fails(1, "cannot be read", "import --cdb %s --out-image %s",
                              fixture_path("tree"), out));
    assert_int_not_equal(access(out, F_OK), 0);
}

TEST(geocells_are_wider_towards_the_poles)
{
    support_run("mkdir -p %s/Tiles/N49/E020 %s/Tiles/N50/E020", fixture_path("zones"),
                fixture_path("zones"));
    assert_true(fixture_fails(1, "has geocells", "import --cdb %s --cell 100 --out-image %s",
                              fixture_path("zones"), fixture_path("none.tif")));
}

static bool san_diego(const char *part, char *path)
{
    char name[128];
    snprintf(name, sizeof name, "cdb_san_diego/%s", part);
    return support_data_path(name, path, 512) != 0;
}

TEST(elevation_of_san_diego_is_that_of_its_tile_to_the_bit)
{
    char root[512], tile[1024];
    struct db_raster ours, theirs;
    if (!san_diego("ImageryMoreLODPositiveElevation", root)) {
        skip();
    }
    assert_int_equal(fixture_run(NULL, 0, "import --cdb %s --cell 400 --out-terrain %s", root,
                                 fixture_path("sd.tif")),
                     0);
    float *a = read_band("sd.tif", 0, &ours);
    snprintf(tile, sizeof tile,
             "%s/Tiles/N32/W118/001_Elevation/LC/U0/N32W118_D001_S001_T001_LC01_U0_R0.tif", root);
    assert_int_equal(db_raster_open_one(&theirs, tile), 0);
    float *b = malloc(512 * 512 * sizeof *b);
    assert_int_equal(GDALRasterIO(theirs.bands[0].handle, GF_Read, 0, 0, 512, 512, b, 512, 512,
                                  GDT_Float32, 0, 0),
                     CE_None);
    assert_true(db_grid_is_same(&ours.grid, &theirs.grid));
    assert_memory_equal(a, b, 512 * 512 * sizeof *a);
    free(a);
    free(b);
    db_raster_close(&ours);
    db_raster_close(&theirs);
}

/* Heights of the only model that a part of a tree has; NULL when the tree is not here. */
static float *heights_of_the_model(const char *tree, const char *part, struct db_raster *r)
{
    char root[512], said[4096];
    if (!san_diego(tree, root)) {
        return NULL;
    }
    assert_int_equal(fixture_run(said, sizeof said,
                                 "import --cdb %s %s --out-heights %s --out-mask %s", root, part,
                                 fixture_path("sd.tif"), fixture_path("sdm.tif")),
                     0);
    assert_non_null(strstr(said, "1 points; 1 with models"));
    return read_band("sd.tif", 0, r);
}

TEST(a_building_of_san_diego_stands_where_and_as_high_as_its_table_says)
{
    struct db_raster r;
    float *h = heights_of_the_model("GSModelsWithGTModelTexture",
                                    "--cell 1 --area 32.8505,-117.254,32.852,-117.2525", &r);
    if (!h) {
        skip();
    }
    const double *g = r.grid.geotransform;
    double area_m2 = 0;
    for (int i = 0; i < r.grid.width * r.grid.height; i++) {
        /* Turned by 90 degrees: the long side, 59.6 m, runs north. Metres by Vincenty at 32.85 N.
         */
        const double east = (g[0] + (i % r.grid.width + 0.5) * g[1] + 117.253236036919) * 93618;
        const double north = (g[3] + (i / r.grid.width + 0.5) * g[5] - 32.851193543201) * 110900;
        if (h[i] > 0) {
            assert_true(fabs((double)h[i] - 32) < 1e-3);
            assert_true(fabs(east) < 17.2 + 1 && fabs(north) < 29.9 + 1);
            area_m2 += g[1] * 93618 * -g[5] * 110900;
        }
    }
    print_message("# %.0f m2 of 2,039 in its bounding box\n", area_m2);
    assert_true(area_m2 > 1000 && area_m2 < 2050);
    assert_int_equal(support_run("grep -q D501_S001_T001_W09_sd_gt_roof_com_01.rgb %s",
                                 fixture_path("sdm.tif.aux.xml")),
                     0);
    free(h);
    db_raster_close(&r);
}

TEST(the_bridge_of_coronado_has_its_height_and_its_road)
{
    struct db_raster r;
    float *h = heights_of_the_model("GTModels", "--cell 4 --area 32.68,-117.17,32.71,-117.135", &r);
    if (!h) {
        skip();
    }
    double highest = 0;
    for (int i = 0; i < r.grid.width * r.grid.height; i++) {
        highest = fmax(highest, (double)h[i]);
    }
    assert_true(fabs(highest - 79.2) < 1);
    assert_int_equal(support_run("grep -q coronado_bridgeroad %s", fixture_path("sdm.tif.aux.xml")),
                     0);
    free(h);
    db_raster_close(&r);
}

TEST_GROUP(fixture_open, fixture_close);
