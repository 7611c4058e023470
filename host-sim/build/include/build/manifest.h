/* Manifest of an image: the section MANIFEST, which names the inputs that the image was made from,
 * as `key: value` lines (docs/FORMATS.md). */
#ifndef BUILD_MANIFEST_H
#define BUILD_MANIFEST_H

#include "hs/class_table.h"
#include "hs/options.h"
#include "image/sha256.h"

#include <gdal.h>
#include <stdint.h>
#include <stdio.h>

struct build_manifest {
    const char *text_of_options; /* "key: value" lines of the choices made */
    const struct db_class_table *table;
    uint32_t seed;
};

/* Write builder, seed, choices and class table. */
void build_manifest_head(FILE *out, const struct build_manifest *m);

/* Size and digest of a file. Returns 0, or -1, unreported, when it cannot be read. */
int build_manifest_hash(const char *path, uint64_t *bytes, char digest[IMAGE_SHA256_TEXT]);

/* "input: ROLE NAME BYTES SHA256" for a file, without its folder: the same inputs give the same
 * image wherever they lie. Returns 0, or -1 with the error reported. */
int build_manifest_file(FILE *out, const char *role, const char *path);

/* The same for every file that an open dataset reads from. */
int build_manifest_dataset(FILE *out, const char *role, GDALDatasetH dataset);

#endif
