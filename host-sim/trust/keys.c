#include "trust/keys.h"

#include "crypto.h"
#include "hs/error.h"
#include "hs/input_file.h"

#include <errno.h>
#include <openssl/crypto.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509.h>
#include <stdio.h>
#include <string.h>

static const char make_one[] = "`openssl genpkey -algorithm ed25519` makes a key";
static const char make_public[] =
    "`openssl pkey -in KEY -pubout -out PUBLIC` writes the public one";

/* The whole file. Returns its size, or -1 with the error reported. */
static int read_file(const char *path, char text[TRUST_KEY_FILE_BYTES])
{
    FILE *file = hs_input_open(path, "rb");
    if (!file) {
        return hs_error(path, "name a PEM file", "%s", strerror(errno));
    }
    errno = 0;
    const size_t size = fread(text, 1, TRUST_KEY_FILE_BYTES, file);
    const int cause = ferror(file) ? errno : 0;
    const bool is_whole = size < TRUST_KEY_FILE_BYTES;
    fclose(file);
    if (cause != 0) {
        return hs_error(path, "name a PEM file", "cannot be read: %s", strerror(cause));
    }
    return is_whole ? (int)size
                    : hs_error(path, "name a PEM file", "longer than %d bytes: no file of keys",
                               TRUST_KEY_FILE_BYTES - 1);
}

/* A public key in DER form. Returns 0, or -1 with the error reported. */
static int take_public(uint8_t key[TRUST_KEY_BYTES], const char *path, const uint8_t *der,
                       long der_bytes)
{
    size_t length = TRUST_KEY_BYTES;
    EVP_PKEY *public = d2i_PUBKEY(NULL, &der, der_bytes);
    int result = 0;
    if (!public) {
        result = hs_error(path, "write it again with openssl", "holds a damaged public key");
    } else if (EVP_PKEY_get_id(public) != EVP_PKEY_ED25519 ||
               EVP_PKEY_get_raw_public_key(public, key, &length) != 1 ||
               length != TRUST_KEY_BYTES) {
        const char *kind = EVP_PKEY_get0_type_name(public);
        result = hs_error(path, make_one, "holds a key of %s, not of Ed25519",
                          kind ? kind : "another kind");
    }
    EVP_PKEY_free(public);
    return result;
}

/* One block of a PEM file, `name` being what stands behind BEGIN. */
static int take_block(struct trust_keys *keys, const char *path, const char *name,
                      const uint8_t *der, long der_bytes)
{
    if (strstr(name, "PRIVATE KEY")) {
        return hs_error(path, make_public,
                        "holds a private key, which nobody but the signer needs");
    }
    if (strcmp(name, PEM_STRING_PUBLIC) != 0) {
        return hs_error(path, make_public, "holds a block %s, which is no public key", name);
    }
    if (keys->count == TRUST_KEYS_MAX) {
        return hs_error(path, "take out those that are not used any more",
                        "more than %d keys would be trusted", TRUST_KEYS_MAX);
    }
    if (take_public(keys->key[keys->count], path, der, der_bytes) != 0) {
        return -1;
    }
    keys->count++;
    return 0;
}

/* After the last block libcrypto finds no further begin; anything else is damage. */
static int at_end(const char *path, bool has_any)
{
    const unsigned long error = ERR_peek_last_error();
    const bool is_end = ERR_GET_REASON(error) == PEM_R_NO_START_LINE;
    ERR_clear_error();
    if (!is_end) {
        return hs_error(path, "write it again with openssl", "a damaged PEM file");
    }
    return has_any ? 0 : hs_error(path, make_public, "no PEM file: it has no `-----BEGIN`");
}

int trust_keys_load(struct trust_keys *keys, const char *path)
{
    char text[TRUST_KEY_FILE_BYTES], *name, *head;
    uint8_t *der;
    long der_bytes;
    struct trust_keys all = *keys;
    const int size = read_file(path, text);
    BIO *bio = size < 0 ? NULL : BIO_new_mem_buf(text, size);
    if (!bio) {
        return size < 0 ? -1 : hs_error(path, NULL, "out of memory");
    }
    int result = 0;
    ERR_clear_error();
    while (result == 0 && PEM_read_bio(bio, &name, &head, &der, &der_bytes) == 1) {
        result = take_block(&all, path, name, der, der_bytes);
        OPENSSL_free(name);
        OPENSSL_free(head);
        OPENSSL_clear_free(der, (size_t)der_bytes);
    }
    BIO_free(bio);
    result = result == 0 ? at_end(path, all.count > keys->count) : -1;
    if (result == 0) {
        *keys = all;
    }
    return result;
}

bool trust_keys_have(const struct trust_keys *keys, const uint8_t key[TRUST_KEY_BYTES])
{
    for (uint32_t i = 0; i < keys->count; i++) {
        if (memcmp(keys->key[i], key, TRUST_KEY_BYTES) == 0) {
            return true;
        }
    }
    return false;
}

/* What the key was asked for, so that the error says the right thing. */
struct password {
    const char *text; /* NULL: none was given */
    bool is_asked;
};

static int give_password(char *to, int room, int is_writing, void *ctx)
{
    struct password *p = ctx;
    (void)is_writing;
    p->is_asked = true;
    const size_t length = p->text ? strlen(p->text) : 0;
    if (length == 0 || length > (size_t)room) {
        return -1;
    }
    memcpy(to, p->text, length);
    return (int)length;
}

static int take_private(struct trust_signer *signer, const char *path, EVP_PKEY *private,
                        const struct password *p)
{
    size_t secret_bytes = TRUST_KEY_BYTES, key_bytes = TRUST_KEY_BYTES;
    if (!private && p->is_asked) {
        return hs_error(path, p->text ? "give its own" : "give --password FILE",
                        p->text ? "its password is another one" : "the key has a password");
    }
    if (!private) {
        return hs_error(path, make_one, "holds no private key in PEM form");
    }
    if (EVP_PKEY_get_id(private) != EVP_PKEY_ED25519 ||
        EVP_PKEY_get_raw_private_key(private, signer->secret, &secret_bytes) != 1 ||
        EVP_PKEY_get_raw_public_key(private, signer->key, &key_bytes) != 1) {
        const char *kind = EVP_PKEY_get0_type_name(private);
        return hs_error(path, make_one, "holds a key of %s, not of Ed25519",
                        kind ? kind : "another kind");
    }
    return 0;
}

/* The first line of a file, without its end. */
static int read_password(const char *path, char text[TRUST_KEY_FILE_BYTES])
{
    const int size = read_file(path, text);
    if (size < 0) {
        return -1;
    }
    text[size] = '\0';
    text[strcspn(text, "\r\n")] = '\0';
    return text[0] ? 0 : hs_error(path, "write the password into its first line", "is empty");
}

int trust_signer_load(struct trust_signer *signer, const char *path, const char *password_path)
{
    char text[TRUST_KEY_FILE_BYTES], secret[TRUST_KEY_FILE_BYTES];
    struct password password = {password_path ? secret : NULL, false};
    memset(signer, 0, sizeof *signer);
    int result = password_path && read_password(password_path, secret) != 0 ? -1 : 0;
    const int size = result == 0 ? read_file(path, text) : -1;
    if (size >= 0) {
        BIO *bio = BIO_new_mem_buf(text, size);
        EVP_PKEY *private =
            bio ? PEM_read_bio_PrivateKey(bio, NULL, give_password, &password) : NULL;
        result = take_private(signer, path, private, &password);
        EVP_PKEY_free(private);
        BIO_free(bio);
        ERR_clear_error();
    } else {
        result = -1;
    }
    OPENSSL_cleanse(text, sizeof text);
    OPENSSL_cleanse(secret, sizeof secret);
    return result;
}

void trust_signer_forget(struct trust_signer *signer)
{
    OPENSSL_cleanse(signer, sizeof *signer);
}

void trust_fingerprint(const uint8_t key[TRUST_KEY_BYTES], char text[TRUST_FINGERPRINT_TEXT])
{
    /* What stands before the 32 bytes in the DER form of every key of Ed25519 (RFC 8410). */
    static const uint8_t prefix[] = {0x30, 0x2a, 0x30, 0x05, 0x06, 0x03,
                                     0x2b, 0x65, 0x70, 0x03, 0x21, 0x00};
    uint8_t digest[TRUST_DIGEST_BYTES] = {0};
    struct trust_sha256 sha;
    trust_sha256_begin(&sha);
    trust_sha256_add(&sha, prefix, sizeof prefix);
    trust_sha256_add(&sha, key, TRUST_KEY_BYTES);
    (void)trust_sha256_end(&sha, digest); /* without memory: zeros, which are nobody's */
    for (int i = 0; i < TRUST_DIGEST_BYTES; i++) {
        snprintf(text + 2 * i, 3, "%02x", digest[i]);
    }
}
