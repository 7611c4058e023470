/* Which radar table the unit uses, and which images it then refuses. */
#include "check.h"
#include "failing_reads.h"
#include "glass_text.h"
#include "lm/bit.h"
#include "lm/image.h"
#include "lm/radar_record.h"
#include "unit_rig.h"

#include <string.h>

enum { ROW_DATABASE = 1, ROW_RADAR = 15, SENSOR_AT = 61 };

/* The default table with another name, band and shortest scale. */
static struct lm_radar other_radar(const char *name, uint8_t sensor)
{
    struct lm_radar radar = lm_radar_default;
    strcpy(radar.name, name);
    radar.sensor = sensor;
    radar.range[0].range_m = 9260;
    radar.range[0].range_nm = 5;
    return radar;
}

/* A rig whose image says its sensor and carries a table, unless that is NULL. */
static struct rig *rig_of(uint8_t sensor, const struct lm_radar *table)
{
    struct rig *r = make_rig();
    r->board.lent.radar = NULL;
    r->image.bytes[SENSOR_AT] = sensor;
    tiny_image_seal(&r->image);
    if (table) {
        uint8_t record[LM_RADAR_RECORD_BYTES];
        lm_radar_pack(table, record);
        assert_int_equal(tiny_image_add_section(&r->image, LM_IMAGE_RADAR, record, sizeof record),
                         0);
        memory_flash_open(&r->board.flash, r->image.bytes, r->image.size);
    }
    return r;
}

static void start(struct rig *r)
{
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
}

static void expect_row(const struct rig *r, uint32_t row, const char *words)
{
    assert_string_equal(lm_bit_row(&r->unit, row).words, words);
}

TEST(an_image_without_a_table_is_seen_by_the_built_in_radar)
{
    struct rig *r = rig_of(LM_SENSOR_X, NULL);
    start(r);
    assert_true(r->unit.map.is_usable && r->unit.map.radar == &lm_radar_default);
    expect_row(r, ROW_RADAR, "DTL LOST 0        RADAR    X");
    free_rig(r);
}

TEST(the_image_s_table_is_used_and_named)
{
    const struct lm_radar ku = other_radar("KU-1", LM_SENSOR_KU);
    struct rig *r = rig_of(LM_SENSOR_KU, &ku);
    start(r);
    assert_true(r->unit.map.is_usable);
    expect_row(r, ROW_RADAR, "DTL LOST 0        IMG RDR  KU-1");
    command(r, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 5});
    run(r, 2);
    assert_int_equal(r->unit.picture.sector.command.range_index, 0);
    assert_int_equal(r->unit.count.commands_refused, 0);
    assert_true(lit_pixels(r) > 1000);
    assert_int_equal(r->unit.flags & LM_FLAG_DB, 0);
    free_rig(r);
}

TEST(the_board_s_table_wins_over_the_image_s)
{
    const struct lm_radar board = other_radar("OURS", LM_SENSOR_KU);
    const struct lm_radar image = other_radar("THEIRS", LM_SENSOR_KU);
    struct rig *r = rig_of(LM_SENSOR_KU, &image);
    r->board.lent.radar = &board;
    start(r);
    assert_true(r->unit.map.is_usable && r->unit.map.radar == &board);
    expect_row(r, ROW_RADAR, "DTL LOST 0        BRD RDR  OURS");
    free_rig(r);
}

TEST(an_image_of_another_band_is_refused_and_both_are_named)
{
    static const struct {
        uint8_t sensor;
        const char *words;
    } images[] = {{LM_SENSOR_KU, "IMAGE KU  RADAR X"},
                  {LM_SENSOR_KA, "IMAGE KA  RADAR X"},
                  {LM_SENSOR_MMW, "IMAGE MMW  RADAR X"},
                  {LM_SENSOR_IR, "IMAGE IR  RADAR X"}};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) {
        struct rig *r = rig_of(images[i].sensor, NULL);
        char row[40] = "DB ";
        start(r);
        run(r, 1);
        assert_false(r->unit.map.is_usable);
        assert_int_equal(r->unit.map.open_status, LM_ERR_SENSOR);
        assert_int_equal(lit_pixels(r), 0);
        expect_row(r, ROW_DATABASE, strcat(row, images[i].words));
        free_rig(r);
    }
}

static bool warns(const struct rig *r, const char *words)
{
    const struct lm_surface glass = glass_of(r);
    return glass_find(&glass, words, r->unit.palette.warning, r->unit.palette.ink, NULL);
}

TEST(the_glass_says_db_fail_and_why)
{
    struct rig *r = rig_of(LM_SENSOR_KU, NULL);
    start(r);
    run(r, 1);
    assert_true(warns(r, "DB FAIL") && warns(r, "IMAGE KU  RADAR X"));
    free_rig(r);
}

TEST(the_board_s_radar_of_another_band_refuses_the_image_too)
{
    const struct lm_radar ka = other_radar("KA", LM_SENSOR_KA);
    struct rig *r = rig_of(LM_SENSOR_X, NULL);
    r->board.lent.radar = &ka;
    start(r);
    assert_int_equal(r->unit.map.open_status, LM_ERR_SENSOR);
    expect_row(r, ROW_DATABASE, "DB IMAGE X  RADAR KA");
    free_rig(r);
}

TEST(an_unknown_sensor_is_refused_as_another_version)
{
    struct rig *r = rig_of(LM_SENSORS, NULL);
    start(r);
    assert_int_equal(r->unit.map.open_status, LM_ERR_VERSION);
    free_rig(r);
}

TEST(an_image_whose_table_is_damaged_is_refused_unless_the_board_has_one)
{
    struct lm_radar ku = other_radar("KU", LM_SENSOR_KU);
    for (int kind = 0; kind < 3; kind++) {
        static const int status[] = {LM_ERR_CORRUPT, LM_ERR_VERSION, LM_ERR_TABLE};
        ku.mode[LM_SECTOR_GM].bars = kind == 2 ? 0 : 1;
        struct rig *r = rig_of(LM_SENSOR_KU, &ku);
        uint8_t *record = r->image.bytes + r->image.size - LM_RADAR_RECORD_BYTES;
        record[kind == 0 ? 100 : 4] ^= kind != 2;
        start(r);
        assert_int_equal(r->unit.map.open_status, status[kind]);
        assert_true(r->unit.map.radar == &lm_radar_default);
        ku.mode[LM_SECTOR_GM].bars = 1;
        r->board.lent.radar = &ku;
        start(r);
        assert_int_equal(r->unit.map.open_status, LM_OK);
        free_rig(r);
    }
}

static void expect_table_with_map(const struct rig *r)
{
    assert_int_equal(r->unit.map.radar_origin,
                     r->unit.map.is_usable ? LM_RADAR_OF_IMAGE : LM_RADAR_BUILT_IN);
}

TEST(a_table_that_the_flash_does_not_give_is_no_table)
{
    const struct lm_radar ku = other_radar("KU", LM_SENSOR_KU);
    struct rig *r = rig_of(LM_SENSOR_KU, &ku);
    start_with_failing_reads(r, expect_table_with_map);
    for (uint32_t every = 1; every < 8; every++) {
        r->board.flash.fail_every = every;
        start(r);
        assert_true(r->unit.map.radar_origin != LM_RADAR_OF_IMAGE || r->unit.map.is_usable);
    }
    free_rig(r);
}
