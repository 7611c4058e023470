/* Cryptography, done by OpenSSL's libcrypto. */
#ifndef TRUST_CRYPTO_H
#define TRUST_CRYPTO_H

#include "trust/keys.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* SHA-256 of bytes that come piece by piece. */
struct trust_sha256 {
    void *ctx; /* owned; NULL without memory, which trust_sha256_end tells */
    bool is_good;
};

void trust_sha256_begin(struct trust_sha256 *s);
void trust_sha256_add(struct trust_sha256 *s, const void *data, size_t bytes);

/* The digest; frees the context. False if it could not be made: no memory. */
bool trust_sha256_end(struct trust_sha256 *s, uint8_t digest[TRUST_DIGEST_BYTES]);

/* True if `signature` is that of the message by the key. */
bool trust_ed25519_fits(const uint8_t key[TRUST_KEY_BYTES], const void *message, size_t bytes,
                        const uint8_t signature[TRUST_SIGNATURE_BYTES]);

/* Sign; false without memory. */
bool trust_ed25519_sign(const struct trust_signer *signer, const void *message, size_t bytes,
                        uint8_t signature[TRUST_SIGNATURE_BYTES]);

#endif
