/* Import of models: small ones written here, whose colours and heights are known cell by cell, bad
 * ones, and a real town. */
#include "check.h"
#include "fixture.h"
#include "gis/raster.h"
#include "support.h"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <math.h>
#include <ogr_srs_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char classes[] =
    "[grass]\ncolour = 1 1 1\nkind = ground\ngamma_db = -20\nspread_db = 3\nlimits_db = -60 20\n"
    "[house]\ncolour = 3 3 3\nkind = structure\ngamma_db = 0\nspread_db = 5\nlimits_db = -6 6\n";

/* Values of a band of a raster; the caller frees. */
static float *read_band(const char *name, int band, struct db_grid *grid)
{
    struct db_raster r;
    assert_int_equal(db_raster_open_one(&r, fixture_path(name)), 0);
    assert_true(band < r.band_count);
    const size_t count = (size_t)r.grid.width * (size_t)r.grid.height;
    float *values = malloc(count * sizeof *values);
    assert_int_equal(GDALRasterIO(r.bands[band].handle, GF_Read, 0, 0, r.grid.width, r.grid.height,
                                  values, r.grid.width, r.grid.height, GDT_Float32, 0, 0),
                     CE_None);
    *grid = r.grid;
    grid->crs = NULL;
    db_raster_close(&r);
    return values;
}

/* 16 x 16 pixels: red above, blue below; the right half of each is green instead. */
static void write_texture(const char *name)
{
    static uint8_t planes[3][16 * 16];
    for (int i = 0; i < 256; i++) {
        const int part = i % 16 >= 8 ? 1 : i / 16 < 8 ? 0 : 2;
        for (int c = 0; c < 3; c++) {
            planes[c][i] = c == part ? 200 : 10;
        }
    }
    GDALDatasetH memory = GDALCreate(GDALGetDriverByName("MEM"), "", 16, 16, 3, GDT_Byte, NULL);
    for (int c = 0; c < 3; c++) {
        assert_int_equal(GDALRasterIO(GDALGetRasterBand(memory, c + 1), GF_Write, 0, 0, 16, 16,
                                      planes[c], 16, 16, GDT_Byte, 0, 0),
                         CE_None);
    }
    GDALClose(GDALCreateCopy(GDALGetDriverByName("PNG"), fixture_path(name), memory, FALSE, NULL,
                             NULL, NULL));
    GDALClose(memory);
}

/* Grass 40 by 40 m on a plane that climbs a metre in 10 m eastwards, and a textured roof 16 by 16 m
 * at 20 m over it; below the roof lies another, which nobody sees. Corners as "x y z". */
#define OBJ_FACES                                                                                  \
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl lawn\nf 1 2 3 4\nusemtl roof\n"                        \
    "f 5/1 6/2 7/3 8/4\nusemtl cellar\nf 9/1 10/2 11/3 12/4\n"

static void write_house(void)
{
    write_texture("roof.png");
    fixture_write("house.mtl",
                  "newmtl lawn\nKd 0.2 0.4 0.6\nnewmtl roof\nKd 1 1 1\nmap_Kd "
                  "roof.png\nnewmtl cellar\nKd 0 0 0\n");
    fixture_write("house.obj",
                  "mtllib house.mtl\nv 0 0 1\nv 40 0 5\nv 40 40 5\nv 0 40 1\nv 8 8 20\nv 24 8 20\n"
                  "v 24 24 20\nv 8 24 20\nv 8 8 10\nv 24 8 10\nv 24 24 10\nv 8 24 10\n" OBJ_FACES);
    /* The same with y up, in feet: north is -z. */
    FILE *f = fopen(fixture_path("feet.obj"), "w");
    static const double corners[12][3] = {{0, 0, 1},  {40, 0, 5},  {40, 40, 5},  {0, 40, 1},
                                          {8, 8, 20}, {24, 8, 20}, {24, 24, 20}, {8, 24, 20},
                                          {8, 8, 10}, {24, 8, 10}, {24, 24, 10}, {8, 24, 10}};
    fputs("mtllib house.mtl\n", f);
    for (int i = 0; i < 12; i++) {
        fprintf(f, "v %.9f %.9f %.9f\n", corners[i][0] / 0.3048, corners[i][2] / 0.3048,
                -corners[i][1] / 0.3048);
    }
    fputs(OBJ_FACES, f);
    fclose(f);
    fixture_write("house.classes", classes);
    fixture_write("house.map", "lawn = grass\nroof = house\ncellar = house\n");
}

#define HOUSE_OUT                                                                                  \
    " --cell 1 --classes %s --map %s --out-image %s --out-mask %s --out-classes %s --out-top %s "  \
    "--out-terrain %s --out-heights %s"
#define HOUSE_PATHS                                                                                \
    fixture_path("house.classes"), fixture_path("house.map"), fixture_path("image.tif"),           \
        fixture_path("mask.tif"), fixture_path("classes.tif"), fixture_path("top.tif"),            \
        fixture_path("terrain.tif"), fixture_path("heights.tif")

/* The colour of the roof's texture at a metre of the model. */
static void roof_colour(double x, double y, int rgb[3])
{
    const int part = x >= 16 ? 1 : y >= 16 ? 0 : 2;
    for (int c = 0; c < 3; c++) {
        rgb[c] = c == part ? 200 : 10;
    }
}

static void check_house(void)
{
    static const char *const names[] = {"image.tif",   "image.tif",   "image.tif", "classes.tif",
                                        "terrain.tif", "heights.tif", "top.tif",   "mask.tif"};
    float *planes[8];
    struct db_grid grid;
    for (int i = 0; i < 8; i++) {
        planes[i] = read_band(names[i], i < 3 ? i : 0, &grid);
        assert_int_equal(grid.width, 40);
        assert_int_equal(grid.height, 40);
    }
    for (int i = 0; i < 40 * 40; i++) {
        const double x = i % 40 + 0.5, y = 39.5 - i / 40;
        const bool is_roof = x > 8 && x < 24 && y > 8 && y < 24;
        int rgb[3] = {51, 102, 153};
        if (is_roof) {
            roof_colour(x, y, rgb);
        }
        for (int c = 0; c < 3; c++) {
            assert_int_equal((int)planes[c][i], rgb[c]);
        }
        const double ground = 1 + x / 10;
        assert_int_equal((int)planes[3][i], is_roof);
        assert_true(fabs((double)planes[4][i] - ground) < 1e-4);
        assert_true(fabs((double)planes[5][i] - (is_roof ? 20 - ground : 0)) < 1e-4);
        assert_true(fabs((double)planes[6][i] - (is_roof ? 20 : ground)) < 1e-4);
        assert_int_equal((int)planes[7][i], is_roof ? 2 : 1);
    }
    for (int i = 0; i < 8; i++) {
        free(planes[i]);
    }
}

TEST(a_house_on_a_slope_comes_out_cell_by_cell_as_it_was_made)
{
    char said[4096];
    write_house();
    assert_int_equal(fixture_run(said, sizeof said,
                                 "import --model %s --unit m --up z --crs EPSG:32631 --origin "
                                 "500000,4000000" HOUSE_OUT,
                                 fixture_path("house.obj"), HOUSE_PATHS),
                     0);
    check_house();
    struct db_grid grid;
    free(read_band("top.tif", 0, &grid));
    assert_true(grid.geotransform[0] == 500000 && grid.geotransform[3] == 4000040);
    assert_non_null(strstr(said, "heights: 256 cells stand above the ground"));
}

TEST(feet_with_y_up_are_the_same_house)
{
    write_house();
    assert_int_equal(fixture_run(NULL, 0,
                                 "import --model %s --unit ft --up y --at 36.1,3" HOUSE_OUT,
                                 fixture_path("feet.obj"), HOUSE_PATHS),
                     0);
    check_house();
}

TEST(a_mask_names_the_pictures_and_goes_with_its_file)
{
    write_house();
    assert_int_equal(fixture_run(NULL, 0, "import --model %s --unit m --up z --at 36.1,3" HOUSE_OUT,
                                 fixture_path("house.obj"), HOUSE_PATHS),
                     0);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(support_run("grep -q '%s</Category>' %s", i ? "/roof.png" : ">lawn",
                                     fixture_path("mask.tif.aux.xml")),
                         0);
    }
}

/* A square of 10 m at a height of 3 m whose north half is one mesh and south half another: two
 * triangles each, in a buffer of base 64. */
static void write_gltf(const char *name, unsigned count)
{
    static const float corners[8][3] = {{0, 3, -10}, {0, 3, -5}, {10, 3, -5}, {10, 3, -10},
                                        {0, 3, -5},  {0, 3, 0},  {10, 3, 0},  {10, 3, -5}};
    static const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    uint8_t bytes[sizeof corners + sizeof indices];
    memcpy(bytes, corners, sizeof corners);
    memcpy(bytes + sizeof corners, indices, sizeof indices);
    char *text = CPLBase64Encode(sizeof bytes, bytes);
    FILE *f = fopen(fixture_path(name), "w");
    fprintf(f,
            "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":"
            "[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},"
            "\"indices\":2,\"material\":0},{\"attributes\":{\"POSITION\":1},\"indices\":2,"
            "\"material\":1}]}],\"materials\":[{\"name\":\"north\",\"pbrMetallicRoughness\":{"
            "\"baseColorFactor\":[1,0,0.21404,1]}},{\"name\":\"south\",\"pbrMetallicRoughness\":{"
            "\"baseColorFactor\":[0,1,0,1]}}],\"buffers\":[{\"byteLength\":%zu,\"uri\":\"data:"
            "application/octet-stream;base64,%s\"}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":"
            "0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":48},{\"buffer\":0,"
            "\"byteOffset\":96,\"byteLength\":12}],\"accessors\":[{\"bufferView\":0,"
            "\"componentType\":5126,\"count\":%u,\"type\":\"VEC3\",\"min\":[0,3,-10],\"max\":[10,3,"
            "-5]},{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":"
            "[0,3,-5],\"max\":[10,3,0]},{\"bufferView\":2,\"componentType\":5123,\"count\":6,"
            "\"type\":\"SCALAR\"}]}",
            sizeof bytes, text, count);
    fclose(f);
    CPLFree(text);
}

TEST(gltf_has_its_own_axes_and_linear_colours)
{
    struct db_grid grid;
    write_gltf("square.gltf", 4);
    assert_int_equal(fixture_run(NULL, 0,
                                 "import --model %s --at 10,20,100 --cell 1 --out-image %s "
                                 "--out-top %s",
                                 fixture_path("square.gltf"), fixture_path("image.tif"),
                                 fixture_path("top.tif")),
                     0);
    float *red = read_band("image.tif", 0, &grid), *blue = read_band("image.tif", 2, &grid);
    float *top = read_band("top.tif", 0, &grid);
    assert_int_equal(grid.width, 10);
    assert_int_equal(grid.height, 10);
    for (int i = 0; i < 100; i++) {
        assert_int_equal((int)red[i], i < 50 ? 255 : 0);
        assert_in_range((int)blue[i], i < 50 ? 127 : 0, i < 50 ? 129 : 0); /* 0.214 is half grey */
        assert_true(top[i] == 103);
    }
    free(red);
    free(blue);
    free(top);
}

/* A square of 16 m whose texture is part of the file; its v runs downwards. */
static void write_gltf_with_texture(void)
{
    static const float floats[20] = {0, 2,   -16, 0, 2, 0, 16, 2, 0, 16,
                                     2, -16, 0,   0, 0, 1, 1,  1, 1, 0};
    static const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    uint8_t bytes[sizeof floats + sizeof indices], png[4096];
    write_texture("inside.png");
    FILE *in = fopen(fixture_path("inside.png"), "rb");
    const size_t length = fread(png, 1, sizeof png, in);
    fclose(in);
    unlink(fixture_path("inside.png"));
    memcpy(bytes, floats, sizeof floats);
    memcpy(bytes + sizeof floats, indices, sizeof indices);
    char *mesh = CPLBase64Encode(sizeof bytes, bytes), *image = CPLBase64Encode((int)length, png);
    FILE *f = fopen(fixture_path("inside.gltf"), "w");
    fprintf(
        f,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":"
        "[{\"mesh\":0}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"TEXCOORD_0\":1},\"indices\":2,\"material\":0}]}],\"materials\":[{"
        "\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],\"textures\":[{"
        "\"source\":0}],\"images\":[{\"uri\":\"data:image/png;base64,%s\"}],\"buffers\":[{"
        "\"byteLength\":%zu,\"uri\":\"data:application/octet-stream;base64,%s\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,"
        "\"byteOffset\":48,\"byteLength\":32},{\"buffer\":0,\"byteOffset\":80,\"byteLength\":12}"
        "],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":"
        "\"VEC3\",\"min\":[0,2,-16],\"max\":[16,2,0]},{\"bufferView\":1,\"componentType\":5126,"
        "\"count\":4,\"type\":\"VEC2\"},{\"bufferView\":2,\"componentType\":5123,\"count\":6,"
        "\"type\":\"SCALAR\"}]}",
        image, sizeof bytes, mesh);
    fclose(f);
    CPLFree(mesh);
    CPLFree(image);
}

TEST(a_texture_inside_the_file_is_found_and_named)
{
    struct db_grid grid;
    write_gltf_with_texture();
    assert_int_equal(fixture_run(NULL, 0,
                                 "import --model %s --at 1,1 --cell 1 --out-image %s --out-mask %s",
                                 fixture_path("inside.gltf"), fixture_path("inside.tif"),
                                 fixture_path("insidem.tif")),
                     0);
    for (int b = 0; b < 3; b++) {
        float *plane = read_band("inside.tif", b, &grid);
        for (int i = 0; i < 256; i++) {
            const int part = i % 16 >= 8 ? 1 : i / 16 < 8 ? 0 : 2;
            assert_int_equal((int)plane[i], b == part ? 200 : 10);
        }
        free(plane);
    }
    assert_int_equal(support_run("grep -q 'inside.gltf/texture-0</Category>' %s",
                                 fixture_path("insidem.tif.aux.xml")),
                     0);
}

/* A triangle 9 m eastwards and 18 m northwards, 3 m up, in centimetres. */
TEST(collada_says_its_unit_and_its_axes)
{
    static const char *const ups[] = {"Z_UP", "Y_UP"};
    static const char *const corners[] = {"0 0 300 900 0 300 0 1800 300",
                                          "0 300 0 900 300 0 0 300 -1800"};
    struct db_grid grid;
    for (int k = 0; k < 2; k++) {
        FILE *f = fopen(fixture_path("slab.dae"), "w");
        fprintf(f,
                "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/"
                "COLLADASchema\" version=\"1.4.1\"><asset><unit meter=\"0.01\"/><up_axis>%s"
                "</up_axis></asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\">"
                "<float_array id=\"a\" count=\"9\">%s</float_array><technique_common><accessor "
                "source=\"#a\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param "
                "name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
                "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
                "source=\"#p\"/></vertices><triangles count=\"1\"><input semantic=\"VERTEX\" "
                "source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry>"
                "</library_geometries><library_visual_scenes><visual_scene id=\"s\"><node><"
                "instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>"
                "<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>",
                ups[k], corners[k]);
        fclose(f);
        assert_int_equal(fixture_run(NULL, 0, "import --model %s --at 1,1 --cell 1 --out-top %s",
                                     fixture_path("slab.dae"), fixture_path("slab.tif")),
                         0);
        float *top = read_band("slab.tif", 0, &grid);
        assert_int_equal(grid.width, 9);
        assert_int_equal(grid.height, 18);
        for (int i = 0; i < 9 * 18; i++) {
            const double x = i % 9 + 0.5, y = 17.5 - i / 9;
            const double inside = 1 - x / 9 - y / 18;
            assert_true(fabs(inside) < 0.01 || top[i] == (float)(inside > 0 ? 3 : -9999));
        }
        free(top);
    }
}

static bool is_there(const char *name)
{
    return access(fixture_path(name), F_OK) == 0;
}

#define IMPORT(options) "import --model %s " options " --out-image %s"

static void check_refusal(const char *says, const char *model, const char *options)
{
    char command[1024];
    snprintf(command, sizeof command, "import --model %s %s --out-image %s", fixture_path(model),
             options, fixture_path("none.tif"));
    if (!fixture_fails(1, says, "%s", command) && !fixture_fails(2, says, "%s", command)) {
        fail_msg("`%s` not refused with `%s`", command, says);
    }
    assert_false(is_there("none.tif"));
}

TEST(what_a_file_does_not_say_is_asked_for)
{
    write_house();
    write_gltf("square.gltf", 4);
    check_refusal("say it with --unit m|cm|mm|ft|us-ft|in and --up y|z", "house.obj",
                  "--at 1,1 --cell 1");
    check_refusal("--unit m|cm", "house.obj", "--at 1,1 --cell 1 --unit m");
    check_refusal("leave out --unit and --up", "square.gltf", "--at 1,1 --cell 1 --unit ft");
    check_refusal("needs m, cm, mm, ft, us-ft or in", "house.obj",
                  "--at 1,1 --cell 1 --unit mile --up z");
    check_refusal("does not say where it stands", "house.obj", "--cell 1 --unit m --up z");
    check_refusal("no projected coordinate reference system", "house.obj",
                  "--cell 1 --unit m --up z --crs EPSG:4326");
    check_refusal("how many metres a cell", "house.obj", "--unit m --up z --at 1,1");
    fixture_write("house.xyzzy", "?");
    check_refusal("no kind of model", "house.xyzzy", "--at 1,1 --cell 1");
    check_refusal("cannot be opened", "absent.glb", "--at 1,1 --cell 1");
}

TEST(a_split_without_ground_is_refused)
{
    write_house();
    fixture_write("all.map", "lawn = house\nroof = house\n");
    check_refusal("needs --classes and --map", "house.obj",
                  "--at 1,1 --cell 1 --unit m --up z --out-terrain /tmp/never.tif");
    char options[512];
    snprintf(options, sizeof options,
             "--at 1,1 --cell 1 --unit m --up z --classes %s --map %s --out-heights %s",
             fixture_path("house.classes"), fixture_path("all.map"), fixture_path("none2.tif"));
    check_refusal("shows no ground from above", "house.obj", options);
    assert_false(is_there("none2.tif"));
}

TEST(hostile_models_cost_an_error)
{
    fixture_write("empty.obj", "");
    check_refusal("cannot be read", "empty.obj", "--at 1,1 --cell 1 --unit m --up z");
    fixture_write("upright.obj", "v 0 0 0\nv 1 0 0\nv 1 0 9\nf 1 2 3\n");
    check_refusal("shows nothing from above", "upright.obj", "--at 1,1 --cell 1 --unit m --up z");
    write_gltf("huge.gltf", 4000000000u);
    check_refusal("huge.gltf", "huge.gltf", "--at 1,1 --cell 1");
    fixture_write("cut.glb", "glTF\2");
    check_refusal("cut.glb", "cut.glb", "--at 1,1 --cell 1");
    write_house();
    check_refusal("1 to 134217728 are made", "house.obj", "--at 1,1 --cell 0.0001 --unit m --up z");
    fixture_write("broken.flt", "this is no OpenFlight file at all");
    check_refusal("cannot be read as OpenFlight", "broken.flt", "--at 1,1 --cell 1");
}

TEST(corners_that_are_no_numbers_are_left_out_and_counted)
{
    char said[4096];
    fixture_write(
        "nan.obj",
        "v 0 0 0\nv 9 0 0\nv 9 9 0\nv nan 1 1\nv 1e30 1 1\nv 9 0 4\nf 1 2 3\nf 1 2 5\nf 1 2 6\n");
    assert_int_equal(fixture_run(said, sizeof said, IMPORT("--at 1,1 --cell 1 --unit m --up z"),
                                 fixture_path("nan.obj"), fixture_path("nan.tif")),
                     0);
    assert_non_null(strstr(said, "1 triangles are left out: a corner is no number"));
    assert_non_null(strstr(said, "1 triangles, 1 upright or without area"));
}

TEST(a_missing_texture_is_named_and_a_plain_colour_stands_for_it)
{
    char said[4096];
    struct db_grid grid;
    write_house();
    unlink(fixture_path("roof.png"));
    assert_int_equal(fixture_run(said, sizeof said,
                                 "import --model %s --unit m --up z --at 36.1,3" HOUSE_OUT,
                                 fixture_path("house.obj"), HOUSE_PATHS),
                     0);
    assert_non_null(strstr(said, "1 texture is missing"));
    assert_non_null(strstr(said, "roof.png"));
    float *red = read_band("image.tif", 0, &grid);
    assert_int_equal((int)red[20 * 40 + 16], 255);
    free(red);
}

/* A cover of wire over the whole, whose west half is holes. */
TEST(what_is_transparent_is_looked_through)
{
    static uint8_t planes[4][16 * 16];
    struct db_grid grid;
    for (int i = 0; i < 256; i++) {
        planes[0][i] = planes[1][i] = planes[2][i] = 99;
        planes[3][i] = i % 16 < 8 ? 0 : 255;
    }
    GDALDatasetH memory = GDALCreate(GDALGetDriverByName("MEM"), "", 16, 16, 4, GDT_Byte, NULL);
    for (int c = 0; c < 4; c++) {
        assert_int_equal(GDALRasterIO(GDALGetRasterBand(memory, c + 1), GF_Write, 0, 0, 16, 16,
                                      planes[c], 16, 16, GDT_Byte, 0, 0),
                         CE_None);
    }
    GDALClose(GDALCreateCopy(GDALGetDriverByName("PNG"), fixture_path("wire.png"), memory, FALSE,
                             NULL, NULL, NULL));
    GDALClose(memory);
    fixture_write("wire.mtl", "newmtl ground\nKd 0.2 0.2 0.2\nnewmtl wire\nmap_Kd wire.png\n");
    fixture_write("wire.obj",
                  "mtllib wire.mtl\nv 0 0 0\nv 32 0 0\nv 32 32 0\nv 0 32 0\nv 0 0 5\n"
                  "v 32 0 5\nv 32 32 5\nv 0 32 5\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                  "usemtl ground\nf 1 2 3 4\nusemtl wire\nf 5/1 6/2 7/3 8/4\n");
    assert_int_equal(fixture_run(NULL, 0,
                                 "import --model %s --unit m --up z --at 1,1 --cell 2 --out-image "
                                 "%s --out-top %s",
                                 fixture_path("wire.obj"), fixture_path("wire.tif"),
                                 fixture_path("wiretop.tif")),
                     0);
    float *grey = read_band("wire.tif", 0, &grid), *top = read_band("wiretop.tif", 0, &grid);
    for (int i = 0; i < 256; i++) {
        assert_int_equal((int)grey[i], i % 16 < 8 ? 51 : 99);
        assert_int_equal((int)top[i], i % 16 < 8 ? 0 : 5);
    }
    free(grey);
    free(top);
}

/* Rotterdam's houses: one of 74 textures is there. */
TEST(a_model_with_one_texture_of_74_goes_on_without_the_others)
{
    char path[512], said[4096];
    struct db_grid grid;
    if (!support_data_path("city_delft_rotterdam/rotterdam/derived_rotterdam.obj", path,
                           sizeof path)) {
        skip();
    }
    assert_int_equal(fixture_run(said, sizeof said,
                                 "import --model %s --unit m --up z --crs EPSG:28992 --origin "
                                 "90000,435000 --cell 0.5 --out-image %s --out-top %s",
                                 path, fixture_path("rotterdam.tif"), fixture_path("rtop.tif")),
                     0);
    assert_non_null(strstr(said, " textures are missing")); /* of roofs; no wall is seen */
    float *top = read_band("rtop.tif", 0, &grid);
    double highest = 0;
    for (int i = 0; i < grid.width * grid.height; i++) {
        highest = fmax(highest, (double)top[i]);
    }
    assert_true(highest > 18 && highest < 18.3);
    free(top);
}

TEST(openflight_without_its_reader_names_the_package)
{
    fixture_write("any.flt", "x");
    assert_int_equal(
        support_run("env PATH=/nowhere %s/bin/landmass-db import --model %s --at 1,1 --cell 1 "
                    "--out-image %s 2> %s",
                    support_build_dir(), fixture_path("any.flt"), fixture_path("none.tif"),
                    fixture_path("said.txt")),
        1);
    assert_int_equal(support_run("grep -q 'install the Debian package openscenegraph' %s",
                                 fixture_path("said.txt")),
                     0);
}

/* Height of the highest triangle over a place, by the sum of areas: another way than the
 * program's. */
struct town {
    double (*corners)[3];
    int (*faces)[3];
    int corner_count, face_count;
};

static void read_town(struct town *t, const char *path)
{
    char line[256];
    FILE *f = fopen(path, "r");
    *t = (struct town){malloc(20000 * sizeof *t->corners), malloc(40000 * sizeof *t->faces), 0, 0};
    while (fgets(line, sizeof line, f)) {
        double *c = t->corners[t->corner_count];
        int *i = t->faces[t->face_count];
        t->corner_count += sscanf(line, "v %lf %lf %lf", c, c + 1, c + 2) == 3;
        t->face_count += sscanf(line, "f %d %d %d", i, i + 1, i + 2) == 3;
    }
    fclose(f);
}

static double cross(const double *a, const double *b, double x, double y)
{
    return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
}

static double town_top(const struct town *t, double x, double y, double *nearest_edge)
{
    double top = NAN;
    for (int i = 0; i < t->face_count; i++) {
        const double *a = t->corners[t->faces[i][0] - 1], *b = t->corners[t->faces[i][1] - 1];
        const double *c = t->corners[t->faces[i][2] - 1];
        const double all = cross(a, b, c[0], c[1]);
        if (fabs(all) < 1e-6) {
            continue;
        }
        const double wa = cross(b, c, x, y) / all, wb = cross(c, a, x, y) / all;
        const double wc = cross(a, b, x, y) / all;
        const double inside = fmin(wa, fmin(wb, wc));
        *nearest_edge = fmin(*nearest_edge, fabs(inside));
        if (inside >= 0) {
            top = fmax(isnan(top) ? -HUGE_VAL : top, wa * a[2] + wb * b[2] + wc * c[2]);
        }
    }
    return top;
}

TEST(a_town_of_delft_has_the_heights_of_its_triangles)
{
    char path[512];
    struct db_grid grid;
    if (!support_data_path("city_delft_rotterdam/derived_delft.obj", path, sizeof path)) {
        skip();
    }
    assert_int_equal(fixture_run(NULL, 0,
                                 "import --model %s --unit m --up z --crs EPSG:28992 --origin "
                                 "84616,447422 --cell 1 --out-top %s",
                                 path, fixture_path("delft.tif")),
                     0);
    float *top = read_band("delft.tif", 0, &grid);
    struct town town;
    read_town(&town, path);
    assert_int_equal(town.face_count, 36271);
    int compared = 0, on_edges = 0, seen = 0;
    for (int i = 0; i < grid.width * grid.height; i += 37) {
        const double x = grid.geotransform[0] + i % grid.width + 0.5 - 84616;
        const double y = grid.geotransform[3] - i / grid.width - 0.5 - 447422;
        double nearest = 1;
        const double wanted = town_top(&town, x, y, &nearest);
        if (nearest < 1e-4) {
            on_edges++; /* single precision may see either side */
            continue;
        }
        compared++;
        seen += !isnan(wanted);
        assert_true(isnan(wanted) ? top[i] == -9999 : fabs((double)top[i] - wanted) < 0.002);
    }
    print_message("# %d cells compared, %d of them on a surface, %d on edges\n", compared, seen,
                  on_edges);
    assert_true(compared > 3000 && seen > 800);
    free(top);
    free(town.corners);
    free(town.faces);
}

TEST_GROUP(fixture_open, fixture_close);
