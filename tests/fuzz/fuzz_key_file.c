/* Any bytes as a PEM file of keys. What is accepted as public keys is counted right and has a
 * fingerprint; what is refused leaves the keys as they were; what is a private key signs. */
#include "fuzz.h"

#include "crypto.h"
#include "trust/keys.h"

#include <openssl/crypto.h>
#include <openssl/err.h>
#include <openssl/pem.h>

const uint32_t fuzz_mutations = 4000;

/* Whether there is a sound block of a private key. To look for one as trust_signer_load does takes
 * libcrypto longer than all the rest. */
static bool has_private_key(const uint8_t *data, size_t size)
{
    BIO *bio = size == 0 ? NULL : BIO_new_mem_buf(data, (int)size);
    char *name, *head;
    uint8_t *der;
    long der_bytes;
    bool is_there = false;
    while (bio && !is_there && PEM_read_bio(bio, &name, &head, &der, &der_bytes) == 1) {
        is_there = strstr(name, "PRIVATE KEY") != NULL;
        OPENSSL_free(name);
        OPENSSL_free(head);
        OPENSSL_free(der);
    }
    BIO_free(bio);
    ERR_clear_error();
    return is_there;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint8_t message[] = "message";
    struct trust_keys keys = {1, {{7}}};
    struct trust_signer signer;
    struct fuzz_file file;
    fuzz_file_open(&file, data, size);
    const int result = trust_keys_load(&keys, file.path);
    FUZZ_ASSERT(keys.key[0][0] == 7 && keys.count <= TRUST_KEYS_MAX);
    FUZZ_ASSERT(result == 0 ? keys.count > 1 : keys.count == 1);
    for (uint32_t i = 1; i < keys.count; i++) {
        char text[TRUST_FINGERPRINT_TEXT];
        trust_fingerprint(keys.key[i], text);
        FUZZ_ASSERT(strlen(text) == TRUST_FINGERPRINT_TEXT - 1 &&
                    trust_keys_have(&keys, keys.key[i]));
    }
    if ((size % 32 == 0 || has_private_key(data, size)) &&
        trust_signer_load(&signer, file.path, NULL) == 0) {
        uint8_t signature[TRUST_SIGNATURE_BYTES];
        FUZZ_ASSERT(result != 0); /* a private key is never taken for a public one */
        FUZZ_ASSERT(trust_ed25519_sign(&signer, message, sizeof message, signature));
        FUZZ_ASSERT(trust_ed25519_fits(signer.key, message, sizeof message, signature));
    }
    trust_signer_forget(&signer);
    fuzz_file_close(&file);
    return 0;
}
