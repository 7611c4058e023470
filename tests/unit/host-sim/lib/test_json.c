/* JSON text: what the standard asks for (RFC 8259), whatever the values are. */
#include "check.h"
#include "hs/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct written {
    char *text;
    size_t size;
    FILE *out;
    struct hs_json json;
};

static void begin(struct written *w)
{
    w->out = open_memstream(&w->text, &w->size);
    assert_non_null(w->out);
    hs_json_begin(&w->json, w->out);
}

static void assert_written(struct written *w, const char *expected)
{
    hs_json_end(&w->json);
    fclose(w->out);
    assert_string_equal(w->text, expected);
    free(w->text);
}

/* The members of an object that has only the text `value`. */
static void assert_text(const char *value, const char *expected)
{
    struct written w;
    char whole[200];
    begin(&w);
    hs_json_text(&w.json, "t", value);
    snprintf(whole, sizeof whole, "{\n  \"t\": %s\n}\n", expected);
    assert_written(&w, whole);
}

TEST(members_are_parted_by_commas_and_what_is_empty_stays_in_a_line)
{
    struct written w;
    begin(&w);
    hs_json_object(&w.json, "none");
    hs_json_close(&w.json);
    hs_json_array(&w.json, "list");
    hs_json_integer(&w.json, NULL, -1);
    hs_json_object(&w.json, NULL);
    hs_json_flag(&w.json, "is_it", true);
    hs_json_close(&w.json);
    hs_json_close(&w.json);
    hs_json_text(&w.json, "last", NULL);
    assert_written(&w,
                   "{\n  \"none\": {},\n  \"list\": [\n    -1,\n    {\n      \"is_it\": true\n"
                   "    }\n  ],\n  \"last\": null\n}\n");
}

TEST(the_end_closes_what_a_failed_run_left_open)
{
    struct written w;
    begin(&w);
    hs_json_array(&w.json, "a");
    hs_json_object(&w.json, NULL);
    hs_json_array(&w.json, "b");
    assert_written(&w, "{\n  \"a\": [\n    {\n      \"b\": []\n    }\n  ]\n}\n");
}

TEST(characters_that_end_or_break_a_text_are_escaped)
{
    assert_text("a\"b\\c", "\"a\\\"b\\\\c\"");
    assert_text("\x01\n\t\x1f\x7f", "\"\\u0001\\u000a\\u0009\\u001f\\u007f\"");
    assert_text("", "\"\"");
}

/* The cases of table 3-7 of the Unicode standard: the least and the greatest of each length, and
 * what stands just outside. */
TEST(what_is_utf_8_is_kept_and_every_other_byte_becomes_the_replacement_character)
{
    static const char *const good[] = {
        "\xc2\x80",     "\xdf\xbf",         "\xe0\xa0\x80",     "\xed\x9f\xbf",      "\xee\x80\x80",
        "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf", "Gr\xc3\xb6\xc3\x9f"};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        char quoted[40];
        snprintf(quoted, sizeof quoted, "\"%s\"", good[i]);
        assert_text(good[i], quoted);
    }
    assert_text("\xc1\xbf", "\"\\ufffd\\ufffd\"");
    assert_text("\xe0\x9f\xbf", "\"\\ufffd\\ufffd\\ufffd\"");
    assert_text("\xed\xa0\x80", "\"\\ufffd\\ufffd\\ufffd\"");
    assert_text("\xf0\x8f\xbf\xbf", "\"\\ufffd\\ufffd\\ufffd\\ufffd\"");
    assert_text("\xf4\x90\x80\x80", "\"\\ufffd\\ufffd\\ufffd\\ufffd\"");
    assert_text("\xf5z", "\"\\ufffdz\"");
    assert_text("a\x80", "\"a\\ufffd\"");
    assert_text("\xe2\x82", "\"\\ufffd\\ufffd\"");
    assert_text("\xc3", "\"\\ufffd\"");
}

TEST(numbers_keep_twelve_digits_and_those_that_are_not_finite_are_null)
{
    struct written w;
    begin(&w);
    hs_json_array(&w.json, "n");
    static const double reals[] = {0.1, -1234567.89012, 1e300, 42, NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < sizeof reals / sizeof reals[0]; i++) {
        hs_json_real(&w.json, NULL, reals[i]);
    }
    hs_json_integer(&w.json, NULL, INT64_MIN);
    hs_json_count(&w.json, NULL, UINT64_MAX);
    assert_written(&w,
                   "{\n  \"n\": [\n    0.1,\n    -1234567.89012,\n    1e+300,\n    42,\n    null,\n"
                   "    null,\n    null,\n    -9223372036854775808,\n    18446744073709551615\n"
                   "  ]\n}\n");
}
