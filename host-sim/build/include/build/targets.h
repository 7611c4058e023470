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

/* Read a file of targets, and the signatures that it names. Returns 0, or -1 with file, line, cause
 * and remedy reported and nothing to free:
 * - a file cannot be read, or a line is none of the forms of docs/targets.md,
 * - a number is out of its range, or a name is too long or stands twice,
 * - there are too many targets, scatterers, legs or libraries,
 * - a leg is too short, too long or goes over a pole. */
int build_targets_read(struct build_targets *t, const char *path);
/* Harmless on a zeroed struct. */
void build_targets_free(struct build_targets *t);

/* The bytes of the section, head and records; the caller frees them. NULL when memory ran out. */
void *build_targets_section(const struct build_targets *t, size_t *bytes);

#endif
