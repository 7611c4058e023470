/* Work plan of an image that is made in shards: a text (docs/FORMATS.md, section 9) that says from
 * which options and sources it is made, how it is cut, and by which key each shard is known. Not
 * the plan of its levels, which is build/plan.h. */
#ifndef BUILD_WORK_H
#define BUILD_WORK_H

#include "build/shard.h"
#include "image/sha256.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

enum { BUILD_WORK_VERSION = 1, BUILD_WORK_OPTIONS_MAX = 512, BUILD_WORK_SOURCES_MAX = 65536 };

/* A file that the image is made from. */
struct build_source {
    char role[24];          /* terrain, class-raster ... */
    struct image_area area; /* where it matters */
    uint64_t bytes;
    int64_t changed; /* when it was, seconds since 1970 */
    char sha256[IMAGE_SHA256_TEXT];
    char *path; /* owned */
};

struct build_work_shard {
    struct build_shard place;
    uint64_t tiles; /* at most so many */
    uint32_t memory_mib;
    char key[IMAGE_SHA256_TEXT]; /* of all that its tiles are made from */
};

struct build_work {
    char *options[BUILD_WORK_OPTIONS_MAX]; /* owned: "--name=value" or "--flag", of `build` */
    int option_count;
    char grid_sha256[IMAGE_SHA256_TEXT]; /* of levels and bands */
    uint16_t heights_dm[16];
    bool has_voids;               /* in the terrain */
    char *manifest;               /* owned: of the image, without what is known at its end */
    struct build_source *sources; /* owned */
    int source_count;
    struct build_work_shard *shards; /* owned */
    int shard_count;
};

/* Add a source, whose path is copied. Returns 0, or -1 with the error reported. */
int build_work_add_source(struct build_work *w, const struct build_source *source);

/* Write a plan, or read one. Each line is checked. Reading returns 0, or -1 with file, line, cause
 * and remedy reported and nothing to free:
 * - the file cannot be read, is no plan or one of another version,
 * - a line is of no known form, or a number is outside its range,
 * - its last line, a checksum of the others, is wrong or missing. */
int build_work_write(const struct build_work *w, FILE *out);
int build_work_read(struct build_work *w, const char *path);
/* Harmless on a zeroed struct. */
void build_work_free(struct build_work *w);

/* The digest of levels and bands. */
void build_work_grid(const struct build_plan *plan, char sha256[IMAGE_SHA256_TEXT]);

/* Look whether sources, those with counts[i] or with NULL all, are those of the plan: by size and
 * time, and by their bytes where the time differs. Returns 0, or -1 with the file reported. */
int build_work_check_sources(const struct build_work *w, const bool *counts);

#endif
