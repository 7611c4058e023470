/* Signature of an image: is it signed, by whom, and is each bit of it what was signed?
 *
 *     struct trust_reader reader;
 *     struct trust_result result;
 *     trust_reader_of_file(&reader, fd, size_bytes);
 *     if (trust_verify(&reader, &keys, NULL, NULL, &result) == TRUST_GOOD) ...
 *
 * Any bytes are safe. Nothing is allocated that grows with the image. Not for the loop that draws:
 * it waits for the medium. */
#ifndef TRUST_VERIFY_H
#define TRUST_VERIFY_H

#include "trust/keys.h"
#include "trust/seal.h"

#include <stdbool.h>
#include <stdint.h>

#include "lm/port.h"

/* Where the image is. */
struct trust_reader {
    void *ctx;
    uint64_t size_bytes; /* of file or device: the image is not longer */
    /* Read `bytes` from `offset`, inside size_bytes. 0, or an errno. */
    int (*read)(void *ctx, uint64_t offset, void *to, uint32_t bytes);
};

/* A file or block device; the descriptor stays the caller's, and its position is not used. */
void trust_reader_of_file(struct trust_reader *reader, int descriptor, uint64_t size_bytes);

/* A flash, borrowed, that answers each read within its first poll. */
void trust_reader_of_flash(struct trust_reader *reader, const struct lm_flash *flash);

enum trust_verdict {
    TRUST_GOOD,       /* signed by one of the keys, and all that was read is what was signed */
    TRUST_FOREIGN,    /* likewise, but by a key that is none of them */
    TRUST_UNSIGNED,   /* an image without a seal */
    TRUST_BROKEN,     /* has a seal that does not fit: damaged, changed, or cut short */
    TRUST_NO_IMAGE,   /* not an image of this version, or its header is damaged */
    TRUST_UNREADABLE, /* the medium failed */
    TRUST_STOPPED     /* the caller stopped it */
};

enum { TRUST_CAUSE_BYTES = 128 };

struct trust_result {
    enum trust_verdict verdict;
    bool is_sealed; /* serial and key say something, be they true or not */
    uint64_t serial;
    uint8_t key[TRUST_KEY_BYTES];  /* that the seal names */
    uint64_t image_bytes;          /* of the whole image; 0 of none */
    uint64_t offset;               /* place of what is wrong */
    char cause[TRUST_CAUSE_BYTES]; /* what is wrong, in words: "section TILES is not what was
                                      signed" */
};

/* Told how far it is, at least once a megabyte. False stops it. */
typedef bool trust_progress(void *ctx, uint64_t done_bytes, uint64_t all_bytes);

/* Check the whole image, reading it once from its begin to its end. `keys` may be empty: then no
 * image is TRUST_GOOD. `progress` may be NULL. Returns result->verdict. */
enum trust_verdict trust_verify(const struct trust_reader *reader, const struct trust_keys *keys,
                                trust_progress *progress, void *ctx, struct trust_result *result);

/* The same for header and seal alone, at most 3 KiB: whether the signature fits them, which image
 * this is, and its serial number. The sections are not looked at, so that TRUST_GOOD says nothing
 * about them yet. */
enum trust_verdict trust_identify(const struct trust_reader *reader, const struct trust_keys *keys,
                                  struct trust_result *result);

/* What to do about a verdict, for messages; NULL for TRUST_GOOD. In static memory. */
const char *trust_remedy(enum trust_verdict verdict);

#endif
