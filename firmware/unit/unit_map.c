#include "lm/unit_map.h"

#include "fx/mem.h"
#include "fx/sat.h"

enum { TILE_READS_A_STEP = 16 };

/* Read the image's targets. No tile is being read yet, so this may wait for the flash. */
static void read_targets(struct lm_unit_map *m, uint32_t poll_limit)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < m->db.target_count && count < LM_TARGETS_MAX; i++) {
        if (lm_target_read(&m->db, i, &m->targets[count], poll_limit) == LM_OK) {
            count++;
        }
    }
    m->target_set.items = m->targets;
    m->target_set.count = count;
    m->count.targets_lost = m->db.target_count - count;
}

/* Read the image's signatures. Targets name them by number, so each keeps its number, and one that
 * is lost is left empty: its targets return no echo. */
static void read_signatures(struct lm_unit_map *m, uint32_t poll_limit)
{
    const uint32_t count = fx_min_u32(m->db.signature_count, LM_SIGNATURES_MAX);
    m->count.signatures_lost = m->db.signature_count - count;
    for (uint32_t i = 0; i < count; i++) {
        if (lm_signature_read(&m->db, i, &m->signatures[i], poll_limit) != LM_OK) {
            memset(&m->signatures[i], 0, sizeof m->signatures[i]);
            m->count.signatures_lost++;
        }
    }
    m->target_set.signatures = m->signatures;
    m->target_set.signature_count = count;
    lm_chips_init(&m->chips, &m->db, m->signatures);
}

int lm_unit_map_open(struct lm_unit_map *m, const struct lm_unit_map_lent *lent)
{
    memset(m, 0, sizeof *m);
    m->open_status = lm_db_open(&m->db, lent->flash, lent->flash_poll_limit);
    m->is_usable = m->open_status == LM_OK;
    if (!m->is_usable) {
        return LM_OK;
    }
    read_targets(m, lent->flash_poll_limit);
    read_signatures(m, lent->flash_poll_limit);
    return lm_tile_cache_init(&m->tiles, &m->db, lent->tile_pool, lent->tile_pool_bytes,
                              lent->flash_poll_limit);
}

void lm_unit_map_service(struct lm_unit_map *m, uint64_t now_us)
{
    if (m->is_usable) {
        lm_chips_service(&m->chips, &m->tiles);
        lm_tile_cache_service(&m->tiles, now_us, TILE_READS_A_STEP);
    }
}

uint32_t lm_unit_map_corrupt_records(const struct lm_unit_map *m)
{
    return m->tiles.count.corrupt + m->chips.count.corrupt;
}
