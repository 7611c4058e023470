/* The tables that are compiled are those of the formulas, and the same on every machine. */
#include "check.h"
#include "fx/crc32c.h"
#include "support.h"
#include "tables/tables.h"

#include <stdlib.h>
#include <string.h>

/* The CRC-32C of each set's text. A machine whose mathematical library rounds otherwise, or a
 * formula that has changed, shows here; after a change of a formula, which is also one of the
 * golden pictures, the sum that the failure prints belongs here. */
static const struct {
    const char *set;
    uint32_t sum;
} known[] = {{"fixed", 0xd8236599},
             {"grain", 0xa359d901},
             {"noise", 0x1e4a6858},
             {"response", 0x0f490b48},
             {"grown", 0x1c7e5635}};

static char *whole_file(const char *path)
{
    FILE *in = fopen(path, "r");
    assert_non_null(in);
    char *text = NULL;
    size_t size = 0;
    assert_true(getdelim(&text, &size, '\0', in) > 0);
    fclose(in);
    return text;
}

static char *made_text(const struct table_set *set)
{
    char *made = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&made, &size);
    assert_non_null(out);
    assert_int_equal(table_set_print(out, set), 0);
    fclose(out);
    return made;
}

TEST(the_tables_that_were_compiled_are_those_of_the_formulas)
{
    for (int i = 0; i < table_set_count; i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/gen/%s", support_build_dir(), table_sets[i].file);
        char *compiled = whole_file(path);
        char *made = made_text(&table_sets[i]);
        assert_string_equal(compiled, made);
        free(compiled);
        free(made);
    }
}

TEST(the_tables_are_the_same_on_every_machine_that_builds)
{
    assert_int_equal(sizeof known / sizeof *known, table_set_count);
    for (int i = 0; i < table_set_count; i++) {
        char *made = made_text(&table_sets[i]);
        const uint32_t sum = fx_crc32c(0, made, strlen(made));
        assert_string_equal(known[i].set, table_sets[i].name);
        if (sum != known[i].sum) {
            fail_msg("the sum of %s is 0x%08x", known[i].set, sum);
        }
        free(made);
    }
}

static int64_t one_too_large(int row, int i)
{
    (void)row;
    return i == 2 ? 65536 : 0;
}

TEST(an_entry_that_does_not_fit_its_type_is_refused)
{
    const struct table wide = {"wide", "uint32_t", "fits", 0, 3, one_too_large};
    const struct table narrow = {"narrow", "uint16_t", "does not fit", 0, 3, one_too_large};
    const struct table_set fits = {"test", "", "", &wide, 1};
    const struct table_set does_not = {"test", "", "", &narrow, 1};
    FILE *out = fopen("/dev/null", "w");
    assert_non_null(out);
    assert_int_equal(table_set_print(out, &fits), 0);
    assert_int_equal(table_set_print(out, &does_not), -1);
    fclose(out);
}

TEST(the_program_writes_the_same_text_to_a_file_and_to_its_output)
{
    const char *build = support_build_dir();
    assert_int_equal(support_run("mkdir -p %s/tmp", build), 0);
    assert_int_equal(support_run("%s/bin/landmass-tables fixed %s/tmp/tables.c && "
                                 "%s/bin/landmass-tables fixed | cmp - %s/tmp/tables.c && "
                                 "cmp %s/tmp/tables.c %s/gen/fixed/src/tables.c",
                                 build, build, build, build, build, build),
                     0);
}

TEST(the_program_explains_itself_and_refuses_what_makes_no_sense)
{
    const char *build = support_build_dir();
    assert_int_equal(support_run("%s/bin/landmass-tables --help | grep -qi 'usage:'", build), 0);
    assert_int_equal(support_run("%s/bin/landmass-tables 2>/dev/null", build), 2);
    assert_int_equal(support_run("%s/bin/landmass-tables nonsense 2>/dev/null", build), 2);
    assert_int_equal(support_run("%s/bin/landmass-tables fixed /nowhere/x.c 2>/dev/null", build),
                     1);
}
