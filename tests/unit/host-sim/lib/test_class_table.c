/* The class table: what is written is read back, and what is wrong is refused with its line. */
#include "check.h"
#include "fixture.h"
#include "hs/class_table.h"

#include "hs/error.h"

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
    assert_memory_equal(&a, &b, sizeof a);
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
        {"[lake]", "[mud]", ":11: class [mud] is here a second time"},
        {"[lake]", "[the lake]", ":11: `the lake` is not a class name"},
        {"[lake]", "[lake", ":11: this is not a class heading"},
        {"[mud]\n", "", ":1: `colour` stands before any class"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        const char *at = strstr(good, wrong[i].from);
        char text[1024];
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
