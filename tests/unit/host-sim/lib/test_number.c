/* Numbers of options and text files: one reader, one contract. */
#include "check.h"
#include "hs/number.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double untouched = 77;

TEST(decimal_numbers_are_read_whole_with_blanks_around_them)
{
    static const struct {
        const char *text;
        double value;
    } good[] = {{"0", 0},      {"-12", -12},   {"+7", 7},
                {".5", 0.5},   {"5.", 5},      {" 1.25e-3\t", 1.25e-3},
                {"1E6", 1e6},  {"007", 7},     {"-0.0", 0},
                {"1e+2", 100}, {"36.5", 36.5}, {"123456789012", 123456789012}};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        double value = untouched;
        assert_true(hs_number(good[i].text, &value));
        assert_true(value == good[i].value);
    }
}

TEST(what_is_no_decimal_number_is_refused_and_changes_nothing)
{
    static const char *const bad[] = {"",    " ",    "x",     "1x",     "0x10",        "0X1p3",
                                      "inf", "-inf", "nan",   "NAN(1)", "infinity",    "1,5",
                                      "1 2", "1e",   "1e+",   "e5",     ".",           "-",
                                      "+-1", "--1",  "1.2.3", "1e999",  "-1e999",      "1_000",
                                      "\n1", "1\n",  "0x",    "1d3",    "\xc2\xa0\x31"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        double value = untouched;
        if (hs_number(bad[i], &value) || value != untouched) {
            fail_msg("`%s` was read as %g", bad[i], value);
        }
    }
}

/* 4.94e-324 is the least denormal number (IEEE 754 binary64). */
TEST(too_small_becomes_the_nearest_and_the_largest_is_read)
{
    double value;
    assert_true(hs_number("1e-400", &value) && value == 0);
    assert_true(hs_number("4.9406564584124654e-324", &value) && value == 0x1p-1074);
    assert_true(hs_number("3e-310", &value) && value > 0 && value < DBL_MIN);
    assert_true(hs_number("1.7976931348623157e308", &value) && value == DBL_MAX);
    assert_false(hs_number("1.8e308", &value));
}

TEST(a_range_has_its_ends)
{
    double value = untouched;
    assert_true(hs_number_within("-90", -90, 90, &value) && value == -90);
    assert_true(hs_number_within("90", -90, 90, &value) && value == 90);
    value = untouched;
    assert_false(hs_number_within("90.0001", -90, 90, &value));
    assert_false(hs_number_within("nan", -90, 90, &value));
    assert_true(value == untouched);
}

TEST(the_beginning_of_a_text_may_be_a_number)
{
    double value = untouched;
    assert_string_equal(hs_number_begin(" 12.5 m", &value), " m");
    assert_true(value == 12.5);
    assert_string_equal(hs_number_begin("6e feet", &value), "e feet");
    assert_true(value == 6);
    assert_null(hs_number_begin("0x10", &value));
    assert_null(hs_number_begin("m", &value));
    assert_true(value == 6);
}

TEST(lists_have_a_number_in_each_place)
{
    double v[3];
    assert_int_equal(hs_numbers("36.5, -14", ',', v, 3), 2);
    assert_true(v[0] == 36.5 && v[1] == -14);
    assert_int_equal(hs_numbers("1,2,3", ',', v, 3), 3);
    static const char *const bad[] = {"",    "1,",    ",1",  "1,,2", "1,2,3,4",
                                      "1;2", "1,nan", "1 2", "0x1,2"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        assert_int_equal(hs_numbers(bad[i], ',', v, 3), -1);
    }
}

/* Every number that is printed is read back as it was: 17 digits tell all doubles apart. */
TEST(any_double_that_is_printed_comes_back)
{
    uint64_t random = 1;
    for (int i = 0; i < 100000; i++) {
        random = random * 6364136223846793005u + 1442695040888963407u;
        union {
            uint64_t bits;
            double number;
        } u = {random ^ random >> 29};
        char text[40];
        double value = untouched;
        snprintf(text, sizeof text, i % 2 ? "%.17g" : "%.16e", u.number);
        assert_true(hs_number(text, &value) == (isfinite(u.number) != 0));
        assert_true(!isfinite(u.number) || value == u.number);
    }
}
