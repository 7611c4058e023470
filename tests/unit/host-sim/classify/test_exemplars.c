/* Exemplars: which pixels lie in a polygon, by GDAL's own rasteriser; patches, against a flood
 * fill; label rasters of another resolution; nodata; context windows; and splits that never part a
 * region. */
#include "check.h"
#include "classify/exemplars.h"
#include "classify/samples.h"
#include "classify/split.h"
#include "components.h"
#include "fixture.h"
#include "support.h"

#include "hs/error.h"
#include "hs/rng.h"

#include <gdal_alg.h>
#include <math.h>
#include <ogr_api.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE = 60 };

static const char two_classes[] =
    "[one]\ncolour = 1 1 1\nkind = ground\ngamma_db = -20\nspread_db = 3\n"
    "limits_db = -30 -10\n"
    "[two]\ncolour = 2 2 2\nkind = water\ngamma_db = -40\nspread_db = 3\n"
    "limits_db = -50 -30\n";

/* ---- Polygons ---- */

static int mark_span(void *context, int y, int x_begin, int x_end)
{
    uint8_t *mask = context;
    for (int x = x_begin; x < x_end; x++) {
        mask[y * SIDE + x]++;
    }
    return 0;
}

/* The polygons of the TSV as we walk them, in two blocks of rows. */
static void walk_all(const struct db_polygons *polygons, uint8_t *mask)
{
    memset(mask, 0, SIDE * SIDE);
    for (size_t i = 0; i < polygons->count; i++) {
        assert_int_equal(db_polygon_walk(&polygons->items[i], 0, 23, SIDE, mark_span, mask), 0);
        assert_int_equal(db_polygon_walk(&polygons->items[i], 23, SIDE, SIDE, mark_span, mask), 0);
    }
}

static void rasterize_by_gdal(const struct db_grid *grid, const char *wkt, uint8_t *mask)
{
    char *text = (char *)wkt;
    OGRGeometryH g;
    assert_int_equal(OGR_G_CreateFromWkt(&text, NULL, &g), OGRERR_NONE);
    GDALDatasetH file = GDALCreate(GDALGetDriverByName("MEM"), "", SIDE, SIDE, 1, GDT_Byte, NULL);
    GDALSetGeoTransform(file, (double *)grid->geotransform);
    const int band = 1;
    const double burn = 1;
    assert_int_equal(
        GDALRasterizeGeometries(file, 1, &band, 1, &g, NULL, NULL, &burn, NULL, NULL, NULL),
        CE_None);
    assert_int_equal(GDALRasterIO(GDALGetRasterBand(file, 1), GF_Read, 0, 0, SIDE, SIDE, mask, SIDE,
                                  SIDE, GDT_Byte, 0, 0),
                     CE_None);
    GDALClose(file);
    OGR_G_DestroyGeometry(g);
}

TEST(the_pixels_of_a_polygon_are_those_gdal_burns)
{
    struct db_grid grid = fixture_grid(SIDE, SIDE);
    struct hs_rng rng;
    hs_rng_seed(&rng, 8);
    for (int trial = 0; trial < 40; trial++) {
        char wkt[2048], tsv[2200];
        int used = snprintf(wkt, sizeof wkt, "POLYGON((");
        double first[2] = {0};
        /* A star around a wandering centre, partly outside the image, with a square hole. */
        const double cx = 70 * hs_rng_uniform(&rng) - 5, cy = 70 * hs_rng_uniform(&rng) - 5;
        for (int i = 0; i < 13; i++) {
            const double r = 4 + 22 * hs_rng_uniform(&rng), a = 6.2831853 * i / 13;
            const double x = 500000 + cx + r * cos(a), y = -400000 - cy + r * sin(a);
            if (i == 0) {
                first[0] = x;
                first[1] = y;
            }
            used += snprintf(wkt + used, sizeof wkt - (size_t)used, "%.6f %.6f,", x, y);
        }
        const double hx = 500000 + cx, hy = -400000 - cy;
        snprintf(wkt + used, sizeof wkt - (size_t)used,
                 "%.6f %.6f),(%.6f %.6f,%.6f %.6f,%.6f %.6f,%.6f %.6f,%.6f %.6f))", first[0],
                 first[1], hx - 1.7, hy - 1.7, hx + 1.7, hy - 1.7, hx + 1.7, hy + 1.7, hx - 1.7,
                 hy + 1.7, hx - 1.7, hy - 1.7);
        snprintf(tsv, sizeof tsv, "class\tWKT\none\t%s\n", wkt);
        fixture_write("star.tsv", tsv);
        struct db_polygons polygons;
        assert_int_equal(db_polygons_read(&polygons, fixture_path("star.tsv"), "class", &grid), 0);
        uint8_t ours[SIDE * SIDE], gdals[SIDE * SIDE];
        walk_all(&polygons, ours);
        rasterize_by_gdal(&grid, wkt, gdals);
        assert_memory_equal(ours, gdals, sizeof ours);
        db_polygons_free(&polygons);
    }
    OSRDestroySpatialReference(grid.crs);
}

TEST(polygons_in_another_crs_land_on_the_same_pixels)
{
    struct db_grid grid = fixture_grid(SIDE, SIDE);
    OGRSpatialReferenceH lonlat = OSRNewSpatialReference(NULL);
    OSRImportFromEPSG(lonlat, 4326);
    OSRSetAxisMappingStrategy(lonlat, OAMS_TRADITIONAL_GIS_ORDER);
    OGRCoordinateTransformationH t = OCTNewCoordinateTransformation(grid.crs, lonlat);
    double x[] = {500010.2, 500050.2, 500050.2, 500010.2};
    double y[] = {-400010.2, -400010.2, -400040.2, -400040.2};
    assert_true(OCTTransform(t, 4, x, y, NULL));
    char text[1024];
    snprintf(text, sizeof text,
             "{\"type\":\"FeatureCollection\",\"features\":[{\"type\":\"Feature\",\"properties\":{"
             "\"class\":\"one\"},\"geometry\":{\"type\":\"Polygon\",\"coordinates\":[[[%.9f,%.9f],["
             "%.9f,%.9f],"
             "[%.9f,%.9f],[%.9f,%.9f],[%.9f,%.9f]]]}}]}",
             x[0], y[0], x[1], y[1], x[2], y[2], x[3], y[3], x[0], y[0]);
    fixture_write("square.geojson", text);
    struct db_polygons polygons;
    assert_int_equal(db_polygons_read(&polygons, fixture_path("square.geojson"), "class", &grid),
                     0);
    uint8_t mask[SIDE * SIDE];
    walk_all(&polygons, mask);
    for (int py = 0; py < SIDE; py++) {
        for (int px = 0; px < SIDE; px++) {
            assert_int_equal(mask[py * SIDE + px], px >= 10 && px < 50 && py >= 10 && py < 40);
        }
    }
    db_polygons_free(&polygons);
    OCTDestroyCoordinateTransformation(t);
    OSRDestroySpatialReference(lonlat);
    OSRDestroySpatialReference(grid.crs);
}

/* ---- Patches ---- */

static void fill_from(const int32_t *labels, int *patch, int x, int y, int number)
{
    patch[y * SIDE + x] = number;
    for (int i = 0; i < 9; i++) {
        const int nx = x + i % 3 - 1, ny = y + i / 3 - 1;
        if (nx >= 0 && nx < SIDE && ny >= 0 && ny < SIDE && patch[ny * SIDE + nx] < 0 &&
            labels[ny * SIDE + nx] == labels[y * SIDE + x]) {
            fill_from(labels, patch, nx, ny, number);
        }
    }
}

TEST(patches_are_those_of_a_flood_fill)
{
    static int32_t labels[SIDE * SIDE];
    static int patch[SIDE * SIDE];
    static uint32_t numbers[SIDE * SIDE];
    struct hs_rng rng;
    hs_rng_seed(&rng, 2);
    for (int trial = 0; trial < 10; trial++) {
        for (int i = 0; i < SIDE * SIDE; i++) {
            labels[i] = (int32_t)hs_rng_below(&rng, (uint32_t)(2 + trial % 4)) - 1;
            patch[i] = -1;
        }
        int count = 0;
        for (int i = 0; i < SIDE * SIDE; i++) {
            if (labels[i] >= 0 && patch[i] < 0) {
                fill_from(labels, patch, i % SIDE, i / SIDE, count++);
            }
        }
        struct db_components p;
        assert_int_equal(db_components_init(&p, SIDE), 0);
        for (int learn = 1; learn >= 0; learn--) {
            for (int y = 0; y < SIDE; y++) {
                assert_int_equal(
                    db_components_row(&p, labels + y * SIDE, numbers + y * SIDE, learn), 0);
            }
            db_components_rewind(&p);
        }
        uint32_t number_of[SIDE * SIDE];
        memset(number_of, 0xff, sizeof number_of);
        for (int i = 0; i < SIDE * SIDE; i++) {
            if (labels[i] < 0) {
                assert_int_equal(numbers[i], DB_NO_COMPONENT);
                continue;
            }
            if (number_of[patch[i]] == UINT32_MAX) {
                number_of[patch[i]] = numbers[i];
            }
            assert_int_equal(number_of[patch[i]], numbers[i]);
        }
        for (int a = 0; a < count; a++) {
            for (int b = 0; b < a; b++) {
                assert_int_not_equal(number_of[a], number_of[b]);
            }
        }
        db_components_free(&p);
    }
}

/* ---- Label rasters of another resolution ---- */

static void read_labels(const char *name, const struct db_grid *grid, int32_t *labels)
{
    struct db_label_rows rows;
    assert_int_equal(db_label_rows_open(&rows, fixture_path(name), grid), 0);
    for (int y = 0; y < grid->height; y++) {
        assert_int_equal(db_label_rows_read(&rows, y, labels + y * grid->width), 0);
    }
    db_label_rows_close(&rows);
}

TEST(a_pixel_takes_the_most_frequent_of_finer_labels)
{
    const float fine[] = {
        1, 1, 2, 3, //
        2, 1, 3, 3, //
        4, 5, 9, 9, //
        5, 4, 9, 7, //
    };
    struct db_grid labels = {.width = 4, .height = 4}, image = {.width = 2, .height = 2};
    fixture_raster("fine.tif", &labels, GDT_Byte, fine, 9);
    int32_t found[4];
    read_labels("fine.tif", &image, found);
    const int32_t expected[] = {1, 3, 4,
                                -1}; /* The smaller of equals; nodata can be in the majority too. */
    assert_memory_equal(found, expected, sizeof expected);
}

TEST(finer_pixels_take_the_label_they_lie_in)
{
    const float coarse[] = {1, 2, 3, 4};
    struct db_grid labels = {.width = 2, .height = 2}, image = {.width = 4, .height = 4};
    fixture_raster("coarse.tif", &labels, GDT_Byte, coarse, 255);
    int32_t found[16];
    read_labels("coarse.tif", &image, found);
    for (int i = 0; i < 16; i++) {
        assert_int_equal(found[i], 1 + i % 4 / 2 + 2 * (i / 8));
    }
}

TEST(labels_of_another_extent_are_refused)
{
    const float labels[8] = {0};
    struct db_grid shape = {.width = 4, .height = 2}, image = {.width = 4, .height = 4};
    struct db_label_rows rows;
    fixture_raster("wide.tif", &shape, GDT_Byte, labels, 255);
    assert_int_equal(db_label_rows_open(&rows, fixture_path("wide.tif"), &image), -1);
}

/* ---- Nodata and context ---- */

static void open_stack(struct db_raster *r, const char *names, bool black)
{
    struct hs_list list = {.count = 0};
    char copy[64];
    snprintf(copy, sizeof copy, "%s", names);
    for (char *name = strtok(copy, ","); name; name = strtok(NULL, ",")) {
        list.items[list.count++] = (char *)fixture_path(name);
    }
    const struct db_raster_options options = {.paths = &list, .black_is_nodata = black};
    assert_int_equal(db_raster_open(r, &options), 0);
}

TEST(a_pixel_without_data_in_any_file_or_not_finite_is_no_data)
{
    const float a[] = {0, 1, 7, 0, NAN, 3}, b[] = {0, 2, 2, 8, 1, INFINITY};
    struct db_grid grid = fixture_grid(6, 1);
    fixture_raster("a.tif", &grid, GDT_Float32, a, 7);
    fixture_raster("b.tif", &grid, GDT_Float32, b, 8);
    struct db_raster r;
    float pixels[12];
    uint8_t valid[6];
    open_stack(&r, "a.tif,b.tif", false);
    assert_int_equal(db_raster_read(&r, 0, 1, pixels, valid), 0);
    const uint8_t expected[] = {1, 1, 0, 0, 0, 0};
    assert_memory_equal(valid, expected, 6);
    db_raster_close(&r);
    open_stack(&r, "a.tif,b.tif", true);
    assert_int_equal(db_raster_read(&r, 0, 1, pixels, valid), 0);
    assert_int_equal(valid[0], 0);
    assert_int_equal(valid[1], 1);
    db_raster_close(&r);
    OSRDestroySpatialReference(grid.crs);
}

TEST(windows_give_mean_and_deviation_whatever_the_blocks)
{
    enum { W = 17, H = 13, CONTEXT = 5 };
    float values[W * H];
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    for (int i = 0; i < W * H; i++) {
        values[i] = i % 11 == 0 ? -1 : (float)(100 + 10 * hs_rng_normal(&rng));
    }
    struct db_grid grid = fixture_grid(W, H);
    fixture_raster("w.tif", &grid, GDT_Float32, values, -1);
    struct db_raster r;
    open_stack(&r, "w.tif", false);
    for (int rows = 1; rows <= H; rows += 4) {
        for (int y0 = 0; y0 < H; y0 += rows) {
            const int n = y0 + rows < H ? rows : H - y0;
            float planes[3 * W * H];
            uint8_t valid[W * H];
            assert_int_equal(db_features_read(&r, CONTEXT, y0, n, planes, valid), 0);
            for (int i = 0; i < n * W; i++) {
                const int x = i % W, y = y0 + i / W;
                double sum = 0, square = 0, count = 0;
                for (int j = 0; j < CONTEXT * CONTEXT; j++) {
                    const int wx = x + j % CONTEXT - 2, wy = y + j / CONTEXT - 2;
                    if (wx >= 0 && wx < W && wy >= 0 && wy < H && values[wy * W + wx] >= 0) {
                        const double v = (double)values[wy * W + wx];
                        sum += v;
                        square += v * v;
                        count++;
                    }
                }
                const double mean = sum / count;
                assert_true(fabs((double)planes[n * W + i] - mean) < 1e-4);
                assert_true(fabs((double)planes[2 * n * W + i] -
                                 sqrt(fmax(0, square / count - mean * mean))) < 1e-3);
            }
        }
    }
    db_raster_close(&r);
    OSRDestroySpatialReference(grid.crs);
}

/* ---- Sampling and splitting ---- */

/* 40 vertical stripes of alternating label with gaps between them. */
static void write_stripes(void)
{
    static float labels[SIDE * 4 * SIDE];
    struct db_grid grid = {.width = 4 * SIDE, .height = SIDE};
    for (int i = 0; i < 4 * SIDE * SIDE; i++) {
        const int x = i % (4 * SIDE);
        labels[i] = x % 6 < 5 ? (float)(1 + x / 6 % 2) : 0;
    }
    fixture_raster("stripes.tif", &grid, GDT_Byte, labels, 0);
    fixture_write("two.classes", two_classes);
    fixture_write("two.map", "1 = one\n2 = two\n");
}

static void find_stripes(struct db_exemplars *e, struct db_samples *s, struct db_class_table *table,
                         long per_class, uint64_t seed)
{
    struct db_label_map map;
    struct db_raster image;
    write_stripes();
    assert_int_equal(db_class_table_read(table, fixture_path("two.classes")), 0);
    assert_int_equal(db_label_map_read(&map, fixture_path("two.map"), table), 0);
    open_stack(&image, "stripes.tif", false);
    const struct db_exemplar_source source = {.labels_path = fixture_path("stripes.tif"),
                                              .map = &map,
                                              .table = table,
                                              .per_class = per_class,
                                              .seed = seed};
    assert_int_equal(db_exemplars_find(e, &source, &image.grid), 0);
    assert_int_equal(db_samples_read(s, &image, 1, e), 0);
    db_raster_close(&image);
}

TEST(exemplars_are_drawn_evenly_up_to_the_cap)
{
    struct db_exemplars e;
    struct db_samples s;
    struct db_class_table table;
    find_stripes(&e, &s, &table, 2000, 1);
    assert_int_equal(e.available[0], 20 * 5 * SIDE);
    assert_int_equal(e.region_count, 40);
    assert_int_equal(e.count, 4000);
    int left = 0;
    for (size_t i = 0; i < s.count; i++) {
        const struct db_exemplar *x = &s.items[i];
        assert_true((double)s.inputs[i] == 1.0 + x->class_index);
        assert_int_equal(x->class_index, x->x / 6 % 2);
        left += x->x < 2 * SIDE;
    }
    assert_in_range(left, 1900, 2100); /* 2000 within three deviations of a fair draw. */
    db_samples_free(&s);
    db_exemplars_free(&e);
}

TEST(a_split_by_polygons_never_parts_a_region)
{
    for (uint64_t seed = 0; seed < 20; seed++) {
        struct db_exemplars e;
        struct db_samples s;
        struct db_class_table table;
        find_stripes(&e, &s, &table, 100000, seed);
        assert_int_equal(
            db_split(&s, e.region_count, &table, true, 0.3, seed, DB_PART_HELD_OUT, false), 0);
        int part_of[40], held[2] = {0}, all[2] = {0};
        memset(part_of, -1, sizeof part_of);
        for (size_t i = 0; i < s.count; i++) {
            const struct db_exemplar *x = &s.items[i];
            int *part = &part_of[x->x / 6];
            assert_true(*part == -1 || *part == x->part);
            *part = x->part;
            held[x->class_index] += x->part == DB_PART_HELD_OUT;
            all[x->class_index]++;
        }
        for (int c = 0; c < 2; c++) {
            assert_int_equal(held[c] * 10, all[c] * 3);
        }
        db_samples_free(&s);
        db_exemplars_free(&e);
    }
}

TEST(a_class_of_one_region_keeps_it_for_training)
{
    struct db_exemplar items[] = {
        {0, 0, 0, 0, 0}, {1, 0, 0, 0, 0}, {2, 0, 1, 1, 0}, {3, 0, 2, 1, 0}};
    float inputs[4] = {0};
    struct db_samples s = {inputs, items, 4, 1, 0};
    struct db_class_table table;
    fixture_write("two.classes", two_classes);
    assert_int_equal(db_class_table_read(&table, fixture_path("two.classes")), 0);
    assert_int_equal(db_split(&s, 3, &table, true, 0.5, 1, DB_PART_HELD_OUT, true), 0);
    assert_int_equal(items[0].part, DB_PART_TRAIN);
    assert_int_equal(items[1].part, DB_PART_TRAIN);
    assert_int_not_equal(items[2].part, items[3].part);
}

TEST(pixels_held_out_are_the_part_asked_for)
{
    struct db_exemplars e;
    struct db_samples s;
    struct db_class_table table;
    find_stripes(&e, &s, &table, 1000, 5);
    assert_int_equal(db_split(&s, e.region_count, &table, false, 0.25, 5, DB_PART_HELD_OUT, false),
                     0);
    int held[2] = {0};
    for (size_t i = 0; i < s.count; i++) {
        held[s.items[i].class_index] += s.items[i].part == DB_PART_HELD_OUT;
    }
    assert_int_equal(held[0], 250);
    assert_int_equal(held[1], 250);
    db_samples_free(&s);
    db_exemplars_free(&e);
}

TEST(alike_exemplars_of_a_class_are_thinned_to_one)
{
    struct db_exemplar items[] = {{0, 0, 0, 0, 0},
                                  {1, 0, 0, 0, 0},
                                  {2, 0, 0, 1, 0},
                                  {3, 0, 0, 0, 0},
                                  {4, 0, 0, 0, DB_PART_HELD_OUT}};
    float inputs[] = {10.01f, 10.02f, 10.01f, 10.3f, 10.01f};
    struct db_samples s = {inputs, items, 5, 1, 0};
    const float scale = 1;
    assert_int_equal(db_thin(&s, &scale, 0.1), 1);
    assert_int_equal(s.count, 4);
    assert_int_equal(items[1].x, 2);
    assert_true(inputs[2] == 10.3f);
}

/* ---- Real polygons ---- */

/* The counts are those of the data's own notes, made with other software. */
struct real_set {
    const char *image, *polygons;
    const char *names[4];
    uint64_t counts[4];
};

static int check_real(const struct real_set *set)
{
    char image[512], path[512];
    if (!support_data_path(set->image, image, sizeof image) ||
        !support_data_path(set->polygons, path, sizeof path)) {
        return 0;
    }
    struct db_class_table table = {.count = 4};
    for (int i = 0; i < 4; i++) {
        snprintf(table.items[i].name, DB_NAME_SIZE, "%s", set->names[i]);
    }
    struct db_label_map map;
    struct db_raster r;
    struct db_exemplars e;
    assert_int_equal(db_label_map_read(&map, NULL, &table), 0);
    assert_int_equal(db_raster_open_one(&r, image), 0);
    const struct db_exemplar_source source = {
        .polygons_path = path, .field = "class", .map = &map, .table = &table, .per_class = 100000};
    assert_int_equal(db_exemplars_find(&e, &source, &r.grid), 0);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(e.available[i], set->counts[i]);
    }
    db_exemplars_free(&e);
    db_raster_close(&r);
    return 1;
}

TEST(the_amazon_polygons_hold_the_pixels_their_notes_count)
{
    const struct real_set village = {
        "sentinel2_amazon_village_srtm_labels/derived/sen2_12band_refl_x10000.bsq",
        "sentinel2_amazon_village_srtm_labels/derived/trainingPolygons_sen2.tsv",
        {"forest", "village", "water", "dryout"},
        {1055, 614, 496, 204}};
    const struct real_set reservoir = {
        "landsat5_amazon_tucurui_srtm_labels/derived/lsat_7band.bsq",
        "landsat5_amazon_tucurui_srtm_labels/derived/trainingPolygons_lsat.tsv",
        {"forest", "water", "cleared", "fallen_dry"},
        {2271, 795, 1124, 220}};
    if (!check_real(&village) || !check_real(&reservoir)) {
        skip();
    }
}

/* ---- Blocks ---- */

/* Bright rows above ground that is almost even: sums that have seen the first carry its rounding.
 */
static float fraction_at(int x, int y)
{
    return y < 8 ? 9.7e3f + 0.37f * (float)x : 0.1f + 1e-6f * (float)((x * 7 + y * 3) % 11);
}

TEST(features_do_not_depend_on_where_a_block_begins)
{
    enum { CONTEXT = 5, FEATURES = 3 };
    static float values[SIDE * SIDE], whole[FEATURES * SIDE * SIDE], part[FEATURES * SIDE * SIDE];
    static uint8_t valid[SIDE * SIDE];
    struct db_grid grid = fixture_grid(SIDE, SIDE);
    struct db_raster r;
    for (int i = 0; i < SIDE * SIDE; i++) {
        values[i] = fraction_at(i % SIDE, i / SIDE);
    }
    fixture_raster("fractions.tif", &grid, GDT_Float32, values, -1);
    OSRDestroySpatialReference(grid.crs);
    assert_int_equal(db_raster_open_one(&r, fixture_path("fractions.tif")), 0);
    assert_int_equal(db_features_read(&r, CONTEXT, 0, SIDE, whole, valid), 0);
    for (int y = 0; y < SIDE; y += 17) {
        const int rows = y + 17 < SIDE ? 17 : SIDE - y;
        assert_int_equal(db_features_read(&r, CONTEXT, y, rows, part, valid), 0);
        for (int k = 0; k < FEATURES; k++) {
            assert_memory_equal(part + k * rows * SIDE, whole + (k * SIDE + y) * SIDE,
                                (size_t)(rows * SIDE) * sizeof *part);
        }
    }
    db_raster_close(&r);
}

TEST_GROUP(fixture_open, fixture_close);
