/* A small image with every kind of section, keys made by openssl, and the image signed. */
#ifndef SIGNED_H
#define SIGNED_H

#include "trust/sign.h"
#include "trust/verify.h"

#include <stddef.h>
#include <stdint.h>

/* Make the folder anew, the image `image.lmdb` in it, the key pairs `a.pem`, `a.pub` and `b.pem`,
 * `b.pub`, and `signed.lmdb`, signed by a with serial number 7. For cmocka's group set-up. */
int signed_open(void **state);

/* The path of a file in the folder. The same few buffers are used in turn. */
const char *signed_path(const char *name);

/* Run a command of the shell in that folder; the test fails if it does. */
void signed_run(const char *command);

/* A whole file; the caller frees it. */
uint8_t *signed_read(const char *name, size_t *size);
void signed_write(const char *name, const void *bytes, size_t size);

/* Verify bytes in memory by the public key `key` ("a.pub"). */
enum trust_verdict signed_judge(const uint8_t *bytes, size_t size, const char *key,
                                struct trust_result *r);

/* Put the checksums of header and section SEAL right. */
void signed_repair(uint8_t *bytes);

/* The section of a type; NULL if there is none. */
const struct lm_image_section *signed_section(const uint8_t *bytes, uint32_t type);

#endif
