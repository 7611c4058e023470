/* A signed image: whoever changes a bit of it, exchanges key or signature, or cuts it short, is
 * found out. */
#include "signed.h"

#include "check.h"
#include "lm/db.h"
#include "lm/status.h"
#include "memory_flash.h"
#include "tiny_image.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

TEST(a_signed_image_is_good_by_its_key_and_foreign_to_another)
{
    struct trust_result r;
    size_t size;
    uint8_t *bytes = signed_read("signed.lmdb", &size);
    assert_int_equal(signed_judge(bytes, size, "a.pub", &r), TRUST_GOOD);
    assert_true(r.is_sealed && r.serial == 7 && r.image_bytes == size);
    assert_int_equal(signed_judge(bytes, size, "b.pub", &r), TRUST_FOREIGN);
    assert_int_equal(r.serial, 7);
    free(bytes);
}

TEST(an_image_without_a_seal_is_unsigned)
{
    struct trust_result r;
    size_t size;
    uint8_t *bytes = signed_read("image.lmdb", &size);
    assert_int_equal(signed_judge(bytes, size, "a.pub", &r), TRUST_UNSIGNED);
    assert_false(r.is_sealed);
    free(bytes);
}

static void expect_flyable(const char *name)
{
    struct memory_flash flash;
    struct lm_db db;
    size_t size;
    uint8_t *bytes = signed_read(name, &size);
    memory_flash_open(&flash, bytes, size);
    assert_int_equal(lm_db_open(&db, &flash.port, 8), LM_OK);
    free(bytes);
}

TEST(the_firmware_takes_an_image_with_and_without_a_seal)
{
    const struct tiny_spec spec = tiny_spec_at(46, 11);
    struct tiny_image image;
    struct trust_signer signer;
    assert_int_equal(tiny_image_build(&image, &spec), 0);
    assert_int_equal(tiny_image_write(&image, signed_path("plain.lmdb")), 0);
    tiny_image_free(&image);
    assert_int_equal(trust_signer_load(&signer, signed_path("a.pem"), NULL), 0);
    assert_int_equal(
        trust_sign_image(signed_path("plain.lmdb"), signed_path("flown.lmdb"), &signer, 1), 0);
    expect_flyable("plain.lmdb");
    expect_flyable("flown.lmdb");
}

static bool is_refused(const uint8_t *bytes, size_t size)
{
    struct trust_result r;
    const enum trust_verdict v = signed_judge(bytes, size, "a.pub", &r);
    return (v == TRUST_BROKEN || v == TRUST_NO_IMAGE) && r.cause[0] != '\0';
}

/* Flip one bit of every `step`th byte; or, with a step of 0, each bit of every byte. */
static void flip(uint8_t *bytes, size_t size, uint64_t from, uint64_t to, uint32_t step)
{
    for (uint64_t i = from; i < to; i += step ? step : 1) {
        for (uint32_t bit = 0; bit < (step ? 1u : 8u); bit++) {
            const uint8_t mask = (uint8_t)(1u << (step ? i % 8 : bit));
            bytes[i] ^= mask;
            if (!is_refused(bytes, size)) {
                fail_msg("bit %u of byte %llu may flip", mask, (unsigned long long)i);
            }
            bytes[i] ^= mask;
        }
    }
}

TEST(one_flipped_bit_is_refused_wherever_it_is)
{
    size_t size;
    uint8_t *bytes = signed_read("signed.lmdb", &size);
    const struct lm_image_header *h = (const void *)bytes;
    uint32_t seen = 0;
    flip(bytes, size, 0, sizeof *h, 4);
    for (uint32_t i = 0; i < h->section_count; i++) {
        const struct lm_image_section s = h->sections[i];
        flip(bytes, size, s.offset, s.offset + s.bytes, s.bytes > 2000 ? 997 : 37);
        flip(bytes, size, s.offset + s.bytes - 1, s.offset + s.bytes, 0);
        const uint64_t end = s.offset + s.bytes, next = (end + 63) / 64 * 64;
        flip(bytes, size, end, next < size ? next : size, 5); /* the gap behind it */
        seen |= s.type < 32 ? 1u << s.type : 0;
    }
    assert_int_equal(seen, (1u << LM_IMAGE_SECTION_TYPES) - 2); /* every kind there is */
    flip(bytes, size, sizeof *h, size, 4001);
    assert_false(is_refused(bytes, size));
    free(bytes);
}

/* A checksum is no obstacle to somebody who means harm. */
TEST(a_flipped_bit_of_header_or_seal_is_refused_though_the_checksums_fit)
{
    size_t size;
    uint8_t *bytes = signed_read("signed.lmdb", &size), *changed = malloc(size);
    const struct lm_image_section seal = *signed_section(bytes, LM_IMAGE_SEAL);
    assert_non_null(changed);
    const uint64_t crc_at =
        (uint64_t)((const uint8_t *)&signed_section(bytes, LM_IMAGE_SEAL)->crc - bytes);
    for (uint64_t i = 0; i < size; i++) {
        if ((i >= LM_DB_HEADER_BYTES - 4 && i < seal.offset) || (i >= crc_at && i < crc_at + 4)) {
            continue; /* what is put right, and what is no header */
        }
        memcpy(changed, bytes, size);
        changed[i] ^= (uint8_t)(1u << i % 8);
        if (signed_section(changed, LM_IMAGE_SEAL) &&
            memcmp(signed_section(changed, LM_IMAGE_SEAL), &seal, sizeof seal) == 0) {
            signed_repair(changed);
        }
        if (!is_refused(changed, size)) {
            fail_msg("byte %llu may change", (unsigned long long)i);
        }
    }
    free(changed);
    free(bytes);
}

TEST(an_image_that_is_cut_short_is_refused_wherever_it_ends)
{
    size_t size;
    uint8_t *bytes = signed_read("signed.lmdb", &size);
    for (size_t end = 0; end < size; end += end < 1100 || end > size - 100 ? 1 : 613) {
        assert_true(is_refused(bytes, end));
    }
    free(bytes);
}

TEST(the_signature_of_another_image_is_refused)
{
    struct trust_signer signer;
    size_t size, other_size;
    uint8_t *bytes = signed_read("image.lmdb", &size);
    bytes[signed_section(bytes, 77)->offset] ^= 1;
    signed_write("other.lmdb", bytes, size);
    free(bytes);
    assert_int_equal(trust_signer_load(&signer, signed_path("a.pem"), NULL), 0);
    assert_int_equal(
        trust_sign_image(signed_path("other.lmdb"), signed_path("other2.lmdb"), &signer, 7), 0);
    bytes = signed_read("signed.lmdb", &size);
    uint8_t *other = signed_read("other2.lmdb", &other_size);
    assert_int_equal(size, other_size);
    const struct lm_image_section seal = *signed_section(bytes, LM_IMAGE_SEAL);
    memcpy(bytes + seal.offset, other + seal.offset, seal.bytes);
    signed_repair(bytes);
    assert_true(is_refused(bytes, size));
    free(other);
    free(bytes);
}

/* The key in the seal says who signed; it is signed itself. */
TEST(another_key_in_the_seal_does_not_make_the_signature_its)
{
    struct trust_keys keys = {0};
    size_t size;
    uint8_t *bytes = signed_read("signed.lmdb", &size);
    struct trust_seal_head *head = (void *)(bytes + signed_section(bytes, LM_IMAGE_SEAL)->offset);
    assert_int_equal(trust_keys_load(&keys, signed_path("b.pub")), 0);
    memcpy(head->key, keys.key[0], sizeof head->key);
    signed_repair(bytes);
    struct trust_result r;
    assert_int_equal(signed_judge(bytes, size, "b.pub", &r), TRUST_BROKEN);
    assert_int_equal(signed_judge(bytes, size, "a.pub", &r), TRUST_BROKEN);
    free(bytes);
}

/* What the table of sections says after a change, its checksums put right. */
static void expect_cause(uint8_t *bytes, size_t size, const char *cause)
{
    struct trust_result r;
    signed_repair(bytes);
    assert_int_equal(signed_judge(bytes, size, "a.pub", &r), TRUST_BROKEN);
    assert_string_equal(r.cause, cause);
}

TEST(sections_that_share_bytes_and_a_second_seal_are_named)
{
    size_t size;
    uint8_t *bytes = signed_read("signed.lmdb", &size);
    struct lm_image_section *s = (void *)(uintptr_t)signed_section(bytes, LM_IMAGE_RADAR);
    const struct lm_image_section kept = *s;
    const char *const place = "section RADAR lies outside the image or in another section";
    s->offset = signed_section(bytes, LM_IMAGE_TILES)->offset;
    expect_cause(bytes, size, "section TILES lies outside the image or in another section");
    s->offset = LM_DB_HEADER_BYTES - 64;
    expect_cause(bytes, size, place);
    s->offset = UINT64_MAX;
    expect_cause(bytes, size, place);
    *s = kept;
    s->bytes = size;
    expect_cause(bytes, size, place);
    s->bytes = kept.bytes + 64;
    expect_cause(bytes, size, "section BUS lies outside the image or in another section");
    *s = kept;
    const struct lm_image_section *last = signed_section(bytes, 77);
    ((struct lm_image_section *)(uintptr_t)last)->type = LM_IMAGE_SEAL;
    expect_cause(bytes, size, "there is more than one section SEAL");
    free(bytes);
}

TEST(signing_again_replaces_the_seal)
{
    struct trust_signer signer;
    size_t size, again_size;
    assert_int_equal(trust_signer_load(&signer, signed_path("b.pem"), NULL), 0);
    assert_int_equal(
        trust_sign_image(signed_path("signed.lmdb"), signed_path("again.lmdb"), &signer, 8), 0);
    assert_int_equal(
        trust_sign_image(signed_path("image.lmdb"), signed_path("once.lmdb"), &signer, 8), 0);
    uint8_t *once = signed_read("once.lmdb", &size),
            *again = signed_read("again.lmdb", &again_size);
    assert_int_equal(size, again_size);
    assert_memory_equal(once, again, size);
    free(once);
    free(again);
}

/* What identifies an image reads little, and says nothing of its sections. */
TEST(an_image_is_identified_by_its_header_and_seal_alone)
{
    struct trust_result r;
    struct trust_keys keys = {0};
    struct trust_reader reader;
    size_t size;
    uint8_t *bytes = signed_read("signed.lmdb", &size);
    bytes[signed_section(bytes, LM_IMAGE_TILES)->offset] ^= 1;
    signed_write("damaged.lmdb", bytes, size);
    assert_int_equal(trust_keys_load(&keys, signed_path("a.pub")), 0);
    FILE *file = fopen(signed_path("damaged.lmdb"), "rb");
    assert_non_null(file);
    trust_reader_of_file(&reader, fileno(file), size);
    assert_int_equal(trust_identify(&reader, &keys, &r), TRUST_GOOD);
    assert_int_equal(r.serial, 7);
    assert_int_equal(trust_verify(&reader, &keys, NULL, NULL, &r), TRUST_BROKEN);
    assert_string_equal(r.cause, "section TILES is not what was signed");
    fclose(file);
    free(bytes);
}

static bool stop_at_once(void *ctx, uint64_t done_bytes, uint64_t all_bytes)
{
    uint64_t *told = ctx;
    assert_true(done_bytes > 0 && done_bytes <= all_bytes);
    ++*told;
    return false;
}

static int fail_behind(void *ctx, uint64_t offset, void *to, uint32_t bytes)
{
    const uint64_t *limit = ctx;
    memset(to, 0, bytes);
    return offset + bytes > *limit ? 5 : 0;
}

TEST(a_medium_that_fails_and_a_caller_who_stops_are_told_apart)
{
    struct trust_result r;
    struct trust_keys keys = {0};
    struct trust_reader reader;
    size_t size;
    uint64_t told = 0, limit = 100;
    free(signed_read("signed.lmdb", &size));
    FILE *file = fopen(signed_path("signed.lmdb"), "rb");
    assert_non_null(file);
    trust_reader_of_file(&reader, fileno(file), size);
    assert_int_equal(trust_verify(&reader, &keys, stop_at_once, &told, &r), TRUST_STOPPED);
    assert_int_equal(told, 1);
    fclose(file);
    const struct trust_reader bad = {&limit, 1 << 20, fail_behind};
    assert_int_equal(trust_verify(&bad, &keys, NULL, NULL, &r), TRUST_UNREADABLE);
}

TEST_GROUP(signed_open, NULL);
