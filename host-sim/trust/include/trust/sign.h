/* Signing of an image: a copy of it with a seal (trust/seal.h). */
#ifndef TRUST_SIGN_H
#define TRUST_SIGN_H

#include "trust/keys.h"

#include <stdint.h>

/* Write the image `from` again as `to`, signed with this serial number. Its sections stay as they
 * are; a seal that it has is replaced. Whether the image is any good is not looked at. Returns 0,
 * or -1 with the error reported and `to` as it was:
 * - `from` cannot be read, is no image of this version, or is cut short,
 * - it has 32 sections, or a seal that does not stand at its end,
 * - `to` cannot be written, or there is no memory. */
int trust_sign_image(const char *from, const char *to, const struct trust_signer *signer,
                     uint64_t serial);

#endif
