/* Targets and signatures of an image: those that cannot be had are counted and told, and none of
 * the others takes their number. */
#include "check.h"
#include "fx/crc32c.h"
#include "lm/bit.h"
#include "lm/image.h"
#include "target_support.h"
#include "unit_rig.h"

#include <stdlib.h>

enum { ROW_LOST = 13, HEAD_BYTES = 64, CHIPS = 4, SIGNATURES = 3 };

static void start_with(struct rig *r, uint32_t type, uint8_t *section, size_t bytes)
{
    const uint32_t crc = fx_crc32c(0, section, HEAD_BYTES - 4);
    memcpy(section + HEAD_BYTES - 4, &crc, sizeof crc);
    assert_int_equal(tiny_image_add_section(&r->image, type, section, bytes), 0);
    memory_flash_open(&r->board.flash, r->image.bytes, r->image.size);
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    assert_true(r->unit.map.is_usable);
}

/* An image of so many targets, of which number 3 is damaged. */
static struct rig *rig_with_targets(uint32_t count)
{
    struct rig *r = make_rig();
    const size_t bytes = HEAD_BYTES + count * LM_TARGET_BYTES;
    uint8_t *section = calloc(1, bytes);
    assert_non_null(section);
    const uint32_t head[2] = {count, LM_TARGET_BYTES};
    memcpy(section, head, sizeof head);
    for (uint32_t i = 0; i < count; i++) {
        struct lm_target t = point_at(46, 11, 100, 20);
        t.id = i;
        seal_target(&t);
        t.crc ^= i == 3;
        memcpy(section + HEAD_BYTES + i * LM_TARGET_BYTES, &t, sizeof t);
    }
    start_with(r, LM_IMAGE_TARGETS, section, bytes);
    free(section);
    return r;
}

static void expect_targets(uint32_t count, uint32_t kept, const char *row)
{
    struct rig *r = rig_with_targets(count);
    const struct lm_target_set *set = &r->unit.map.target_set;
    assert_int_equal(set->count, kept);
    for (uint32_t i = 0; i < kept; i++) {
        assert_int_equal(set->items[i].id, i < 3 ? i : i + 1);
    }
    assert_string_equal(lm_bit_row(&r->unit, ROW_LOST).words, row);
    free_rig(r);
}

TEST(a_damaged_target_is_left_out_and_told)
{
    expect_targets(5, 4, "TGT LOST 1        SIG LOST 0");
    expect_targets(LM_TARGETS_MAX + 1, LM_TARGETS_MAX, "TGT LOST 1        SIG LOST 0");
}

TEST(targets_beyond_what_a_display_keeps_are_told)
{
    expect_targets(LM_TARGETS_MAX + 3, LM_TARGETS_MAX, "TGT LOST 3        SIG LOST 0");
}

static struct lm_signature signature(uint32_t height_mm)
{
    struct lm_signature s = {.name = "box",
                             .aspects = CHIPS,
                             .depressions = 1,
                             .origin_row = 8,
                             .pixel_mm = 500,
                             .height_mm = height_mm,
                             .depression = {hs_bam(10)}};
    s.crc = fx_crc32c(0, (const uint8_t *)&s + 4, sizeof s - 4);
    return s;
}

/* Target 1 is of signature 1, which is damaged; target 2 of signature 2. */
TEST(a_damaged_signature_leaves_the_numbers_of_the_others)
{
    struct rig *r = make_rig();
    const size_t bytes = HEAD_BYTES + SIGNATURES * LM_SIGNATURE_BYTES + CHIPS * LM_CHIP_BYTES;
    uint8_t *section = calloc(1, bytes);
    assert_non_null(section);
    const uint32_t head[4] = {SIGNATURES, LM_SIGNATURE_BYTES, CHIPS, LM_CHIP_BYTES};
    memcpy(section, head, sizeof head);
    for (uint32_t i = 0; i < SIGNATURES; i++) {
        struct lm_signature s = signature(3000 + i);
        s.crc ^= i == 1;
        memcpy(section + HEAD_BYTES + i * LM_SIGNATURE_BYTES, &s, sizeof s);
    }
    start_with(r, LM_IMAGE_SIGNATURES, section, bytes);
    free(section);
    const struct lm_target_set *set = &r->unit.map.target_set;
    assert_int_equal(set->signature_count, SIGNATURES);
    for (uint8_t i = 0; i < SIGNATURES; i++) {
        const struct lm_target_body body = {.signature = i, .flags = LM_TARGET_HAS_SIGNATURE};
        const struct lm_signature *s = lm_target_signature(set, &body);
        assert_int_equal(s == NULL, i == 1);
        assert_true(s == NULL || s->height_mm == 3000u + i);
    }
    assert_string_equal(lm_bit_row(&r->unit, ROW_LOST).words, "TGT LOST 0        SIG LOST 1");
    free_rig(r);
}
