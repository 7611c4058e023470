/* The radar record: what is packed comes back, docs/FORMATS.md says where each byte lies, and bytes
 * of any kind give a sound table or none. */
#include "check.h"
#include "fx/crc32c.h"
#include "hs/rng.h"
#include "lm/radar_check.h"
#include "lm/radar_record.h"
#include "lm/status.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void seal(uint8_t *record)
{
    const uint32_t crc = fx_crc32c(0, record + 4, LM_RADAR_RECORD_BYTES - 4);
    memcpy(record, &crc, sizeof crc);
}

static void expect_same(const struct lm_radar *a, const struct lm_radar *b)
{
    assert_string_equal(a->name, b->name);
    for (uint32_t i = 0; i < LM_SECTOR_MODES; i++) {
        assert_memory_equal(a->mode[i].name, b->mode[i].name, LM_NAME_SIZE);
    }
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        assert_memory_equal(a->fov[i].name, b->fov[i].name, LM_NAME_SIZE);
    }
    for (uint32_t n = 0; lm_radar_field(n); n++) {
        const struct lm_radar_field *f = lm_radar_field(n);
        for (uint32_t i = 0; i < f->count; i++) {
            assert_int_equal(lm_radar_field_value(a, f, i), lm_radar_field_value(b, f, i));
        }
    }
}

TEST(the_default_table_comes_back_from_its_record)
{
    uint8_t record[LM_RADAR_RECORD_BYTES];
    struct lm_radar radar;
    lm_radar_pack(&lm_radar_default, record);
    assert_int_equal(lm_radar_unpack(&radar, record, sizeof record), LM_OK);
    expect_same(&radar, &lm_radar_default);
}

/* Every element lies where the page says: numbers are set one by one and looked for there. */
TEST(each_number_lies_where_formats_md_says)
{
    uint32_t at = 58;
    FILE *page = fopen("docs/FORMATS.md", "r");
    assert_non_null(page);
    char *text = NULL;
    size_t capacity = 0;
    assert_true(getdelim(&text, &capacity, '\0', page) > 0);
    fclose(page);
    for (uint32_t n = 0; lm_radar_field(n); n++) {
        const struct lm_radar_field *f = lm_radar_field(n);
        char row[160], many[16] = "";
        if (f->count > 1) {
            snprintf(many, sizeof many, "[%u]", f->count);
        }
        snprintf(row, sizeof row, "| %u | %c%u%s | `%s` |", at, f->is_signed ? 'i' : 'u',
                 8u * f->size, many, f->name);
        if (!strstr(text, row)) {
            fail_msg("docs/FORMATS.md, 1.12, lacks the row %s", row);
        }
        for (uint32_t i = 0; i < f->count; i++, at += f->size) {
            uint8_t record[LM_RADAR_RECORD_BYTES];
            struct lm_radar radar;
            uint64_t stored = 0;
            memset(&radar, 0, sizeof radar);
            lm_radar_field_set(&radar, f, i, -1);
            lm_radar_pack(&radar, record);
            for (uint32_t k = 58; k < sizeof record; k++) {
                assert_int_equal(record[k], k >= at && k < at + f->size ? 255 : 0);
            }
            memcpy(&stored, record + at, f->size);
            assert_true(stored == UINT64_MAX >> (64 - 8 * f->size));
        }
    }
    assert_int_equal(at, LM_RADAR_RECORD_BYTES);
    free(text);
}

TEST(every_flipped_bit_of_a_record_is_refused)
{
    uint8_t record[LM_RADAR_RECORD_BYTES];
    struct lm_radar radar;
    lm_radar_pack(&lm_radar_default, record);
    for (size_t bit = 0; bit < 8 * sizeof record; bit++) {
        record[bit / 8] = (uint8_t)(record[bit / 8] ^ 1u << bit % 8);
        const int status = lm_radar_unpack(&radar, record, sizeof record);
        const bool is_version = bit / 8 == 4 || bit / 8 == 5;
        assert_int_equal(status, is_version ? LM_ERR_VERSION : LM_ERR_CORRUPT);
        record[bit / 8] = (uint8_t)(record[bit / 8] ^ 1u << bit % 8);
    }
}

TEST(a_record_of_another_length_is_refused)
{
    uint8_t record[2 * LM_RADAR_RECORD_BYTES] = {0};
    struct lm_radar radar;
    lm_radar_pack(&lm_radar_default, record);
    for (uint32_t bytes = 0; bytes <= sizeof record; bytes++) {
        if (bytes != LM_RADAR_RECORD_BYTES) {
            assert_int_equal(lm_radar_unpack(&radar, record, bytes), LM_ERR_CORRUPT);
        }
    }
}

/* The checksum fits; only the contract stands in the way. */
TEST(a_hostile_record_gives_a_table_that_keeps_its_contract_or_none)
{
    struct hs_rng rng;
    uint32_t accepted = 0, refused = 0;
    hs_rng_seed(&rng, 3);
    for (uint32_t round = 0; round < 20000; round++) {
        uint8_t record[LM_RADAR_RECORD_BYTES];
        struct lm_radar radar;
        lm_radar_pack(&lm_radar_default, record);
        for (uint32_t n = hs_rng_below(&rng, 3) + 1; n > 0; n--) {
            record[8 + hs_rng_below(&rng, sizeof record - 8)] = (uint8_t)hs_rng_below(&rng, 256);
        }
        seal(record);
        const int status = lm_radar_unpack(&radar, record, sizeof record);
        assert_true(status == LM_OK || status == LM_ERR_TABLE);
        assert_int_equal(lm_radar_check(&radar, NULL), status);
        accepted += status == LM_OK;
        refused += status != LM_OK;
    }
    assert_true(accepted > 1000 && refused > 1000);
}

/* Which name a unit goes by: a field whose name ends in one must say so, for tools that print it.
 */
TEST(each_field_has_the_unit_that_its_name_says)
{
    static const struct {
        const char *ending;
        enum lm_radar_unit unit;
    } endings[] = {{"_db_q8", LM_RADAR_DB_Q8},
                   {"_db_per_km_q16", LM_RADAR_DB_PER_KM_Q16},
                   {"bam_per_s", LM_RADAR_BAM_PER_S},
                   {"gamma_q8", LM_RADAR_Q8},
                   {"_mm_s", LM_RADAR_MM_S},
                   {"_m", LM_RADAR_M},
                   {"_nm", LM_RADAR_NMI},
                   {"_mm", LM_RADAR_MM},
                   {"_um", LM_RADAR_UM},
                   {"_ns", LM_RADAR_NS},
                   {"_ms", LM_RADAR_MS},
                   {"_permille", LM_RADAR_PERMILLE},
                   {"_percent", LM_RADAR_PERCENT},
                   {"sensor", LM_RADAR_WORD}};
    for (uint32_t n = 0; lm_radar_field(n); n++) {
        const struct lm_radar_field *f = lm_radar_field(n);
        char name[64];
        snprintf(name, sizeof name, "%s", f->name);
        if (name[strlen(name) - 1] == ']') {
            *strrchr(name, '[') = '\0';
        }
        /* Angles have no ending: they alone of the fields without one take four bytes. */
        enum lm_radar_unit unit = f->size == 4 ? LM_RADAR_BAM : LM_RADAR_NUMBER;
        for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
            const size_t length = strlen(endings[i].ending);
            if (strlen(name) >= length &&
                strcmp(name + strlen(name) - length, endings[i].ending) == 0) {
                unit = endings[i].unit;
                break;
            }
        }
        if (f->unit != unit) {
            fail_msg("%s has not the unit of its name", f->name);
        }
    }
}

TEST(a_record_too_short_for_a_version_is_corrupt_whatever_lies_behind_it)
{
    uint8_t record[LM_RADAR_RECORD_BYTES];
    struct lm_radar radar;
    memset(record, 255, sizeof record);
    for (uint32_t bytes = 0; bytes < 8; bytes++) {
        assert_int_equal(lm_radar_unpack(&radar, record, bytes), LM_ERR_CORRUPT);
    }
    assert_int_equal(lm_radar_unpack(&radar, record, 8), LM_ERR_VERSION);
}
