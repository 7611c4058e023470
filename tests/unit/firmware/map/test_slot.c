/* Which copy of a slot's record counts, and which slot is flown: against a plain statement of the
 * rules of docs/slots.md. */
#include "check.h"
#include "lm/slot.h"

#include <string.h>

static struct lm_slot_record record(uint32_t state, uint64_t generation, uint64_t sequence)
{
    struct lm_slot_record r = {.state = state, .generation = generation, .sequence = sequence};
    lm_slot_seal(&r);
    return r;
}

TEST(the_record_is_that_of_the_document)
{
    /* Bytes 0..59 written by hand; the checksum by a CRC-32C of
     * its own, bit by bit, in Python. */
    struct lm_slot_record r = {.state = LM_SLOT_WHOLE,
                               .generation = 5,
                               .sequence = 0x0102030405060708,
                               .image_bytes = 1112113,
                               .image_crc = 0xA1B2C3D4};
    static const uint8_t wanted[60] = {'L',  'M',  'D', 'B', 'S', 'L', 'O', 'T',  1,    0,    0,
                                       0,    2,    0,   0,   0,   5,   0,   0,    0,    0,    0,
                                       0,    0,    8,   7,   6,   5,   4,   3,    2,    1,    0x31,
                                       0xf8, 0x10, 0,   0,   0,   0,   0,   0xd4, 0xc3, 0xb2, 0xa1};
    lm_slot_seal(&r);
    assert_memory_equal(&r, wanted, sizeof wanted);
    assert_int_equal(r.crc, 0xC2983795);
}

TEST(of_two_copies_the_later_sound_one_counts)
{
    for (uint64_t a = 0; a < 3; a++) {
        for (uint64_t b = 0; b < 3; b++) {
            for (int damaged = 0; damaged < 4; damaged++) {
                struct lm_slot_record copies[LM_SLOT_COPIES] = {record(LM_SLOT_LOADING, a, 1),
                                                                record(LM_SLOT_WHOLE, b, 1)};
                copies[0].crc ^= (uint32_t)(damaged & 1);
                copies[1].crc ^= (uint32_t)(damaged & 2);
                const struct lm_slot_record *wanted = damaged == 3   ? NULL
                                                      : damaged == 1 ? &copies[1]
                                                      : damaged == 2 ? &copies[0]
                                                      : b > a        ? &copies[1]
                                                                     : &copies[0];
                assert_ptr_equal(lm_slot_of(copies), wanted);
            }
        }
    }
}

TEST(one_wrong_bit_makes_a_record_unsound)
{
    for (uint32_t bit = 0; bit < 8 * sizeof(struct lm_slot_record); bit++) {
        struct lm_slot_record copies[LM_SLOT_COPIES] = {record(LM_SLOT_WHOLE, 1, 1),
                                                        record(LM_SLOT_WHOLE, 1, 1)};
        uint8_t *bytes = (uint8_t *)&copies[0];
        copies[1].crc ^= 1;
        assert_ptr_equal(lm_slot_of(copies), &copies[0]);
        bytes[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_null(lm_slot_of(copies));
    }
}

TEST(another_version_or_state_is_no_record)
{
    for (uint32_t word = 0; word < 5; word++) {
        const struct lm_slot_record copies[LM_SLOT_COPIES] = {record(word, 2, 1),
                                                              record(word, 1, 1)};
        assert_int_equal(lm_slot_of(copies) != NULL, word == 1 || word == 2);
    }
    struct lm_slot_record all_ones[LM_SLOT_COPIES];
    memset(all_ones, 0xff, sizeof all_ones); /* flash that was erased */
    assert_null(lm_slot_of(all_ones));
}

TEST(of_two_whole_slots_the_later_load_is_flown)
{
    const struct lm_slot_record early = record(LM_SLOT_WHOLE, 9, 1),
                                late = record(LM_SLOT_WHOLE, 1, UINT64_MAX),
                                loading = record(LM_SLOT_LOADING, 20, 5);
    assert_int_equal(lm_slot_later(&early, &late), 1);
    assert_int_equal(lm_slot_later(&late, &early), 0);
    assert_int_equal(lm_slot_later(&early, &early), 0);
    assert_int_equal(lm_slot_later(&loading, &early), 1);
    assert_int_equal(lm_slot_later(&early, &loading), 0);
    assert_int_equal(lm_slot_later(NULL, &early), 1);
    assert_int_equal(lm_slot_later(&early, NULL), 0);
    assert_int_equal(lm_slot_later(&loading, NULL), -1);
    assert_int_equal(lm_slot_later(NULL, NULL), -1);
}
