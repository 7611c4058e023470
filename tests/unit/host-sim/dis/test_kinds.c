/* The table of kinds: which rule decides, and that no line is taken by mistake. */
#include "check.h"
#include "dis/kinds.h"

#include <stdio.h>
#include <string.h>

static struct dis_kinds kinds;

static int read_text(const char *text)
{
    char copy[2000];
    snprintf(copy, sizeof copy, "%s", text);
    FILE *in = fmemopen(copy, strlen(copy), "r");
    assert_non_null(in);
    const int status = dis_kinds_read_stream(&kinds, in, "test");
    fclose(in);
    return status;
}

/* The kind that a type becomes, "skip", or NULL where no rule fits. */
static const char *becomes(uint8_t kind, uint8_t domain, uint16_t country, uint8_t category)
{
    const struct dis_type type = {kind, domain, country, category, 1, 2, 3};
    struct dis_kind found;
    if (dis_kinds_find(&kinds, &type, &found) == NULL) {
        return NULL;
    }
    return found.is_skipped ? "skip" : dis_kind_name(found.kind);
}

TEST(the_first_rule_that_fits_decides_and_fields_are_numbers_ranges_or_any)
{
    assert_int_equal(read_text("# remark\n1.1.222.6 kind car rcs 9 signature 2\n"
                               "1.1.*.24-26 kind train # wagons\n1.2 kind fighter\n4 skip\n"),
                     0);
    assert_string_equal(becomes(1, 1, 222, 6), "car");
    assert_null(becomes(1, 1, 223, 6));
    assert_string_equal(becomes(1, 1, 65535, 24), "train");
    assert_string_equal(becomes(1, 1, 222, 26), "train");
    assert_null(becomes(1, 1, 222, 27));
    assert_string_equal(becomes(1, 2, 0, 0), "fighter");
    assert_string_equal(becomes(4, 9, 0, 0), "skip");
}

TEST(words_say_cross_section_signature_and_what_it_stands_on)
{
    const struct dis_type car = {1, 1, 222, 6, 0, 0, 0}, jet = {1, 2, 0, 1, 0, 0, 0},
                          missile = {2, 1, 0, 0, 0, 0, 0};
    struct dis_kind k;
    assert_int_equal(read_text("1.1 kind car signature 255 rcs -12.5\n1.2 kind fighter\n"
                               "2.1 height kind missile\n"),
                     0);
    assert_non_null(dis_kinds_find(&kinds, &car, &k));
    assert_true(k.signature == 255 && k.rcs_dbsm == -12.5 && k.is_on_ground);
    assert_non_null(dis_kinds_find(&kinds, &jet, &k));
    assert_true(k.signature == 0 && isnan(k.rcs_dbsm) && !k.is_on_ground);
    assert_non_null(dis_kinds_find(&kinds, &missile, &k));
    assert_false(k.is_on_ground);
}

TEST(a_line_that_is_wrong_is_refused)
{
    static const char *const wrong[] = {
        "1.1",                           /* no kind */
        "1.1 kind",                      /* no name */
        "1.1 kind zeppelin",             /* no such kind */
        "1.1 kind car kind truck",       /* twice */
        "1.1 kind car rcs 61",           /* out of range */
        "1.1 kind car rcs nan",          /* no number */
        "1.1 kind car signature 0",      /* counted from 1 */
        "1.1 kind car signature 1.5",    /* half a signature */
        "1.1 kind car ground height",    /* both */
        "1.1 kind car skip",             /* skip is not alone */
        "1.1 kind car colour red",       /* unknown word */
        "256 kind car",                  /* a byte */
        "1.1.65536 kind car",            /* two bytes */
        "1.1.1.1.1.1.1.1 kind car",      /* eight fields */
        "1. kind car",                   /* a field is missing */
        "1.1.5-3 kind car",              /* backwards */
        "1.1.-3 kind car",               /* no lower end */
        "1,1 kind car",                  /* another separator */
        "99999999999999999999 kind car", /* beyond all */
        "",                              /* nothing at all */
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        assert_int_equal(read_text(wrong[i]), -1);
    }
}

TEST(a_line_that_can_never_decide_is_refused)
{
    assert_int_equal(read_text("1.1 kind car\n1.1.222 kind truck\n"), -1);
    assert_int_equal(read_text("1.1.222 kind truck\n1.1 kind car\n"), 0);
    assert_int_equal(read_text("1.1.*.1-9 kind car\n1.1.*.3-5 kind truck\n"), -1);
    assert_int_equal(read_text("1.1.*.1-9 kind car\n1.1.*.3-10 kind truck\n"), 0);
}

/* Some types as SISO-REF-010 names them. */
TEST(the_table_that_is_built_in_knows_what_platforms_are)
{
    assert_int_equal(dis_kinds_read_builtin(&kinds), 0);
    assert_string_equal(becomes(1, 1, 225, 1), "tracked-armour"); /* M1 Abrams */
    assert_string_equal(becomes(1, 1, 222, 6), "car");            /* GAZ-69 */
    assert_string_equal(becomes(1, 1, 39, 7), "truck");           /* large wheeled utility */
    assert_string_equal(becomes(1, 1, 225, 24), "train");
    assert_string_equal(becomes(1, 2, 225, 1), "fighter");     /* F-16 */
    assert_string_equal(becomes(1, 2, 225, 21), "helicopter"); /* UH-60 */
    assert_string_equal(becomes(1, 3, 225, 1), "large-ship");  /* a carrier */
    assert_string_equal(becomes(1, 3, 225, 6), "ship");        /* a frigate */
    assert_string_equal(becomes(1, 3, 0, 84), "boat");
    assert_string_equal(becomes(1, 4, 225, 1), "skip"); /* a submarine */
    assert_string_equal(becomes(3, 1, 225, 1), "person");
    assert_string_equal(becomes(2, 1, 225, 1), "missile");
    assert_string_equal(becomes(9, 9, 9, 9), "skip");
}
