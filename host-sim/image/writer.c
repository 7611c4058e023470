#include "image/writer.h"

#include "image/border.h"

#include "fx/crc32c.h"
#include "hs/error.h"
#include "hs/progress.h"
#include "hs/team.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

static uint64_t aligned(uint64_t offset)
{
    const uint64_t a = LM_IMAGE_SECTION_ALIGNMENT;
    return (offset + a - 1) / a * a;
}

static int write_failed(const struct image_writer *w)
{
    return hs_error(w->file.path, "free some space and run again", "cannot be written: %s",
                    strerror(errno));
}

static int put(struct image_writer *w, const void *data, size_t bytes)
{
    if (bytes > 0 && fwrite(data, 1, bytes, w->file.stream) != bytes) {
        return write_failed(w);
    }
    return 0;
}

/* Zeros up to `offset`, which is less than a section's alignment away. */
static int pad_to(struct image_writer *w, uint64_t offset)
{
    static const uint8_t zeros[LM_IMAGE_SECTION_ALIGNMENT];
    const off_t here = ftello(w->file.stream);
    return here < 0 ? write_failed(w) : put(w, zeros, offset - (uint64_t)here);
}

static struct lm_image_section *section(struct image_writer *w, enum lm_image_section_type type)
{
    return &w->header.sections[type - 1];
}

/* Everything before the tiles has a known length; their length follows when all are written. */
static void place_sections(struct image_writer *w)
{
    const uint64_t bytes[LM_IMAGE_SECTION_TYPES] = {
        [LM_IMAGE_CLASSES] = sizeof w->classes,
        [LM_IMAGE_BANDS] = (uint64_t)w->header.band_count * sizeof(struct lm_band),
        [LM_IMAGE_DIRECTORY] = (uint64_t)w->header.entry_count * sizeof(struct lm_tile_entry),
    };
    uint64_t offset = sizeof w->header;
    for (uint32_t type = LM_IMAGE_CLASSES; type <= LM_IMAGE_MANIFEST; type++) {
        struct lm_image_section *s = section(w, type);
        *s = (struct lm_image_section){
            .type = type, .offset = aligned(offset), .bytes = bytes[type]};
        offset = s->offset + s->bytes;
    }
}

static int write_zeros_before_tiles(struct image_writer *w)
{
    if (fseeko(w->file.stream, (off_t)section(w, LM_IMAGE_TILES)->offset, SEEK_SET) != 0) {
        return write_failed(w);
    }
    return 0;
}

int image_writer_begin(struct image_writer *w, const char *path,
                       const struct lm_image_header *header, const struct lm_classes *classes,
                       const struct lm_band *bands)
{
    memset(w, 0, sizeof *w);
    w->header = *header;
    memcpy(w->header.magic, "LANDMASS", sizeof w->header.magic);
    w->header.version = LM_DB_VERSION;
    w->header.header_bytes = LM_DB_HEADER_BYTES;
    w->header.record_bytes = LM_TILE_BYTES;
    w->header.section_count = LM_IMAGE_MANIFEST;
    w->classes = *classes;
    memcpy(w->bands, bands, header->band_count * sizeof *bands);
    place_sections(w);
    image_sha256_begin(&w->tiles_sha256);
    w->records = malloc((size_t)header->entry_count * sizeof *w->records);
    w->stored = malloc((size_t)header->entry_count * sizeof *w->stored);
    w->details = calloc(header->entry_count + 1u, sizeof *w->details);
    if (!w->records || !w->stored || !w->details) {
        image_writer_abort(w);
        return hs_error(path, "choose larger cells or a smaller area", "out of memory");
    }
    memset(w->records, 0xff, (size_t)header->entry_count * sizeof *w->records);
    if (hs_atomic_open(&w->file, path) != 0 || write_zeros_before_tiles(w) != 0) {
        image_writer_abort(w);
        return -1;
    }
    return 0;
}

int image_writer_tile(struct image_writer *w, uint32_t entry, const struct lm_tile *tile)
{
    w->records[entry] = w->header.record_count++;
    return put(w, tile, LM_TILE_BYTES);
}

void image_writer_detail(struct image_writer *w, uint32_t entry, uint32_t place, uint8_t size)
{
    w->details[entry] = (struct image_detail_place){place, size};
}

/* Hash a section that is in memory, write it, and add its line to the manifest. */
static int put_section(struct image_writer *w, struct lm_image_section *s, const void *data,
                       FILE *manifest)
{
    struct image_sha256 sha;
    char digest[IMAGE_SHA256_TEXT];
    image_sha256_begin(&sha);
    image_sha256_add(&sha, data, s->bytes);
    image_sha256_end(&sha, digest);
    s->crc = fx_crc32c(0, data, s->bytes);
    if (manifest) {
        fprintf(manifest, "section-sha256: %s %s\n", image_section_name(s->type), digest);
    }
    if (fseeko(w->file.stream, (off_t)s->offset, SEEK_SET) != 0) {
        return write_failed(w);
    }
    return put(w, data, s->bytes);
}

static int put_directory(struct image_writer *w, FILE *manifest)
{
    const uint32_t count = w->header.entry_count;
    enum { RAW_SIZE = LM_TILE_BYTES / LM_DB_PLACE_BYTES };
    struct lm_tile_entry *entries = malloc(count * sizeof *entries);
    if (!entries) {
        return hs_error(w->file.path, "choose larger cells or a smaller area", "out of memory");
    }
    for (uint32_t i = 0; i < count; i++) {
        const bool has_tile = w->records[i] != LM_TILE_ABSENT;
        const struct image_stored_place none = {LM_TILE_ABSENT, 0};
        const struct image_stored_place at = has_tile ? w->stored[w->records[i]] : none;
        entries[i] = (struct lm_tile_entry){
            .place = at.place,
            .size = at.size,
            .encoding = has_tile && at.size != RAW_SIZE ? LM_TILE_LZ4 : LM_TILE_RAW,
            .detail_place = w->details[i].size ? w->details[i].place : LM_TILE_ABSENT,
            .detail_size = w->details[i].size,
        };
        entries[i].crc = image_entry_crc(i, &entries[i]);
    }
    const int result = put_section(w, section(w, LM_IMAGE_DIRECTORY), entries, manifest);
    free(entries);
    return result;
}

/* The tiles, mapped from the unfinished file: they are as large as the image. */
struct mapped_tiles {
    struct image_writer *w;
    struct lm_db db; /* grid and bands alone */
    struct lm_tile *tiles;
    uint8_t *map;
    size_t map_bytes;
};

static const struct lm_tile *find_written(void *ctx, uint8_t lod, uint32_t row, uint32_t column)
{
    const struct mapped_tiles *m = ctx;
    const int64_t entry = lm_db_entry(&m->db, lod, row, column);
    const uint32_t record = entry < 0 ? LM_TILE_ABSENT : m->w->records[entry];
    return record == LM_TILE_ABSENT ? NULL : &m->tiles[record];
}

enum { RELEASE_RECORDS = 4096 }; /* 72 MB: what the process holds of the file at a time */

/* A border takes nothing but own points of neighbours, and leaves those as they are: the order of
 * the tiles does not matter. */
static void fill_and_seal(struct mapped_tiles *m)
{
    const struct image_writer *w = m->w;
    const struct image_neighbours n = {find_written, m, w->header.shift0};
    for (uint32_t i = 0; i < w->header.record_count; i++) {
        struct lm_tile *tile = &m->tiles[i];
        if (!w->has_borders) {
            image_border_fill(&n, tile);
        }
        tile->crc = fx_crc32c(0, &tile->lod, LM_TILE_BYTES - sizeof tile->crc);
        if (i % RELEASE_RECORDS == RELEASE_RECORDS - 1) {
            (void)madvise(m->map, m->map_bytes, MADV_DONTNEED); /* a shared map loses nothing */
        }
    }
}

/* Records that are packed together, by all processors, before any of them is put in place. */
enum { ROUND_RECORDS = 1024, PART_RECORDS = 16 };

struct round {
    const struct mapped_tiles *m;
    uint32_t first, count;            /* records */
    uint16_t sizes[ROUND_RECORDS];    /* of each, in units of LM_DB_PLACE_BYTES */
    uint8_t (*packed)[LM_TILE_BYTES]; /* owned; ROUND_RECORDS of them */
};

static void *begin_part(void *ctx)
{
    return ctx;
}

static void end_part(void *ctx, void *own)
{
    (void)ctx;
    (void)own;
}

static void pack_part(void *ctx, void *own, uint32_t part)
{
    struct round *r = own;
    (void)ctx;
    for (uint32_t i = part * PART_RECORDS; i < r->count && i < (part + 1) * PART_RECORDS; i++) {
        r->sizes[i] = image_pack(&r->m->tiles[r->first + i], r->m->w->compression, r->packed[i]);
    }
}

/* Put the records of a round one behind the other. None is longer than it was unpacked, so that
 * they go where records lie that have been packed. */
static void put_round(const struct round *r)
{
    struct image_writer *w = r->m->w;
    for (uint32_t i = 0; i < r->count; i++) {
        const size_t bytes = (size_t)r->sizes[i] * LM_DB_PLACE_BYTES;
        w->stored[r->first + i] = (struct image_stored_place){w->tiles_size, r->sizes[i]};
        memcpy((uint8_t *)r->m->tiles + (size_t)w->tiles_size * LM_DB_PLACE_BYTES, r->packed[i],
               bytes);
        w->tiles_size += r->sizes[i];
        w->tiles_crc = fx_crc32c(w->tiles_crc, r->packed[i], bytes);
        image_sha256_add(&w->tiles_sha256, r->packed[i], bytes);
    }
}

/* Put all records as they are stored. Returns 0, or -1 without memory. */
static int pack(const struct mapped_tiles *m)
{
    struct image_writer *w = m->w;
    struct round r = {.m = m, .packed = malloc(ROUND_RECORDS * sizeof *r.packed)};
    const struct hs_team team = {&r, begin_part, pack_part, end_part, NULL};
    const uint32_t threads = hs_team_threads();
    struct hs_progress progress;
    int result = r.packed ? 0 : -1;
    hs_progress_begin(&progress, "storing tiles", w->header.record_count);
    w->tiles_size = 0;
    for (; result == 0 && r.first < w->header.record_count; r.first += r.count) {
        const uint32_t left = w->header.record_count - r.first;
        r.count = left < ROUND_RECORDS ? left : ROUND_RECORDS;
        result = hs_team_run(&team, (r.count + PART_RECORDS - 1) / PART_RECORDS, threads);
        if (result == 0) {
            put_round(&r);
            (void)madvise(m->map, m->map_bytes, MADV_DONTNEED);
            hs_progress_update(&progress, r.first + r.count);
        }
    }
    hs_progress_end(&progress);
    free(r.packed);
    return result;
}

static int finish_tiles(struct image_writer *w)
{
    struct mapped_tiles m = {.w = w,
                             .db = {.lod_count = w->header.lod_count,
                                    .shift0 = w->header.shift0,
                                    .band_count = w->header.band_count}};
    memcpy(m.db.bands, w->bands, sizeof m.db.bands);
    /* The map begins at a page. */
    const uint64_t offset = section(w, LM_IMAGE_TILES)->offset;
    const uint64_t page = offset % (uint64_t)sysconf(_SC_PAGESIZE);
    const size_t bytes = page + (size_t)w->header.record_count * LM_TILE_BYTES;
    if (w->header.record_count == 0) {
        return 0;
    }
    if (fflush(w->file.stream) != 0) {
        return write_failed(w);
    }
    m.map_bytes = bytes;
    m.map = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fileno(w->file.stream),
                 (off_t)(offset - page));
    if (m.map == MAP_FAILED) {
        return write_failed(w);
    }
    m.tiles = (void *)(m.map + page);
    fill_and_seal(&m);
    const int packed = pack(&m);
    munmap(m.map, bytes);
    if (packed != 0) {
        return hs_error(w->file.path, NULL, "out of memory");
    }
    const off_t end = (off_t)(offset + (uint64_t)w->tiles_size * LM_DB_PLACE_BYTES);
    return ftruncate(fileno(w->file.stream), end) == 0 ? 0 : write_failed(w);
}

static int put_tables(struct image_writer *w, FILE *manifest)
{
    if (put_section(w, section(w, LM_IMAGE_CLASSES), &w->classes, manifest) != 0 ||
        put_section(w, section(w, LM_IMAGE_BANDS), w->bands, manifest) != 0 ||
        put_directory(w, manifest) != 0) {
        return -1;
    }
    struct lm_image_section *tiles = section(w, LM_IMAGE_TILES);
    char digest[IMAGE_SHA256_TEXT];
    image_sha256_end(&w->tiles_sha256, digest);
    fprintf(manifest, "section-sha256: TILES %s\n", digest);
    tiles->crc = w->tiles_crc;
    tiles->bytes = (uint64_t)w->tiles_size * LM_DB_PLACE_BYTES;
    fprintf(manifest, "records: %s\n",
            w->compression == IMAGE_COMPRESSION_LZ4 ? image_pack_encoder() : "raw");
    return 0;
}

/* Append a section whose length was not known before to the image, which ends at `*end`. */
static int append_section(struct image_writer *w, struct lm_image_section *s,
                          const struct image_bytes *bytes, FILE *manifest, uint64_t *end)
{
    s->offset = aligned(*end);
    s->bytes = bytes->count;
    if (fseeko(w->file.stream, (off_t)*end, SEEK_SET) != 0) {
        return write_failed(w);
    }
    *end = s->offset + s->bytes;
    return pad_to(w, s->offset) == 0 ? put_section(w, s, bytes->data, manifest) : -1;
}

/* Sections that an image need not have. */
static int put_extra(struct image_writer *w, enum lm_image_section_type type,
                     const struct image_bytes *bytes, FILE *manifest, uint64_t *end)
{
    if (!bytes->data) {
        return 0;
    }
    struct lm_image_section *s = &w->header.sections[w->header.section_count++];
    s->type = type;
    return append_section(w, s, bytes, manifest, end);
}

static int put_header(struct image_writer *w)
{
    w->header.crc = fx_crc32c(0, &w->header, sizeof w->header - sizeof w->header.crc);
    if (fseeko(w->file.stream, 0, SEEK_SET) != 0) {
        return write_failed(w);
    }
    return put(w, &w->header, sizeof w->header);
}

static int finish(struct image_writer *w, const char *manifest)
{
    const struct {
        enum lm_image_section_type type;
        const struct image_bytes *bytes;
    } extras[] = {
        {LM_IMAGE_TARGETS, &w->targets},
        {LM_IMAGE_SIGNATURES, &w->signatures},
        {LM_IMAGE_GEOID, &w->geoid},
        {LM_IMAGE_DETAIL, &w->detail},
        {LM_IMAGE_RADAR, &w->radar},
        {LM_IMAGE_BUS, &w->bus},
        {LM_IMAGE_GEOID_PAGES, &w->geoid_pages},
    };
    char *text = NULL;
    size_t bytes = 0;
    FILE *stream = open_memstream(&text, &bytes);
    if (!stream) {
        return hs_error(w->file.path, NULL, "out of memory");
    }
    fputs(manifest, stream);
    int result = finish_tiles(w) == 0 ? put_tables(w, stream) : -1;
    const struct lm_image_section *tiles = section(w, LM_IMAGE_TILES);
    uint64_t end = tiles->offset + tiles->bytes;
    for (size_t i = 0; i < sizeof extras / sizeof extras[0] && result == 0; i++) {
        result = put_extra(w, extras[i].type, extras[i].bytes, stream, &end);
    }
    if (fclose(stream) != 0) {
        result = hs_error(w->file.path, NULL, "out of memory");
    }
    if (result == 0) {
        const struct image_bytes whole = {text, bytes};
        result = append_section(w, section(w, LM_IMAGE_MANIFEST), &whole, NULL, &end);
        w->header.image_bytes = end;
    }
    free(text);
    return result == 0 ? put_header(w) : -1;
}

int image_writer_end(struct image_writer *w, const char *manifest)
{
    const int result = finish(w, manifest) == 0 ? hs_atomic_commit(&w->file) : -1;
    image_writer_abort(w);
    return result;
}

void image_writer_abort(struct image_writer *w)
{
    hs_atomic_abort(&w->file);
    free(w->records);
    free(w->stored);
    free(w->details);
    w->records = NULL;
    w->stored = NULL;
    w->details = NULL;
}
