/* Seal of a flash image: the section SEAL, which signs it (docs/FORMATS.md, 1.14).
 *
 *     head | digest[count] | signature
 *
 * The signature is Ed25519 (RFC 8032) over the header of the image, with its own checksum and that
 * of the section SEAL taken as zero, and the seal up to the signature. The digests are the SHA-256
 * of every other section, and between sections there is nothing but zeros: so each bit of the image
 * is signed. */
#ifndef TRUST_SEAL_H
#define TRUST_SEAL_H

#include "lm/image.h"

#include <stdint.h>

enum {
    TRUST_SEAL_VERSION = 1,
    TRUST_DIGEST_BYTES = 32,
    TRUST_KEY_BYTES = 32,
    TRUST_SIGNATURE_BYTES = 64,
    TRUST_DIGESTS_MAX = LM_IMAGE_SECTIONS_MAX - 1
};

struct trust_seal_head {
    uint32_t version, count;      /* TRUST_SEAL_VERSION; number of digests */
    uint64_t serial;              /* grows from image to image */
    uint8_t key[TRUST_KEY_BYTES]; /* public key that the signature is by */
    uint8_t reserved[16];         /* zero */
};

/* One for each section but SEAL, in the order of the header's table. */
struct trust_seal_digest {
    uint32_t type, reserved; /* of the section; zero */
    uint8_t sha256[TRUST_DIGEST_BYTES];
};
_Static_assert(sizeof(struct trust_seal_head) == 64 && sizeof(struct trust_seal_digest) == 40,
               "the seal must be what FORMATS.md says");

struct trust_seal {
    struct trust_seal_head head;
    struct trust_seal_digest digest[TRUST_DIGESTS_MAX]; /* head.count of them */
    uint8_t signature[TRUST_SIGNATURE_BYTES];
};

enum {
    TRUST_SEAL_MAX_BYTES = sizeof(struct trust_seal),
    TRUST_MESSAGE_MAX_BYTES = LM_DB_HEADER_BYTES + TRUST_SEAL_MAX_BYTES
};

/* Size of the section SEAL with so many digests, and how much of it is signed. */
uint32_t trust_seal_bytes(uint32_t count);
uint32_t trust_seal_signed_bytes(uint32_t count);

/* What is signed: writes it to `message` and returns its size. `seal_index` is the place of SEAL in
 * the header's table; seal->head.count is at most TRUST_DIGESTS_MAX. */
uint32_t trust_seal_message(const struct lm_image_header *header, uint32_t seal_index,
                            const struct trust_seal *seal,
                            uint8_t message[TRUST_MESSAGE_MAX_BYTES]);

#endif
