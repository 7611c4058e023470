#include "image/reader.h"

#include "fx/crc32c.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/signature_file.h"
#include "hs/zero_bytes.h"
#include "image/grid.h"
#include "image/pack.h"
#include "lm/bus_record.h"
#include "lm/radar_check.h"
#include "lm/radar_record.h"
#include "lm/sensor.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

int image_map(struct image *image, const char *path)
{
    *image = (struct image){0};
    hs_input_note(path);
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    struct stat status;
    if (fd < 0 || fstat(fd, &status) != 0 || !S_ISREG(status.st_mode)) {
        const int cause = fd < 0 ? errno : EINVAL;
        if (fd >= 0) {
            close(fd);
        }
        return hs_error(path, "check the name", "cannot be read: %s", strerror(cause));
    }
    image->size_bytes = (uint64_t)status.st_size;
    void *bytes = image->size_bytes ? mmap(NULL, image->size_bytes, PROT_READ, MAP_PRIVATE, fd, 0)
                                    : MAP_FAILED;
    close(fd);
    if (bytes == MAP_FAILED) {
        return hs_error(path, "give an image that `landmass-db build` wrote", "%s",
                        image->size_bytes ? "cannot be mapped" : "is empty");
    }
    image->bytes = bytes;
    image->is_mapped = 1;
    return 0;
}

void image_lend(struct image *image, const void *bytes, size_t size_bytes)
{
    *image = (struct image){.bytes = bytes, .size_bytes = size_bytes};
}

void image_close(struct image *image)
{
    if (image->is_mapped) {
        munmap((void *)image->bytes, image->size_bytes);
    }
    image_unpacked_free(image->unpacked);
    *image = (struct image){0};
}

static int check_header(const struct image *image, struct image_findings *f)
{
    const struct lm_image_header *h = &image->header;
    if (memcmp(h->magic, "LANDMASS", sizeof h->magic) != 0) {
        image_find(f, 0, "the file does not begin with LANDMASS: it is no image");
        return -1;
    }
    if (h->version != LM_DB_VERSION) {
        image_find(f, 8, "version %" PRIu32 " instead of %d: %s", h->version, LM_DB_VERSION,
                   IMAGE_OTHER_VERSION_REMEDY);
        return -1;
    }
    if (fx_crc32c(0, h, offsetof(struct lm_image_header, crc)) != h->crc) {
        image_find(f, offsetof(struct lm_image_header, crc),
                   "the header's checksum does not fit it");
    }
    if (h->image_bytes != image->size_bytes) {
        image_find(f, 16, "the header says %" PRIu64 " bytes, the file has %" PRIu64,
                   h->image_bytes, image->size_bytes);
    }
    if (!db_is_zero(h->reserved0, sizeof h->reserved0) ||
        !db_is_zero(h->reserved1, sizeof h->reserved1)) {
        image_find(f, 60, "unused bytes of the header are not zero");
    }
    if (h->top != LM_IMAGE_TOP_PLAIN) {
        image_find(
            f, offsetof(struct lm_image_header, top),
            "its coarsest level is stored in another way (top %u): no program here can read it",
            h->top);
        return -1;
    }
    if (h->sensor >= LM_SENSORS) {
        image_find(f, offsetof(struct lm_image_header, sensor),
                   "its reflectivity is of sensor %u, which no program here knows", h->sensor);
        return -1;
    }
    const bool is_sound =
        h->header_bytes == LM_DB_HEADER_BYTES && h->record_bytes == LM_TILE_BYTES &&
        h->shift0 >= LM_DB_SHIFT_MIN && h->lod_count >= 1 && h->lod_count <= LM_DB_LODS_MAX &&
        h->shift0 + h->lod_count - 1 <= LM_DB_SHIFT_MAX && h->band_count >= 1 &&
        h->band_count <= LM_DB_BANDS_MAX && h->section_count >= LM_IMAGE_MANIFEST &&
        h->section_count <= LM_IMAGE_SECTIONS_MAX && h->image_bytes >= LM_DB_HEADER_BYTES;
    if (!is_sound) {
        image_find(f, 12, "a field of the header is out of its range");
    }
    return is_sound ? 0 : -1;
}

static uint64_t expected_bytes(const struct lm_image_header *h, uint32_t type)
{
    switch (type) {
    case LM_IMAGE_CLASSES:
        return sizeof(struct lm_classes);
    case LM_IMAGE_BANDS:
        return (uint64_t)h->band_count * sizeof(struct lm_band);
    case LM_IMAGE_DIRECTORY:
        return (uint64_t)h->entry_count * sizeof(struct lm_tile_entry);
    default:
        return UINT64_MAX; /* as long as it says */
    }
}

static int check_section(struct image *image, uint32_t index, struct image_findings *f)
{
    const struct lm_image_section *s = &image->header.sections[index];
    const uint64_t at = offsetof(struct lm_image_header, sections) + index * sizeof *s;
    const uint64_t expected = expected_bytes(&image->header, s->type);
    if (s->offset % LM_IMAGE_SECTION_ALIGNMENT != 0 || s->offset < LM_DB_HEADER_BYTES ||
        s->offset > image->size_bytes || s->bytes > image->size_bytes - s->offset) {
        image_find(f, at, "section %s does not lie inside the image", image_section_name(s->type));
        return -1;
    }
    if (expected != UINT64_MAX && s->bytes != expected) {
        image_find(f, at, "section %s has %" PRIu64 " bytes instead of %" PRIu64,
                   image_section_name(s->type), s->bytes, expected);
        return -1;
    }
    const bool has_places = s->type == LM_IMAGE_TILES || s->type == LM_IMAGE_DETAIL;
    if (has_places &&
        (s->bytes % LM_DB_PLACE_BYTES != 0 || s->bytes / LM_DB_PLACE_BYTES >= LM_TILE_ABSENT)) {
        image_find(f, at, "section %s has %" PRIu64 " bytes, which is no number of units of %d",
                   image_section_name(s->type), s->bytes, LM_DB_PLACE_BYTES);
        return -1;
    }
    if (s->type >= LM_IMAGE_SECTION_TYPES || s->type == 0) {
        return 0;
    }
    if (image->sections[s->type]) {
        image_find(f, at, "there are two sections %s", image_section_name(s->type));
        return -1;
    }
    image->sections[s->type] = s;
    return 0;
}

static int check_sections(struct image *image, struct image_findings *f)
{
    const struct lm_image_header *h = &image->header;
    int result = 0;
    for (uint32_t i = 0; i < h->section_count; i++) {
        result |= check_section(image, i, f);
    }
    for (uint32_t type = LM_IMAGE_CLASSES; type <= LM_IMAGE_MANIFEST; type++) {
        if (!image->sections[type]) {
            image_find(f, offsetof(struct lm_image_header, sections), "section %s is missing",
                       image_section_name(type));
            result = -1;
        }
    }
    const uint32_t unused = LM_IMAGE_SECTIONS_MAX - h->section_count;
    if (!db_is_zero(&h->sections[h->section_count], unused * sizeof h->sections[0])) {
        image_find(f, offsetof(struct lm_image_header, sections),
                   "unused section entries are not zero");
    }
    return result;
}

static int check_band(const struct image *image, uint32_t index, struct image_findings *f)
{
    const struct lm_band *b = &image->db.bands[index];
    const uint64_t at = image->sections[LM_IMAGE_BANDS]->offset + index * sizeof *b;
    if (b->reserved != 0) {
        image_find(f, at, "band %" PRIu32 ": unused bytes are not zero", index);
    }
    if (b->lod >= image->header.lod_count || b->zone > 3) {
        image_find(f, at, "band %" PRIu32 ": level %u or zone %u does not exist", index, b->lod,
                   b->zone);
        return -1;
    }
    const uint8_t shift = (uint8_t)(image->header.shift0 + b->lod);
    const uint32_t rows_all = image_rows_all(shift), round = image_columns_round(shift, b->zone);
    if (b->rows < 1 || b->row0 >= rows_all || b->rows > rows_all - b->row0 || b->columns < 1 ||
        b->column0 >= round || b->columns > round) {
        image_find(f, at, "band %" PRIu32 ": rows or columns lie outside the Earth", index);
        return -1;
    }
    const uint64_t entries = (uint64_t)b->rows * b->columns;
    if (entries > image->header.entry_count || b->entry0 > image->header.entry_count - entries) {
        image_find(f, at, "band %" PRIu32 ": its entries lie outside the directory", index);
        return -1;
    }
    if (image_row_zone(shift, b->row0) != b->zone ||
        image_row_zone(shift, b->row0 + b->rows - 1) != b->zone) {
        image_find(f, at, "band %" PRIu32 ": its rows are not all in zone %u", index, b->zone);
        return -1;
    }
    return 0;
}

static int check_bands(const struct image *image, struct image_findings *f)
{
    int result = 0;
    for (uint32_t i = 0; i < image->header.band_count; i++) {
        result |= check_band(image, i, f);
    }
    return result;
}

/* Below LM_TILE_ABSENT: check_section. */
static uint32_t units_of(const struct lm_image_section *s)
{
    return (uint32_t)(s->bytes / LM_DB_PLACE_BYTES);
}

static void fill_db(struct image *image)
{
    const struct lm_image_header *h = &image->header;
    const struct lm_image_section *detail = image->sections[LM_IMAGE_DETAIL];
    image->db = (struct lm_db){
        .lod_count = h->lod_count,
        .shift0 = h->shift0,
        .band_count = h->band_count,
        .entry_count = h->entry_count,
        .record_count = h->record_count,
        .directory_offset = image->sections[LM_IMAGE_DIRECTORY]->offset,
        .records_offset = image->sections[LM_IMAGE_TILES]->offset,
        .tiles_size = units_of(image->sections[LM_IMAGE_TILES]),
        .detail_offset = detail ? detail->offset : 0,
        .detail_size = detail ? units_of(detail) : 0,
        .mean_elevation_m_q6 = h->mean_elevation_m_q6,
        .geoid_m_q6 = h->geoid_m_q6,
        .centre_latitude = h->centre_latitude,
        .centre_longitude = h->centre_longitude,
        .sensor = h->sensor,
    };
    memcpy(&image->db.classes, image->bytes + image->sections[LM_IMAGE_CLASSES]->offset,
           sizeof image->db.classes);
    memcpy(image->db.bands, image->bytes + image->sections[LM_IMAGE_BANDS]->offset,
           h->band_count * sizeof(struct lm_band));
    image->entries = (const void *)(image->bytes + image->db.directory_offset);
}

/* The head of the targets says how many there are. */
static int read_targets_head(struct image *image, struct image_findings *f)
{
    const struct lm_image_section *s = image->sections[LM_IMAGE_TARGETS];
    struct lm_targets_head head;
    if (!s) {
        return 0;
    }
    if (s->bytes < sizeof head) {
        image_find(f, s->offset, "section TARGETS is too short for its head");
        return -1;
    }
    memcpy(&head, image->bytes + s->offset, sizeof head);
    if (fx_crc32c(0, &head, offsetof(struct lm_targets_head, crc)) != head.crc ||
        head.record_bytes != LM_TARGET_BYTES || head.count > LM_DB_TARGETS_MAX ||
        s->bytes != sizeof head + (uint64_t)head.count * LM_TARGET_BYTES) {
        image_find(f, s->offset, "the head of section TARGETS does not fit it or its checksum");
        return -1;
    }
    if (!db_is_zero(head.reserved, sizeof head.reserved)) {
        image_find(f, s->offset, "unused bytes of the head of section TARGETS are not zero");
    }
    image->db.target_count = head.count;
    image->db.targets_offset = s->offset + sizeof head;
    image->targets = (const void *)(image->bytes + image->db.targets_offset);
    return 0;
}

static int read_signatures_head(struct image *image, struct image_findings *f)
{
    const struct lm_image_section *s = image->sections[LM_IMAGE_SIGNATURES];
    struct lm_signatures_head head;
    if (!s) {
        return 0;
    }
    if (s->bytes < sizeof head) {
        image_find(f, s->offset, "section SIGNATURES is too short for its head");
        return -1;
    }
    memcpy(&head, image->bytes + s->offset, sizeof head);
    if (!db_signatures_head_fits(&head, s->bytes)) {
        image_find(f, s->offset, "the head of section SIGNATURES does not fit it or its checksum");
        return -1;
    }
    if (!db_signatures_head_rest_is_zero(&head)) {
        image_find(f, s->offset, "unused bytes of the head of section SIGNATURES are not zero");
    }
    image->db.signature_count = head.count;
    image->db.chip_count = head.chip_count;
    image->db.signatures_offset = s->offset + sizeof head;
    image->db.chips_offset =
        image->db.signatures_offset + (uint64_t)head.count * LM_SIGNATURE_BYTES;
    image->signatures = (const void *)(image->bytes + image->db.signatures_offset);
    image->chips = (const void *)(image->bytes + image->db.chips_offset);
    return 0;
}

static int read_geoid(struct image *image, struct image_findings *f)
{
    const struct lm_image_section *s = image->sections[LM_IMAGE_GEOID];
    struct lm_geoid *g = &image->db.geoid;
    if (!s) {
        return 0;
    }
    if (s->bytes != sizeof *g) {
        image_find(f, s->offset, "section GEOID has not its %zu bytes", sizeof *g);
        return -1;
    }
    memcpy(g, image->bytes + s->offset, sizeof *g);
    if (!lm_geoid_is_sound(g)) {
        image_find(f, s->offset, "section GEOID: a number of the grid is out of its range");
        return -1;
    }
    if (!db_is_zero(g->reserved0, sizeof g->reserved0) ||
        !db_is_zero(g->reserved1, sizeof g->reserved1) || g->crc != 0) {
        image_find(f, s->offset, "unused bytes of section GEOID are not zero");
    }
    return 0;
}

static int read_geoid_pages(struct image *image, struct image_findings *f)
{
    const struct lm_image_section *s = image->sections[LM_IMAGE_GEOID_PAGES];
    struct lm_geoid_pages *p = &image->db.geoid_pages;
    struct lm_geoid_pages_head head;
    if (!s) {
        return 0;
    }
    memcpy(&head, image->bytes + s->offset, s->bytes < sizeof head ? s->bytes : sizeof head);
    if (s->bytes < sizeof head || !lm_geoid_pages_are_sound(&head, s->bytes) ||
        fx_crc32c(0, &head, offsetof(struct lm_geoid_pages_head, crc)) != head.crc) {
        image_find(f, s->offset, "the head of section GEOID_PAGES does not hold");
        return -1;
    }
    *p = (struct lm_geoid_pages){.offset = s->offset + sizeof head,
                                 .shift = head.shift,
                                 .row0 = head.row0,
                                 .rows = head.rows,
                                 .column0 = head.column0,
                                 .columns = head.columns};
    for (uint32_t i = 0; i < head.rows * head.columns; i++) {
        struct lm_geoid page;
        const uint64_t at = p->offset + i * (uint64_t)sizeof page;
        memcpy(&page, image->bytes + at, sizeof page);
        if (!lm_geoid_page_is_sound(p, i + 1, &page)) {
            image_find(f, at, "page %" PRIu32 " of the geoid does not hold", i + 1);
        } else if (!db_is_zero(page.reserved0, sizeof page.reserved0) ||
                   !db_is_zero(page.reserved1, sizeof page.reserved1)) {
            image_find(f, at, "unused bytes of page %" PRIu32 " of the geoid are not zero", i + 1);
        }
    }
    return 0;
}

/* The radar table is needed by nothing else: what is wrong with it is noted, and the rest read. */
static void read_radar(struct image *image, struct image_findings *f)
{
    const struct lm_image_section *s = image->sections[LM_IMAGE_RADAR];
    struct lm_radar_fault fault;
    if (!s) {
        return;
    }
    const uint32_t bytes = s->bytes > UINT32_MAX ? UINT32_MAX : (uint32_t)s->bytes;
    const int status = lm_radar_unpack(&image->radar, image->bytes + s->offset, bytes);
    image->has_radar = status == LM_OK;
    image->db.radar_offset = s->offset;
    image->db.radar_bytes = bytes;
    if (status == LM_ERR_TABLE && lm_radar_check(&image->radar, &fault) != LM_OK) {
        image_find(f, s->offset, "section RADAR: %s, element %" PRIu32 ", must be %s", fault.field,
                   fault.index, fault.needs ? fault.needs : "inside its range");
    } else if (status != LM_OK) {
        image_find(f, s->offset, "section RADAR: %s",
                   status == LM_ERR_VERSION ? "a table of another version"
                                            : "its length or its checksum does not fit it");
    } else if (image->radar.sensor != image->header.sensor) {
        image_find(f, s->offset, "section RADAR: a radar of band %s, for reflectivity of %s",
                   lm_sensor_word(image->radar.sensor), lm_sensor_word(image->header.sensor));
    }
}

/* So is the bus table. */
static void read_bus(struct image *image, struct image_findings *f)
{
    const struct lm_image_section *s = image->sections[LM_IMAGE_BUS];
    struct lm_bus_table table = {0};
    if (!s) {
        return;
    }
    image->db.bus_offset = s->offset;
    image->db.bus_bytes = s->bytes > UINT32_MAX ? UINT32_MAX : (uint32_t)s->bytes;
    const int status = lm_bus_unpack(&table, image->bytes + s->offset, image->db.bus_bytes);
    if (status == LM_OK) {
        memcpy(image->bus_name, table.name, sizeof image->bus_name);
        return;
    }
    uint32_t row = 0;
    if (status == LM_ERR_TABLE && lm_bus_profile_check(&table.profile, &row) != LM_OK && row != 0) {
        image_find(f, s->offset, "section BUS: row %" PRIu32 " breaks what a bus table must keep",
                   row);
        return;
    }
    image_find(f, s->offset, "section BUS: %s",
               status == LM_ERR_VERSION ? "a table of another version"
               : status == LM_ERR_TABLE ? "a field or a framing that is not known"
                                        : "its length or its checksum does not fit it");
}

/* Compressed records need room to be unpacked; an image that has none does without. */
static int make_room(struct image *image, struct image_findings *f)
{
    bool is_needed = false;
    for (uint32_t i = 0; i < image->header.entry_count; i++) {
        is_needed = is_needed || image->entries[i].encoding == LM_TILE_LZ4;
    }
    if (!is_needed || image->unpacked) {
        return 0;
    }
    image->unpacked = image_unpacked_new(image->header.entry_count, IMAGE_UNPACKED_TILES);
    if (!image->unpacked) {
        image_find(f, image->db.records_offset, "not enough memory to unpack its tiles");
    }
    return image->unpacked ? 0 : -1;
}

int image_read_tables(struct image *image, struct image_findings *findings)
{
    if (image->size_bytes < sizeof image->header) {
        image_find(findings, 0, "%" PRIu64 " bytes are too few for a header", image->size_bytes);
        return -1;
    }
    memcpy(&image->header, image->bytes, sizeof image->header);
    if (check_header(image, findings) != 0 || check_sections(image, findings) != 0) {
        return -1;
    }
    fill_db(image);
    if (make_room(image, findings) != 0) {
        return -1;
    }
    read_radar(image, findings);
    read_bus(image, findings);
    if (read_geoid(image, findings) != 0 || read_geoid_pages(image, findings) != 0) {
        return -1;
    }
    return read_targets_head(image, findings) == 0 && read_signatures_head(image, findings) == 0
               ? check_bands(image, findings)
               : -1;
}

int image_open(struct image *image, const char *path)
{
    if (image_map(image, path) != 0) {
        return -1;
    }
    struct image_findings findings = {stderr, 0, 4, false, NULL};
    if (image_read_tables(image, &findings) != 0 || findings.count > 0) {
        const bool is_other_version = image->header.version != LM_DB_VERSION &&
                                      memcmp(image->header.magic, "LANDMASS", 8) == 0;
        image_close(image);
        return hs_error(path,
                        is_other_version ? IMAGE_OTHER_VERSION_REMEDY
                                         : "`landmass-db verify` says more; build the image "
                                           "again",
                        is_other_version ? "is an image of another version"
                                         : "is not a sound image");
    }
    return 0;
}

const struct lm_tile *image_entry_tile(const struct image *image, uint32_t entry)
{
    const struct lm_tile_entry *e = &image->entries[entry];
    if (lm_db_entry_check(&image->db, entry, e) != LM_OK || e->place == LM_TILE_ABSENT) {
        return NULL;
    }
    const uint8_t *record = image->bytes + image_record_offset(image, entry);
    return e->encoding == LM_TILE_RAW
               ? (const void *)record
               : image_unpacked_tile(image->unpacked, entry, record, e->size);
}

bool image_copy_tile(const struct image *image, uint32_t entry, struct lm_tile *tile)
{
    const struct lm_tile_entry *e = &image->entries[entry];
    if (lm_db_entry_check(&image->db, entry, e) != LM_OK || e->place == LM_TILE_ABSENT) {
        return false;
    }
    (void)image_unpack(image->bytes + image_record_offset(image, entry), e->size, tile);
    return true;
}

const struct lm_tile *image_find_tile(const struct image *image, uint8_t level, uint32_t row,
                                      uint32_t column)
{
    const int64_t entry = lm_db_entry(&image->db, level, row, column);
    return entry < 0 ? NULL : image_entry_tile(image, (uint32_t)entry);
}

uint64_t image_record_offset(const struct image *image, uint32_t entry)
{
    return lm_db_tile_offset(&image->db, &image->entries[entry]);
}

const struct lm_band *image_band(const struct image *image, uint8_t level, uint32_t row)
{
    for (uint32_t i = 0; i < image->header.band_count; i++) {
        const struct lm_band *b = &image->db.bands[i];
        if (b->lod == level && row >= b->row0 && row - b->row0 < b->rows) {
            return b;
        }
    }
    return NULL;
}

static int by_place(const void *a, const void *b, void *entries)
{
    const struct lm_tile_entry *all = entries;
    const uint32_t x = all[*(const uint32_t *)a].place, y = all[*(const uint32_t *)b].place;
    return (x > y) - (x < y);
}

void image_sort_by_place(const struct image *image, uint32_t *entries, uint32_t count)
{
    qsort_r(entries, count, sizeof *entries, by_place, (void *)image->entries);
}
