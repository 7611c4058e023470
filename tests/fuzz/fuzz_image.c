/* A flash image of any bytes: opened, its coarsest level read, its tiles looked up and sampled. The
 * first byte of the input says which checksums are put right, the next eight where to look; the
 * rest is the image. */
#include "fuzz.h"
#include "lm/geoid_reader.h"
#include "lm/scan_line.h"
#include "memory_flash.h"
#include "seal.h"

const uint32_t fuzz_mutations = 60000;

enum { SLOTS = 24, POLLS = 128 };

static void sample(struct lm_tile_cache *cache, struct lm_scan_line *line, struct lm_position from,
                   uint32_t cell_mm)
{
    struct lm_geo_origin origin;
    struct lm_ground_path path;
    lm_geo_set_origin(&origin, from);
    const struct lm_position points[3] = {from, lm_geo_direct(&origin, 0x2AAAAAAA, 2560000),
                                          lm_geo_direct(&origin, 0x2AAAAAAA, 5120000)};
    const uint8_t level = lm_scan_lod(cache->db, cell_mm);
    for (int i = 0; i < 2; i++) {
        lm_ground_path_fit(&path, points, 64);
        lm_scan_line_run(line, cache, level, NULL, &path, 64); /* asks for what is missing */
        lm_tile_cache_service(cache, (uint64_t)i * 2000000, POLLS);
    }
    (void)lm_scan_elevation(cache, level, from, 0);
}

static void look_at_bands(struct lm_tile_cache *cache)
{
    const struct lm_db *db = cache->db;
    for (uint32_t i = 0; i < db->band_count && i < 8; i++) {
        const struct lm_band *b = &db->bands[i];
        const struct lm_tile *tile =
            lm_tile_cache_get(cache, b->lod, b->row0 + b->rows - 1, b->column0 + b->columns - 1);
        FUZZ_ASSERT(!tile || tile->lod >= b->lod);
        const int64_t entry = lm_db_entry(db, b->lod, b->row0, b->column0);
        FUZZ_ASSERT(entry >= 0 && entry < db->entry_count);
    }
    lm_tile_cache_service(cache, 0, POLLS);
}

static void read_geoid_page(struct lm_tile_cache *cache, struct lm_position place)
{
    struct lm_geoid_reader *reader = calloc(1, sizeof *reader);
    FUZZ_ASSERT(reader);
    lm_geoid_reader_service(reader, cache, cache->db, place);
    lm_tile_cache_service(cache, 0, POLLS);
    lm_geoid_reader_service(reader, cache, cache->db, place);
    const int32_t height_m_q6 = lm_geoid_reader_height_m_q6(reader, cache->db, place);
    FUZZ_ASSERT(height_m_q6 >= -(1 << 20) && height_m_q6 <= 1 << 20);
    free(reader);
}

static void use(const struct lm_db *db, struct fuzz_supply *s)
{
    struct lm_tile_cache *cache = malloc(sizeof *cache);
    struct lm_scan_line *line = malloc(sizeof *line);
    uint8_t *pool = malloc(SLOTS * sizeof(struct lm_tile));
    FUZZ_ASSERT(cache && line && pool);
    const struct lm_position there = {fuzz_u32(s), fuzz_u32(s)};
    const struct lm_position centre = {db->centre_latitude, db->centre_longitude};
    if (db->geoid.rows > 0) {
        const int32_t height_m_q6 = lm_geoid_height_m_q6(&db->geoid, there);
        FUZZ_ASSERT(height_m_q6 >= INT16_MIN && height_m_q6 <= INT16_MAX);
    }
    if (lm_tile_cache_init(cache, db, pool, SLOTS * sizeof(struct lm_tile), POLLS) == LM_OK) {
        look_at_bands(cache);
        lm_tile_cache_keep_around(cache, there);
        read_geoid_page(cache, there);
        lm_tile_cache_service(cache, 0, POLLS);
        for (uint32_t cell_mm = 500; cell_mm < 100000000; cell_mm *= 40) {
            sample(cache, line, centre, cell_mm);
            sample(cache, line, there, cell_mm);
        }
        FUZZ_ASSERT(cache->count.substituted <= cache->count.misses);
    }
    free(pool);
    free(line);
    free(cache);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const uint8_t parts = fuzz_u8(&supply);
    struct fuzz_supply place = supply;
    (void)fuzz_take(&supply, 8);
    uint8_t *image = malloc(supply.left + 1);
    struct lm_db *db = malloc(sizeof *db);
    FUZZ_ASSERT(image && db);
    memcpy(image, supply.at, supply.left);
    seal_image(image, supply.left, parts);
    struct memory_flash flash;
    memory_flash_open(&flash, image, supply.left);
    flash.fail_every = parts >> 4;
    if (lm_db_open(db, &flash.port, POLLS) == LM_OK) {
        use(db, &place);
    }
    free(db);
    free(image);
    return 0;
}
