#include "head.h"

#include "fx/crc32c.h"
#include "hs/zero_bytes.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum trust_verdict trust_note(struct trust_result *r, enum trust_verdict verdict, uint64_t offset,
                              const char *cause, ...)
{
    va_list arguments;
    va_start(arguments, cause);
    vsnprintf(r->cause, sizeof r->cause, cause, arguments);
    va_end(arguments);
    r->verdict = verdict;
    r->offset = offset;
    return verdict;
}

const char *trust_section_name(uint32_t type)
{
    static const char *const names[LM_IMAGE_SECTION_TYPES] = {[LM_IMAGE_CLASSES] = "CLASSES",
                                                              [LM_IMAGE_BANDS] = "BANDS",
                                                              [LM_IMAGE_DIRECTORY] = "DIRECTORY",
                                                              [LM_IMAGE_TILES] = "TILES",
                                                              [LM_IMAGE_MANIFEST] = "MANIFEST",
                                                              [LM_IMAGE_TARGETS] = "TARGETS",
                                                              [LM_IMAGE_SIGNATURES] = "SIGNATURES",
                                                              [LM_IMAGE_GEOID] = "GEOID",
                                                              [LM_IMAGE_DETAIL] = "DETAIL",
                                                              [LM_IMAGE_RADAR] = "RADAR",
                                                              [LM_IMAGE_SEAL] = "SEAL",
                                                              [LM_IMAGE_BUS] = "BUS",
                                                              [LM_IMAGE_GEOID_PAGES] =
                                                                  "GEOID_PAGES"};
    return type < LM_IMAGE_SECTION_TYPES && names[type] ? names[type] : "of another version";
}

static uint64_t entry_place(uint32_t index)
{
    return offsetof(struct lm_image_header, sections) + index * sizeof(struct lm_image_section);
}

static enum trust_verdict check_header(const struct trust_reader *reader,
                                       const struct lm_image_header *h, struct trust_result *r)
{
    if (memcmp(h->magic, "LANDMASS", sizeof h->magic) != 0) {
        return trust_note(r, TRUST_NO_IMAGE, 0, "does not begin with LANDMASS");
    }
    if (h->version != LM_DB_VERSION) {
        return trust_note(r, TRUST_NO_IMAGE, offsetof(struct lm_image_header, version),
                          "an image of version %" PRIu32 " instead of %d", h->version,
                          LM_DB_VERSION);
    }
    if (fx_crc32c(0, h, offsetof(struct lm_image_header, crc)) != h->crc) {
        return trust_note(r, TRUST_NO_IMAGE, offsetof(struct lm_image_header, crc),
                          "the header's checksum does not fit it");
    }
    if (h->header_bytes != sizeof *h || h->section_count > LM_IMAGE_SECTIONS_MAX ||
        h->image_bytes < sizeof *h) {
        return trust_note(r, TRUST_NO_IMAGE, offsetof(struct lm_image_header, header_bytes),
                          "a field of the header is out of its range");
    }
    r->image_bytes = h->image_bytes;
    if (h->image_bytes > reader->size_bytes) {
        return trust_note(r, TRUST_BROKEN, reader->size_bytes,
                          "ends after %" PRIu64 " of its %" PRIu64 " bytes", reader->size_bytes,
                          h->image_bytes);
    }
    return TRUST_GOOD;
}

/* True if section a stands before b. Of two at one place the empty one is first. */
static bool is_before(const struct lm_image_section *a, const struct lm_image_section *b)
{
    return a->offset != b->offset ? a->offset < b->offset : a->bytes < b->bytes;
}

/* Order the sections; at most 32, so that the simplest way will do. */
static void sort(struct trust_head *head)
{
    const struct lm_image_section *s = head->header.sections;
    for (uint32_t i = 0; i < head->header.section_count; i++) {
        uint32_t place = i;
        for (; place > 0 && is_before(&s[i], &s[head->order[place - 1]]); place--) {
            head->order[place] = head->order[place - 1];
        }
        head->order[place] = (uint8_t)i;
    }
}

static enum trust_verdict check_places(struct trust_head *head, struct trust_result *r)
{
    const struct lm_image_header *h = &head->header;
    uint64_t end = sizeof *h;
    sort(head);
    for (uint32_t i = 0; i < h->section_count; i++) {
        const struct lm_image_section *s = &h->sections[head->order[i]];
        if (s->offset < end || s->offset > h->image_bytes ||
            s->bytes > h->image_bytes - s->offset) {
            return trust_note(r, TRUST_BROKEN, entry_place(head->order[i]),
                              "section %s lies outside the image or in another section",
                              trust_section_name(s->type));
        }
        end = s->offset + s->bytes;
    }
    return TRUST_GOOD;
}

/* Number of sections SEAL; *index is that of the last. */
static uint32_t find_seal(const struct lm_image_header *h, uint32_t *index)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < h->section_count; i++) {
        if (h->sections[i].type == LM_IMAGE_SEAL) {
            *index = i;
            count++;
        }
    }
    return count;
}

/* One digest for each other section, in the order of the table. */
static bool digests_fit(const struct trust_head *head)
{
    const struct lm_image_header *h = &head->header;
    for (uint32_t i = 0, k = 0; i < h->section_count; i++) {
        if (i != head->seal_index) {
            const struct trust_seal_digest *d = &head->seal.digest[k++];
            if (d->type != h->sections[i].type || d->reserved != 0) {
                return false;
            }
        }
    }
    return true;
}

/* Bring the bytes of the section into the struct, where the signature stands apart. */
static void unpack_seal(struct trust_seal *seal, const uint8_t *bytes, uint32_t count)
{
    const uint32_t before = trust_seal_signed_bytes(count);
    memset(seal, 0, sizeof *seal);
    memcpy(seal, bytes, before);
    memcpy(seal->signature, bytes + before, sizeof seal->signature);
}

static enum trust_verdict read_seal(struct trust_head *head, const struct trust_reader *reader,
                                    struct trust_result *r)
{
    const struct lm_image_section *s = &head->header.sections[head->seal_index];
    const uint32_t count = head->header.section_count - 1;
    uint8_t bytes[TRUST_SEAL_MAX_BYTES];
    if (s->bytes != trust_seal_bytes(count)) {
        return trust_note(r, TRUST_BROKEN, entry_place(head->seal_index),
                          "section SEAL has %" PRIu64 " bytes instead of %" PRIu32, s->bytes,
                          trust_seal_bytes(count));
    }
    const int cause = reader->read(reader->ctx, s->offset, bytes, (uint32_t)s->bytes);
    if (cause != 0) {
        return trust_note(r, TRUST_UNREADABLE, s->offset, "cannot be read: %s", strerror(cause));
    }
    unpack_seal(&head->seal, bytes, count);
    if (fx_crc32c(0, bytes, s->bytes) != s->crc) {
        return trust_note(r, TRUST_BROKEN, s->offset, "section SEAL: its checksum does not fit it");
    }
    if (head->seal.head.version != TRUST_SEAL_VERSION || head->seal.head.count != count ||
        !db_is_zero(head->seal.head.reserved, sizeof head->seal.head.reserved) ||
        !digests_fit(head)) {
        return trust_note(r, TRUST_BROKEN, s->offset,
                          "section SEAL: of another version, or of other sections than the image");
    }
    r->is_sealed = true;
    r->serial = head->seal.head.serial;
    memcpy(r->key, head->seal.head.key, sizeof r->key);
    return TRUST_GOOD;
}

enum trust_verdict trust_head_read(struct trust_head *head, const struct trust_reader *reader,
                                   struct trust_result *r)
{
    memset(r, 0, sizeof *r);
    memset(head, 0, sizeof *head);
    if (reader->size_bytes < sizeof head->header) {
        return trust_note(r, TRUST_NO_IMAGE, 0, "%" PRIu64 " bytes are too few for a header",
                          reader->size_bytes);
    }
    const int cause = reader->read(reader->ctx, 0, &head->header, sizeof head->header);
    if (cause != 0) {
        return trust_note(r, TRUST_UNREADABLE, 0, "cannot be read: %s", strerror(cause));
    }
    enum trust_verdict verdict = check_header(reader, &head->header, r);
    if (verdict == TRUST_GOOD) {
        verdict = check_places(head, r);
    }
    if (verdict != TRUST_GOOD) {
        return verdict;
    }
    const uint32_t seals = find_seal(&head->header, &head->seal_index);
    if (seals == 0) {
        return trust_note(r, TRUST_UNSIGNED, 0, "is not signed");
    }
    return seals == 1 ? read_seal(head, reader, r)
                      : trust_note(r, TRUST_BROKEN, entry_place(head->seal_index),
                                   "there is more than one section SEAL");
}
