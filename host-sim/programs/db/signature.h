/* What the commands tell of an image's signature. */
#ifndef DB_SIGNATURE_H
#define DB_SIGNATURE_H

#include "image/reader.h"
#include "trust/verify.h"

/* Look at header and seal alone, print a line, and report it as `signature`. */
void db_signature_print(const struct image *image);

/* Check the signature of the whole image by the public keys in `key_path`, print a line and report
 * it. NULL: whose it is does not matter, and there need not be one. Returns 0, or -1 with the error
 * reported: it is not signed, not by one of these keys, does not fit, or the keys cannot be read.
 */
int db_signature_check(const struct image *image, const char *path, const char *key_path);

#endif
