/* Any bytes as a PEM file of keys. What is accepted as public keys is counted right and has a
 * fingerprint; what is refused leaves the keys as they were; what is a private key signs. */
#include "fuzz.h"

#include "crypto.h"
#include "trust/keys.h"

const uint32_t fuzz_mutations = 4000;

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
    if (trust_signer_load(&signer, file.path, NULL) == 0) {
        uint8_t signature[TRUST_SIGNATURE_BYTES];
        FUZZ_ASSERT(result != 0); /* a private key is never taken for a public one */
        FUZZ_ASSERT(trust_ed25519_sign(&signer, message, sizeof message, signature));
        FUZZ_ASSERT(trust_ed25519_fits(signer.key, message, sizeof message, signature));
    }
    trust_signer_forget(&signer);
    fuzz_file_close(&file);
    return 0;
}
