/* Text tables of a bus: what is read, and that every mistake is refused with its line. */
#include "bus/table_text.h"

#include "bus/print.h"
#include "check.h"
#include "lm/bus.h"
#include "lm/bus_record.h"
#include "lm/status.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct bus_table table;

/* What is written to standard error while a text is read as a table. */
static int read_text(const char *text, char *errors, size_t size)
{
    FILE *in = tmpfile(), *caught = tmpfile();
    fputs(text, in);
    rewind(in);
    fflush(stderr);
    const int kept = dup(STDERR_FILENO);
    dup2(fileno(caught), STDERR_FILENO);
    const int status = bus_table_read(&table, in, "my.bus");
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    rewind(caught);
    errors[fread(errors, 1, size - 1, caught)] = '\0';
    fclose(caught);
    fclose(in);
    return status;
}

#define PACKED "profile mine\nframing packed\n"
#define ALT                                                                                        \
    "item \"altitude\" field=true-altitude id=0x100 range=0..9000 period=100 stale=300 dead=5000 "
#define CANAS "profile mine\nframing canaerospace\n"

TEST(every_mistake_is_refused_with_its_line_and_its_word)
{
    static const struct {
        const char *text, *place, *word;
    } tests[] = {
        {"", "line 0", "nothing there"},
        {"profile mine\n", "line 1", "nothing there"},
        {"framing packed\n" ALT "bits=0+16 unit=m\n", "line 2", "nothing there"},
        {"profile a b\n", "line 1", "profile"},
        {"profile mine\nframing morse\n", "line 2", "morse"},
        {PACKED "framing packed\n", "line 3", "framing"},
        {PACKED "colour green\n", "line 3", "colour"},
        {PACKED "channel-mask 0x1ff\n", "line 3", "channel-mask"},
        {PACKED "channel-mask 0x20000000\n", "line 3", "channel-mask"},
        {"profile mine\n" ALT "bits=0+16 unit=m\n", "line 2", "framing"},
        {PACKED "item altitude field=true-altitude\n", "line 3", "item"},
        {PACKED "item \"\" field=true-altitude\n", "line 3", "item"},
        {PACKED "item \"a|b\" field=true-altitude\n", "line 3", "name"},
        {PACKED "item \"a\" id=3 field=pitch\n", "line 3", "field"},
        {PACKED "item \"a\"\n", "line 3", "field"},
        {PACKED "item \"a\" field=flavour\n", "line 3", "flavour"},
        {PACKED "item \"a\" field=pitch id=1 bits=0+16 unit=deg\n", "line 3", "item"},
        {PACKED ALT "unit=m\n", "line 3", "bits"},
        {PACKED ALT "bits=0+16\n", "line 3", "unit"},
        {PACKED ALT "bits=0+16 unit=deg\n", "line 3", "unit"},
        {PACKED ALT "bits=0+16 unit=furlong\n", "line 3", "furlong"},
        {PACKED ALT "bits=50+16 unit=m\n", "line 3", "bits"},
        {PACKED ALT "bits=4294967290+16 unit=m\n", "line 3", "bits"},
        {PACKED ALT "bits=0+0 unit=m\n", "line 3", "bits"},
        {PACKED ALT "bits=0+33 unit=m\n", "line 3", "bits"},
        {PACKED ALT "bits=0+16 type=float unit=m\n", "line 3", "bits"},
        {PACKED ALT "bits=0+16 type=roman unit=m\n", "line 3", "roman"},
        {PACKED ALT "bits=0+16 endian=middle unit=m\n", "line 3", "middle"},
        {PACKED ALT "bits=0+16 none=0x10000 unit=m\n", "line 3", "none"},
        {PACKED ALT "bits=0+16 when=3 unit=m\n", "line 3", "when"},
        {PACKED ALT "bits=0+16 when=16+2=4 unit=m\n", "line 3", "when"},
        {PACKED ALT "bits=0+16 scale=0 unit=m\n", "line 3", "scale"},
        {PACKED ALT "bits=0+16 scale=nan unit=m\n", "line 3", "scale"},
        {PACKED ALT "bits=0+16 scale=1e11 unit=m\n", "line 3", "scale"},
        {PACKED ALT "bits=0+16 scale=1e-30 unit=m\n", "line 3", "scale"},
        {PACKED ALT "bits=0+32 type=float scale=1e-12 unit=m\n", "line 3", "scale"},
        {PACKED ALT "bits=0+16 scale=1e-9 offset=1e12 unit=m\n", "line 3", "offset"},
        {PACKED ALT "bits=0+16 mask=0xff unit=m\n", "line 3", "id"},
        {PACKED ALT "bits=0+16 types=FLOAT unit=m\n", "line 3", "types"},
        {PACKED ALT "bits=0+16 unit=m range=9..3\n", "line 3", "range"},
        {PACKED ALT "bits=0+16 unit=m range=0..3x\n", "line 3", "range"},
        {PACKED ALT "bits=0+16 unit=m id=0x20000000\n", "line 3", "id"},
        {PACKED ALT "bits=0+16 unit=m stale=99\n", "line 3", "period"},
        {PACKED ALT "bits=0+16 unit=m dead=300\n", "line 3", "period"},
        {PACKED ALT "bits=0+16 unit=m dead=60001\n", "line 3", "dead"},
        {PACKED ALT "bits=0+16 unit=m period=0.5\n", "line 3", "period"},
        {PACKED ALT "bits=0+16 unit=m weight=3\n", "line 3", "weight"},
        {PACKED ALT "bits=0+16 unit\n", "line 3", "unit"},
        {PACKED ALT "bits=0+16 unit=m\n# again\n" ALT "bits=16+16 unit=m\n", "line 5", "field"},
        {PACKED "item \"a\" field=latitude id=1 range=-90..90 period=100 stale=300 dead=5000 "
                "bits=0+32 unit=deg\n",
         "line 3", "dead"},
        {PACKED "item \"a\" field=rain-rate id=1 range=1..150 period=100 stale=300 dead=5000 "
                "bits=0+16 unit=m\n",
         "line 3", "unit"},
        {PACKED "item \"a\" field=rain-radius id=1 range=100..9000 period=100 stale=300 dead=5000 "
                "bits=0+16 unit=m\n",
         "line 3", "sets"},
        {CANAS ALT "id=199 types=FLOAT\n", "line 3", "id"},
        {CANAS ALT "id=300\n", "line 3", "types"},
        {CANAS ALT "id=300 types=FLOAT,REAL\n", "line 3", "REAL"},
        {CANAS ALT "id=300 types=CHAR4\n", "line 3", "CHAR4"},
        {CANAS ALT "id=300 types=DOUBLEH\n", "line 3", "DOUBLEH"},
        {CANAS ALT "id=300 types=FLOAT bits=0+16\n", "line 3", "bits"},
        {CANAS ALT "id=300 types=FLOAT per-unit=0\n", "line 3", "per-unit"},
        {CANAS ALT "id=300 types=FLOAT\n" ALT "id=300 priority=1 types=FLOAT\n", "line 4", "id"},
        {"profile mine\nframing canaerospace-types-assumed\n" ALT "id=300 types=FLOAT,LONG\n",
         "line 3", "types"},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        char errors[1024];
        const int status = read_text(tests[i].text, errors, sizeof errors);
        if (status != -1 || strstr(errors, tests[i].place) == NULL ||
            strstr(errors, tests[i].word) == NULL) {
            fail_msg("status %d, \"%s\" of:\n%s", status, errors, tests[i].text);
        }
    }
}

TEST(too_many_items_and_too_long_a_line_are_refused)
{
    char errors[1024];
    static char text[1 << 17];
    size_t length = (size_t)snprintf(text, sizeof text, PACKED);
    for (int i = 0; i <= LM_BUS_ROWS_MAX; i++) {
        length += (size_t)snprintf(text + length, sizeof text - length,
                                   ALT "bits=0+16 unit=m priority=%d id=%d\n", i, 1000 + i);
    }
    assert_int_equal(read_text(text, errors, sizeof errors), -1);
    assert_non_null(strstr(errors, "one too many"));
    assert_int_equal(table.profile.row_count, LM_BUS_ROWS_MAX);

    length = (size_t)snprintf(text, sizeof text, PACKED);
    for (int i = 0; i < 9; i++) {
        length += (size_t)snprintf(text + length, sizeof text - length,
                                   ALT "bits=%d+4 unit=m priority=%d\n", i, i);
    }
    assert_int_equal(read_text(text, errors, sizeof errors), -1);
    assert_non_null(strstr(errors, "line 11"));
    assert_non_null(strstr(errors, "eight"));

    memset(text, 'x', 2000);
    strcpy(text + 2000, "\n");
    assert_int_equal(read_text(text, errors, sizeof errors), -1);
    assert_non_null(strstr(errors, "longer than"));
}

static struct lm_bus_event only_event(const uint8_t bytes[8])
{
    struct lm_bus bus;
    struct lm_bus_event events[LM_BUS_EVENTS] = {{0}};
    lm_bus_init(&bus, &table.profile);
    struct lm_can_frame frame = {.id = 0x100, .is_extended = true, .length = 8};
    memcpy(frame.data, bytes, 8);
    assert_int_equal(lm_bus_take(&bus, &frame, events), 1);
    return events[0];
}

TEST(a_table_means_what_it_says)
{
    char errors[1024];
    assert_int_equal(read_text("# a remark\n"
                               "profile  mine # and another\r\n"
                               "framing packed\n\n" ALT "bits=8+16 \\\n"
                               "  type=signed endian=little scale=0.5 offset=100 unit=ft\n",
                               errors, sizeof errors),
                     0);
    assert_string_equal(errors, "");
    assert_string_equal(table.profile.name, "mine");
    assert_string_equal(table.profile.rows[0].name, "altitude");
    /* 1000 * 0.5 + 100 ft, in bytes 1 and 2. */
    const struct lm_bus_event e = only_event((const uint8_t[8]){9, 0xe8, 0x03, 9, 9, 9, 9, 9});
    assert_int_equal(e.value, lround(600 * 0.3048 * 64));
    assert_int_equal(e.step, (uint32_t)(0.5 * 0.3048 * 64));
}

TEST(a_signed_number_has_its_least_value_too)
{
    char errors[1024];
    const struct {
        uint8_t bytes[8];
        int metres;
    } tests[] = {
        {{0xf8, 0x00}, -2048}, {{0x07, 0xff}, 2047}, {{0xff, 0xff}, -1}, {{0x08, 0x01}, -2047}};
    assert_int_equal(read_text(PACKED ALT "range=-3000..9000 bits=4+12 type=signed unit=m\n",
                               errors, sizeof errors),
                     0);
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        assert_int_equal(only_event(tests[i].bytes).value, tests[i].metres * 64);
    }
}

TEST(a_number_that_says_nothing_is_no_value)
{
    char errors[1024];
    assert_int_equal(read_text(PACKED "invalid-mask 0x40000\nchannel-mask 0x3\n" ALT
                                      "mask=0x1ff8fffc bits=0+16 none=0xffff when=16+2=1 unit=m\n",
                               errors, sizeof errors),
                     0);
    const struct {
        uint32_t id;
        uint8_t length, data[3];
        enum lm_bus_outcome outcome;
    } tests[] = {
        {0x100, 3, {0x01, 0x00, 0x40}, LM_BUS_VALUE},
        {0x103, 3, {0x01, 0x00, 0x40}, LM_BUS_VALUE},   /* another channel */
        {0x20100, 3, {0x01, 0x00, 0x40}, LM_BUS_VALUE}, /* a bit outside the mask */
        {0x100, 3, {0xff, 0xff, 0x40}, LM_BUS_NO_DATA},
        {0x40100, 3, {0x01, 0x00, 0x40}, LM_BUS_NO_DATA}, /* its sender does not vouch for it */
        {0x100, 3, {0x01, 0x00, 0x80}, LM_BUS_UNUSED},    /* the condition is not met */
        {0x100, 2, {0x01, 0x00, 0x40}, LM_BUS_BAD_LENGTH},
        {0x100, 3, {0x23, 0x29, 0x40}, LM_BUS_OUT_OF_RANGE}, /* 9001 */
        {0x104, 3, {0x01, 0x00, 0x40}, LM_BUS_UNUSED},
    };
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        struct lm_bus bus;
        struct lm_bus_event events[LM_BUS_EVENTS];
        lm_bus_init(&bus, &table.profile);
        struct lm_can_frame frame = {
            .id = tests[i].id, .is_extended = true, .length = tests[i].length};
        memcpy(frame.data, tests[i].data, 3);
        const bool is_value = tests[i].outcome == LM_BUS_VALUE;
        assert_int_equal(lm_bus_take(&bus, &frame, events), is_value);
        assert_int_equal(bus.count.outcome[tests[i].outcome], 1);
        assert_true(!is_value || events[0].channel == (tests[i].id & 3));
    }
    struct lm_bus bus;
    struct lm_bus_event events[LM_BUS_EVENTS];
    lm_bus_init(&bus, &table.profile);
    const struct lm_can_frame short_id = {.id = 0x100, .length = 8};
    assert_int_equal(lm_bus_take(&bus, &short_id, events), 0);
    assert_int_equal(bus.count.outcome[LM_BUS_FOREIGN], 1);
}

TEST(floats_that_are_no_numbers_are_refused)
{
    char errors[1024];
    assert_int_equal(read_text(PACKED ALT "bits=0+64 type=float unit=m\n", errors, sizeof errors),
                     0);
    static const struct {
        uint8_t top[2];
        enum lm_bus_outcome outcome;
    } tests[] = {{{0x7f, 0xf8}, LM_BUS_NOT_A_NUMBER}, {{0xff, 0xf0}, LM_BUS_NOT_A_NUMBER},
                 {{0x7f, 0xef}, LM_BUS_OUT_OF_RANGE}, {{0xbf, 0xf0}, LM_BUS_OUT_OF_RANGE},
                 {{0x40, 0x59}, LM_BUS_VALUE},        {{0x00, 0x01}, LM_BUS_VALUE}};
    for (size_t i = 0; i < sizeof tests / sizeof *tests; i++) {
        struct lm_bus bus;
        struct lm_bus_event events[LM_BUS_EVENTS];
        lm_bus_init(&bus, &table.profile);
        struct lm_can_frame frame = {.id = 0x100, .is_extended = true, .length = 8};
        memcpy(frame.data, tests[i].top, 2);
        lm_bus_take(&bus, &frame, events);
        assert_int_equal(bus.count.outcome[tests[i].outcome], 1);
    }
}

/* The tables of the tree, read from their files, as records. */
TEST(what_a_text_says_a_record_keeps)
{
    static const char *const files[] = {"host-sim/bus/arinc825.bus", "host-sim/bus/nmea2000.bus"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        uint8_t record[LM_BUS_RECORD_BYTES_MAX];
        struct lm_bus_table kept;
        assert_int_equal(bus_table_load(&table, files[i]), 0);
        const uint32_t bytes = lm_bus_pack(&table.profile, record);
        assert_int_equal(lm_bus_unpack(&kept, record, bytes), LM_OK);
        assert_string_equal(kept.name, table.name);
        for (int k = 0; k < table.profile.row_count; k++) {
            struct lm_bus_row row = table.rows[k];
            row.name = kept.rows[k].name;
            assert_memory_equal(&row.packing.bias, &kept.rows[k].packing.bias, 8);
            assert_true(row.packing.multiplier == kept.rows[k].packing.multiplier);
            assert_true(row.id == kept.rows[k].id && row.field == kept.rows[k].field);
        }
    }
}

/* What the reader lets pass keeps what the firmware takes for granted: the same check judges both.
 */
TEST(what_the_reader_takes_the_firmware_takes)
{
    static const char *const texts[] = {
        PACKED ALT "bits=0+64 type=float unit=m scale=0.3\n",
        PACKED ALT "bits=0+32 type=float unit=ft offset=-4000\n",
        PACKED ALT "bits=0+1 unit=m scale=9000\n",
        PACKED ALT "bits=31+32 type=signed unit=m scale=1e-6 none=0xffffffff\n",
        CANAS ALT "id=200 types=SHORT,FLOAT per-unit=1000000000\n",
        CANAS ALT "id=1999 types=SHORT2\n"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        char errors[1024];
        assert_int_equal(read_text(texts[i], errors, sizeof errors), 0);
        assert_int_equal(lm_bus_profile_check(&table.profile, NULL), LM_OK);
    }
}

TEST(a_file_that_is_not_there_is_named)
{
    fflush(stderr);
    FILE *caught = tmpfile();
    const int kept = dup(STDERR_FILENO);
    dup2(fileno(caught), STDERR_FILENO);
    const int status = bus_table_load(&table, "/nowhere/my.bus");
    fflush(stderr);
    dup2(kept, STDERR_FILENO);
    close(kept);
    char errors[400] = "";
    rewind(caught);
    errors[fread(errors, 1, sizeof errors - 1, caught)] = '\0';
    fclose(caught);
    assert_int_equal(status, -1);
    assert_non_null(strstr(errors, "/nowhere/my.bus: cannot be opened: No such file"));
}

TEST(a_canaerospace_of_ones_own_is_read)
{
    char errors[1024];
    assert_int_equal(
        read_text(CANAS ALT "id=1500 types=SHORT,FLOAT per-unit=2\n", errors, sizeof errors), 0);
    struct lm_bus bus;
    struct lm_bus_event events[LM_BUS_EVENTS] = {{0}};
    lm_bus_init(&bus, &table.profile);
    const struct lm_can_frame frame = {.id = 1500, .length = 6, .data = {7, 6, 0, 0, 0x03, 0xe9}};
    assert_int_equal(lm_bus_take(&bus, &frame, events), 1);
    assert_int_equal(events[0].value, 1001 * 32);
}
