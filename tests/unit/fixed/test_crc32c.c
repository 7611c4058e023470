/* CRC-32C against the published examples of RFC 3720, appendix B.4, and its own definition. */
#include "check.h"
#include "fx/crc32c.h"
#include "hs/rng.h"

#include <string.h>

TEST(the_check_value_of_the_polynomial_is_met)
{
    assert_int_equal(fx_crc32c(0, "123456789", 9), 0xe3069283u);
    assert_int_equal(fx_crc32c(0, "", 0), 0);
}

/* The RFC prints the bytes as sent, lowest first. */
TEST(the_examples_of_rfc_3720_are_met)
{
    uint8_t block[32];
    memset(block, 0, sizeof block);
    assert_int_equal(fx_crc32c(0, block, sizeof block), 0x8a9136aau);
    memset(block, 0xff, sizeof block);
    assert_int_equal(fx_crc32c(0, block, sizeof block), 0x62a8ab43u);
    for (int i = 0; i < 32; i++) {
        block[i] = (uint8_t)i;
    }
    assert_int_equal(fx_crc32c(0, block, sizeof block), 0x46dd794eu);
    for (int i = 0; i < 32; i++) {
        block[i] = (uint8_t)(31 - i);
    }
    assert_int_equal(fx_crc32c(0, block, sizeof block), 0x113fdb5cu);
    static const uint8_t scsi_read[48] = {0x01, 0xc0, 0, 0,    0,    0, 0, 0,    0,    0, 0,    0,
                                          0,    0,    0, 0,    0x14, 0, 0, 0,    0,    0, 0x04, 0,
                                          0,    0,    0, 0x14, 0,    0, 0, 0x18, 0x28, 0, 0,    0,
                                          0,    0,    0, 0,    0x02, 0, 0, 0,    0,    0, 0,    0};
    assert_int_equal(fx_crc32c(0, scsi_read, sizeof scsi_read), 0xd9963a56u);
}

/* The definition, one bit at a time. */
static uint32_t crc_bit_by_bit(const uint8_t *data, size_t len)
{
    uint32_t crc = ~0u;
    for (size_t i = 0; i < len * 8; i++) {
        const uint32_t bit = (uint32_t)data[i / 8] >> i % 8 & 1u;
        crc = crc >> 1 ^ (((crc ^ bit) & 1u) != 0 ? 0x82f63b78u : 0u);
    }
    return ~crc;
}

TEST(every_length_and_alignment_agrees_with_the_definition)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    uint8_t bytes[128];
    for (size_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)hs_rng_u64(&rng);
    }
    for (size_t start = 0; start < 8; start++) {
        for (size_t len = 0; len <= sizeof bytes - start; len++) {
            assert_int_equal(fx_crc32c(0, bytes + start, len), crc_bit_by_bit(bytes + start, len));
        }
    }
}

TEST(a_crc_goes_on_where_another_stopped)
{
    const char text[] = "the sweep never waits for flash";
    const uint32_t whole = fx_crc32c(0, text, sizeof text);
    for (size_t cut = 0; cut <= sizeof text; cut++) {
        assert_int_equal(fx_crc32c(fx_crc32c(0, text, cut), text + cut, sizeof text - cut), whole);
    }
}

TEST(any_single_bit_flipped_in_a_record_is_seen)
{
    uint8_t record[512] = {0};
    const uint32_t clean = fx_crc32c(0, record, sizeof record);
    for (size_t bit = 0; bit < sizeof record * 8; bit++) {
        record[bit / 8] ^= (uint8_t)(1u << bit % 8);
        assert_true(fx_crc32c(0, record, sizeof record) != clean);
        record[bit / 8] ^= (uint8_t)(1u << bit % 8);
    }
}
