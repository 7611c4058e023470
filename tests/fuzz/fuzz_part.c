/* Parts of an image: a sound part of two tiles is made, the input overwrites some of its bytes, and
 * its checksums are corrected where the first byte says so. Whatever opens can be taken from. */
#include "build/part.h"
#include "fuzz.h"
#include "fx/crc32c.h"

#include <string.h>
#include <unistd.h>

const uint32_t fuzz_mutations = 500;

static const struct build_shard shard = {
    .level = 1, .zone = 0, .row0 = 10, .rows = 1, .column0 = 20, .columns = 1};

/* The bytes of a sound part; made once. */
static const uint8_t *sound_part(size_t *size)
{
    static uint8_t *bytes;
    static size_t count;
    if (!bytes) {
        char path[64], key[IMAGE_SHA256_TEXT] = "key";
        struct build_part_writer w;
        struct build_context *b = calloc(1, sizeof *b);
        struct build_tile *t = calloc(1, sizeof *t);
        snprintf(path, sizeof path, "/tmp/fuzz-part-%d", (int)getpid());
        FUZZ_ASSERT(b && t && build_part_begin(&w, path, &shard, 0, 1, key) == 0);
        t->record.row = 20;
        t->record.column = 40;
        FUZZ_ASSERT(build_part_put(&w, 7, t, false) == 0);
        t->record = (struct lm_tile){.lod = 1, .row = 10, .column = 20};
        FUZZ_ASSERT(build_part_put(&w, 8, t, true) == 0 && build_part_end(&w, b) == 0);
        FILE *file = fopen(path, "rb");
        FUZZ_ASSERT(file && (bytes = malloc(1 << 20)));
        count = fread(bytes, 1, 1 << 20, file);
        fclose(file);
        unlink(path);
        free(t);
        free(b);
    }
    *size = count;
    return bytes;
}

/* Three bytes of a place and one of a value, again and again; places count from the header, and
 * from the end where the highest bit is set. */
static bool overwrite(uint8_t *part, size_t bytes, const uint8_t *data, size_t size)
{
    bool is_body_changed = false;
    for (size_t i = 1; i + 4 <= size; i += 4) {
        const size_t at =
            (size_t)data[i] | (size_t)data[i + 1] << 8 | (size_t)(data[i + 2] & 0x7f) << 16;
        const size_t place = data[i + 2] & 0x80 ? bytes - 1 - at % bytes : at % bytes;
        part[place] = data[i + 3];
        is_body_changed |= place >= BUILD_PART_HEADER_BYTES;
    }
    return is_body_changed;
}

static void seal(uint8_t *part, size_t bytes, uint8_t how, bool is_body_changed)
{
    struct build_part_head head;
    if ((how & 1) && is_body_changed) { /* a sum of all the body, and many inputs leave it alone */
        char digest[IMAGE_SHA256_TEXT];
        struct image_sha256 sha;
        image_sha256_begin(&sha);
        image_sha256_add(&sha, part + BUILD_PART_HEADER_BYTES, bytes - BUILD_PART_HEADER_BYTES);
        image_sha256_end(&sha, digest);
        memcpy(part + offsetof(struct build_part_head, body_sha256), digest,
               sizeof head.body_sha256);
    }
    if (how & 2) {
        const uint32_t crc = fx_crc32c(0, part, BUILD_PART_HEADER_BYTES - sizeof crc);
        memcpy(part + BUILD_PART_HEADER_BYTES - sizeof crc, &crc, sizeof crc);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    size_t bytes;
    const uint8_t *sound = sound_part(&bytes);
    uint8_t *part = malloc(bytes);
    struct lm_tile *record = malloc(sizeof *record);
    struct build_tile *tile = malloc(sizeof *tile);
    struct fuzz_file file;
    struct build_part p;
    FUZZ_ASSERT(part && record && tile);
    memcpy(part, sound, bytes);
    const bool is_body_changed = overwrite(part, bytes, data, size);
    seal(part, bytes, size > 0 ? data[0] : 3, is_body_changed);
    fuzz_file_open(&file, part, bytes);
    if (build_part_open(&p, file.path) == 0) {
        for (uint32_t entry = 0; entry < 16; entry++) {
            const int level = entry == 8;
            const struct image_frame f = {.row = level ? 10 : 20, .column = level ? 20 : 40};
            const int taken = build_part_take(&p, entry, &f, level, record, level ? tile : NULL);
            FUZZ_ASSERT(taken <= 1 && (size > 1 || taken == (entry == 7 || entry == 8)));
            FUZZ_ASSERT(taken < 1 || record->post_shift <= LM_TILE_POST_SHIFT_MAX);
        }
        build_part_close(&p);
    } else {
        FUZZ_ASSERT(size > 4);
    }
    fuzz_file_close(&file);
    free(tile);
    free(record);
    free(part);
    return 0;
}
