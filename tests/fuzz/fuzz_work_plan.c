/* Work plans of landmass-db: what is accepted lies in range, and is the same when it is written and
 * read again. Its last line, a checksum, is corrected first. */
#include "build/work.h"
#include "fuzz.h"

#include <string.h>

const uint32_t fuzz_mutations = 20000;

/* The input with a new last line, where it has one. The caller frees it. */
static char *seal_plan(const uint8_t *data, size_t size, size_t *bytes)
{
    static const char end[] = "\nend ";
    const uint8_t *last = size > 0 ? memmem(data, size, end, sizeof end - 1) : NULL;
    const size_t kept = last ? (size_t)(last - data) + 1 : size;
    struct image_sha256 sha;
    char digest[IMAGE_SHA256_TEXT], *text = malloc(kept + 80);
    FUZZ_ASSERT(text);
    image_sha256_begin(&sha);
    image_sha256_add(&sha, data, kept);
    image_sha256_end(&sha, digest);
    if (kept > 0) {
        memcpy(text, data, kept);
    }
    *bytes = kept + (last ? (size_t)sprintf(text + kept, "end %s\n", digest) : 0);
    return text;
}

static void check(const struct build_work *w)
{
    FUZZ_ASSERT(w->shard_count > 0 && w->shard_count <= BUILD_SHARDS_MAX && w->manifest);
    FUZZ_ASSERT(w->heights_dm[0] == 0);
    for (int i = 0; i < w->shard_count; i++) {
        const struct build_shard *s = &w->shards[i].place;
        FUZZ_ASSERT(s->level < LM_DB_LODS_MAX && s->zone <= 3 && s->rows > 0 && s->columns > 0);
        FUZZ_ASSERT(strlen(w->shards[i].key) == 64);
    }
    for (int i = 0; i < w->source_count; i++) {
        const struct image_area *a = &w->sources[i].area;
        FUZZ_ASSERT(a->south <= a->north && a->width >= 0 && a->width <= IMAGE_BAM_ROUND);
        FUZZ_ASSERT(w->sources[i].path[0]);
    }
}

static char *written(const struct build_work *w)
{
    char *text = NULL;
    size_t bytes = 0;
    FILE *out = open_memstream(&text, &bytes);
    FUZZ_ASSERT(out && build_work_write(w, out) == 0 && fclose(out) == 0);
    return text;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file, again;
    struct build_work first, second;
    size_t bytes;
    char *sealed = seal_plan(data, size, &bytes);
    fuzz_file_open(&file, (const uint8_t *)sealed, bytes);
    if (build_work_read(&first, file.path) == 0) {
        check(&first);
        char *one = written(&first);
        fuzz_file_open(&again, (const uint8_t *)one, strlen(one));
        FUZZ_ASSERT(build_work_read(&second, again.path) == 0);
        char *two = written(&second);
        FUZZ_ASSERT(strcmp(one, two) == 0);
        build_work_free(&second);
        build_work_free(&first);
        fuzz_file_close(&again);
        free(one);
        free(two);
    }
    fuzz_file_close(&file);
    free(sealed);
    return 0;
}
