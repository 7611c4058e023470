#include "crypto.h"

#include <openssl/evp.h>

void trust_sha256_begin(struct trust_sha256 *s)
{
    s->ctx = EVP_MD_CTX_new();
    s->is_good = s->ctx && EVP_DigestInit_ex(s->ctx, EVP_sha256(), NULL) == 1;
}

void trust_sha256_add(struct trust_sha256 *s, const void *data, size_t bytes)
{
    s->is_good = s->is_good && EVP_DigestUpdate(s->ctx, data, bytes) == 1;
}

bool trust_sha256_end(struct trust_sha256 *s, uint8_t digest[TRUST_DIGEST_BYTES])
{
    unsigned int length = 0;
    const bool is_good = s->is_good && EVP_DigestFinal_ex(s->ctx, digest, &length) == 1 &&
                         length == TRUST_DIGEST_BYTES;
    EVP_MD_CTX_free(s->ctx);
    s->ctx = NULL;
    return is_good;
}

bool trust_ed25519_fits(const uint8_t key[TRUST_KEY_BYTES], const void *message, size_t bytes,
                        const uint8_t signature[TRUST_SIGNATURE_BYTES])
{
    EVP_PKEY *public = EVP_PKEY_new_raw_public_key(EVP_PKEY_ED25519, NULL, key, TRUST_KEY_BYTES);
    EVP_MD_CTX *ctx = EVP_MD_CTX_new();
    const bool fits = public && ctx && EVP_DigestVerifyInit(ctx, NULL, NULL, NULL, public) == 1 &&
                      EVP_DigestVerify(ctx, signature, TRUST_SIGNATURE_BYTES, message, bytes) == 1;
    EVP_MD_CTX_free(ctx);
    EVP_PKEY_free(public);
    return fits;
}

bool trust_ed25519_sign(const struct trust_signer *signer, const void *message, size_t bytes,
                        uint8_t signature[TRUST_SIGNATURE_BYTES])
{
    EVP_PKEY *private =
        EVP_PKEY_new_raw_private_key(EVP_PKEY_ED25519, NULL, signer->secret, TRUST_KEY_BYTES);
    EVP_MD_CTX *ctx = EVP_MD_CTX_new();
    size_t length = TRUST_SIGNATURE_BYTES;
    const bool is_good = private && ctx &&
                         EVP_DigestSignInit(ctx, NULL, NULL, NULL, private) == 1 &&
                         EVP_DigestSign(ctx, signature, &length, message, bytes) == 1 &&
                         length == TRUST_SIGNATURE_BYTES;
    EVP_MD_CTX_free(ctx);
    EVP_PKEY_free(private);
    return is_good;
}
