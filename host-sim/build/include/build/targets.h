/* Targets for an image that is being built: a text file (docs/targets.md) in, the section TARGETS
 * out. Those of a finished image: image/targets.h. */
#ifndef BUILD_TARGETS_H
#define BUILD_TARGETS_H

#include "build/signatures.h"
#include "lm/target.h"

#include <stddef.h>
#include <stdint.h>

struct build_targets {
    struct lm_target *items; /* owned; sealed, id = place in the file */
    uint32_t count;
    struct build_signatures signatures; /* owned: of its `library` lines */
};

/* Read a file of targets, and the signatures that it names. Returns 0, or -1 with the error
 * reported and nothing to free. */
int build_targets_read(struct build_targets *t, const char *path);
void build_targets_free(struct build_targets *t);

/* The bytes of the section, head and records; the caller frees them. NULL when memory ran out. */
void *build_targets_section(const struct build_targets *t, size_t *bytes);

#endif
