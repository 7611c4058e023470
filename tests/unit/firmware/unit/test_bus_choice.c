/* Which table of the bus the unit hears, and what it does with a damaged one. */
#include "check.h"
#include "failing_reads.h"
#include "fx/crc32c.h"
#include "height_rows.h"
#include "lm/bit.h"
#include "lm/bus_filters.h"
#include "lm/bus_record.h"
#include "lm/image.h"
#include "unit_rig.h"

#include <string.h>

static const struct lm_bus_profile ours = {.name = "ours", .rows = height_rows, .row_count = 1};

/* A rig whose image carries that table, with one byte of it changed by `flip` and sealed again. */
static struct rig *rig_with_table(uint32_t at, uint8_t flip, bool is_sealed)
{
    struct rig *r = make_rig();
    uint8_t record[LM_BUS_RECORD_BYTES_MAX];
    const uint32_t bytes = lm_bus_pack(&ours, record);
    record[at] ^= flip;
    if (is_sealed) {
        const uint32_t crc = fx_crc32c(0, record + 4, bytes - 4);
        memcpy(record, &crc, sizeof crc);
    }
    r->board.lent.bus_profile = NULL;
    assert_int_equal(tiny_image_add_section(&r->image, LM_IMAGE_BUS, record, bytes), 0);
    memory_flash_open(&r->board.flash, r->image.bytes, r->image.size);
    return r;
}

static void start(struct rig *r)
{
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
}

TEST(an_image_without_a_table_is_flown_on_canaerospace)
{
    struct rig *r = make_rig();
    r->board.lent.bus_profile = NULL;
    start(r);
    assert_ptr_equal(r->unit.bus.profile, &lm_bus_canas17);
    assert_null(r->unit.map.bus);
    free_rig(r);
}

TEST(the_image_s_table_is_heard)
{
    struct rig *r = rig_with_table(0, 0, true);
    start(r);
    assert_true(r->unit.map.is_usable);
    assert_string_equal(r->unit.bus.profile->name, "ours");
    const struct lm_can_frame frame = {
        .id = 700, .length = 8, .data = {1, LM_CANAS_FLOAT, 0, 0, 0x44, 0x7a}}; /* 1000 m */
    struct lm_bus_event events[LM_BUS_EVENTS];
    assert_int_equal(lm_bus_take(&r->unit.bus, &frame, events), 1);
    assert_int_equal(events[0].field, LM_BUS_TRUE_ALTITUDE);
    assert_int_equal(events[0].value, 1000 * 64);
    free_rig(r);
}

TEST(the_board_s_table_wins_over_the_image_s_even_where_that_is_damaged)
{
    struct rig *r = rig_with_table(50, 1, false);
    r->board.lent.bus_profile = &lm_bus_xcsoar;
    start(r);
    assert_true(r->unit.map.is_usable);
    assert_ptr_equal(r->unit.bus.profile, &lm_bus_xcsoar);
    free_rig(r);
}

/* One frame that waits. */
static int give_once(void *ctx, struct lm_can_frame *frame)
{
    struct lm_can_frame *waiting = ctx;
    const bool is_there = waiting->length != 0;
    *frame = *waiting;
    waiting->length = 0;
    return is_there;
}

TEST(each_table_hears_its_own_interface)
{
    struct rig *r = make_rig();
    struct lm_can_frame first = {.id = 700, .length = 8, .data = {1, LM_CANAS_FLOAT}};
    struct lm_can_frame second = first;
    const struct lm_can can = {.ctx = &first, .receive = give_once},
                        can_2 = {.ctx = &second, .receive = give_once};
    r->board.lent.bus_profile = &lm_bus_canas17;
    r->board.lent.can = &can;
    r->board.lent.can_2 = &can_2;
    r->board.lent.tables[0] = (struct lm_board_table){&ours, 1};
    start(r);
    lm_unit_step(&r->unit, 1000);
    assert_int_equal(r->unit.bus.count.outcome[LM_BUS_UNUSED], 1);
    assert_int_equal(r->unit.more[0].count.outcome[LM_BUS_VALUE], 1);
    assert_int_equal(r->unit.count.bus_frames, 2);
    /* Its rank lies behind all of the first table's. */
    assert_int_equal(r->unit.nav.item[LM_BUS_TRUE_ALTITUDE][0].rank, 64 << 8);
    free_rig(r);
}

/* As many as a board may have, the last one among them; priorities follow in their order. What
 * stands behind the tables, a list of all nodes, is no table. */
TEST(each_of_three_further_tables_is_heard)
{
    static uint8_t everybody[4 * LM_BUS_NODE_BYTES];
    static struct lm_bus_row row[LM_BUS_TABLES_MORE];
    static struct lm_bus_profile table[LM_BUS_TABLES_MORE];
    struct rig *r = make_rig();
    struct lm_can_frame frame = {.length = 0};
    const struct lm_can can = {.ctx = &frame, .receive = give_once};
    r->board.lent.can = &can;
    memset(everybody, 0xff, sizeof everybody);
    r->board.lent.bus_nodes = everybody;
    for (uint32_t t = 0; t < LM_BUS_TABLES_MORE; t++) {
        row[t] = height_rows[0];
        row[t].id += t;
        row[t].priority = 200; /* counts as 63 */
        table[t] = (struct lm_bus_profile){.name = "more", .rows = &row[t], .row_count = 1};
        r->board.lent.tables[t] = (struct lm_board_table){&table[t], 0};
    }
    start(r);
    for (uint32_t t = 0; t < LM_BUS_TABLES_MORE; t++) {
        frame = (struct lm_can_frame){
            .id = 700 + t, .length = 8, .data = {1, LM_CANAS_FLOAT, 0, 0, 0x44, 0x7a}};
        lm_unit_step(&r->unit, 1000 * (t + 1));
        assert_int_equal(r->unit.more[t].count.outcome[LM_BUS_VALUE], 1);
        assert_int_equal(r->unit.nav.item[LM_BUS_TRUE_ALTITUDE][t].rank, ((t + 1) * 64 + 63) << 8);
    }
    free_rig(r);
}

TEST(a_second_interface_that_falls_silent_is_flagged)
{
    struct rig *r = make_rig();
    struct lm_can_frame second = {.id = 5, .length = 1};
    const struct lm_can can_2 = {.ctx = &second, .receive = give_once};
    r->board.lent.can_2 = &can_2;
    start(r);
    for (uint64_t now_us = 0; now_us < 3000000; now_us += 100000) {
        struct lm_can_frame first = {.id = 5, .length = 1};
        const struct lm_can can = {.ctx = &first, .receive = give_once};
        second.length = now_us < 1500000;
        r->board.lent.can = &can;
        lm_unit_step(&r->unit, now_us);
        const bool is_silent = now_us > 1400000 + LM_BUS_SILENT_US;
        assert_int_equal((r->unit.flags & LM_FLAG_BUS) != 0, is_silent);
    }
    free_rig(r);
}

TEST(profiles_that_take_one_frame_clash_and_others_do_not)
{
    static const struct lm_bus_row far[] = {{.id = 701, .packing.mask = 0x1fffffff}};
    static const struct lm_bus_row channel[] = {{.id = 0x102bc, .packing.mask = 0x1fffffff}};
    static const struct lm_bus_profile packed[] = {
        {.name = "far", .rows = far, .row_count = 1, .framing = LM_BUS_PACKED},
        {.name = "channel 1 of 700", .rows = channel, .row_count = 1, .framing = LM_BUS_PACKED}};
    uint32_t id = 0;
    assert_true(lm_bus_profiles_clash(&lm_bus_canas17, &lm_bus_xcsoar, &id));
    assert_int_equal(id, 1036);
    assert_true(lm_bus_profiles_clash(&ours, &ours, NULL));
    assert_false(lm_bus_profiles_clash(&lm_bus_canas17, &ours, &id));
    assert_false(lm_bus_profiles_clash(&lm_bus_canas17, &lm_bus_generic, &id));
    assert_false(lm_bus_profiles_clash(&ours, &packed[0], &id));
    assert_true(lm_bus_profiles_clash(&ours, &packed[1], &id));
    assert_true(lm_bus_profiles_clash(&packed[1], &ours, &id));
}

TEST(an_image_whose_table_is_damaged_is_refused)
{
    static const struct {
        uint32_t at;
        bool is_sealed;
        int status;
    } cases[] = {{50, false, LM_ERR_CORRUPT}, {4, true, LM_ERR_VERSION}, {40, true, LM_ERR_TABLE}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct rig *r = rig_with_table(cases[i].at, 2, cases[i].is_sealed);
        start(r);
        assert_false(r->unit.map.is_usable);
        assert_int_equal(r->unit.map.open_status, cases[i].status);
        assert_ptr_equal(r->unit.bus.profile, &lm_bus_canas17);
        run(r, 1);
        assert_int_equal(r->unit.flags & LM_FLAG_DB, LM_FLAG_DB);
        free_rig(r);
    }
}

TEST(a_table_longer_than_any_is_refused)
{
    struct rig *r = make_rig();
    static uint8_t record[LM_BUS_RECORD_BYTES_MAX + 1];
    r->board.lent.bus_profile = NULL;
    assert_int_equal(tiny_image_add_section(&r->image, LM_IMAGE_BUS, record, sizeof record), 0);
    memory_flash_open(&r->board.flash, r->image.bytes, r->image.size);
    start(r);
    assert_int_equal(r->unit.map.open_status, LM_ERR_CORRUPT);
    free_rig(r);
}

/* It is read into the pool of tiles, and not beyond it. */
TEST(a_table_longer_than_the_pool_is_refused)
{
    struct rig *r = rig_with_table(0, 0, true);
    uint8_t *pool = r->board.lent.tile_pool;
    r->board.lent.tile_pool_bytes = 64;
    memset(pool, 0xAA, 256);
    start(r);
    assert_int_equal(r->unit.map.open_status, LM_ERR_CORRUPT);
    assert_ptr_equal(r->unit.bus.profile, &lm_bus_canas17);
    for (int i = 64; i < 256; i++) {
        assert_int_equal(pool[i], 0xAA);
    }
    free_rig(r);
}

static void expect_table_with_map(const struct rig *r)
{
    assert_int_equal(r->unit.map.bus != NULL, r->unit.map.is_usable);
}

TEST(a_table_that_the_flash_does_not_give_is_not_heard)
{
    struct rig *r = rig_with_table(0, 0, true);
    start_with_failing_reads(r, expect_table_with_map);
    for (uint32_t every = 1; every < 8; every++) {
        r->board.flash.fail_every = every;
        start(r);
        assert_true(r->unit.bus.profile == &lm_bus_canas17 || r->unit.map.is_usable);
    }
    free_rig(r);
}
