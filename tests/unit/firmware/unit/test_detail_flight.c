/* Detail in flight: a patch over a tile that has some shows it, and does not wait for it for ever.
 */
#include "check.h"
#include "fx/crc32c.h"
#include "hs/angle.h"
#include "lm/image.h"
#include "unit_rig.h"

#include <stdlib.h>
#include <string.h>

enum { UNITS = 2, RECORD_BYTES = UNITS * LM_DETAIL_UNIT_BYTES };

/* 46.02 N 11.02 E: hills and houses of the map, without water. */
static struct lm_position centre(void)
{
    return (struct lm_position){hs_bam(46.02), hs_bam(11.02)};
}

/* A hall of 100 m in the tile that holds the centre, or nothing but that the tile has detail. */
static void add_detail(struct rig *r, bool has_hall)
{
    struct lm_db db;
    struct lm_tile_entry entry;
    union {
        struct lm_detail detail;
        uint8_t bytes[RECORD_BYTES];
    } *record = calloc(1, sizeof *record);
    assert_int_equal(lm_db_open(&db, &r->board.flash.port, 1000), LM_OK);
    const uint32_t side_log2 = (uint32_t)db.shift0 + LM_TILE_CELLS_LOG2;
    const fx_bam_t north = centre().latitude + FX_BAM_90, east = centre().longitude;
    struct lm_detail *d = &record->detail;
    d->row = north >> side_log2;
    d->column = east >> side_log2;
    d->count = has_hall;
    d->items[0] = (struct lm_detail_item){.kind = LM_DETAIL_BLOCK,
                                          .class_number = TINY_STRUCTURE,
                                          .gamma_code = 255,
                                          .north = (uint16_t)(north >> (side_log2 - 16)),
                                          .east = (uint16_t)(east >> (side_log2 - 16)),
                                          .length_dm = 1000,
                                          .width_dm = 1000,
                                          .height_dm = 150};
    d->crc = fx_crc32c(0, record->bytes + 4, RECORD_BYTES - 4);
    const uint32_t number = (uint32_t)lm_db_entry(&db, 0, d->row, d->column);
    assert_int_equal(tiny_image_add_section(&r->image, LM_IMAGE_DETAIL, record, RECORD_BYTES), 0);
    uint8_t *at = r->image.bytes + lm_db_entry_offset(&db, number);
    memcpy(&entry, at, sizeof entry);
    entry.detail_place = 0;
    entry.detail_size = UNITS;
    memcpy(at, &entry, sizeof entry);
    tiny_image_seal(&r->image);
    memory_flash_open(&r->board.flash, r->image.bytes, r->image.size);
    free(record);
}

static struct lm_control patch_of(uint32_t cell_mm)
{
    return (struct lm_control){.kind = LM_CONTROL_SAR,
                               .sar = {.centre = centre(),
                                       .cell_mm = cell_mm,
                                       .look_azimuth = FX_BAM_DEG(45),
                                       .range_m = 20000,
                                       .height_m_q6 = 3000 * 64}};
}

enum content { MAP_ALONE, EMPTY, HALL };

static struct rig *start(enum content content)
{
    struct rig *r = make_rig();
    if (content != MAP_ALONE) {
        add_detail(r, content == HALL);
    }
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 0.5);
    return r;
}

static void fly_patch(struct rig *r, uint32_t cell_mm)
{
    command(r, patch_of(cell_mm));
    run(r, 6);
    assert_int_equal(r->unit.page.picture, LM_PICTURE_PATCH);
    assert_int_equal(r->unit.picture.sar.line, r->unit.picture.sar.lines);
}

/* Pixels of the patch as bright as the glass can be. */
static uint32_t brightest(const struct rig *r)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        count += r->plane[i] >= 250;
    }
    return count;
}

TEST(a_patch_shows_what_stands_in_its_tiles_instead_of_the_map_s_structures)
{
    uint32_t bright[3];
    for (enum content content = MAP_ALONE; content <= HALL; content++) {
        struct rig *r = start(content);
        const struct lm_sar *s = &r->unit.picture.sar;
        fly_patch(r, 3000);
        assert_int_equal(s->detail_state,
                         content == MAP_ALONE ? LM_SAR_DETAIL_NONE : LM_SAR_DETAIL_READY);
        if (content != MAP_ALONE) {
            assert_int_equal(s->detail.tile_count, 1);
            assert_int_equal(s->detail.shape_count, content == HALL);
        }
        bright[content] = brightest(r);
        free_rig(r);
    }
    print_message("# bright pixels: map %u, without its houses %u, with the hall %u\n", bright[0],
                  bright[1], bright[2]);
    assert_true(bright[EMPTY] < bright[MAP_ALONE]);
    assert_true(bright[HALL] > bright[EMPTY] + 100);
}

TEST(a_patch_no_finer_than_the_map_takes_its_cells)
{
    struct rig *r = start(HALL);
    const struct lm_db *db = &r->unit.map.db;
    fly_patch(r, 9000);
    assert_int_equal(r->unit.picture.sar.detail_state, LM_SAR_DETAIL_READY);
    assert_true(lm_db_cell_mm(db, db->finest) > 9000);
    free_rig(r);
}

/* The flash hangs when the tiles of the patch are there and the record is still to be read. */
TEST(a_patch_does_not_wait_for_detail_for_ever)
{
    struct rig *r = start(HALL);
    const struct lm_picture *p = &r->unit.picture;
    command(r, patch_of(3000));
    for (int i = 0; i < 5000 && p->sar.detail_state != LM_SAR_DETAIL_LOADING; i++) {
        run(r, STEP_US * 1e-6);
    }
    assert_int_equal(p->sar.detail_state, LM_SAR_DETAIL_LOADING);
    r->board.flash.busy_polls = UINT32_MAX;
    run(r, 10);
    assert_int_equal(p->sar.detail_state, LM_SAR_DETAIL_READY);
    assert_int_equal(p->sar.line, p->sar.lines);
    free_rig(r);
}
