/* Chains of slots and ring of requests of the tile cache (lm/tile_cache.h).
 *
 * Invariant: each slot in use is in the chain of its tile, once, and no other slot is in any chain;
 * so a walk along a chain ends. The ring holds at most LM_TILE_REQUESTS.
 *
 * Proved, for any cache that keeps it and any tile: no access outside an object, loops end; a
 * request keeps the ring. prove_find: a tile that is found is the one that was asked for.
 * prove_claim: a slot that is given to another tile leaves its chain and enters the right one, in
 * which the tile is then found; a slot that is read or pinned is never taken. prove_queue: a
 * request is taken, or it is there already, or the ring is full and it is counted.
 *
 * Assumed: three slots, two chains and two LODs stand for all; the .proof file shrinks the tables.
 * The reading of records is proved elsewhere (`db`, `lz4`). */
#include "firmware/map/tile_cache.c"

#include "prove.h"

enum { LODS = 2 };

struct lm_tile_cache nondet_cache(void);
struct lm_db nondet_db(void);

/* Walk along a chain; false if a slot of another one is in it. Adds the slots to *total. */
static bool is_chain(const struct lm_tile_cache *c, uint8_t lod, uint32_t chain, uint32_t *total)
{
    uint16_t i = c->heads[lod][chain];
    for (uint32_t n = 0; n < LM_TILE_SLOTS_MAX && i < LM_SLOT_NONE; n++) {
        const struct lm_tile_slot *s = &c->slots[i];
        if (s->state == LM_SLOT_FREE || s->lod != lod ||
            lm_tile_chain(s->row, s->column) != chain) {
            return false;
        }
        *total += 1;
        i = s->next;
    }
    return i == LM_SLOT_NONE;
}

static bool is_kept(const struct lm_tile_cache *c)
{
    uint32_t chained = 0, used = 0;
    bool are_chains = true;
    for (uint32_t n = 0; n < LODS * LM_TILE_CHAINS; n++) {
        are_chains =
            are_chains && is_chain(c, (uint8_t)(n / LM_TILE_CHAINS), n % LM_TILE_CHAINS, &chained);
    }
    for (uint32_t i = 0; i < LM_TILE_SLOTS_MAX; i++) {
        used += c->slots[i].state != LM_SLOT_FREE;
    }
    return are_chains && chained == used && c->slot_count == LM_TILE_SLOTS_MAX &&
           c->wanted_head - c->wanted_tail <= LM_TILE_REQUESTS;
}

static struct lm_db db;

static struct lm_tile_cache a_cache(void)
{
    struct lm_tile_cache c = nondet_cache();
    db.lod_count = LODS;
    c.db = &db;
    ASSUME(is_kept(&c));
    return c;
}

void prove_find(void)
{
    const struct lm_tile_cache c = a_cache();
    const uint32_t row = nondet_u32(), column = nondet_u32();
    const uint8_t lod = nondet_u8();
    ASSUME(lod < LODS);
    const uint16_t i = find(&c, lod, row, column);
    PROVE(i == LM_SLOT_NONE ||
          (i < LM_SLOT_NONE && c.slots[i].state != LM_SLOT_FREE && c.slots[i].lod == lod &&
           c.slots[i].row == row && c.slots[i].column == column));
}

void prove_claim(void)
{
    struct lm_tile_cache c = a_cache();
    const struct lm_tile_key key = {nondet_u32(), nondet_u32(), nondet_u32(), nondet_u8(), 0};
    ASSUME(key.lod < LODS);
    uint32_t kept = 0; /* bit n: slot n must not be taken */
    for (uint32_t n = 0; n < LM_TILE_SLOTS_MAX; n++) {
        const bool is_top =
            c.is_top_resident && c.slots[n].state == LM_SLOT_RESIDENT && c.slots[n].lod == LODS - 1;
        kept |= (uint32_t)(is_top || c.slots[n].state == LM_SLOT_READING) << n;
    }
    const uint16_t i = claim_slot(&c, &key);
    PROVE(i <= LM_SLOT_NONE);
    PROVE(i < LM_SLOT_NONE || kept == (1u << LM_TILE_SLOTS_MAX) - 1);
    if (i < LM_SLOT_NONE) {
        PROVE((kept >> i & 1) == 0);
        c.slots[i].state = LM_SLOT_READING; /* as whoever claims it does */
        PROVE(find(&c, key.lod, key.row, key.column) == i);
    }
    PROVE(is_kept(&c));
}

void prove_queue(void)
{
    struct lm_tile_cache c = nondet_cache();
    const struct lm_tile_key key = {nondet_u32(), nondet_u32(), nondet_u32(), nondet_u8()};
    ASSUME(c.wanted_head - c.wanted_tail <= LM_TILE_REQUESTS);
    const uint32_t head = c.wanted_head, dropped = c.count.requests_dropped;
    const bool is_full = c.wanted_head - c.wanted_tail == LM_TILE_REQUESTS;
    queue_request(&c, &key);
    PROVE(c.wanted_head - c.wanted_tail <= LM_TILE_REQUESTS);
    PROVE(c.wanted_head == head || (c.wanted_head == head + 1 && !is_full &&
                                    c.wanted[head % LM_TILE_REQUESTS].entry == key.entry));
    PROVE(c.count.requests_dropped == dropped || is_full);
}
