#include "trust/verify.h"

#include "crypto.h"
#include "head.h"
#include "hs/whole_file.h"
#include "hs/zero_bytes.h"

#include <errno.h>
#include <string.h>

enum { CHUNK_BYTES = 64 << 10 };

/* A walk through the image from its begin to its end. */
struct walk {
    const struct trust_reader *reader;
    trust_progress *progress;
    void *ctx;
    struct trust_result *r;
    uint8_t chunk[CHUNK_BYTES];
};

static int read_file(void *ctx, uint64_t offset, void *to, uint32_t bytes)
{
    return hs_read_whole((int)(intptr_t)ctx, to, bytes, offset);
}

void trust_reader_of_file(struct trust_reader *reader, int descriptor, uint64_t size_bytes)
{
    *reader = (struct trust_reader){(void *)(intptr_t)descriptor, size_bytes, read_file};
}

static int read_flash(void *ctx, uint64_t offset, void *to, uint32_t bytes)
{
    const struct lm_flash *flash = ctx;
    return flash->read_start(flash->ctx, offset, to, bytes) == LM_OK &&
                   flash->read_poll(flash->ctx) == LM_OK
               ? 0
               : EIO;
}

void trust_reader_of_flash(struct trust_reader *reader, const struct lm_flash *flash)
{
    *reader = (struct trust_reader){(void *)(uintptr_t)flash, flash->size_bytes, read_flash};
}

/* Read the bytes of a section or of a gap, piece by piece. `sha` NULL: they must be zero. */
static enum trust_verdict walk_bytes(struct walk *w, uint64_t from, uint64_t to,
                                     struct trust_sha256 *sha)
{
    while (from < to) {
        const uint32_t bytes = to - from < CHUNK_BYTES ? (uint32_t)(to - from) : CHUNK_BYTES;
        const int cause = w->reader->read(w->reader->ctx, from, w->chunk, bytes);
        if (cause != 0) {
            return trust_note(w->r, TRUST_UNREADABLE, from, "cannot be read: %s", strerror(cause));
        }
        if (sha) {
            trust_sha256_add(sha, w->chunk, bytes);
        } else if (!db_is_zero(w->chunk, bytes)) {
            return trust_note(w->r, TRUST_BROKEN, from, "bytes between the sections are not zero");
        }
        from += bytes;
        if (w->progress && !w->progress(w->ctx, from, w->r->image_bytes)) {
            return trust_note(w->r, TRUST_STOPPED, from, "was not checked to its end");
        }
    }
    return TRUST_GOOD;
}

static const struct trust_seal_digest *digest_of(const struct trust_head *head, uint32_t section)
{
    return &head->seal.digest[section < head->seal_index ? section : section - 1];
}

static enum trust_verdict walk_section(struct walk *w, const struct trust_head *head,
                                       uint32_t number)
{
    const struct lm_image_section *s = &head->header.sections[number];
    uint8_t digest[TRUST_DIGEST_BYTES];
    struct trust_sha256 sha;
    if (number == head->seal_index) {
        return TRUST_GOOD; /* has been read already */
    }
    trust_sha256_begin(&sha);
    const enum trust_verdict verdict = walk_bytes(w, s->offset, s->offset + s->bytes, &sha);
    const bool is_made = trust_sha256_end(&sha, digest);
    if (verdict != TRUST_GOOD) {
        return verdict;
    }
    if (!is_made) {
        return trust_note(w->r, TRUST_UNREADABLE, s->offset, "out of memory");
    }
    return memcmp(digest, digest_of(head, number)->sha256, sizeof digest) == 0
               ? TRUST_GOOD
               : trust_note(w->r, TRUST_BROKEN, s->offset, "section %s is not what was signed",
                            trust_section_name(s->type));
}

static enum trust_verdict walk_image(struct walk *w, const struct trust_head *head)
{
    const struct lm_image_header *h = &head->header;
    enum trust_verdict verdict = TRUST_GOOD;
    uint64_t end = sizeof *h;
    for (uint32_t i = 0; i < h->section_count && verdict == TRUST_GOOD; i++) {
        const struct lm_image_section *s = &h->sections[head->order[i]];
        verdict = walk_bytes(w, end, s->offset, NULL);
        if (verdict == TRUST_GOOD) {
            verdict = walk_section(w, head, head->order[i]);
        }
        end = s->offset + s->bytes;
    }
    return verdict == TRUST_GOOD ? walk_bytes(w, end, h->image_bytes, NULL) : verdict;
}

/* Whose signature it is, once it is known to be one: the last thing that is said. */
static enum trust_verdict judge_key(const struct trust_keys *keys, struct trust_result *r)
{
    if (trust_keys_have(keys, r->key)) {
        r->verdict = TRUST_GOOD;
        return TRUST_GOOD;
    }
    char fingerprint[TRUST_FINGERPRINT_TEXT];
    trust_fingerprint(r->key, fingerprint);
    return trust_note(r, TRUST_FOREIGN, 0, "is signed by key %.16s, which is not trusted here",
                      fingerprint);
}

/* Header, seal, and the signature over both. */
static enum trust_verdict open_head(struct trust_head *head, const struct trust_reader *reader,
                                    struct trust_result *r)
{
    uint8_t message[TRUST_MESSAGE_MAX_BYTES];
    const enum trust_verdict verdict = trust_head_read(head, reader, r);
    if (verdict != TRUST_GOOD) {
        return verdict;
    }
    const uint32_t bytes =
        trust_seal_message(&head->header, head->seal_index, &head->seal, message);
    return trust_ed25519_fits(head->seal.head.key, message, bytes, head->seal.signature)
               ? TRUST_GOOD
               : trust_note(r, TRUST_BROKEN, head->header.sections[head->seal_index].offset,
                            "the signature does not fit header and seal");
}

enum trust_verdict trust_identify(const struct trust_reader *reader, const struct trust_keys *keys,
                                  struct trust_result *result)
{
    struct trust_head head;
    const enum trust_verdict verdict = open_head(&head, reader, result);
    return verdict == TRUST_GOOD ? judge_key(keys, result) : verdict;
}

enum trust_verdict trust_verify(const struct trust_reader *reader, const struct trust_keys *keys,
                                trust_progress *progress, void *ctx, struct trust_result *result)
{
    struct trust_head head;
    struct walk w = {.reader = reader, .progress = progress, .ctx = ctx, .r = result};
    enum trust_verdict verdict = open_head(&head, reader, result);
    if (verdict == TRUST_GOOD) {
        verdict = walk_image(&w, &head);
    }
    return verdict == TRUST_GOOD ? judge_key(keys, result) : verdict;
}

const char *trust_remedy(enum trust_verdict verdict)
{
    static const char *const remedies[] = {
        [TRUST_GOOD] = NULL,
        [TRUST_FOREIGN] = "sign it with a trusted key, or trust that one",
        [TRUST_UNSIGNED] = "`landmass-db sign` signs it",
        [TRUST_BROKEN] = "fetch the image again from who signed it",
        [TRUST_NO_IMAGE] = "`landmass-db verify` says more",
        [TRUST_UNREADABLE] = "check the medium",
        [TRUST_STOPPED] = "check it again"};
    return remedies[verdict];
}
