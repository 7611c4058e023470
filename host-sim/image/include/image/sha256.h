/* SHA-256 (FIPS 180-4), by which the manifest names its inputs and sections. Usage: begin, add as
 * often as needed, end. OpenSSL's libcrypto does the work, by the functions whose state lies in the
 * caller's struct: a digest can be copied and given up, and none can fail. */
#ifndef IMAGE_SHA256_H
#define IMAGE_SHA256_H

#define OPENSSL_API_COMPAT 0x10101000L /* OpenSSL 3 calls these functions deprecated */

#include <openssl/sha.h>
#include <stddef.h>
#include <stdint.h>

enum { IMAGE_SHA256_BYTES = 32, IMAGE_SHA256_TEXT = 2 * IMAGE_SHA256_BYTES + 1 };

struct image_sha256 {
    SHA256_CTX state;
};

/* Start a digest, and add bytes to it. */
void image_sha256_begin(struct image_sha256 *s);
void image_sha256_add(struct image_sha256 *s, const void *data, size_t length_bytes);

/* The digest in hexadecimal, lower case, with a terminating zero. The context is used up. */
void image_sha256_end(struct image_sha256 *s, char text[IMAGE_SHA256_TEXT]);

#endif
