/* The class table: what is written is read back, and what is wrong is refused with its line. */
#include "check.h"
#include "fixture.h"
#include "hs/class_table.h"

#include "hs/error.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char good[] =
    "[mud]\n"
    "colour = 1 2 3   # chosen\n"
    "kind = ground\n"
    "gamma_db = -20.25 # dB; some report\n"
    "spread_db = 3\n"
    "limits_db = -30 -10\n"
    "texture = k\n"
    "texture_shape = 2.5\n"
    "height_m = 1.5\n"
    "looks = 4\n"
    "ku_db = -19 2.5 -29 -9 # dB; another report\n"
    "emissivity = 0.9 0.05\n"
    "albedo = 0.2 0.03\n"
    "conductivity = 1.5 0.25\n"
    "heat_capacity = 2.25 # MJ/(m3 K)\n"
    "wetness = 0.5\n"
    "roughness_m = 0.002\n"
    "[lake]\n"
    "colour = 255 0 0\n"
    "kind = water\n"
    "gamma_db = -40\n"
    "spread_db = 0\n"
    "limits_db = -50 -25\n";

TEST(a_table_written_and_read_back_is_the_same_with_its_sources)
{
    struct db_class_table a, b;
    fixture_write("good.classes", good);
    assert_int_equal(db_class_table_read(&a, fixture_path("good.classes")), 0);
    assert_int_equal(a.count, 2);
    assert_string_equal(a.items[0].source[DB_KEY_GAMMA], "dB; some report");
    assert_true(a.items[0].gamma_db == -20.25 && a.items[0].looks == 4);
    assert_int_equal(a.items[0].texture, DB_TEXTURE_K);
    assert_int_equal(a.items[1].kind, DB_KIND_WATER);
    assert_true(a.items[1].looks == 1 && a.items[1].height_m == 0);
    assert_int_equal(db_class_table_write(&a, fixture_path("again.classes")), 0);
    assert_int_equal(db_class_table_read(&b, fixture_path("again.classes")), 0);
    for (int i = 0; i < a.count; i++) {
        b.items[i].line = a.items[i].line; /* A heading line was added. */
    }
    assert_memory_equal(&a, &b, sizeof a);
}

TEST(a_sensor_gets_its_own_levels_and_x_those_without_a_band)
{
    struct db_class_table t;
    const char *path = fixture_path("good.classes");
    fixture_write("good.classes", good);
    assert_int_equal(db_class_table_read(&t, path), 0);
    const struct db_class *mud = &t.items[0];
    const struct db_thermal *thermal = &mud->thermal;
    assert_true(thermal->albedo == 0.2 && thermal->albedo_spread == 0.03);
    assert_true(thermal->conductivity == 1.5 && thermal->conductivity_spread == 0.25);
    assert_true(thermal->heat_capacity == 2.25 && thermal->wetness == 0.5);
    assert_true(thermal->roughness_m == 0.002 && t.items[1].thermal.roughness_m == 0.01);
    t.count = 1; /* The lake has X alone. */
    assert_int_equal(db_class_table_choose(&t, path, HS_SENSOR_KU), 0);
    assert_true(mud->gamma_db == -19 && mud->spread_db == 2.5);
    assert_true(mud->low_db == -29 && mud->high_db == -9 && mud->texture == DB_TEXTURE_K);
    assert_int_equal(db_class_table_choose(&t, path, HS_SENSOR_X), 0);
    assert_true(mud->gamma_db == -20.25 && mud->spread_db == 3 && mud->high_db == -10);
}

/* A tenth is reflected, -10 dB, and half of that tenth is 10 / ln 10 / 2 = 2.1715 dB. */
TEST(the_infrared_reflects_what_it_does_not_emit)
{
    struct db_class_table t;
    fixture_write("good.classes", good);
    assert_int_equal(db_class_table_read(&t, fixture_path("good.classes")), 0);
    t.count = 1;
    assert_int_equal(db_class_table_choose(&t, "good", HS_SENSOR_IR), 0);
    const struct db_class *mud = &t.items[0];
    assert_true(fabs(mud->gamma_db + 10) < 1e-9 && fabs(mud->spread_db - 2.1715) < 1e-4);
    assert_true(fabs(mud->low_db + 10 + 3 * mud->spread_db) < 1e-9 && mud->high_db <= 0);
    assert_int_equal(mud->texture, DB_TEXTURE_GAUSSIAN);
}

TEST(a_table_without_the_values_of_a_sensor_is_refused_with_the_line_of_the_class)
{
    static const struct {
        const char *sensor, *says;
    } lacks[] = {
        {"ku", ":18: class [lake] has no `ku_db`, which Ku band needs"},
        {"ka", ":1: class [mud] has no `ka_db`, which Ka band needs"},
        {"mmw", ":1: class [mud] has no `mmw_db`, which the millimetre band needs"},
        {"ir", ":18: class [lake] has no `emissivity`, which the infrared needs"},
    };
    fixture_write("good.classes", good);
    for (size_t i = 0; i < sizeof lacks / sizeof lacks[0]; i++) {
        if (!fixture_fails(HS_EXIT_FAILED, lacks[i].says,
                           "reflect --class-raster x.tif --out y.tif --classes %s --sensor %s",
                           fixture_path("good.classes"), lacks[i].sensor)) {
            fail_msg("%s", lacks[i].sensor);
        }
    }
}

/* 5 log10 of the frequency: surfacegamma of MATLAB's Radar Toolbox, after Nathanson and Long. */
TEST(the_tables_that_come_with_it_have_every_sensor_and_a_source_for_each_value)
{
    static const char *const tables[] = {"heaton6", "landcover"};
    static const double rise_db[] = {
        [HS_SENSOR_KU] = 1.02, [HS_SENSOR_KA] = 2.72, [HS_SENSOR_MMW] = 4.87};
    for (int k = 0; k < 2; k++) {
        struct db_class_table t;
        char path[80];
        snprintf(path, sizeof path, "host-sim/programs/db/classes/%s.classes", tables[k]);
        assert_int_equal(db_class_table_read(&t, path), 0);
        for (int i = 0; i < t.count; i++) {
            for (int key = DB_KEY_KU; key < DB_KEY_COUNT; key++) {
                assert_true(!t.items[i].has_key[key] || t.items[i].source[key][0] != '\0');
            }
        }
        for (int s = 0; s < HS_SENSOR_COUNT; s++) {
            assert_int_equal(db_class_table_choose(&t, path, (enum hs_sensor)s), 0);
        }
        for (int s = HS_SENSOR_KU; s <= HS_SENSOR_MMW; s++) {
            const struct db_levels *soil = t.items[0].levels;
            assert_true(fabs(soil[s].gamma_db - soil[HS_SENSOR_X].gamma_db - rise_db[s]) < 0.06);
        }
    }
}

TEST(heatons_six_classes_are_as_the_paper_names_them)
{
    struct db_class_table t;
    char names[256];
    assert_int_equal(db_class_table_read(&t, "host-sim/programs/db/classes/heaton6.classes"), 0);
    db_class_names(&t, names, sizeof names);
    assert_string_equal(names, "soil, asphalt, concrete, structure, vegetation, water");
    for (int i = 0; i < t.count; i++) {
        assert_true(t.items[i].source[DB_KEY_GAMMA][0] != '\0');
        assert_true(t.items[i].source[DB_KEY_SPREAD][0] != '\0');
        assert_true(t.items[i].source[DB_KEY_LIMITS][0] != '\0');
    }
    /* Separable means, overlapping limits: Heaton on soil and vegetation. */
    const struct db_class *soil = &t.items[0], *vegetation = &t.items[4];
    assert_true(soil->gamma_db != vegetation->gamma_db);
    assert_true(soil->high_db > vegetation->low_db);
}

TEST(every_mistake_is_refused_with_its_line)
{
    static const struct {
        const char *from, *to, *says;
    } wrong[] = {
        {"kind = ground", "kind = air", ":3: `kind` needs ground, water"},
        {"colour = 1 2 3", "colour = 1 2", ":2: `colour` needs three"},
        {"colour = 1 2 3", "colour = 1 2 256", ":2: `colour` needs three"},
        {"gamma_db = -20.25", "gamma_db = low", ":4: `gamma_db` needs a number"},
        {"gamma_db = -20.25", "gamma_db = nan", ":4: `gamma_db` needs a number"},
        {"limits_db = -30 -10", "limits_db = -10 -30", ":6: `limits_db` needs two"},
        {"gamma_db = -20.25", "gamma_db = -5", "outside its limits"},
        {"spread_db = 3\n", "", "without `spread_db`"},
        {"kind = ground", "kinds = ground", ":3: `kinds` is not a known key"},
        {"kind = ground", "kind ground", ":3: this line is neither"},
        {"spread_db = 3", "kind = water", ":5: `kind` is given twice"},
        {"[lake]", "[mud]", ":18: class [mud] is here a second time"},
        {"[lake]", "[the lake]", ":18: `the lake` is not a class name"},
        {"[lake]", "[lake", ":18: this is not a class heading"},
        {"ku_db = -19 2.5 -29 -9", "ku_db = -19 2.5", ":11: `ku_db` needs four numbers"},
        {"ku_db = -19 2.5 -29 -9", "ku_db = -19 2.5 -9 -29", ":11: `ku_db` needs four numbers"},
        {"ku_db = -19 2.5 -29 -9", "ku_db = -8 2.5 -29 -9", ":11: `ku_db` needs four numbers"},
        {"ku_db = -19 2.5 -29 -9", "ku_db = -19 21 -29 -9", ":11: `ku_db` needs four numbers"},
        {"emissivity = 0.9 0.05", "emissivity = 1 0.05", ":12: `emissivity` needs two numbers"},
        {"albedo = 0.2 0.03", "albedo = 0.2 nan", ":13: `albedo` needs two numbers"},
        {"conductivity = 1.5", "conductivity = 0", ":14: `conductivity` needs two numbers"},
        {"heat_capacity = 2.25", "heat_capacity = -1", ":15: `heat_capacity` needs a number"},
        {"wetness = 0.5", "wetness = 1.5", ":16: `wetness` needs a number"},
        {"roughness_m = 0.002", "roughness_m = 0", ":17: `roughness_m` needs a number"},
        {"[mud]\n", "", ":1: `colour` stands before any class"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const char *at = strstr(good, wrong[i].from);
        char text[1024];
        assert_non_null(at);
        snprintf(text, sizeof text, "%.*s%s%s", (int)(at - good), good, wrong[i].to,
                 at + strlen(wrong[i].from));
        fixture_write("wrong.classes", text);
        if (!fixture_fails(HS_EXIT_FAILED, wrong[i].says,
                           "reflect --class-raster x.tif --out y.tif --classes %s",
                           fixture_path("wrong.classes"))) {
            fail_msg("`%s` for `%s`", wrong[i].to, wrong[i].from);
        }
    }
}

TEST(a_seventeenth_class_is_refused)
{
    struct db_class_table t;
    FILE *f = fopen(fixture_path("many.classes"), "w");
    for (int i = 0; i < 17; i++) {
        fprintf(f,
                "[c%d]\ncolour = 0 0 0\nkind = ground\ngamma_db = 0\nspread_db = 1\n"
                "limits_db = -1 1\n",
                i);
    }
    fclose(f);
    assert_int_equal(db_class_table_read(&t, fixture_path("many.classes")), -1);
}

TEST_GROUP(fixture_open, fixture_close);
