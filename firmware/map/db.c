#include "lm/db.h"

#include "fx/crc32c.h"
#include "fx/mem.h"
#include "lm/const.h"
#include "lm/image.h"
#include "lm/sensor.h"

#if __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "records are used in place: landmass needs a little-endian machine"
#endif

enum { HEIGHT_MAX_M_Q6 = 1 << 20 };

int lm_db_read(const struct lm_flash *flash, uint64_t offset, void *destination, uint32_t length,
               uint32_t poll_limit)
{
    int status = flash->read_start(flash->ctx, offset, destination, length);
    if (status != LM_OK) {
        return LM_ERR_IO;
    }
    for (uint32_t i = 0; i < poll_limit; i++) {
        status = flash->read_poll(flash->ctx);
        if (status != LM_BUSY) {
            return status == LM_OK ? LM_OK : LM_ERR_IO;
        }
    }
    return LM_ERR_IO;
}

/* True if a height is within 16 km. Heights of the header and of records are added in 32 bits. */
static bool is_height(int32_t height_m_q6)
{
    return height_m_q6 >= -HEIGHT_MAX_M_Q6 && height_m_q6 <= HEIGHT_MAX_M_Q6;
}

static bool header_is_sound(const struct lm_image_header *h, uint64_t flash_bytes)
{
    return h->header_bytes == LM_DB_HEADER_BYTES && h->image_bytes <= flash_bytes &&
           h->shift0 >= LM_DB_SHIFT_MIN && h->lod_count >= 1 && h->lod_count <= LM_DB_LODS_MAX &&
           h->shift0 + h->lod_count - 1 <= LM_DB_SHIFT_MAX && h->band_count >= 1 &&
           h->band_count <= LM_DB_BANDS_MAX && h->record_bytes == LM_TILE_BYTES &&
           h->section_count <= LM_IMAGE_SECTIONS_MAX && is_height(h->mean_elevation_m_q6) &&
           is_height(h->geoid_m_q6);
}

static const struct lm_image_section *section_of_type(const struct lm_image_header *h,
                                                      uint32_t type)
{
    for (uint32_t i = 0; i < h->section_count; i++) {
        if (h->sections[i].type == type) {
            return &h->sections[i];
        }
    }
    return NULL;
}

static bool is_inside(const struct lm_image_header *h, const struct lm_image_section *s)
{
    return s->offset % LM_IMAGE_SECTION_ALIGNMENT == 0 && s->bytes <= h->image_bytes &&
           s->offset <= h->image_bytes - s->bytes;
}

/* The section of a type if it lies inside the image and has this length, or NULL. */
static const struct lm_image_section *find_section(const struct lm_image_header *h, uint32_t type,
                                                   uint64_t bytes)
{
    const struct lm_image_section *s = section_of_type(h, type);
    return s && s->bytes == bytes && is_inside(h, s) ? s : NULL;
}

static int read_section(struct lm_db *db, const struct lm_image_section *s, void *destination,
                        uint32_t poll_limit)
{
    const uint32_t length = (uint32_t)s->bytes; /* bounded by find_section */
    const int status = lm_db_read(db->flash, db->base + s->offset, destination, length, poll_limit);
    if (status != LM_OK) {
        return status;
    }
    return fx_crc32c(0, destination, length) == s->crc ? LM_OK : LM_ERR_CORRUPT;
}

/* Number of tile columns around the Earth at this shift and zone. */
static uint32_t columns_round(uint8_t shift, uint8_t zone)
{
    return 1u << (32 - LM_TILE_CELLS_LOG2 - shift - zone);
}

/* True if a band lies on the Earth and its directory entries exist. Shifts are at most
 * 20 and zones 3, so there are at least 32 rows and 8 columns. */
static bool band_is_sound(const struct lm_db *db, const struct lm_band *b)
{
    if (b->lod >= db->lod_count || b->zone > 3 || b->rows == 0 || b->columns == 0) {
        return false;
    }
    const uint8_t shift = (uint8_t)(db->shift0 + b->lod);
    const uint32_t rows_all = 1u << (31 - LM_TILE_CELLS_LOG2 - shift); /* pole to pole */
    const uint32_t columns_all = columns_round(shift, b->zone);
    if (b->row0 >= rows_all || b->rows > rows_all - b->row0 || b->column0 >= columns_all ||
        b->columns > columns_all) {
        return false;
    }
    const uint64_t entries = (uint64_t)b->rows * b->columns;
    return entries <= db->entry_count && b->entry0 <= db->entry_count - entries;
}

static bool classes_are_sound(const struct lm_classes *c)
{
    for (int i = 0; i < LM_DB_CLASSES; i++) {
        if (c->entry[i].kind > LM_KIND_TREES || c->entry[i].facing > LM_FACINGS) {
            return false;
        }
    }
    for (int i = 1; i < 16; i++) {
        if (c->height_dm[i] < c->height_dm[i - 1]) {
            return false;
        }
    }
    return c->height_dm[0] == 0;
}

/* Read the head of an optional section of records. Its last four bytes are the CRC of those before.
 * LM_OK with *s NULL if the image has no such section. */
static int read_head(const struct lm_db *db, const struct lm_image_header *h, uint32_t type,
                     void *head, uint32_t head_bytes, const struct lm_image_section **s,
                     uint32_t poll_limit)
{
    *s = section_of_type(h, type);
    if (*s == NULL) {
        return LM_OK;
    }
    if ((*s)->bytes < head_bytes || !is_inside(h, *s)) {
        return LM_ERR_CORRUPT;
    }
    const int status = lm_db_read(db->flash, db->base + (*s)->offset, head, head_bytes, poll_limit);
    if (status != LM_OK) {
        return status;
    }
    const uint8_t *bytes = head;
    const uint32_t crc_at = head_bytes - (uint32_t)sizeof(uint32_t);
    return fx_crc32c(0, bytes, crc_at) == fx_load_u32(bytes + crc_at) ? LM_OK : LM_ERR_CORRUPT;
}

/* Targets and signatures: the head is checked here, each record when it is read. */
static int read_targets_head(struct lm_db *db, const struct lm_image_header *h, uint32_t poll_limit)
{
    struct lm_targets_head head;
    const struct lm_image_section *s;
    const int status = read_head(db, h, LM_IMAGE_TARGETS, &head, sizeof head, &s, poll_limit);
    db->target_count = 0;
    db->targets_offset = 0;
    if (status != LM_OK || s == NULL) {
        return status;
    }
    if (head.record_bytes != LM_TARGET_BYTES || head.count > LM_DB_TARGETS_MAX ||
        s->bytes != sizeof head + (uint64_t)head.count * LM_TARGET_BYTES) {
        return LM_ERR_CORRUPT;
    }
    db->target_count = head.count;
    db->targets_offset = db->base + s->offset + sizeof head;
    return LM_OK;
}

static int read_signatures_head(struct lm_db *db, const struct lm_image_header *h,
                                uint32_t poll_limit)
{
    struct lm_signatures_head head;
    const struct lm_image_section *s;
    const int status = read_head(db, h, LM_IMAGE_SIGNATURES, &head, sizeof head, &s, poll_limit);
    db->signature_count = db->chip_count = 0;
    db->signatures_offset = db->chips_offset = 0;
    if (status != LM_OK || s == NULL) {
        return status;
    }
    const uint64_t records = (uint64_t)head.count * LM_SIGNATURE_BYTES;
    if (head.record_bytes != LM_SIGNATURE_BYTES || head.chip_bytes != LM_CHIP_BYTES ||
        head.count > LM_DB_SIGNATURES_MAX || head.chip_count > LM_DB_CHIPS_MAX ||
        s->bytes != sizeof head + records + (uint64_t)head.chip_count * LM_CHIP_BYTES) {
        return LM_ERR_CORRUPT;
    }
    db->signature_count = head.count;
    db->chip_count = head.chip_count;
    db->signatures_offset = db->base + s->offset + sizeof head;
    db->chips_offset = db->signatures_offset + records;
    return LM_OK;
}

/* Size of a section that the directory counts in units, or UINT32_MAX if it cannot be one. */
static uint32_t size_in_units(const struct lm_image_header *h, const struct lm_image_section *s)
{
    const uint64_t units = s->bytes / LM_DB_PLACE_BYTES;
    const bool is_sound =
        is_inside(h, s) && s->bytes % LM_DB_PLACE_BYTES == 0 && units < UINT32_MAX;
    return is_sound ? (uint32_t)units : UINT32_MAX;
}

/* The sections that the directory leads to: tiles, and vector detail, which is optional. */
static int find_tiles(struct lm_db *db, const struct lm_image_header *h)
{
    const struct lm_image_section *tiles = section_of_type(h, LM_IMAGE_TILES);
    const struct lm_image_section *detail = section_of_type(h, LM_IMAGE_DETAIL);
    if (tiles == NULL) {
        return LM_ERR_CORRUPT;
    }
    db->records_offset = db->base + tiles->offset;
    db->tiles_size = size_in_units(h, tiles);
    db->detail_offset = detail ? db->base + detail->offset : 0;
    db->detail_size = detail ? size_in_units(h, detail) : 0;
    return db->tiles_size != UINT32_MAX && db->detail_size != UINT32_MAX ? LM_OK : LM_ERR_CORRUPT;
}

/* The grid of the geoid is optional. */
static int read_geoid(struct lm_db *db, const struct lm_image_header *h, uint32_t poll_limit)
{
    db->geoid.rows = 0;
    if (section_of_type(h, LM_IMAGE_GEOID) == NULL) {
        return LM_OK;
    }
    const struct lm_image_section *s = find_section(h, LM_IMAGE_GEOID, sizeof db->geoid);
    if (s == NULL) {
        return LM_ERR_CORRUPT;
    }
    const int status = read_section(db, s, &db->geoid, poll_limit);
    if (status != LM_OK) {
        return status;
    }
    return lm_geoid_is_sound(&db->geoid) ? LM_OK : LM_ERR_CORRUPT;
}

/* So are its pages. Each is checked when it is read. */
static int read_geoid_pages(struct lm_db *db, const struct lm_image_header *h, uint32_t poll_limit)
{
    struct lm_geoid_pages_head head;
    const struct lm_image_section *s;
    const int status = read_head(db, h, LM_IMAGE_GEOID_PAGES, &head, sizeof head, &s, poll_limit);
    db->geoid_pages.rows = 0;
    if (status != LM_OK || s == NULL) {
        return status;
    }
    if (!lm_geoid_pages_are_sound(&head, s->bytes)) {
        return LM_ERR_CORRUPT;
    }
    db->geoid_pages = (struct lm_geoid_pages){.offset = db->base + s->offset + sizeof head,
                                              .shift = head.shift,
                                              .row0 = head.row0,
                                              .rows = head.rows,
                                              .column0 = head.column0,
                                              .columns = head.columns};
    return LM_OK;
}

/* The tables of radar and bus are optional. Who reads the record checks it. */
static int find_record(const struct lm_db *db, const struct lm_image_header *h,
                       enum lm_image_section_type type, uint64_t *offset, uint32_t *bytes)
{
    const struct lm_image_section *s = section_of_type(h, type);
    *offset = s ? db->base + s->offset : 0;
    *bytes = s ? (uint32_t)s->bytes : 0;
    return !s || (is_inside(h, s) && s->bytes > 0 && s->bytes <= UINT32_MAX) ? LM_OK
                                                                             : LM_ERR_CORRUPT;
}

static int read_tables(struct lm_db *db, const struct lm_image_header *h, uint32_t poll_limit)
{
    const uint64_t band_bytes = (uint64_t)db->band_count * sizeof(struct lm_band);
    const struct lm_image_section *classes = find_section(h, LM_IMAGE_CLASSES, sizeof db->classes);
    const struct lm_image_section *bands = find_section(h, LM_IMAGE_BANDS, band_bytes);
    const struct lm_image_section *directory = find_section(
        h, LM_IMAGE_DIRECTORY, (uint64_t)db->entry_count * sizeof(struct lm_tile_entry));
    if (!classes || !bands || !directory) {
        return LM_ERR_CORRUPT;
    }
    db->directory_offset = db->base + directory->offset;
    int status = read_section(db, classes, &db->classes, poll_limit);
    if (status == LM_OK) {
        status = read_section(db, bands, db->bands, poll_limit);
    }
    if (status != LM_OK) {
        return status;
    }
    for (uint32_t i = 0; i < db->band_count; i++) {
        if (!band_is_sound(db, &db->bands[i])) {
            return LM_ERR_CORRUPT;
        }
    }
    return classes_are_sound(&db->classes) ? LM_OK : LM_ERR_CORRUPT;
}

int lm_db_open_part(struct lm_db *db, const struct lm_flash *flash,
                    const struct lm_flash_part *part, uint32_t poll_limit)
{
    struct lm_image_header h;
    if (part->bytes < sizeof h) {
        return LM_ERR_CORRUPT;
    }
    const int status = lm_db_read(flash, part->offset, &h, sizeof h, poll_limit);
    if (status != LM_OK) {
        return status;
    }
    if (memcmp(h.magic, "LANDMASS", 8) != 0) {
        return LM_ERR_CORRUPT;
    }
    if (h.version != LM_DB_VERSION) {
        return LM_ERR_VERSION; /* its checksum may lie elsewhere */
    }
    if (fx_crc32c(0, &h, sizeof h - sizeof h.crc) != h.crc) {
        return LM_ERR_CORRUPT;
    }
    if (h.top != LM_IMAGE_TOP_PLAIN || h.sensor >= LM_SENSORS) {
        return LM_ERR_VERSION;
    }
    if (!header_is_sound(&h, part->bytes)) {
        return LM_ERR_CORRUPT;
    }
    db->flash = flash;
    db->base = part->offset;
    const struct lm_image_section *radar = section_of_type(&h, LM_IMAGE_RADAR);
    db->radar_crc = radar ? radar->crc : 0;
    db->finest = 0;
    db->shift0 = h.shift0;
    db->lod_count = h.lod_count;
    db->band_count = h.band_count;
    db->entry_count = h.entry_count;
    db->record_count = h.record_count;
    db->mean_elevation_m_q6 = h.mean_elevation_m_q6;
    db->geoid_m_q6 = h.geoid_m_q6;
    db->centre_latitude = h.centre_latitude;
    db->centre_longitude = h.centre_longitude;
    db->sensor = h.sensor;
    memcpy(db->title, h.title, sizeof h.title);
    db->title[sizeof h.title] = 0;
    int tables = read_tables(db, &h, poll_limit);
    if (tables == LM_OK) {
        tables = read_geoid(db, &h, poll_limit);
    }
    if (tables == LM_OK) {
        tables = read_geoid_pages(db, &h, poll_limit);
    }
    if (tables == LM_OK) {
        tables = find_tiles(db, &h);
    }
    if (tables == LM_OK) {
        tables = find_record(db, &h, LM_IMAGE_RADAR, &db->radar_offset, &db->radar_bytes);
    }
    if (tables == LM_OK) {
        tables = find_record(db, &h, LM_IMAGE_BUS, &db->bus_offset, &db->bus_bytes);
    }
    if (tables == LM_OK) {
        tables = read_targets_head(db, &h, poll_limit);
    }
    return tables == LM_OK ? read_signatures_head(db, &h, poll_limit) : tables;
}

int lm_db_open(struct lm_db *db, const struct lm_flash *flash, uint32_t poll_limit)
{
    const struct lm_flash_part whole = {0, flash->size_bytes};
    return lm_db_open_part(db, flash, &whole, poll_limit);
}

int64_t lm_db_entry(const struct lm_db *db, uint8_t lod, uint32_t row, uint32_t column)
{
    for (uint32_t i = 0; i < db->band_count; i++) {
        const struct lm_band *b = &db->bands[i];
        if (b->lod != lod || row < b->row0 || row - b->row0 >= b->rows) {
            continue;
        }
        const uint32_t round = columns_round((uint8_t)(db->shift0 + lod), b->zone);
        const uint32_t east = (column - b->column0) & (round - 1);
        if (column < round && east < b->columns) {
            return (int64_t)b->entry0 + (int64_t)(row - b->row0) * b->columns + east;
        }
    }
    return -1;
}

/* True if `size` units from `place` on lie in a section of that many units. No sum overflows. */
static bool lies_in(uint32_t place, uint32_t size, uint32_t section_size)
{
    return size <= section_size && place <= section_size - size;
}

static bool detail_is_sound(const struct lm_db *db, const struct lm_tile_entry *e)
{
    return e->detail_place == LM_TILE_ABSENT
               ? e->detail_size == 0
               : e->detail_size > 0 && lies_in(e->detail_place, e->detail_size, db->detail_size);
}

/* A compressed record is shorter than a raw one: it is unpacked in the memory of its tile. */
static bool has_sound_size(const struct lm_tile_entry *e)
{
    enum { RAW_SIZE = LM_TILE_BYTES / LM_DB_PLACE_BYTES };
    return e->encoding == LM_TILE_RAW ? e->size == RAW_SIZE : e->size > 0 && e->size < RAW_SIZE;
}

int lm_db_entry_check(const struct lm_db *db, uint32_t number, const struct lm_tile_entry *entry)
{
    const uint32_t crc = fx_crc32c(0, &number, sizeof number);
    if (fx_crc32c(crc, entry, offsetof(struct lm_tile_entry, crc)) != entry->crc) {
        return LM_ERR_CORRUPT;
    }
    if (entry->place == LM_TILE_ABSENT) {
        return LM_OK;
    }
    if (entry->encoding != LM_TILE_RAW && entry->encoding != LM_TILE_LZ4) {
        return LM_ERR_VERSION;
    }
    const bool is_sound = has_sound_size(entry) &&
                          lies_in(entry->place, entry->size, db->tiles_size) &&
                          detail_is_sound(db, entry);
    return is_sound ? LM_OK : LM_ERR_CORRUPT;
}

int lm_tile_check(const struct lm_tile *tile, uint8_t lod, uint32_t row, uint32_t column)
{
    const uint8_t *bytes = (const uint8_t *)tile;
    const bool is_sound = tile->lod == lod && tile->row == row && tile->column == column &&
                          tile->post_shift <= LM_TILE_POST_SHIFT_MAX &&
                          is_height(tile->base_m_q6) && (tile->under & 15) == 0 &&
                          fx_crc32c(0, bytes + 4, LM_TILE_BYTES - 4) == tile->crc;
    return is_sound ? LM_OK : LM_ERR_CORRUPT;
}

uint32_t lm_db_cell_mm(const struct lm_db *db, uint8_t lod)
{
    return (uint32_t)(((uint64_t)LM_MM_PER_BAM_Q16 << (db->shift0 + lod)) >> 16);
}
