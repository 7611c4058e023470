#include "flags.h"

#include "lm/bit.h"
#include "lm/units.h"
#include "ownship.h"

enum {
    TILE_FAULT_SHOWN_US = 3000000,
    READ_US = 1000000, /* a read that takes longer will not end */
    SENDER_SHOWN_US = 3000000,
    /* An aircraft on the ground, or a height that is a little wrong, is not below the terrain.
     * UNSOURCED. */
    BELOW_M_Q10 = 10 << 10
};

/* A read that never ends is no error of the flash's, and yet no tile comes any more. */
static bool is_read_stuck(struct lm_unit *u, uint64_t now_us)
{
    const struct lm_tile_cache *tiles = &u->map.tiles;
    if (!u->map.is_usable || lm_tile_cache_is_idle(tiles) ||
        tiles->count.bytes_read != u->tile_faults.bytes_asked) {
        u->tile_faults.bytes_asked = tiles->count.bytes_read;
        u->tile_faults.asked_us = now_us;
    }
    return now_us - u->tile_faults.asked_us > READ_US;
}

static uint32_t map_flags(struct lm_unit *u, uint64_t now_us)
{
    const uint32_t faults = u->map.tiles.count.io_errors + lm_unit_map_corrupt_records(&u->map);
    if (faults != u->tile_faults.seen) {
        u->tile_faults.seen = faults;
        u->tile_faults.grew_us = now_us;
    }
    const bool is_fault = is_read_stuck(u, now_us) || lm_unit_map_refused(&u->map) != 0 ||
                          (faults != 0 && now_us - u->tile_faults.grew_us < TILE_FAULT_SHOWN_US);
    return (u->map.is_usable ? 0u : LM_FLAG_DB) | (is_fault ? LM_FLAG_TILE : 0u);
}

static uint32_t nav_flags(const struct lm_unit *u)
{
    const struct lm_ownship *own = &u->ownship;
    if (!lm_picture_needs_ownship(&u->picture)) {
        return 0;
    }
    if (u->is_polar) {
        return LM_FLAG_POLE;
    }
    if (own->position_quality == LM_NAV_DEAD || own->height_quality == LM_NAV_DEAD ||
        own->heading_quality == LM_NAV_DEAD) {
        return LM_FLAG_NAV_DEAD;
    }
    const bool is_good = own->position_quality == LM_NAV_GOOD &&
                         own->height_quality == LM_NAV_GOOD && own->heading_quality == LM_NAV_GOOD;
    return (is_good ? 0 : LM_FLAG_NAV_STALE) | (own->is_heading_magnetic ? LM_FLAG_MAGNETIC : 0u);
}

/* LM_FLAG_BELOW, by the elevation read last. */
static uint32_t terrain_flags(const struct lm_unit *u)
{
    const struct lm_ownship *own = &u->ownship;
    if (!u->map.is_usable || u->ground_m_q10 == LM_NO_ELEVATION || !lm_ownship_is_known(own) ||
        own->height_quality == LM_NAV_DEAD) {
        return 0;
    }
    const int32_t height_m_q10 = lm_m_q10_of_m_q6(lm_antenna_height_m_q6(own, &u->map));
    return height_m_q10 + BELOW_M_Q10 < u->ground_m_q10 ? LM_FLAG_BELOW : 0;
}

/* LM_FLAG_SENDER, for a while after one of the counts grew. */
static uint32_t sender_flags(struct lm_unit *u, uint64_t now_us)
{
    const struct lm_sender_counts now = lm_sender_counts(u);
    const uint8_t kind = now.disagreements != u->senders.disagreements ? 3
                         : now.rivals != u->senders.rivals             ? 2
                         : now.stuck != u->senders.stuck               ? 1
                                                                       : 0;
    if (kind != 0) {
        u->senders.stuck = now.stuck;
        u->senders.rivals = now.rivals;
        u->senders.disagreements = now.disagreements;
        u->senders.grew_us = now_us;
        u->senders.kind = kind;
    }
    return u->senders.kind != 0 && now_us - u->senders.grew_us < SENDER_SHOWN_US ? LM_FLAG_SENDER
                                                                                 : 0;
}

/* Of two interfaces, either. */
static bool is_bus_silent(const struct lm_unit *u, uint64_t now_us)
{
    return now_us - u->last_bus_us > LM_BUS_SILENT_US ||
           (u->board->can_2 && now_us - u->last_bus_2_us > LM_BUS_SILENT_US);
}

/* By itself, or by whoever had it begin with the settings of before. */
static bool has_restarted(const struct lm_unit *u)
{
    return u->is_restored || u->board->restart != NULL;
}

uint32_t lm_update_flags(struct lm_unit *u, uint64_t now_us)
{
    const uint32_t flags =
        map_flags(u, now_us) | nav_flags(u) | sender_flags(u, now_us) | terrain_flags(u) |
        (u->page.is_frozen ? LM_FLAG_FROZEN : 0u) | (u->page.is_override ? LM_FLAG_SILENT : 0u) |
        (u->picture.coverage.is_off_map ? LM_FLAG_OFF_MAP : 0u) |
        (u->weather.is_stale ? LM_FLAG_WEATHER : 0u) |
        (u->exercise.is_stale || u->malfunctions.is_stale || u->live.is_silent ? LM_FLAG_EXERCISE
                                                                               : 0u) |
        (u->malfunctions.now.set != 0 ? LM_FLAG_MALFUNCTION : 0u) |
        (u->board->is_database_unsigned || u->unsigned_places != 0 ? LM_FLAG_UNSIGNED : 0u) |
        (now_us < u->unable.until_us ? LM_FLAG_UNABLE : 0u) |
        (has_restarted(u) && now_us < LM_RESTART_SHOWN_US ? LM_FLAG_RESTART : 0u) |
        (is_bus_silent(u, now_us) ? LM_FLAG_BUS : 0u);
    const uint32_t risen = flags & ~u->flags;
    lm_fault_log_add(&u->faults, risen, now_us);
    u->flags = flags;
    return risen;
}
