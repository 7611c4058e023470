/* The radar table as text: what is printed reads back to the bit, and what is wrong is refused with
 * its line. */
#include "check.h"
#include "hs/rng.h"
#include "lm/radar_check.h"
#include "lm/radar_record.h"
#include "radar/text.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

static const char *path_of(const char *name)
{
    static char path[512];
    snprintf(path, sizeof path, "%s/tmp/radar-%s", support_build_dir(), name);
    return path;
}

static void print_to(const char *path, const struct lm_radar *radar)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    radar_text_print(file, radar);
    assert_int_equal(fclose(file), 0);
}

/* Both as records, which hold every number and no padding. */
static void expect_same(const struct lm_radar *a, const struct lm_radar *b)
{
    uint8_t first[LM_RADAR_RECORD_BYTES], second[LM_RADAR_RECORD_BYTES];
    lm_radar_pack(a, first);
    lm_radar_pack(b, second);
    assert_memory_equal(first, second, sizeof first);
}

TEST(the_built_in_table_reads_back_to_the_bit)
{
    const char *path = path_of("default");
    struct lm_radar radar;
    print_to(path, &lm_radar_default);
    assert_int_equal(radar_text_read(&radar, path), 0);
    expect_same(&radar, &lm_radar_default);
}

/* Any number of any field, whatever its unit: a table is changed in one element at a time. */
TEST(every_number_that_the_check_allows_reads_back_to_the_bit)
{
    const char *path = path_of("random");
    struct hs_rng rng;
    uint32_t tried = 0;
    hs_rng_seed(&rng, 11);
    for (uint32_t round = 0; round < 3000; round++) {
        struct lm_radar table = lm_radar_default, radar;
        const struct lm_radar_field *f = lm_radar_field(hs_rng_below(&rng, 78));
        for (uint32_t i = 0; i < lm_radar_field_count(&table, f); i++) {
            const uint64_t span = (uint64_t)(f->max - f->min) + 1;
            lm_radar_field_set(&table, f, i, f->min + (int64_t)(hs_rng_u64(&rng) % span));
        }
        if (lm_radar_check(&table, NULL) == 0) {
            print_to(path, &table);
            assert_int_equal(radar_text_read(&radar, path), 0);
            expect_same(&radar, &table);
            tried++;
        }
    }
    assert_true(tried > 1000);
}

/* The whole of a file; the caller frees it. */
static char *text_of(const char *path)
{
    char *text = NULL;
    size_t capacity = 0;
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    (void)getdelim(&text, &capacity, '\0', file);
    fclose(file);
    return text;
}

/* The default table as text, with the line of `field` replaced by `line`, or without it if NULL. */
static void write_with(const char *path, const char *field, const char *line)
{
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size), *file = fopen(path, "w");
    assert_true(stream && file);
    radar_text_print(stream, &lm_radar_default);
    fclose(stream);
    bool is_found = false;
    for (char *rest = text, *next; (next = strsep(&rest, "\n")) != NULL;) {
        const size_t length = strlen(field);
        if (length > 0 && strncmp(next, field, length) == 0 && next[length] == ' ') {
            is_found = true;
            fprintf(file, "%s\n", line ? line : "");
        } else {
            fprintf(file, "%s\n", next);
        }
    }
    if (*field == '\0') {
        fprintf(file, "%s\n", line);
    } else {
        assert_true(is_found);
    }
    fclose(file);
    free(text);
}

TEST(what_is_wrong_is_refused_with_file_line_field_and_remedy)
{
    static const struct {
        const char *field, *line, *says;
    } cases[] = {
        {"antenna.fan", NULL, "lacks the field antenna.fan"},
        {"antenna.fan", "antenna.fan = 61 deg", ":27: antenna.fan: 61 is not 0 to 60 deg"},
        {"antenna.fan", "antenna.fan = -1 deg", "antenna.fan: -1 is not 0 to 60 deg"},
        {"antenna.fan", "antenna.fan = nan deg", "antenna.fan: 'nan' is no number"},
        {"antenna.fan", "antenna.fan = 1e400 deg", "antenna.fan: '1e400' is no number"},
        {"antenna.fan", "antenna.fan = 30", "wants the unit deg"},
        {"antenna.fan", "antenna.fan = 30 rad", "wants the unit deg"},
        {"antenna.fan", "antenna.fan = 30, 30 deg", "has 2 values and needs 1"},
        {"antenna.fan", "antenna.fan = deg", "antenna.fan: wants the unit deg"},
        {"antenna.fan", "antenna.fan 30 deg", "is no 'field = numbers unit'"},
        {"antenna.fan", "antenna.fann = 30 deg", "antenna.fann is no field"},
        {"", "antenna.fan = 30 deg", "antenna.fan stands in line 27, too"},
        {"cells", "cells = 256 m", "cells: has no unit"},
        {"cells", "cells = 256.5", "cells: 256.5 is not a whole number"},
        {"sensor", "sensor = ir", "sensor: 'ir' is no band of a radar"},
        {"sensor", "sensor = s", "sensor: 's' is no band of a radar"},
        {"name", "name = EIGHT888", "name: 'EIGHT888' has not 1 to 7 characters"},
        {"name", "name = A,B", "name: has 2 values and needs 1"},
        {"name", "name = A_B", "name, value 1: must be 1 to 7 letters"},
        {"mode.name", "mode.name = GM, GM, SEA", "mode.name, value 2: must be"},
        {"range.stc_end_m", "range.stc_end_m = 1, 2, 3 m", "has 3 values and needs 4"},
        {"range.range_m", "range.range_m = 2e4, 4e4, 6e4, 8e4, 9e4, 1e5, 11e4, 12e4, 13e4 m",
         "a radar has up to 8 scales"},
        {"range.range_m", "range.range_m = 18520, 18520, 74080, 148160 m",
         ":8: range.range_m, value 2: must be each scale longer"},
        {"sample", "sample = 1 deg", "sample, value 1: must be 1/4 to 2/7 of antenna.azimuth_beam"},
        {"mode.gate_mm_s[1]", "mode.gate_mm_s[1] = 0, 1, 0 mm/s", "mode.gate_mm_s[1], value 2"},
        {"mode.tone.white_db", "mode.tone.white_db = 6, 0, -48 dB",
         "mode.tone.white_db, value 3: must be 1 dB or more above black"},
        {"fov[EXP..].window_permille", "fov[EXP..].window_permille = 5, 5, 5 permille", NULL},
    };
    const char *path = path_of("wrong");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        char log[600];
        write_with(path, cases[i].field, cases[i].line);
        const int code = support_run("%s/bin/landmass-radar check %s >/dev/null 2>%s-log",
                                     support_build_dir(), path, path);
        snprintf(log, sizeof log, "%s-log", path);
        char *text = text_of(log);
        assert_int_equal(code, cases[i].says ? 1 : 0);
        if (cases[i].says && !(text && strstr(text, cases[i].says))) {
            fail_msg("'%s' does not say '%s'", text, cases[i].says);
        }
        free(text);
    }
}
