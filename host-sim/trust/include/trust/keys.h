/* Keys of Ed25519 (RFC 8032), read from PEM files as OpenSSL writes them:
 *
 *     openssl genpkey -algorithm ed25519 -out signing.pem
 *     openssl pkey -in signing.pem -pubout -out public.pem
 */
#ifndef TRUST_KEYS_H
#define TRUST_KEYS_H

#include "trust/seal.h"

#include <stdbool.h>
#include <stdint.h>

enum {
    TRUST_KEYS_MAX = 8,
    TRUST_KEY_FILE_BYTES = 16 << 10, /* a longer file is refused */
    TRUST_FINGERPRINT_TEXT = 65
};

/* Public keys that are trusted. */
struct trust_keys {
    uint32_t count;
    uint8_t key[TRUST_KEYS_MAX][TRUST_KEY_BYTES];
};

/* A private key, with its public one. */
struct trust_signer {
    uint8_t secret[TRUST_KEY_BYTES], key[TRUST_KEY_BYTES];
};

/* Add the public keys of a PEM file, one or several, to *keys. Returns 0, or -1 with the error
 * reported and *keys as it was:
 * - the file cannot be read, is longer than TRUST_KEY_FILE_BYTES, or is no PEM file,
 * - it holds something else than public keys of Ed25519; a private key is named as such,
 * - there would be more than TRUST_KEYS_MAX. */
int trust_keys_load(struct trust_keys *keys, const char *path);

bool trust_keys_have(const struct trust_keys *keys, const uint8_t key[TRUST_KEY_BYTES]);

/* Read the private key of a PEM file. `password_path` names a file whose first line is its
 * password; NULL: it has none. Returns 0, or -1 with the error reported:
 * - a file cannot be read, or holds no private key of Ed25519,
 * - the key has a password and none, or a wrong one, was given.
 * trust_signer_forget wipes it. */
int trust_signer_load(struct trust_signer *signer, const char *path, const char *password_path);
void trust_signer_forget(struct trust_signer *signer);

/* Fingerprint of a public key in hexadecimal: the SHA-256 of its DER form, as
 * `openssl pkey -pubin -in public.pem -outform DER | sha256sum` prints it. */
void trust_fingerprint(const uint8_t key[TRUST_KEY_BYTES], char text[TRUST_FINGERPRINT_TEXT]);

#endif
