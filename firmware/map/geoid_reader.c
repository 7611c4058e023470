#include "lm/geoid_reader.h"

/* The read has ended, well or not. */
static void take_page(struct lm_geoid_reader *r, const struct lm_geoid_pages *pages)
{
    const bool is_read = r->read.status == LM_OK;
    const bool is_sound = is_read && lm_geoid_page_is_sound(pages, r->reading, &r->page);
    r->corrupt += is_read && !is_sound;
    r->resident = is_sound ? r->reading : 0;
    r->lost = is_sound ? 0 : r->reading;
    r->reading = 0;
}

void lm_geoid_reader_service(struct lm_geoid_reader *r, struct lm_tile_cache *tiles,
                             const struct lm_db *db, struct lm_position place)
{
    const struct lm_geoid_pages *pages = &db->geoid_pages;
    const uint32_t wanted = lm_geoid_page_of(pages, place);
    if (r->reading != 0) {
        if (r->read.status == LM_BUSY) {
            return;
        }
        take_page(r, &r->db->geoid_pages);
    }
    if (r->db != db) {
        r->db = db;
        r->resident = r->lost = 0;
    }
    if (wanted == 0 || wanted == r->resident || wanted == r->lost) {
        return;
    }
    r->read =
        (struct lm_flash_request){.offset = pages->offset + (wanted - 1) * (uint64_t)sizeof r->page,
                                  .destination = &r->page,
                                  .length = sizeof r->page};
    if (lm_tile_cache_read(tiles, &r->read)) {
        r->reading = wanted;
        r->resident = 0;
    }
}

int32_t lm_geoid_reader_height_m_q6(const struct lm_geoid_reader *r, const struct lm_db *db,
                                    struct lm_position place)
{
    const uint32_t page = lm_geoid_page_of(&db->geoid_pages, place);
    if (page != 0 && page == r->resident && db == r->db) {
        return lm_geoid_height_m_q6(&r->page, place);
    }
    return db->geoid.rows > 0 ? lm_geoid_height_m_q6(&db->geoid, place) : db->geoid_m_q6;
}
