/* Blocks of LZ4: those of the library's encoder at every level, those written by hand from the
 * description of the format, and hostile ones, judged by the library's decoder. */
#include "lm/lz4.h"

#include "check.h"
#include "hs/rng.h"

#include <lz4.h>
#include <lz4hc.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { BYTES_MAX = 70000, BLOCK_MAX = BYTES_MAX + BYTES_MAX / 255 + 16, GUARD = 64 };

static int encode(int level, const uint8_t *bytes, int count, uint8_t *block)
{
    const int made =
        level < 0 ? LZ4_compress_fast((const char *)bytes, (char *)block, count, BLOCK_MAX, -level)
                  : LZ4_compress_HC((const char *)bytes, (char *)block, count, BLOCK_MAX, level);
    assert_true(made > 0);
    return made;
}

/* Decode a block that lies `at` in a buffer of its own size, in steps of so many sequences. Bytes
 * around the buffer and, where they are apart, those of the block must stay. The output goes to
 * `out`. */
static int decode_at(const uint8_t *block, uint32_t block_bytes, uint32_t at, uint8_t *out,
                     uint32_t out_bytes, uint32_t step)
{
    const uint32_t end = at + block_bytes > out_bytes ? at + block_bytes : out_bytes;
    uint8_t *memory = malloc(end + (size_t)2 * GUARD);
    assert_non_null(memory);
    memset(memory, 0xA5, end + (size_t)2 * GUARD);
    memcpy(memory + GUARD + at, block, block_bytes);
    struct lm_lz4 d;
    lm_lz4_begin(&d, memory + GUARD, out_bytes, at, block_bytes);
    int status = LM_BUSY;
    uint64_t sequences = 0;
    while (status == LM_BUSY) {
        status = lm_lz4_run(&d, step);
        sequences += step;
        assert_true(sequences <= out_bytes / 4u + 1u + step);
    }
    for (uint32_t i = 0; i < GUARD; i++) {
        assert_int_equal(memory[i], 0xA5);
        assert_int_equal(memory[GUARD + end + i], 0xA5);
    }
    if (at >= out_bytes) {
        assert_memory_equal(memory + GUARD + at, block, block_bytes);
    }
    memcpy(out, memory + GUARD, out_bytes);
    free(memory);
    return status;
}

static int decode(const uint8_t *block, uint32_t block_bytes, uint8_t *out, uint32_t out_bytes)
{
    return decode_at(block, block_bytes, out_bytes, out, out_bytes, UINT32_MAX / 2);
}

/* Kinds of bytes, from what repeats for ever to what never does. */
enum { KINDS = 6 };
static void fill(int kind, struct hs_rng *rng, uint8_t *bytes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint8_t drawn = (uint8_t)hs_rng_below(rng, 256);
        bytes[i] = kind == 0   ? 0
                   : kind == 1 ? (uint8_t)(i % 7)
                   : kind == 2 ? drawn & 1
                   : kind == 3 ? (uint8_t)(drawn < 20 ? drawn : i / 300)
                   : kind == 4 ? (uint8_t)(i > 40 && drawn > 30 ? bytes[i - 40] : drawn)
                               : drawn;
    }
}

static void check_round_trip(int level, const uint8_t *bytes, uint32_t count)
{
    static uint8_t block[BLOCK_MAX], out[BYTES_MAX];
    const uint32_t made = (uint32_t)encode(level, bytes, (int)count, block);
    assert_int_equal(decode(block, made, out, count), LM_OK);
    assert_memory_equal(out, bytes, count);
    memset(out, 0, count);
    assert_int_equal(decode_at(block, made, count + 3, out, count, 1), LM_OK);
    assert_memory_equal(out, bytes, count);
    /* The margin that lz4.h gives a block in the end of its output, LZ4_DECOMPRESS_INPLACE_MARGIN.
     */
    memset(out, 0, count);
    const uint32_t margin = made / 256 + 32;
    if (made <= count + margin) {
        assert_int_equal(decode_at(block, made, count + margin - made, out, count, 50), LM_OK);
        assert_memory_equal(out, bytes, count);
    }
}

TEST(what_the_library_encodes_is_decoded_at_every_level)
{
    static uint8_t bytes[BYTES_MAX];
    static const uint32_t large[] = {1000, 4096, 17424, 65535, 65536, BYTES_MAX};
    static const int levels[] = {-100, -10, -1, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12};
    struct hs_rng rng;
    hs_rng_seed(&rng, 15);
    for (int kind = 0; kind < KINDS; kind++) {
        for (size_t l = 0; l < sizeof levels / sizeof levels[0]; l++) {
            for (uint32_t count = 1; count < 300; count += 1 + count / 40) {
                fill(kind, &rng, bytes, count);
                check_round_trip(levels[l], bytes, count);
            }
            for (size_t i = 0; i < sizeof large / sizeof large[0]; i++) {
                fill(kind, &rng, bytes, large[i]);
                check_round_trip(levels[l], bytes, large[i]);
            }
        }
    }
}

struct sample {
    const char *block;
    uint32_t block_bytes, out_bytes;
    const char *out; /* NULL: refused */
};
#define SAMPLE(block, out)                                                                         \
    {                                                                                              \
        block, sizeof block - 1, sizeof out - 1, out                                               \
    }
#define REFUSED(block, out_bytes)                                                                  \
    {                                                                                              \
        block, sizeof block - 1, out_bytes, NULL                                                   \
    }

TEST(blocks_written_by_hand_from_the_description)
{
    static const struct sample samples[] = {
        SAMPLE("\x00", ""),
        SAMPLE("\x50hello", "hello"),
        SAMPLE("\xF0\x00"
               "fifteen letters",
               "fifteen letters"),
        SAMPLE("\x13"
               "a\x01\x00\x50"
               "bcdef",
               "aaaaaaaabcdef"), /* a match longer than its offset */
        SAMPLE("\x30"
               "abc\x03\x00\x80"
               "01234567",
               "abcabca01234567"),
        SAMPLE("\x3F"
               "abc\x03\x00\x01\x50"
               "VWXYZ",
               "abcabcabcabcabcabcabcabVWXYZ"),
        REFUSED("", 0),
        REFUSED("\x00", 1),
        REFUSED("\x50hell", 5),      /* literals end with the block */
        REFUSED("\x50hello", 4),     /* and fit the output */
        REFUSED("\x50hello", 6),     /* which they fill */
        REFUSED("\xF0", 15),         /* the length goes on behind the end */
        REFUSED("\xF0\xFF\xFF", 15), /* likewise, and is too large */
        REFUSED("\x10"
                "a\x01",
                12), /* an offset needs two bytes */
        REFUSED("\x13"
                "a\x00\x00\x50"
                "bcdef",
                13), /* an offset is not 0 */
        REFUSED("\x13"
                "a\x02\x00\x50"
                "bcdef",
                13), /* nor leads before the output */
        REFUSED("\x13"
                "a\x01\x00\x40"
                "bcde",
                12), /* the last five are literals */
        REFUSED("\x11"
                "a\x01\x00\x60"
                "bcdefg",
                12), /* a match begins twelve before the end */
        REFUSED("\x13"
                "a\x01\x00",
                9), /* no block ends with a match */
    };
    for (size_t i = 0; i < sizeof samples / sizeof samples[0]; i++) {
        const struct sample *s = &samples[i];
        uint8_t out[64];
        const int status = decode((const uint8_t *)s->block, s->block_bytes, out, s->out_bytes);
        assert_int_equal(status, s->out ? LM_OK : LM_ERR_CORRUPT);
        if (s->out) {
            assert_memory_equal(out, s->out, s->out_bytes);
        }
    }
}

static uint32_t get_length(const uint8_t **at, const uint8_t *end, uint32_t half)
{
    uint32_t length = half, more = half == 15 ? 255 : 0;
    while (more == 255 && *at < end) {
        more = *(*at)++;
        length += more;
    }
    return length;
}

/* Does a block that the library accepts break the description: an offset of 0, or fewer than five
 * literals in the end? */
static bool breaks_the_description(const uint8_t *block, uint32_t bytes)
{
    const uint8_t *at = block, *const end = block + bytes;
    while (at < end) {
        const uint8_t token = *at++;
        const uint32_t literals = get_length(&at, end, token >> 4);
        if ((size_t)(end - at) <= literals) {
            return literals < 5;
        }
        at += literals;
        if (end - at >= 2 && at[0] == 0 && at[1] == 0) {
            return true;
        }
        at += 2;
        (void)get_length(&at, end, token & 15);
    }
    return false;
}

struct tally {
    int accepted, refused, exceptions;
};

/* Both decoders must agree, with the exceptions that the header names. */
static void compare(const uint8_t *block, uint32_t bytes, uint32_t out_bytes, struct tally *tally)
{
    static uint8_t ours[BYTES_MAX], theirs[BYTES_MAX];
    const bool is_ours = decode(block, bytes, ours, out_bytes) == LM_OK;
    const bool is_theirs = LZ4_decompress_safe((const char *)block, (char *)theirs, (int)bytes,
                                               (int)out_bytes) == (int)out_bytes;
    if (is_ours) {
        assert_true(is_theirs);
        assert_memory_equal(ours, theirs, out_bytes);
    } else if (is_theirs) {
        assert_true(breaks_the_description(block, bytes));
        tally->exceptions++;
    }
    tally->accepted += is_ours;
    tally->refused += !is_ours;
}

/* Change some bytes, cut the end off or double a part. */
static uint32_t damage(struct hs_rng *rng, uint8_t *block, uint32_t bytes)
{
    const uint32_t kind = hs_rng_below(rng, 4), at = hs_rng_below(rng, bytes);
    if (kind == 0) {
        return 1 + at;
    }
    if (kind == 1) {
        const uint32_t to = hs_rng_below(rng, bytes), left = bytes - (at > to ? at : to);
        memmove(block + to, block + at, left);
        return bytes;
    }
    for (uint32_t i = hs_rng_below(rng, 3) + 1; i > 0; i--) {
        const uint8_t drawn = (uint8_t)hs_rng_below(rng, 256);
        block[hs_rng_below(rng, bytes)] ^= kind == 2 ? drawn : (uint8_t)(1u << drawn % 8);
    }
    return bytes;
}

TEST(damaged_blocks_are_judged_as_the_library_judges_them)
{
    static uint8_t bytes[2000], block[BLOCK_MAX];
    struct tally tally = {0, 0, 0};
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    for (int i = 0; i < 60000; i++) {
        const uint32_t count = 1 + hs_rng_below(&rng, i % 3 ? 60 : 2000);
        fill((int)hs_rng_below(&rng, KINDS), &rng, bytes, count);
        const uint32_t made = (uint32_t)encode(i % 2 ? -1 : 9, bytes, (int)count, block);
        compare(block, damage(&rng, block, made), count, &tally);
    }
    assert_true(tally.accepted > 5000 && tally.refused > 20000 && tally.exceptions > 10);
}

static uint8_t *put_length(uint8_t *at, uint32_t length)
{
    for (; length >= 255; length -= 255) {
        *at++ = 255;
    }
    *at++ = (uint8_t)length;
    return at;
}

/* Append a sequence, whose match is 0 for the last. Returns the bytes that it makes. */
static uint32_t put_sequence(struct hs_rng *rng, uint8_t **block, uint32_t literals, uint32_t match)
{
    uint8_t *at = *block + 1;
    const uint32_t more = match > 0 ? match - 4 : 0;
    **block = (uint8_t)((literals < 15 ? literals : 15) << 4 | (more < 15 ? more : 15));
    at = literals < 15 ? at : put_length(at, literals - 15);
    for (uint32_t i = 0; i < literals; i++) {
        *at++ = (uint8_t)hs_rng_below(rng, 256);
    }
    if (match > 0) {
        *at++ = (uint8_t)hs_rng_below(rng, 30);
        *at++ = (uint8_t)(hs_rng_below(rng, 60) == 0);
        at = more < 15 ? at : put_length(at, more - 15);
    }
    *block = at;
    return literals + match;
}

/* Any sequences: matches that reach too far back or too near to the end, outputs too short. */
TEST(random_sequences_are_judged_as_the_library_judges_them)
{
    uint8_t block[2000];
    struct tally tally = {0, 0, 0};
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    for (int i = 0; i < 300000; i++) {
        uint8_t *end = block;
        uint32_t out_bytes = 0;
        for (uint32_t k = hs_rng_below(&rng, 4); k > 0; k--) {
            out_bytes += put_sequence(&rng, &end, hs_rng_below(&rng, i % 5 ? 40 : 300),
                                      4 + hs_rng_below(&rng, i % 7 ? 20 : 300));
        }
        out_bytes += put_sequence(&rng, &end, 1 + hs_rng_below(&rng, 14), 0);
        out_bytes += hs_rng_below(&rng, 10) == 0 ? hs_rng_below(&rng, 3) : 0;
        const uint32_t cut = hs_rng_below(&rng, 10) == 0 && end - block > 2;
        compare(block, (uint32_t)(end - block) - cut, out_bytes, &tally);
    }
    assert_true(tally.accepted > 50000 && tally.refused > 50000 && tally.exceptions > 500);
}

/* In the end of its output a block is decoded right or refused, never decoded wrong; with the room
 * that it needs it is decoded. */
TEST(a_block_in_the_end_of_its_output_never_overtakes_itself)
{
    static uint8_t bytes[3000], block[BLOCK_MAX], out[3000];
    int refused = 0;
    struct hs_rng rng;
    hs_rng_seed(&rng, 8);
    for (int i = 0; i < 3000; i++) {
        const uint32_t count = 200 + hs_rng_below(&rng, 2800);
        fill(i % KINDS, &rng, bytes, count);
        const uint32_t made = (uint32_t)encode(9, bytes, (int)count, block);
        bool was_decoded = false;
        for (uint32_t margin = 0; margin < 48; margin += 3) {
            if (made > count + margin) {
                continue;
            }
            const int status = decode_at(block, made, count + margin - made, out, count, 7);
            if (status == LM_OK) {
                assert_memory_equal(out, bytes, count);
            }
            assert_true(status == LM_OK || !was_decoded);
            was_decoded = status == LM_OK;
            refused += status != LM_OK;
        }
        assert_true(was_decoded);
    }
    assert_true(refused > 0);
}
