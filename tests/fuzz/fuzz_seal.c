/* Header and seal of an image of any bytes. The first byte says what is put right: 1 the checksums,
 * 2 digests and signature too; the next four name a bit that is flipped then. What was signed
 * passes, unless there is something between its sections; with the flipped bit nothing passes. */
#include "fuzz.h"

#include "crypto.h"
#include "fx/crc32c.h"
#include "head.h"

#include <errno.h>
#include <stddef.h>

const uint32_t fuzz_mutations = 20000;

/* RFC 8032, 7.1, test 1. */
static const struct trust_signer signer = {
    {0x9d, 0x61, 0xb1, 0x9d, 0xef, 0xfd, 0x5a, 0x60, 0xba, 0x84, 0x4a,
     0xf4, 0x92, 0xec, 0x2c, 0xc4, 0x44, 0x49, 0xc5, 0x69, 0x7b, 0x32,
     0x69, 0x19, 0x70, 0x3b, 0xac, 0x03, 0x1c, 0xae, 0x7f, 0x60},
    {0xd7, 0x5a, 0x98, 0x01, 0x82, 0xb1, 0x0a, 0xb7, 0xd5, 0x4b, 0xfe,
     0xd3, 0xc9, 0x64, 0x07, 0x3a, 0x0e, 0xe1, 0x72, 0xf3, 0xda, 0xa6,
     0x23, 0x25, 0xaf, 0x02, 0x1a, 0x68, 0xf7, 0x07, 0x51, 0x1a}};

struct bytes {
    uint8_t *at;
    size_t size;
};

static int read_bytes(void *ctx, uint64_t offset, void *to, uint32_t bytes)
{
    const struct bytes *b = ctx;
    FUZZ_ASSERT(offset <= b->size && bytes <= b->size - offset);
    memcpy(to, b->at + offset, bytes);
    return 0;
}

static void put_header(struct bytes *b, struct lm_image_header *h)
{
    h->crc = fx_crc32c(0, h, offsetof(struct lm_image_header, crc));
    memcpy(b->at, h, sizeof *h);
}

/* Put the checksums right of whatever says that it is a seal. */
static void repair(struct bytes *b)
{
    struct lm_image_header h;
    if (b->size < sizeof h) {
        return;
    }
    memcpy(&h, b->at, sizeof h);
    for (uint32_t i = 0; i < h.section_count && i < LM_IMAGE_SECTIONS_MAX; i++) {
        struct lm_image_section *s = &h.sections[i];
        if (s->type == LM_IMAGE_SEAL && s->offset <= b->size && s->bytes <= b->size - s->offset) {
            s->crc = fx_crc32c(0, b->at + s->offset, s->bytes);
        }
    }
    put_header(b, &h);
}

/* Sign what has the form of a signed image. */
static void sign(struct bytes *b, struct trust_head *head)
{
    struct lm_image_header *h = &head->header;
    uint8_t message[TRUST_MESSAGE_MAX_BYTES];
    memcpy(head->seal.head.key, signer.key, sizeof signer.key);
    for (uint32_t i = 0, k = 0; i < h->section_count; i++) {
        if (i != head->seal_index) {
            struct trust_sha256 sha;
            trust_sha256_begin(&sha);
            trust_sha256_add(&sha, b->at + h->sections[i].offset, h->sections[i].bytes);
            FUZZ_ASSERT(trust_sha256_end(&sha, head->seal.digest[k++].sha256));
        }
    }
    const uint32_t bytes = trust_seal_message(h, head->seal_index, &head->seal, message);
    FUZZ_ASSERT(trust_ed25519_sign(&signer, message, bytes, head->seal.signature));
    const uint32_t before = trust_seal_signed_bytes(head->seal.head.count);
    uint8_t *to = b->at + h->sections[head->seal_index].offset;
    memcpy(to, &head->seal, before);
    memcpy(to + before, head->seal.signature, TRUST_SIGNATURE_BYTES);
    repair(b);
}

static void judge(struct bytes *b, bool is_signed, uint32_t flip)
{
    const struct trust_keys keys = {0};
    const struct trust_reader reader = {b, b->size, read_bytes};
    struct trust_result r, head;
    const enum trust_verdict verdict = trust_verify(&reader, &keys, NULL, NULL, &r);
    const enum trust_verdict first = trust_identify(&reader, &keys, &head);
    FUZZ_ASSERT(verdict != TRUST_GOOD && verdict != TRUST_STOPPED);
    FUZZ_ASSERT(verdict == first || (first == TRUST_FOREIGN && verdict == TRUST_BROKEN));
    FUZZ_ASSERT(r.cause[0] != '\0');
    if (is_signed) {
        FUZZ_ASSERT(first == TRUST_FOREIGN);
        FUZZ_ASSERT(verdict == TRUST_FOREIGN || strstr(r.cause, "between the sections") != NULL);
        b->at[flip / 8 % r.image_bytes] ^= (uint8_t)(1u << flip % 8);
        const enum trust_verdict flipped = trust_verify(&reader, &keys, NULL, NULL, &r);
        FUZZ_ASSERT(verdict != TRUST_FOREIGN || flipped == TRUST_BROKEN ||
                    flipped == TRUST_NO_IMAGE);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const uint8_t parts = fuzz_u8(&supply);
    const uint32_t flip = fuzz_u32(&supply);
    struct bytes image = {malloc(supply.left + 1), supply.left};
    struct trust_head *head = malloc(sizeof *head);
    FUZZ_ASSERT(image.at && head);
    memcpy(image.at, supply.at, supply.left);
    if (parts & 3) {
        repair(&image);
    }
    const struct trust_reader reader = {&image, image.size, read_bytes};
    struct trust_result r;
    const bool has_form = trust_head_read(head, &reader, &r) == TRUST_GOOD;
    if (has_form && (parts & 2)) {
        sign(&image, head);
    }
    judge(&image, has_form && (parts & 2), flip);
    free(head);
    free(image.at);
    return 0;
}
