/* Database image: header, heads of sections, tile directory (lm/db.h).
 *
 * Proved: prove_header, prove_band, prove_classes: what passes a check has the ranges that lm/db.h
 * names, so that no row, column or shift of a tile leaves its type. prove_section: a section that
 * is found lies inside the image. prove_entry: a directory entry that passes leads into TILES and
 * DETAIL, a record's size is 1..273 units. Any checksum may match. prove_lookup: a tile that is
 * found by any row and column lies in a band, and its entry is one of that band's. prove_inside: it
 * is one of the directory's, in bands of up to 31 rows and columns; a product of longer numbers is
 * too much for the solver.
 *
 * Assumed: no flash is larger than 2^62 bytes. */
#include "firmware/map/db.c"

#include "prove.h"

struct lm_db nondet_db(void);
struct lm_image_header nondet_header(void);
struct lm_tile_entry nondet_entry(void);
struct lm_classes nondet_classes(void);

uint32_t fx_crc32c(uint32_t crc, const void *data, size_t len)
{
    PROVE(__CPROVER_r_ok(data, len));
    return nondet_u32();
}

bool lm_geoid_is_sound(const struct lm_geoid *g)
{
    return nondet_bool();
}

static struct lm_image_header a_sound_header(void)
{
    struct lm_image_header h = nondet_header();
    const uint64_t flash_bytes = nondet_u64();
    ASSUME(flash_bytes < 1ull << 62 && header_is_sound(&h, flash_bytes));
    return h;
}

static struct lm_db a_db(const struct lm_flash *flash, const struct lm_image_header *h)
{
    struct lm_db db = nondet_db();
    db.flash = flash;
    db.shift0 = h->shift0;
    db.lod_count = h->lod_count;
    db.band_count = h->band_count;
    db.entry_count = h->entry_count;
    return db;
}

void prove_header(void)
{
    const struct lm_image_header h = a_sound_header();
    PROVE(h.shift0 + h.lod_count - 1 + LM_TILE_CELLS_LOG2 + 3 < 32);
    PROVE(h.shift0 >= LM_DB_SHIFT_MIN && h.lod_count >= 1 && h.lod_count <= LM_DB_LODS_MAX &&
          h.shift0 + h.lod_count - 1 <= LM_DB_SHIFT_MAX);
    PROVE(h.band_count <= LM_DB_BANDS_MAX && h.section_count <= LM_IMAGE_SECTIONS_MAX);
    PROVE(h.mean_elevation_m_q6 >= -(1 << 20) && h.mean_elevation_m_q6 <= 1 << 20);
}

void prove_section(void)
{
    const struct lm_image_header h = a_sound_header();
    const uint64_t bytes = nondet_u64();
    const struct lm_image_section *s = find_section(&h, nondet_u32(), bytes);
    if (s != NULL) {
        PROVE(s >= h.sections && s < h.sections + h.section_count && s->bytes == bytes);
        PROVE(s->offset <= h.image_bytes && s->bytes <= h.image_bytes - s->offset &&
              s->offset % 64 == 0);
    }
}

void prove_band(void)
{
    const struct lm_image_header h = a_sound_header();
    const struct lm_db db = a_db(NULL, &h);
    const struct lm_band *b = &db.bands[0];
    if (band_is_sound(&db, b)) {
        const uint32_t shift = db.shift0 + b->lod + LM_TILE_CELLS_LOG2;
        PROVE(b->lod < db.lod_count && b->zone <= 3 && shift + b->zone < 32);
        PROVE((uint64_t)b->row0 + b->rows <= 1ull << (31 - shift));
        PROVE(b->column0 < 1u << (32 - shift - b->zone) &&
              b->columns <= 1u << (32 - shift - b->zone));
        PROVE(b->entry0 < db.entry_count);
    }
}

void prove_classes(void)
{
    const struct lm_classes c = nondet_classes();
    const uint32_t i = nondet_u32();
    ASSUME(i < LM_DB_CLASSES);
    if (classes_are_sound(&c)) {
        PROVE(c.entry[i].kind <= LM_KIND_TREES && c.entry[i].facing <= LM_FACINGS &&
              c.height_dm[0] == 0);
        PROVE(i == 0 || c.height_dm[i] >= c.height_dm[i - 1]);
    }
}

void prove_entry(void)
{
    const struct lm_db db = nondet_db();
    const struct lm_tile_entry e = nondet_entry();
    ASSUME(db.records_offset < 1ull << 62);
    if (lm_db_entry_check(&db, nondet_u32(), &e) == LM_OK && e.place != LM_TILE_ABSENT) {
        PROVE(e.size >= 1 && e.size <= LM_TILE_BYTES / LM_DB_PLACE_BYTES);
        PROVE((uint64_t)e.place + e.size <= db.tiles_size);
        PROVE(e.encoding == LM_TILE_RAW || e.size < LM_TILE_BYTES / LM_DB_PLACE_BYTES);
        PROVE(e.detail_place == LM_TILE_ABSENT ||
              (uint64_t)e.detail_place + e.detail_size <= db.detail_size);
        PROVE(lm_db_tile_offset(&db, &e) - db.records_offset <= 64ull * db.tiles_size);
    }
}

/* An image of one band, of any shift that a header may have: each further band is a turn of the
 * same loop. */
static struct lm_db a_db_of_a_band(void)
{
    struct lm_db db = nondet_db();
    ASSUME(db.shift0 >= LM_DB_SHIFT_MIN && db.lod_count >= 1 && db.lod_count <= LM_DB_LODS_MAX &&
           db.shift0 + db.lod_count - 1 <= LM_DB_SHIFT_MAX);
    db.band_count = 1;
    ASSUME(band_is_sound(&db, &db.bands[0]));
    return db;
}

void prove_lookup(void)
{
    const struct lm_db db = a_db_of_a_band();
    const struct lm_band *b = &db.bands[0];
    const uint8_t lod = nondet_u8();
    const uint32_t row = nondet_u32(), column = nondet_u32();
    const int64_t entry = lm_db_entry(&db, lod, row, column);
    PROVE(entry == -1 || entry >= b->entry0);
    PROVE(entry == -1 || (lod == b->lod && row >= b->row0 && row - b->row0 < b->rows));
    PROVE(entry == -1 || column >> (26 - db.shift0 - lod - b->zone) == 0);
}

void prove_inside(void)
{
    const struct lm_db db = a_db_of_a_band();
    ASSUME(db.bands[0].rows < 32 && db.bands[0].columns < 32);
    PROVE(lm_db_entry(&db, nondet_u8(), nondet_u32(), nondet_u32()) < db.entry_count);
}
