/* Signatures for an image that is being built: files .sig in, the section SIGNATURES out. Those of
 * a finished image: image/signatures.h. */
#ifndef BUILD_SIGNATURES_H
#define BUILD_SIGNATURES_H

#include "hs/signature_file.h"

#include <stddef.h>
#include <stdint.h>

struct build_signatures {
    struct db_signature items[LM_DB_SIGNATURES_MAX]; /* owned */
    char *paths[LM_DB_SIGNATURES_MAX];               /* owned: where each came from */
    uint32_t count;
};

/* The number of the signature of that name, or -1. */
int build_signatures_find(const struct build_signatures *s, const char *name);

/* Read a file as one more signature, there being room, under a new name of up to 16 letters.
 * Returns 0, or -1 with the error reported and nothing added. */
int build_signatures_add(struct build_signatures *s, const char *name, const char *path);

/* Number and seal all, and put them into the bytes of a section, which the caller frees. NULL when
 * memory ran out. */
void *build_signatures_section(struct build_signatures *s, size_t *bytes);

/* Harmless on a zeroed struct. */
void build_signatures_free(struct build_signatures *s);

#endif
