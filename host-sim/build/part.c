#include "build/part.h"

#include "fx/crc32c.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "image/codes.h"
#include "image/pack.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { CELLS = LM_TILE_CELLS, CELLS2 = CELLS * CELLS, POSTS2 = LM_TILE_POSTS * LM_TILE_POSTS };

static const char magic[8] = "LANDPART";

/* The header is the struct, zeros, and a checksum in the last four bytes. */
_Static_assert(sizeof(struct build_part_head) <= BUILD_PART_HEADER_BYTES - 4, "it fits");
_Static_assert(offsetof(struct build_part_head, counts) == 208 &&
                   sizeof(struct build_counts) == 448 && sizeof(struct build_towns) == 800 &&
                   sizeof(struct build_part_head) == 208 + 448 + 800,
               "as docs/FORMATS.md has it, without holes");
_Static_assert(sizeof(struct build_part_item) == 16, "likewise");

/* What the tile above needs, packed. The arrays lie where each is aligned. */
struct top {
    double q6[CELLS2];
    float built[CELLS2];
    int32_t posts_q6[POSTS2];
    uint16_t cells[CELLS2];
    struct image_place place[CELLS2];
    uint8_t has[POSTS2];
    uint8_t zero[3];
};
_Static_assert(sizeof(struct top) == 94856, "as docs/FORMATS.md has it");

static void pack_top(struct top *to, const struct build_tile *t)
{
    memset(to, 0, sizeof *to);
    for (int i = 0; i < CELLS2; i++) {
        const struct image_top *top = &t->ground.top[i / CELLS][i % CELLS];
        to->q6[i] = top->q6;
        to->place[i] = top->place;
    }
    memcpy(to->built, t->built, sizeof to->built);
    memcpy(to->cells, t->ground.cells, sizeof to->cells);
    memcpy(to->posts_q6, t->posts.q6, sizeof to->posts_q6);
    memcpy(to->has, t->posts.has, sizeof to->has);
}

static bool is_elevation(double q6)
{
    return q6 >= -IMAGE_ELEVATION_LIMIT_Q6 && q6 <= IMAGE_ELEVATION_LIMIT_Q6;
}

/* Returns false when it holds what no tile has. */
static bool unpack_top(const struct top *from, struct build_tile *t)
{
    bool is_good = true;
    for (int i = 0; i < CELLS2; i++) {
        t->ground.top[i / CELLS][i % CELLS] = (struct image_top){from->q6[i], from->place[i]};
        is_good =
            is_good && is_elevation(from->q6[i]) && from->built[i] >= 0 && from->built[i] <= 1;
    }
    for (int i = 0; i < POSTS2; i++) {
        is_good = is_good && is_elevation(from->posts_q6[i]) && from->has[i] <= 1;
    }
    memcpy(t->built, from->built, sizeof t->built);
    memcpy(t->ground.cells, from->cells, sizeof t->ground.cells);
    memcpy(t->posts.q6, from->posts_q6, sizeof t->posts.q6);
    memcpy(t->posts.has, from->has, sizeof t->posts.has);
    return is_good;
}

/* ---- writing ---- */

static int write_failed(const struct build_part_writer *w)
{
    return hs_error(w->file.path, "free some space and run again", "cannot be written: %s",
                    strerror(errno));
}

static int put(struct build_part_writer *w, const void *data, size_t bytes)
{
    if (bytes > 0 && fwrite(data, 1, bytes, w->file.stream) != bytes) {
        return write_failed(w);
    }
    image_sha256_add(&w->sha256, data, bytes);
    w->offset += bytes;
    return 0;
}

int build_part_begin(struct build_part_writer *w, const char *path, const struct build_shard *shard,
                     uint32_t number, uint32_t shard_count, const char *key)
{
    static const uint8_t zeros[BUILD_PART_HEADER_BYTES];
    *w = (struct build_part_writer){.head = {.version = BUILD_PART_VERSION,
                                             .header_bytes = BUILD_PART_HEADER_BYTES,
                                             .number = number,
                                             .shard_count = shard_count,
                                             .level = shard->level,
                                             .zone = shard->zone,
                                             .row0 = shard->row0,
                                             .rows = shard->rows,
                                             .column0 = shard->column0,
                                             .columns = shard->columns}};
    memcpy(w->head.magic, magic, sizeof magic);
    memcpy(w->head.key, key, sizeof w->head.key);
    if (hs_atomic_open(&w->file, path) != 0) {
        return -1;
    }
    const bool is_begun = fwrite(zeros, 1, sizeof zeros, w->file.stream) == sizeof zeros;
    image_sha256_begin(&w->sha256);
    w->offset = sizeof zeros;
    if (!is_begun) {
        write_failed(w);
        build_part_abort(w);
    }
    return is_begun ? 0 : -1;
}

static int add_item(struct build_part_writer *w, uint32_t entry, bool is_top, uint16_t size)
{
    if (w->item_count == w->item_capacity) {
        const size_t capacity = w->item_capacity ? 2 * w->item_capacity : 1024;
        struct build_part_item *items = realloc(w->items, capacity * sizeof *items);
        if (!items) {
            return hs_error(w->file.path, "cut the area into more shards", "out of memory");
        }
        w->items = items;
        w->item_capacity = capacity;
    }
    w->items[w->item_count++] = (struct build_part_item){entry, is_top, size, w->offset};
    return 0;
}

int build_part_put(void *writer, uint32_t entry, const struct build_tile *tile, bool is_top)
{
    struct build_part_writer *w = writer;
    uint8_t record[LM_TILE_BYTES];
    const uint16_t size = image_pack(&tile->record, IMAGE_COMPRESSION_QUICK, record);
    w->head.tile_count++;
    if (add_item(w, entry, false, size) != 0 ||
        put(w, record, (size_t)size * LM_DB_PLACE_BYTES) != 0) {
        return -1;
    }
    if (!is_top) {
        return 0;
    }
    struct top top;
    pack_top(&top, tile);
    return add_item(w, entry, true, 0) == 0 ? put(w, &top, sizeof top) : -1;
}

static int compare_items(const void *a, const void *b)
{
    const struct build_part_item *x = a, *y = b;
    return x->entry != y->entry ? (x->entry > y->entry) - (x->entry < y->entry)
                                : (x->is_top > y->is_top) - (x->is_top < y->is_top);
}

static int finish(struct build_part_writer *w, const struct build_context *b)
{
    static uint8_t header[BUILD_PART_HEADER_BYTES];
    char digest[IMAGE_SHA256_TEXT];
    if (w->item_count > 0) {
        qsort(w->items, w->item_count, sizeof *w->items, compare_items);
    }
    w->head.index_offset = w->offset;
    w->head.index_count = (uint32_t)w->item_count;
    if (put(w, w->items, w->item_count * sizeof *w->items) != 0) {
        return -1;
    }
    image_sha256_end(&w->sha256, digest);
    memcpy(w->head.body_sha256, digest, sizeof w->head.body_sha256);
    w->head.part_bytes = w->offset;
    w->head.counts = b->counts;
    w->head.towns = b->towns;
    memset(header, 0, sizeof header);
    memcpy(header, &w->head, sizeof w->head);
    const uint32_t crc = fx_crc32c(0, header, sizeof header - sizeof crc);
    memcpy(header + sizeof header - sizeof crc, &crc, sizeof crc);
    if (fseeko(w->file.stream, 0, SEEK_SET) != 0 ||
        fwrite(header, 1, sizeof header, w->file.stream) != sizeof header) {
        return write_failed(w);
    }
    return hs_atomic_commit(&w->file);
}

int build_part_end(struct build_part_writer *w, const struct build_context *b)
{
    const int result = finish(w, b);
    build_part_abort(w);
    return result;
}

void build_part_abort(struct build_part_writer *w)
{
    hs_atomic_abort(&w->file);
    free(w->items);
    w->items = NULL;
}

/* ---- reading ---- */

static const char make_again[] = "make this shard again";

static struct build_part_item item_at(const struct build_part *p, uint32_t i)
{
    struct build_part_item item;
    memcpy(&item, p->index + (size_t)i * sizeof item, sizeof item);
    return item;
}

static int check_head(const struct build_part *p)
{
    const struct build_part_head *h = &p->head;
    uint32_t crc;
    memcpy(&crc, p->bytes + BUILD_PART_HEADER_BYTES - sizeof crc, sizeof crc);
    if (memcmp(h->magic, magic, sizeof magic) != 0) {
        return hs_error(p->path, "name parts that `landmass-db build --shard` made",
                        "is no part of an image");
    }
    if (h->version != BUILD_PART_VERSION || h->header_bytes != BUILD_PART_HEADER_BYTES) {
        return hs_error(p->path, make_again, "is a part of version %u, not of %d",
                        (unsigned)h->version, BUILD_PART_VERSION);
    }
    if (crc != fx_crc32c(0, p->bytes, BUILD_PART_HEADER_BYTES - sizeof crc)) {
        return hs_error(p->path, make_again, "is damaged: the checksum of its header is wrong");
    }
    const uint64_t index_bytes = (uint64_t)h->index_count * sizeof(struct build_part_item);
    if (h->part_bytes != p->size || h->index_offset < BUILD_PART_HEADER_BYTES ||
        h->index_offset > p->size || index_bytes != p->size - h->index_offset) {
        return hs_error(p->path, make_again, "is damaged: it has %zu bytes and says %llu", p->size,
                        (unsigned long long)h->part_bytes);
    }
    return 0;
}

/* Of a part that are looked at before their memory is given back. */
static const size_t checked_bytes = (size_t)32 << 20;

static int check_body(const struct build_part *p)
{
    struct image_sha256 sha;
    char digest[IMAGE_SHA256_TEXT];
    image_sha256_begin(&sha);
    for (size_t at = BUILD_PART_HEADER_BYTES, bytes; at < p->size; at += bytes) {
        bytes = p->size - at < checked_bytes ? p->size - at : checked_bytes;
        image_sha256_add(&sha, p->bytes + at, bytes);
        build_part_release(p);
    }
    image_sha256_end(&sha, digest);
    return memcmp(digest, p->head.body_sha256, sizeof p->head.body_sha256) == 0
               ? 0
               : hs_error(p->path, make_again, "is damaged: its checksum is wrong");
}

/* A record that is packed is no longer than a raw one. */
static bool is_sound_size(const struct build_part_item *item)
{
    return item->is_top ? item->size == 0
                        : item->size > 0 && item->size <= LM_TILE_BYTES / LM_DB_PLACE_BYTES;
}

static int check_index(const struct build_part *p)
{
    uint32_t tiles = 0;
    struct build_part_item before = {0, 0, 0, 0};
    for (uint32_t i = 0; i < p->head.index_count; i++) {
        const struct build_part_item item = item_at(p, i);
        const uint64_t bytes =
            item.is_top ? sizeof(struct top) : (uint64_t)item.size * LM_DB_PLACE_BYTES;
        if (item.is_top > 1 || !is_sound_size(&item) || item.offset < BUILD_PART_HEADER_BYTES ||
            item.offset > p->head.index_offset || bytes > p->head.index_offset - item.offset ||
            (i > 0 && compare_items(&before, &item) >= 0)) {
            return hs_error(p->path, make_again, "is damaged: item %u of its index is wrong",
                            (unsigned)i);
        }
        tiles += !item.is_top;
        before = item;
    }
    return tiles == p->head.tile_count
               ? 0
               : hs_error(p->path, make_again, "is damaged: it has %u tiles and says %u",
                          (unsigned)tiles, (unsigned)p->head.tile_count);
}

/* Map a whole file. Returns 0, or -1 with the error reported. */
static int map_file(struct build_part *p)
{
    struct stat status;
    const int fd = open(p->path, O_RDONLY | O_CLOEXEC);
    if (fd < 0 || fstat(fd, &status) != 0) {
        const int cause = errno;
        if (fd >= 0) {
            close(fd);
        }
        return hs_error(p->path, make_again, "cannot be read: %s", strerror(cause));
    }
    void *map = MAP_FAILED;
    if (S_ISREG(status.st_mode) && status.st_size >= BUILD_PART_HEADER_BYTES) {
        map = mmap(NULL, (size_t)status.st_size, PROT_READ, MAP_PRIVATE, fd, 0);
    }
    close(fd);
    if (map == MAP_FAILED) {
        return hs_error(p->path, make_again, "is no part of an image: it is too short");
    }
    p->bytes = map;
    p->size = (size_t)status.st_size;
    return 0;
}

int build_part_open(struct build_part *p, const char *path)
{
    *p = (struct build_part){.path = path};
    hs_input_note(path);
    if (map_file(p) != 0) {
        return -1;
    }
    memcpy(&p->head, p->bytes, sizeof p->head);
    int result = check_head(p);
    if (result == 0) {
        p->index = p->bytes + p->head.index_offset;
        result = check_body(p) == 0 ? check_index(p) : -1;
    }
    if (result != 0) {
        build_part_close(p);
    }
    return result;
}

void build_part_close(struct build_part *p)
{
    if (p->bytes) {
        munmap((void *)(uintptr_t)p->bytes, p->size);
    }
    *p = (struct build_part){.path = NULL};
}

/* The bytes of an item, or NULL where there is none; its size in units into *size. */
static const uint8_t *find(const struct build_part *p, uint32_t entry, bool is_top, uint16_t *size)
{
    const struct build_part_item wanted = {entry, is_top, 0, 0};
    uint32_t low = 0, high = p->head.index_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const struct build_part_item item = item_at(p, middle);
        const int order = compare_items(&item, &wanted);
        if (order == 0) {
            *size = item.size;
            return p->bytes + item.offset;
        }
        low = order < 0 ? middle + 1 : low;
        high = order < 0 ? high : middle;
    }
    return NULL;
}

/* Is it a record of this tile, as a builder leaves it before borders are filled? */
static bool is_record(const struct lm_tile *t, const struct image_frame *f, int level)
{
    return t->lod == level && t->zone == f->zone && t->row == f->row && t->column == f->column &&
           t->post_shift <= LM_TILE_POST_SHIFT_MAX && is_elevation(t->base_m_q6) &&
           t->block_bytes == 0;
}

void build_part_release(const struct build_part *p)
{
    (void)madvise((void *)(uintptr_t)p->bytes, p->size, MADV_DONTNEED);
}

int build_part_take(const struct build_part *p, uint32_t entry, const struct image_frame *frame,
                    int level, struct lm_tile *record, struct build_tile *tile)
{
    uint16_t size;
    const uint8_t *bytes = find(p, entry, false, &size);
    if (!bytes) {
        return 0;
    }
    bool is_good = image_unpack(bytes, size, record) && is_record(record, frame, level);
    const uint8_t *above = tile ? find(p, entry, true, &size) : NULL;
    is_good = is_good && (!tile || above);
    if (is_good && tile) {
        struct top *top = malloc(sizeof *top);
        if (!top) {
            return hs_error(p->path, NULL, "out of memory");
        }
        memcpy(top, above, sizeof *top);
        is_good = unpack_top(top, tile);
        free(top);
    }
    return is_good
               ? 1
               : hs_error(p->path, make_again, "holds a wrong tile: level %d, row %u, column %u",
                          level, (unsigned)frame->row, (unsigned)frame->column);
}
