#include "trust/sign.h"

#include "crypto.h"
#include "fx/crc32c.h"
#include "head.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/progress.h"
#include "hs/zero_bytes.h"

#include <errno.h>
#include <inttypes.h>
#include <stddef.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { CHUNK_BYTES = 64 << 10 };

struct copy {
    const char *from;
    struct trust_reader reader;
    struct trust_head head; /* of `from`; then of what is written */
    struct hs_atomic_file to;
    struct hs_progress progress;
    uint8_t chunk[CHUNK_BYTES];
};

static int write_failed(const struct copy *c)
{
    return hs_error(c->to.path, "free some space and run again", "cannot be written: %s",
                    strerror(errno));
}

static int put(struct copy *c, const void *bytes, size_t count)
{
    return fwrite(bytes, 1, count, c->to.stream) == count ? 0 : write_failed(c);
}

/* Copy from the place where both files are. `sha` NULL: a gap, which must hold zeros. */
static int copy_bytes(struct copy *c, uint64_t from, uint64_t to, struct trust_sha256 *sha)
{
    while (from < to) {
        const uint32_t bytes = to - from < CHUNK_BYTES ? (uint32_t)(to - from) : CHUNK_BYTES;
        const int cause = c->reader.read(c->reader.ctx, from, c->chunk, bytes);
        if (cause != 0) {
            return hs_error(c->from, "check the medium", "cannot be read at %" PRIu64 ": %s", from,
                            strerror(cause));
        }
        if (sha) {
            trust_sha256_add(sha, c->chunk, bytes);
        } else if (!db_is_zero(c->chunk, bytes)) {
            return hs_error(c->from, "build it again",
                            "bytes between the sections are not zero, near %" PRIu64, from);
        }
        if (put(c, c->chunk, bytes) != 0) {
            return -1;
        }
        from += bytes;
        hs_progress_update(&c->progress, from);
    }
    return 0;
}

static int copy_section(struct copy *c, uint32_t number)
{
    const struct lm_image_section *s = &c->head.header.sections[number];
    struct trust_seal_digest *d = &c->head.seal.digest[number];
    struct trust_sha256 sha;
    trust_sha256_begin(&sha);
    const int result = copy_bytes(c, s->offset, s->offset + s->bytes, &sha);
    d->type = s->type;
    if (!trust_sha256_end(&sha, d->sha256) && result == 0) {
        return hs_error(c->from, NULL, "out of memory");
    }
    return result;
}

/* Take SEAL out of the table, so that its number is that of the last section. The seal must be the
 * last in the file, too: what lies behind it would have to move. */
static int forget_seal(struct copy *c)
{
    struct lm_image_header *h = &c->head.header;
    const uint32_t last = h->section_count - 1, at = c->head.seal_index;
    if (c->head.order[last] != at) {
        return hs_error(c->from, "`landmass-db convert` writes it without its seal",
                        "its seal does not stand at its end");
    }
    for (uint32_t i = at; i < last; i++) {
        h->sections[i] = h->sections[i + 1];
    }
    for (uint32_t i = 0; i < last; i++) {
        c->head.order[i] = (uint8_t)(c->head.order[i] - (c->head.order[i] > at));
    }
    memset(&h->sections[last], 0, sizeof h->sections[last]);
    h->section_count = last;
    return 0;
}

/* Open `from`, and read what it is. */
static int open_image(struct copy *c, int descriptor)
{
    struct trust_result r;
    struct stat status;
    if (fstat(descriptor, &status) != 0 || !S_ISREG(status.st_mode)) {
        return hs_error(c->from, "name an image", "is no ordinary file");
    }
    trust_reader_of_file(&c->reader, descriptor, (uint64_t)status.st_size);
    const enum trust_verdict verdict = trust_head_read(&c->head, &c->reader, &r);
    if (verdict != TRUST_GOOD && verdict != TRUST_UNSIGNED) {
        return hs_error(c->from, "`landmass-db verify` says more", "%s", r.cause);
    }
    if (verdict == TRUST_GOOD && forget_seal(c) != 0) {
        return -1;
    }
    return c->head.header.section_count < LM_IMAGE_SECTIONS_MAX
               ? 0
               : hs_error(c->from, "build it without some of them",
                          "has %d sections and no room for a seal", LM_IMAGE_SECTIONS_MAX);
}

/* All sections, one behind the other, and their digests. Returns where they end; 0 on failure. */
static uint64_t copy_sections(struct copy *c)
{
    const struct lm_image_header *h = &c->head.header;
    uint64_t end = sizeof *h;
    int result = put(c, h, sizeof *h); /* written again when the rest is known */
    for (uint32_t i = 0; i < h->section_count && result == 0; i++) {
        const struct lm_image_section *s = &h->sections[c->head.order[i]];
        result = copy_bytes(c, end, s->offset, NULL);
        if (result == 0) {
            result = copy_section(c, c->head.order[i]);
        }
        end = s->offset + s->bytes;
    }
    return result == 0 ? end : 0;
}

/* Fill in header and seal for sections that end at `end`, and sign. */
static int make_seal(struct copy *c, uint64_t end, const struct trust_signer *signer,
                     uint64_t serial)
{
    struct lm_image_header *h = &c->head.header;
    struct trust_seal *seal = &c->head.seal;
    uint8_t message[TRUST_MESSAGE_MAX_BYTES];
    const uint64_t a = LM_IMAGE_SECTION_ALIGNMENT;
    const uint32_t count = h->section_count;
    seal->head = (struct trust_seal_head){TRUST_SEAL_VERSION, count, serial, {0}, {0}};
    memcpy(seal->head.key, signer->key, sizeof seal->head.key);
    h->sections[count] =
        (struct lm_image_section){LM_IMAGE_SEAL, 0, (end + a - 1) / a * a, trust_seal_bytes(count)};
    h->section_count = count + 1;
    h->image_bytes = h->sections[count].offset + h->sections[count].bytes;
    const uint32_t bytes = trust_seal_message(h, count, seal, message);
    return trust_ed25519_sign(signer, message, bytes, seal->signature)
               ? 0
               : hs_error(c->from, NULL, "cannot be signed: out of memory");
}

static int put_seal(struct copy *c, uint64_t end)
{
    static const uint8_t zeros[LM_IMAGE_SECTION_ALIGNMENT];
    struct lm_image_header *h = &c->head.header;
    struct lm_image_section *s = &h->sections[h->section_count - 1];
    const uint32_t before = trust_seal_signed_bytes(c->head.seal.head.count);
    s->crc = fx_crc32c(0, &c->head.seal, before);
    s->crc = fx_crc32c(s->crc, c->head.seal.signature, TRUST_SIGNATURE_BYTES);
    h->crc = fx_crc32c(0, h, offsetof(struct lm_image_header, crc));
    if (put(c, zeros, s->offset - end) != 0 || put(c, &c->head.seal, before) != 0 ||
        put(c, c->head.seal.signature, TRUST_SIGNATURE_BYTES) != 0) {
        return -1;
    }
    return fseeko(c->to.stream, 0, SEEK_SET) == 0 ? put(c, h, sizeof *h) : write_failed(c);
}

static int write_signed(struct copy *c, const struct trust_signer *signer, uint64_t serial)
{
    hs_progress_begin(&c->progress, "signing", c->head.header.image_bytes);
    memset(&c->head.seal, 0, sizeof c->head.seal);
    const uint64_t end = copy_sections(c);
    const bool is_good =
        end != 0 && make_seal(c, end, signer, serial) == 0 && put_seal(c, end) == 0;
    hs_progress_end(&c->progress);
    return is_good ? 0 : -1;
}

int trust_sign_image(const char *from, const char *to, const struct trust_signer *signer,
                     uint64_t serial)
{
    struct copy c = {.from = from};
    FILE *file = hs_input_open(from, "rb");
    if (!file) {
        return hs_error(from, "name an image", "%s", strerror(errno));
    }
    int result = open_image(&c, fileno(file));
    if (result == 0) {
        result = hs_atomic_open(&c.to, to);
        if (result == 0) {
            result = write_signed(&c, signer, serial);
            result = result == 0 ? hs_atomic_commit(&c.to) : -1;
            hs_atomic_abort(&c.to);
        }
    }
    fclose(file);
    return result;
}
