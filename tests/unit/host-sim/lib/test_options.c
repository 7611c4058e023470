/* Command lines: what the table says is what is accepted, and what the help, the manual page and
 * the shell's completion say. */
#include "check.h"
#include "hs/error.h"
#include "hs/options.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct values {
    bool is_quiet;
    const char *out, *track, *second, *folder, *axis, *share;
    struct hs_list list;
    double height;
    long count;
    int format;
    int pairs;
};

static const char *take_pair(void *context, const char *text)
{
    int *pairs = context;
    double a, b;
    if (sscanf(text, "%lf,%lf", &a, &b) != 2) {
        return "needs two numbers";
    }
    ++*pairs;
    return NULL;
}

static const struct hs_usage usage = {"try", "a command to try", "First.\n\n'Second -paragraph."};

/* Read a command line of up to 8 words; ended by NULL. Returns -1 to go on, or the exit code. */
static int read_words(struct values *v, const char *const *words)
{
    *v = (struct values){.height = NAN, .count = 7, .format = 1};
    char *argv[10] = {(char *)(size_t) "try"};
    int argc = 1, exit_code = -1;
    while (argc < 9 && words[argc - 1]) {
        argv[argc] = (char *)(size_t)words[argc - 1];
        argc++;
    }
    struct hs_taker pair = {take_pair, &v->pairs};
    const struct hs_option options[] = {
        {"TRACK", HS_INPUT_ARGUMENT, &v->track, 0, 0, NULL, "a track", true},
        {"SECOND", HS_INPUT_ARGUMENT, &v->second, 0, 0, NULL, "another", false},
        {"quiet", HS_FLAG, &v->is_quiet, 0, 0, NULL, "say nothing", false},
        {"Numbers", HS_HEADING, NULL, 0, 0, NULL, "All of them.\n", false},
        {"out", HS_TEXT, &v->out, 0, 0, "FILE", "where to\n.TH or not", false},
        {"item", HS_LIST, &v->list, 0, 0, "NAME", "again and again", false},
        {"height", HS_REAL, &v->height, -10, 10, "M", "metres", false},
        {"count", HS_INTEGER, &v->count, 0, 9, "N", "how many", false},
        {"format", HS_CHOICE, &v->format, 0, 0, "csv|gpx|igc", "of the track", false},
        {"into", HS_FOLDER, &v->folder, 0, 0, "DIR", "a folder", false},
        {"pair", HS_TAKER, &pair, 0, 0, "A,B", "a pair", false},
        {"axis", HS_WORD, &v->axis, 0, 0, "y|z", "which axis", false},
        {"share", HS_TEXT, &v->share, 0, 0, "all|equal|NAME=X,..", "of each", false},
        HS_NEEDS_ROW("SECOND", "quiet|pair"),
        HS_NEEDS_ROW("axis", "into|format=csv"),
        HS_CLASHES_ROW("quiet", "pair"),
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           &exit_code)
               ? -1
               : exit_code;
}
#define READ(v, ...) read_words(v, (const char *const[]){__VA_ARGS__, NULL})

TEST(every_kind_is_read_with_its_value_beside_or_behind_an_equals_sign)
{
    struct values v;
    assert_int_equal(READ(&v, "--height=-2.5", "flight.gpx", "--item", "a,b", "--item=c",
                          "--format", "igc", "--count=9"),
                     -1);
    assert_true(v.height == -2.5 && v.count == 9 && v.format == 2 && v.list.count == 3);
    assert_string_equal(v.track, "flight.gpx");
    assert_string_equal(v.list.items[2], "c");
    assert_null(v.second);
    hs_list_free(&v.list);
    assert_int_equal(READ(&v, "-", "two", "--pair", "1,2", "--pair", "3,4"), -1);
    assert_true(v.pairs == 2 && !v.is_quiet && v.count == 7 && v.format == 1 && isnan(v.height));
    assert_string_equal(v.second, "two");
}

/* Run what prints, with `stream` going to a file, and return what it said. */
static int caught(int stream, char *text, size_t size, const char *const *words)
{
    char path[] = "/tmp/landmass-test-XXXXXX";
    const int file = mkstemp(path), kept = dup(stream);
    fflush(NULL);
    dup2(file, stream);
    struct values v;
    const int code = read_words(&v, words);
    hs_list_free(&v.list);
    fflush(NULL);
    dup2(kept, stream);
    close(kept);
    const ssize_t length = pread(file, text, size - 1, 0);
    text[length > 0 ? length : 0] = '\0';
    close(file);
    unlink(path);
    return code;
}
#define CAUGHT(stream, text, ...)                                                                  \
    caught(stream, text, sizeof text, (const char *const[]){__VA_ARGS__, NULL})

TEST(a_wrong_command_line_is_refused_with_the_option_and_the_cause)
{
    static const struct {
        const char *words[5], *said;
    } wrong[] = {
        {{"t", "--nosuch"}, "try --nosuch: is not an option"},
        {{"t", "-q"}, "try -q: is not an option"},
        {{"t", "--height", "11"}, "try --height 11: needs a number from -10 to 10"},
        {{"t", "--height", "nan"}, "needs a number"},
        {{"t", "--height", "1e999"}, "needs a number"},
        {{"t", "--count", "1.5"}, "try --count 1.5: needs a whole number from 0 to 9"},
        {{"t", "--count", "1x"}, "needs a whole number"},
        {{"t", "--count"}, "try --count: needs a value"},
        {{"t", "--quiet=yes"}, "takes no value"},
        {{"t", "--format", "cs"}, "try --format cs: needs csv, gpx or igc"},
        {{"t", "--pair", "1"}, "try --pair 1: needs two numbers"},
        {{"t", "u", "v"}, "try v: is a word too many"},
        {{"--quiet"}, "try TRACK: is required"},
        {{"t", "--TRACK", "u"}, "is not an option"},
        {{"t", "--Numbers", "u"}, "is not an option"},
        {{"t", "--axis", "x"}, "try --axis x: needs y or z"},
        {{"t", "--axis", "y"}, "try --axis: needs --into or --format csv"},
        {{"t", "--quiet", "--pair", "1,2"}, "try --quiet: cannot be given together with --pair"},
        {{"t", "second", "--axis=z"}, "try SECOND: needs --quiet or --pair"},
    };
    hs_set_program("landmass-test");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        char text[400];
        const int code = caught(STDERR_FILENO, text, sizeof text, wrong[i].words);
        if (code != HS_EXIT_USAGE || !strstr(text, wrong[i].said) ||
            !strstr(text, "see landmass-test try --help")) {
            fail_msg("%s %s: exit %d, said \"%s\"", wrong[i].words[0],
                     wrong[i].words[1] ? wrong[i].words[1] : "", code, text);
        }
    }
}

TEST(the_help_names_every_option_with_range_and_default)
{
    char text[4000];
    assert_int_equal(CAUGHT(STDOUT_FILENO, text, "--help"), HS_EXIT_OK);
    static const char *const parts[] = {"Usage: landmass-test try TRACK [SECOND] [options]",
                                        "\nFirst.\n\n'Second -paragraph.\n",
                                        "  TRACK  (required)\n",
                                        "  --quiet\n",
                                        "  --out FILE\n      where to .TH or not\n",
                                        "\nNumbers:\nAll of them.\n",
                                        "Range -10 to 10.\n",
                                        "Range 0 to 9; default 7.\n",
                                        "  --format csv|gpx|igc\n",
                                        "Default gpx.\n",
                                        "  --axis y|z\n      which axis\n",
                                        "Needs --into or --format csv.\n",
                                        "Cannot be given together with --pair.\n",
                                        "  --version\n"};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        if (!strstr(text, parts[i])) {
            fail_msg("the help lacks \"%s\"", parts[i]);
        }
    }
    char again[4000];
    assert_int_equal(CAUGHT(STDOUT_FILENO, again, "--count", "99", "-h"), HS_EXIT_OK);
    assert_string_equal(again, text);
}

TEST(the_list_for_the_shell_has_every_option_and_its_value)
{
    char text[1000];
    assert_int_equal(CAUGHT(STDOUT_FILENO, text, "--help=list"), HS_EXIT_OK);
    assert_string_equal(
        text,
        "\tTRACK\tfile\n\tSECOND\tfile\n--quiet\t\t\n--out\tFILE\t\n"
        "--item\tNAME\t\n--height\tM\t\n--count\tN\t\n"
        "--format\tcsv|gpx|igc\tcsv|gpx|igc\n--into\tDIR\tfolder\n"
        "--pair\tA,B\t\n--axis\ty|z\ty|z\n"
        "--share\tall|equal|NAME=X,..\tall|equal\n--json\tFILE\tfile\n--help\t\t\n--version\t\t\n");
}

TEST(the_manual_page_escapes_what_would_be_a_command)
{
    char text[4000];
    assert_int_equal(CAUGHT(STDOUT_FILENO, text, "--help=man"), HS_EXIT_OK);
    static const char *const parts[] = {
        ".TH LANDMASS-TEST-TRY 1 ", "landmass\\-test\\-try \\- a command to try\n",
        "\n\\&'Second \\-paragraph.\n", "\n\\&.TH or not\n", "\\fB\\-\\-height\\fR \\fIM\\fR\n"};
    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        if (!strstr(text, parts[i])) {
            fail_msg("the page lacks \"%s\": %s", parts[i], text);
        }
    }
}

TEST(a_choice_has_its_word_by_default_too)
{
    struct values v;
    assert_int_equal(READ(&v, "t", "--axis", "y", "--format", "csv"), -1);
    assert_string_equal(v.axis, "y");
    assert_int_equal(READ(&v, "t", "--axis", "y", "--into", "."), -1);
}
