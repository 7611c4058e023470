/* Protocol buffers of OpenStreetMap, after the format's description (wiki.openstreetmap.org, "PBF
 * Format"). Nothing in the file is believed. */
#include "hs/error.h"
#include "hs/progress.h"
#include "osm_reading.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

enum { HEAD_MAX = 64 << 10, BLOCK_MAX = 32 << 20 };

/* ---- protocol buffers ---- */

/* Bytes yet to be read. */
struct span {
    const uint8_t *at, *end;
};

/* A field of a message: a number, or bytes. */
struct field {
    uint32_t number;
    bool is_bytes;
    uint64_t value;
    struct span bytes;
};

static bool read_varint(struct span *s, uint64_t *value)
{
    *value = 0;
    for (unsigned shift = 0; s->at < s->end && shift < 64; shift += 7) {
        const uint8_t byte = *s->at++;
        *value |= (uint64_t)(byte & 0x7F) << shift;
        if (byte < 0x80) {
            return true;
        }
    }
    return false;
}

static int64_t zigzag(uint64_t value)
{
    return (int64_t)(value >> 1) ^ -(int64_t)(value & 1);
}

/* Deltas of a damaged file may be anything: they wrap. */
static int64_t plus(int64_t a, int64_t b)
{
    return (int64_t)((uint64_t)a + (uint64_t)b);
}

/* The next field. False at the end, or with *is_bad set. */
static bool next_field(struct span *s, struct field *f, bool *is_bad)
{
    uint64_t key, length;
    if (s->at == s->end || *is_bad) {
        return false;
    }
    *is_bad = true;
    if (!read_varint(s, &key)) {
        return false;
    }
    *f = (struct field){.number = (uint32_t)(key >> 3), .is_bytes = (key & 7) == 2};
    if ((key & 7) == 0 && !read_varint(s, &f->value)) {
        return false;
    }
    if ((key & 7) != 0) {
        const size_t left = (size_t)(s->end - s->at);
        length = (key & 7) == 1 ? 8 : 4;
        if ((f->is_bytes && !read_varint(s, &length)) ||
            ((key & 7) != 1 && (key & 7) != 5 && !f->is_bytes) ||
            length > (size_t)(s->end - s->at) || left == 0) {
            return false;
        }
        f->bytes = (struct span){s->at, s->at + length};
        s->at += length;
    }
    *is_bad = false;
    return true;
}

/* ---- a block ---- */

struct block {
    char *text; /* owned: the strings, each with a final zero */
    const char **strings;
    size_t text_capacity, string_capacity, string_count;
    int64_t granularity, latitude_offset, longitude_offset;
};

/* Arrays of the element at hand; owned, and used again. */
struct element_room {
    int64_t *refs;
    uint8_t *kinds;
    const char **roles, **tags;
    size_t ref_capacity, kind_capacity, role_capacity, tag_capacity;
};

struct pbf {
    const char *path;
    FILE *file;
    uint64_t offset;
    struct osm_sink *sink;
    struct block block;
    struct element_room room;
    uint8_t *packed, *unpacked; /* owned */
    size_t packed_capacity, unpacked_capacity;
    const char *fault; /* what is wrong in the block */
};

static bool fail(struct pbf *p, const char *fault)
{
    p->fault = p->fault ? p->fault : fault;
    return false;
}

static bool short_of_memory(struct pbf *p)
{
    return fail(p, "out of memory");
}

static const char *string_of(struct pbf *p, uint64_t number)
{
    if (number >= p->block.string_count) {
        fail(p, "names a string that the block does not have");
        return NULL;
    }
    return p->block.strings[number];
}

/* The table of strings, each copied with a zero behind it. */
static bool read_strings(struct pbf *p, struct span table)
{
    struct block *b = &p->block;
    struct field f;
    bool is_bad = false;
    size_t used = 0;
    /* Each string has two bytes of its own in the file, and one more here. */
    if (!osm_room((void **)&b->text, &b->text_capacity, 2 * (size_t)(table.end - table.at) + 1,
                  1)) {
        return short_of_memory(p);
    }
    b->string_count = 0;
    while (next_field(&table, &f, &is_bad)) {
        if (f.number != 1 || !f.is_bytes) {
            continue;
        }
        const size_t length = (size_t)(f.bytes.end - f.bytes.at);
        if (!osm_room((void **)&b->strings, &b->string_capacity, b->string_count + 1,
                      sizeof *b->strings)) {
            return short_of_memory(p);
        }
        b->strings[b->string_count++] = b->text + used;
        memcpy(b->text + used, f.bytes.at, length);
        b->text[used + length] = '\0';
        used += length + 1;
    }
    return !is_bad || fail(p, "has a damaged table of strings");
}

/* ---- elements ---- */

static bool give(struct pbf *p, struct osm_element *e, int *result)
{
    e->tags = p->room.tags;
    *result = p->sink->take(p->sink->context, e);
    return *result == 0;
}

/* Add a pair of strings to the tags. */
static bool add_tag(struct pbf *p, struct osm_element *e, uint64_t key, uint64_t value)
{
    struct element_room *r = &p->room;
    const char *const k = string_of(p, key), *const v = string_of(p, value);
    if (!osm_room((void **)&r->tags, &r->tag_capacity, 2 * e->tag_count + 2, sizeof *r->tags)) {
        return short_of_memory(p);
    }
    if (!k || !v) {
        return false;
    }
    r->tags[2 * e->tag_count] = k;
    r->tags[2 * e->tag_count + 1] = v;
    e->tag_count++;
    return true;
}

static bool read_tags(struct pbf *p, struct osm_element *e, struct span keys, struct span values)
{
    uint64_t key, value;
    while (keys.at < keys.end) {
        if (!read_varint(&keys, &key) || !read_varint(&values, &value)) {
            return fail(p, "has a key without a value");
        }
        if (!add_tag(p, e, key, value)) {
            return false;
        }
    }
    return true;
}

static double degrees(const struct block *b, int64_t offset, int64_t value)
{
    return 1e-9 * ((double)offset + (double)b->granularity * (double)value);
}

static bool read_node(struct pbf *p, struct span s, int *result)
{
    struct osm_element e = {.kind = OSM_NODE};
    struct span keys = {0}, values = {0};
    struct field f;
    bool is_bad = false;
    while (next_field(&s, &f, &is_bad)) {
        if (f.number == 1) {
            e.id = zigzag(f.value);
        } else if (f.number == 2) {
            keys = f.bytes;
        } else if (f.number == 3) {
            values = f.bytes;
        } else if (f.number == 8) {
            e.latitude = degrees(&p->block, p->block.latitude_offset, zigzag(f.value));
        } else if (f.number == 9) {
            e.longitude = degrees(&p->block, p->block.longitude_offset, zigzag(f.value));
        }
    }
    return (!is_bad || fail(p, "has a damaged node")) && read_tags(p, &e, keys, values) &&
           give(p, &e, result);
}

/* Columns of many nodes. */
struct dense {
    struct span ids, latitudes, longitudes, tags;
    int64_t id, latitude, longitude; /* so far */
};

/* Key and value numbers up to a zero. */
static bool read_dense_tags(struct pbf *p, struct osm_element *e, struct span *tags)
{
    uint64_t key, value;
    while (tags->at < tags->end) {
        if (!read_varint(tags, &key)) {
            return fail(p, "has a damaged tag");
        }
        if (key == 0) {
            return true;
        }
        if (!read_varint(tags, &value)) {
            return fail(p, "has a key without a value");
        }
        if (!add_tag(p, e, key, value)) {
            return false;
        }
    }
    return true;
}

static bool read_dense_nodes(struct pbf *p, struct dense *d, int *result)
{
    uint64_t id, latitude, longitude;
    while (d->ids.at < d->ids.end) {
        if (!read_varint(&d->ids, &id) || !read_varint(&d->latitudes, &latitude) ||
            !read_varint(&d->longitudes, &longitude)) {
            return fail(p, "has nodes without a place");
        }
        d->id = plus(d->id, zigzag(id));
        d->latitude = plus(d->latitude, zigzag(latitude));
        d->longitude = plus(d->longitude, zigzag(longitude));
        struct osm_element e = {
            .kind = OSM_NODE,
            .id = d->id,
            .latitude = degrees(&p->block, p->block.latitude_offset, d->latitude),
            .longitude = degrees(&p->block, p->block.longitude_offset, d->longitude)};
        if (!read_dense_tags(p, &e, &d->tags) || !give(p, &e, result)) {
            return false;
        }
    }
    return true;
}

static bool read_dense(struct pbf *p, struct span s, int *result)
{
    struct dense d = {.id = 0};
    struct field f;
    bool is_bad = false;
    while (next_field(&s, &f, &is_bad)) {
        struct span *const column = f.number == 1    ? &d.ids
                                    : f.number == 8  ? &d.latitudes
                                    : f.number == 9  ? &d.longitudes
                                    : f.number == 10 ? &d.tags
                                                     : NULL;
        if (column) {
            *column = f.bytes;
        }
    }
    return (!is_bad || fail(p, "has damaged nodes")) && read_dense_nodes(p, &d, result);
}

/* Numbers that are each the difference to the one before. */
static bool read_refs(struct pbf *p, struct osm_element *e, struct span s)
{
    struct element_room *r = &p->room;
    uint64_t delta;
    int64_t ref = 0;
    if (!osm_room((void **)&r->refs, &r->ref_capacity, (size_t)(s.end - s.at) + 1,
                  sizeof *r->refs)) {
        return short_of_memory(p);
    }
    while (s.at < s.end) {
        if (!read_varint(&s, &delta)) {
            return fail(p, "has a damaged reference");
        }
        ref = plus(ref, zigzag(delta));
        r->refs[e->ref_count++] = ref;
    }
    e->refs = r->refs;
    return true;
}

static bool read_roles(struct pbf *p, struct osm_element *e, struct span roles, struct span kinds)
{
    struct element_room *r = &p->room;
    uint64_t role, kind;
    if (!osm_room((void **)&r->roles, &r->role_capacity, e->ref_count + 1, sizeof *r->roles) ||
        !osm_room((void **)&r->kinds, &r->kind_capacity, e->ref_count + 1, 1)) {
        return short_of_memory(p);
    }
    for (size_t i = 0; i < e->ref_count; i++) {
        if (!read_varint(&roles, &role) || !read_varint(&kinds, &kind) || kind >= OSM_KINDS) {
            return fail(p, "has a member without a role or a kind");
        }
        r->roles[i] = string_of(p, role);
        r->kinds[i] = (uint8_t)kind;
        if (!r->roles[i]) {
            return false;
        }
    }
    e->roles = r->roles;
    e->ref_kinds = r->kinds;
    return true;
}

/* A way, or a relation: fields 1 to 3 are alike. */
static bool read_way(struct pbf *p, struct span s, enum osm_kind kind, int *result)
{
    struct osm_element e = {.kind = kind};
    struct span columns[11] = {{0}};
    struct field f;
    bool is_bad = false;
    while (next_field(&s, &f, &is_bad)) {
        if (f.number == 1 && !f.is_bytes) {
            e.id = (int64_t)f.value;
        } else if (f.number < 11 && f.is_bytes) {
            columns[f.number] = f.bytes;
        }
    }
    if (is_bad) {
        return fail(p, "has a damaged way or relation");
    }
    const bool is_way = kind == OSM_WAY;
    return read_tags(p, &e, columns[2], columns[3]) &&
           read_refs(p, &e, is_way ? columns[8] : columns[9]) &&
           (is_way || read_roles(p, &e, columns[8], columns[10])) && give(p, &e, result);
}

static bool read_group(struct pbf *p, struct span s, int *result)
{
    struct field f;
    bool is_bad = false, goes_on = true;
    while (goes_on && next_field(&s, &f, &is_bad)) {
        if (!f.is_bytes) {
            continue;
        }
        goes_on = f.number == 1   ? read_node(p, f.bytes, result)
                  : f.number == 2 ? read_dense(p, f.bytes, result)
                  : f.number == 3 ? read_way(p, f.bytes, OSM_WAY, result)
                  : f.number == 4 ? read_way(p, f.bytes, OSM_RELATION, result)
                                  : true;
    }
    return goes_on && (!is_bad || fail(p, "has a damaged group"));
}

static bool read_data(struct pbf *p, struct span s, int *result)
{
    struct field f;
    struct span again = s;
    bool is_bad = false;
    p->block.granularity = 100;
    p->block.latitude_offset = p->block.longitude_offset = 0;
    p->block.string_count = 0;
    /* Groups may stand before what they need. */
    while (next_field(&s, &f, &is_bad)) {
        if (f.number == 1 && f.is_bytes && !read_strings(p, f.bytes)) {
            return false;
        }
        int64_t *const setting = f.number == 17   ? &p->block.granularity
                                 : f.number == 19 ? &p->block.latitude_offset
                                 : f.number == 20 ? &p->block.longitude_offset
                                                  : NULL;
        if (setting) {
            *setting = (int64_t)f.value;
        }
    }
    bool goes_on = !is_bad || fail(p, "is damaged");
    while (goes_on && next_field(&again, &f, &is_bad)) {
        goes_on = f.number != 2 || !f.is_bytes || read_group(p, f.bytes, result);
    }
    return goes_on;
}

/* ---- the head of the file ---- */

static void read_box(struct osm_box *box, struct span s)
{
    struct field f;
    bool is_bad = false;
    double sides[5] = {0}; /* west, east, north, south from 1 */
    while (next_field(&s, &f, &is_bad)) {
        if (f.number >= 1 && f.number <= 4) {
            sides[f.number] = 1e-9 * (double)zigzag(f.value);
        }
    }
    *box = (struct osm_box){!is_bad, sides[4], sides[1], sides[3], sides[2]};
}

static bool is_known_feature(struct span s)
{
    static const char *const known[] = {"OsmSchema-V0.6", "DenseNodes"};
    for (int i = 0; i < 2; i++) {
        const size_t length = strlen(known[i]);
        if ((size_t)(s.end - s.at) == length && memcmp(s.at, known[i], length) == 0) {
            return true;
        }
    }
    return false;
}

static bool read_head(struct pbf *p, struct span s)
{
    struct field f;
    bool is_bad = false;
    while (next_field(&s, &f, &is_bad)) {
        if (f.number == 1 && f.is_bytes) {
            read_box(&p->sink->box, f.bytes);
        } else if (f.number == 4 && f.is_bytes && !is_known_feature(f.bytes)) {
            return fail(p, "needs a reader of other features, such as history");
        }
    }
    return !is_bad || fail(p, "is damaged");
}

/* ---- blobs ---- */

static bool unpack(struct pbf *p, struct span packed, uint64_t raw_bytes, struct span *data)
{
    uLongf length = (uLongf)raw_bytes;
    if (raw_bytes > BLOCK_MAX) {
        return fail(p, "is longer than 32 MiB");
    }
    if (!osm_room((void **)&p->unpacked, &p->unpacked_capacity, raw_bytes + 1, 1)) {
        return short_of_memory(p);
    }
    if (uncompress(p->unpacked, &length, packed.at, (uLong)(packed.end - packed.at)) != Z_OK ||
        length != raw_bytes) {
        return fail(p, "does not unpack to its length");
    }
    *data = (struct span){p->unpacked, p->unpacked + length};
    return true;
}

/* What a blob holds, unpacked. */
static bool open_blob(struct pbf *p, struct span s, struct span *data)
{
    struct field f;
    struct span packed = {0};
    bool is_bad = false, is_plain = false, is_packed = false, is_other = false;
    uint64_t raw_bytes = 0;
    while (next_field(&s, &f, &is_bad)) {
        if (f.number == 1 && f.is_bytes) {
            *data = f.bytes;
            is_plain = true;
        } else if (f.number == 2) {
            raw_bytes = f.value;
        } else if (f.number == 3 && f.is_bytes) {
            packed = f.bytes;
            is_packed = true;
        } else {
            is_other = true;
        }
    }
    if (is_bad || (!is_plain && !is_packed && !is_other)) {
        return fail(p, "is damaged");
    }
    if (is_plain) {
        return true;
    }
    return is_packed ? unpack(p, packed, raw_bytes, data)
                     : fail(p, "is compressed, but not by zlib; write it again with osmium");
}

/* Kind of the next blob and its length. False at the end of the file, or with a fault. */
static bool read_blob_head(struct pbf *p, char kind[16], uint64_t *bytes)
{
    uint8_t length[4];
    struct field f;
    bool is_bad = false;
    const size_t got = fread(length, 1, 4, p->file);
    const uint32_t head = got != 4 ? 0
                                   : (uint32_t)length[0] << 24 | (uint32_t)length[1] << 16 |
                                         (uint32_t)length[2] << 8 | length[3];
    if (got == 0 && feof(p->file)) {
        return false;
    }
    if (!osm_room((void **)&p->packed, &p->packed_capacity, HEAD_MAX, 1)) {
        return short_of_memory(p);
    }
    if (got != 4 || head > HEAD_MAX || fread(p->packed, 1, head, p->file) != head) {
        return fail(p, "is no block of a PBF file, or is cut short");
    }
    struct span s = {p->packed, p->packed + head};
    *bytes = 0;
    kind[0] = '\0';
    while (next_field(&s, &f, &is_bad)) {
        if (f.number == 1 && f.is_bytes && f.bytes.end - f.bytes.at < 16) {
            memcpy(kind, f.bytes.at, (size_t)(f.bytes.end - f.bytes.at));
            kind[f.bytes.end - f.bytes.at] = '\0';
        } else if (f.number == 3) {
            *bytes = f.value;
        }
    }
    p->offset += 4u + head;
    return is_bad || *bytes > BLOCK_MAX ? fail(p, "is no block of a PBF file") : true;
}

static bool read_blob(struct pbf *p, int *result)
{
    char kind[16];
    uint64_t bytes;
    struct span data = {0};
    if (!read_blob_head(p, kind, &bytes)) {
        return false;
    }
    if (!osm_room((void **)&p->packed, &p->packed_capacity, bytes + 1, 1)) {
        return short_of_memory(p);
    }
    if (fread(p->packed, 1, bytes, p->file) != bytes) {
        return fail(p, "is cut short");
    }
    if (!open_blob(p, (struct span){p->packed, p->packed + bytes}, &data)) {
        return false;
    }
    const bool goes_on = strcmp(kind, "OSMData") == 0     ? read_data(p, data, result)
                         : strcmp(kind, "OSMHeader") == 0 ? read_head(p, data)
                                                          : true; /* the format tells to skip it */
    p->offset += bytes;
    return goes_on;
}

static int read_blobs(struct pbf *p)
{
    int result = 0;
    bool is_first = true;
    struct hs_progress bar;
    hs_progress_begin(&bar, "reading", osm_bytes(p->file));
    while (read_blob(p, &result)) {
        is_first = false;
        hs_progress_update(&bar, p->offset);
    }
    hs_progress_end(&bar);
    if (p->fault) {
        return hs_error(p->path, "get it again, or mend it with osmium",
                        "the block at byte %llu %s", (unsigned long long)p->offset, p->fault);
    }
    return is_first && result == 0 ? hs_error(p->path, NULL, "is empty") : result;
}

int osm_pbf_read(const char *path, struct osm_sink *sink)
{
    struct pbf p = {.path = path, .file = fopen(path, "rb"), .sink = sink};
    if (!p.file) {
        return hs_error(path, "check the name", "cannot be read: %s", strerror(errno));
    }
    const int result = read_blobs(&p);
    fclose(p.file);
    free(p.packed);
    free(p.unpacked);
    free(p.block.text);
    free(p.block.strings);
    free(p.room.refs);
    free(p.room.kinds);
    free(p.room.roles);
    free(p.room.tags);
    return result;
}
