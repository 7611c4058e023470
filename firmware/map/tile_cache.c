#include "lm/tile_cache.h"

#include "fx/mem.h"

enum {
    DUPLICATES_SEARCHED = 32, /* newest requests that are searched for a duplicate */
    SLOTS_LEAST = 20          /* the nine that lm_tile_cache_keep_around keeps, and as many more */
};

static uint8_t coarsest_lod(const struct lm_tile_cache *c)
{
    return (uint8_t)(c->db->lod_count - 1);
}

static uint16_t *head_of(struct lm_tile_cache *c, uint8_t lod, uint32_t row, uint32_t column)
{
    return &c->heads[lod][lm_tile_chain(row, column)];
}

static uint16_t find(const struct lm_tile_cache *c, uint8_t lod, uint32_t row, uint32_t column)
{
    uint16_t i = c->heads[lod][lm_tile_chain(row, column)];
    /* A chain holds each slot at most once, so this ends. */
    while (i != LM_SLOT_NONE) {
        const struct lm_tile_slot *s = &c->slots[i];
        if (s->row == row && s->column == column) {
            return i;
        }
        i = s->next;
    }
    return LM_SLOT_NONE;
}

static void unlink_slot(struct lm_tile_cache *c, uint16_t victim)
{
    const struct lm_tile_slot *s = &c->slots[victim];
    uint16_t *link = head_of(c, s->lod, s->row, s->column);
    while (*link != victim) {
        link = &c->slots[*link].next;
    }
    *link = s->next;
}

/* A free slot, or the one that was used longest ago, unlinked from its chain. A coarsest LOD that
 * is resident whole and the slot being read stay. lm_tile_cache_init leaves more slots that are
 * neither, so LM_SLOT_NONE does not happen. If it did, nothing would be written. */
static uint16_t take_slot(struct lm_tile_cache *c)
{
    const uint8_t pinned = c->is_top_resident ? coarsest_lod(c) : LM_DB_LODS_MAX;
    uint16_t best = LM_SLOT_NONE;
    uint32_t best_age = 0;
    for (uint32_t i = 0; i < c->slot_count; i++) {
        const struct lm_tile_slot *s = &c->slots[i];
        if (s->state == LM_SLOT_FREE) {
            return (uint16_t)i;
        }
        const uint32_t age = c->clock - s->last_use;
        const bool is_pinned = s->state == LM_SLOT_RESIDENT && s->lod == pinned;
        if (!is_pinned && s->state != LM_SLOT_READING && (best == LM_SLOT_NONE || age > best_age)) {
            best = (uint16_t)i;
            best_age = age;
        }
    }
    if (best != LM_SLOT_NONE) {
        unlink_slot(c, best);
        c->count.evicted++;
    }
    return best;
}

/* Assign a slot to a tile and put it first in its chain. LM_SLOT_NONE if there is none. */
static uint16_t claim_slot(struct lm_tile_cache *c, const struct lm_tile_key *key)
{
    const uint16_t i = take_slot(c);
    if (i == LM_SLOT_NONE) {
        return i;
    }
    uint16_t *head = head_of(c, key->lod, key->row, key->column);
    c->slots[i] = (struct lm_tile_slot){.resident = LM_TILE_NO_NAME,
                                        .row = key->row,
                                        .column = key->column,
                                        .lod = key->lod,
                                        .last_use = c->clock,
                                        .next = *head};
    *head = i;
    return i;
}

/* End the read under way; its slot gets a state. */
static void finish(struct lm_tile_cache *c, enum lm_slot_state state)
{
    struct lm_tile_slot *s = &c->slots[c->reading_slot];
    s->state = (uint8_t)state;
    s->resident = state == LM_SLOT_RESIDENT ? lm_tile_name(s->row, s->column) : LM_TILE_NO_NAME;
    s->failed_us = c->now_us;
    c->reading_slot = LM_SLOT_NONE;
}

static void fail(struct lm_tile_cache *c, uint32_t *counter)
{
    (*counter)++;
    finish(c, LM_SLOT_BAD);
}

/* Start to read a part of a tile. A refusal counts as a failed read. */
static void start_read(struct lm_tile_cache *c, uint64_t offset, void *to, uint32_t length)
{
    const struct lm_flash *flash = c->db->flash;
    c->count.bytes_read += length;
    if (flash->read_start(flash->ctx, offset, to, length) != LM_OK) {
        fail(c, &c->count.io_errors);
    }
}

/* True if a slot needs no read now: all states but BAD, and BAD until the retry is due. */
static bool is_settled(const struct lm_tile_cache *c, uint16_t i)
{
    const struct lm_tile_slot *s = &c->slots[i];
    return s->state != LM_SLOT_BAD || c->now_us - s->failed_us < LM_TILE_RETRY_US;
}

/* Begin to read the oldest requested tile. It may have become resident since it was requested; then
 * nothing is read. */
static void start_next(struct lm_tile_cache *c)
{
    const struct lm_tile_key key = c->wanted[c->wanted_tail % LM_TILE_REQUESTS];
    c->wanted_tail++;
    uint16_t slot = find(c, key.lod, key.row, key.column);
    if (slot == LM_SLOT_NONE) {
        slot = claim_slot(c, &key);
    } else if (is_settled(c, slot)) {
        return;
    }
    if (slot == LM_SLOT_NONE) {
        c->count.requests_dropped++;
        return;
    }
    c->slots[slot].state = LM_SLOT_READING;
    c->reading_slot = slot;
    c->reading_entry = key.entry;
    c->is_reading_entry = true;
    start_read(c, lm_db_entry_offset(c->db, key.entry), &c->entry, sizeof c->entry);
}

/* The directory entry was read: begin to read the record that it names. */
static void take_entry(struct lm_tile_cache *c)
{
    const struct lm_tile_entry *entry = &c->entry;
    const int status = lm_db_entry_check(c->db, c->reading_entry, entry);
    if (status != LM_OK) {
        c->count.encodings += status == LM_ERR_VERSION;
        fail(c, &c->count.corrupt);
    } else if (entry->place == LM_TILE_ABSENT) {
        const struct lm_tile_slot absent = c->slots[c->reading_slot];
        finish(c, LM_SLOT_ABSENT);
        lm_tile_cache_want(c, absent.lod, absent.row, absent.column); /* requests its parent */
    } else {
        c->is_reading_entry = false;
        c->slots[c->reading_slot].detail_place = entry->detail_place;
        c->slots[c->reading_slot].detail_size = entry->detail_size;
        start_read(c, lm_db_tile_offset(c->db, entry),
                   lm_tile_unpack_place(&c->pool[c->reading_slot], entry->size),
                   (uint32_t)LM_DB_PLACE_BYTES * entry->size);
    }
}

/* The tile is whole: make it resident if it passes its check. */
static void take_tile(struct lm_tile_cache *c)
{
    const struct lm_tile_slot *s = &c->slots[c->reading_slot];
    if (lm_tile_check(&c->pool[c->reading_slot], s->lod, s->row, s->column) != LM_OK) {
        fail(c, &c->count.corrupt);
        return;
    }
    c->count.tiles_read++;
    c->slots[c->reading_slot].base = lm_tile_base_of(c->pool, &c->pool[c->reading_slot]);
    finish(c, LM_SLOT_RESIDENT);
}

/* Go on with a compressed record after a part of its unpacking, or its begin. */
static void go_on_unpacking(struct lm_tile_cache *c, int status)
{
    c->is_unpacking = status == LM_BUSY;
    if (status == LM_OK) {
        take_tile(c);
    } else if (status != LM_BUSY) {
        fail(c, &c->count.corrupt);
    }
}

/* The record was read. */
static void take_record(struct lm_tile_cache *c)
{
    if (c->entry.encoding == LM_TILE_RAW) {
        take_tile(c);
    } else {
        go_on_unpacking(c,
                        lm_tile_unpack_begin(&c->unpack, &c->pool[c->reading_slot], c->entry.size));
    }
}

bool lm_tile_cache_read(struct lm_tile_cache *c, struct lm_flash_request *request)
{
    if (c->request) {
        return false;
    }
    request->status = LM_BUSY;
    c->request = request;
    return true;
}

static void finish_request(struct lm_tile_cache *c, bool is_ok)
{
    c->request->status = is_ok ? LM_OK : LM_ERR_IO;
    c->count.io_errors += !is_ok;
    c->request = NULL;
    c->is_reading_request = false;
}

static void start_request(struct lm_tile_cache *c)
{
    const struct lm_flash *flash = c->db->flash;
    const struct lm_flash_request *g = c->request;
    c->count.bytes_read += g->length;
    c->is_reading_request =
        flash->read_start(flash->ctx, g->offset, g->destination, g->length) == LM_OK;
    if (!c->is_reading_request) {
        finish_request(c, false);
    }
}

/* Begin the next read: the other part's request first, then tiles. False if there is none. */
static bool start_pending(struct lm_tile_cache *c)
{
    if (c->request) {
        start_request(c);
    } else if (c->wanted_tail != c->wanted_head) {
        start_next(c);
    } else {
        return false;
    }
    return true;
}

/* The read under way has ended, well or not. */
static void end_read(struct lm_tile_cache *c, bool is_ok)
{
    if (c->is_reading_request) {
        finish_request(c, is_ok);
    } else if (!is_ok) {
        fail(c, &c->count.io_errors);
    } else if (c->is_reading_entry) {
        take_entry(c);
    } else {
        take_record(c);
    }
}

static bool is_reading(const struct lm_tile_cache *c)
{
    return c->is_reading_request || c->reading_slot != LM_SLOT_NONE;
}

void lm_tile_cache_service(struct lm_tile_cache *c, uint64_t now_us, uint32_t reads)
{
    const struct lm_flash *flash = c->db->flash;
    c->now_us = now_us;
    for (uint32_t i = 0; i < reads; i++) {
        if (!is_reading(c)) {
            if (!start_pending(c)) {
                return;
            }
            continue;
        }
        if (c->is_unpacking) {
            go_on_unpacking(c, lm_tile_unpack_run(&c->unpack));
            continue;
        }
        const int status = flash->read_poll(flash->ctx);
        if (status == LM_BUSY) {
            return;
        }
        end_read(c, status == LM_OK);
    }
}

/* Queue a tile of the image unless it is among the newest requests. Neighbouring lines request the
 * same tiles, so the search is short and finds most duplicates. */
static void queue_request(struct lm_tile_cache *c, const struct lm_tile_key *key)
{
    for (uint32_t back = 1; back <= DUPLICATES_SEARCHED && back <= c->wanted_head - c->wanted_tail;
         back++) {
        if (c->wanted[(c->wanted_head - back) % LM_TILE_REQUESTS].entry == key->entry) {
            return;
        }
    }
    if (c->wanted_head - c->wanted_tail == LM_TILE_REQUESTS) {
        c->count.requests_dropped++;
        return;
    }
    c->wanted[c->wanted_head % LM_TILE_REQUESTS] = *key;
    c->wanted_head++;
}

/* Request a tile, or mark it as used if it needs no read. `i` is its slot or LM_SLOT_NONE. False if
 * the image has no such tile. */
static bool want_tile(struct lm_tile_cache *c, uint8_t lod, uint32_t row, uint32_t column,
                      uint16_t i)
{
    if (i != LM_SLOT_NONE) {
        if (c->slots[i].state == LM_SLOT_ABSENT) {
            return false;
        }
        c->slots[i].last_use = c->clock;
        if (is_settled(c, i)) {
            return true;
        }
    }
    const int64_t entry = lm_db_entry(c->db, lod, row, column);
    if (entry < 0) {
        return false;
    }
    queue_request(c, &(struct lm_tile_key){row, column, (uint32_t)entry, lod});
    return true;
}

void lm_tile_cache_want(struct lm_tile_cache *c, uint8_t lod, uint32_t row, uint32_t column)
{
    /* For a tile that the image leaves out, the first ancestor that it has is read. */
    for (; lod < c->db->lod_count; lod++, row >>= 1, column >>= 1) {
        if (want_tile(c, lod, row, column, find(c, lod, row, column))) {
            return;
        }
    }
}

static bool is_resident(const struct lm_tile_cache *c, uint16_t i)
{
    return c->slots[i].state == LM_SLOT_RESIDENT;
}

const struct lm_tile_slot *lm_tile_cache_find(const struct lm_tile_cache *c, uint8_t lod,
                                              uint32_t row, uint32_t column)
{
    const uint16_t i = find(c, lod, row, column);
    return is_resident(c, i) ? &c->slots[i] : NULL;
}

static const struct lm_tile *use_slot(struct lm_tile_cache *c, uint16_t i)
{
    c->slots[i].last_use = c->clock;
    return &c->pool[i];
}

/* Walk from the tile to its ancestors. The first that the image has is requested, and the first
 * that is resident answers. */
const struct lm_tile *lm_tile_cache_get(struct lm_tile_cache *c, uint8_t lod, uint32_t row,
                                        uint32_t column)
{
    bool is_wanted = false, is_missed = false;
    c->clock++;
    for (uint8_t at = lod; at < c->db->lod_count; at++, row >>= 1, column >>= 1) {
        const uint16_t i = find(c, at, row, column);
        if (is_resident(c, i)) {
            c->count.not_exact += at != lod;
            c->count.substituted += is_missed;
            return use_slot(c, i);
        }
        if (!is_wanted) {
            is_wanted = want_tile(c, at, row, column, i);
            is_missed = is_wanted && at == lod;
            c->count.misses += is_missed;
        }
    }
    c->count.not_exact++;
    c->count.off_map++;
    return NULL;
}

bool lm_tile_cache_is_idle(const struct lm_tile_cache *c)
{
    return !is_reading(c) && !c->request && c->wanted_head == c->wanted_tail;
}

void lm_tile_cache_keep_around(struct lm_tile_cache *c, struct lm_position place)
{
    const uint8_t lod = coarsest_lod(c);
    const uint32_t side_log2 = (uint32_t)c->db->shift0 + lod + LM_TILE_CELLS_LOG2; /* <= 26 */
    const uint32_t rows = 1u << (31 - side_log2);
    if (c->is_top_resident) {
        return;
    }
    /* South of row 0 the row wraps, and is none of the rows either. */
    for (uint32_t i = 0; i < 9; i++) {
        const uint32_t row = ((place.latitude + FX_BAM_90) >> side_log2) + i / 3 - 1;
        if (row < rows) {
            const uint32_t east_log2 = side_log2 + lm_db_zone((row << side_log2) - FX_BAM_90);
            const uint32_t column = (place.longitude >> east_log2) + i % 3 - 1;
            lm_tile_cache_want(c, lod, row, column & UINT32_MAX >> east_log2);
        }
    }
}

/* Read every tile of a band of the coarsest LOD and wait for each. */
static void read_band(struct lm_tile_cache *c, const struct lm_band *band, uint32_t poll_limit)
{
    const uint32_t round = 1u << (32 - LM_TILE_CELLS_LOG2 - c->db->shift0 - band->lod - band->zone);
    for (uint32_t t = 0; t < band->rows * band->columns; t++) {
        const uint32_t column = (band->column0 + t % band->columns) & (round - 1);
        lm_tile_cache_want(c, band->lod, band->row0 + t / band->columns, column);
        for (uint32_t polls = 0; polls < poll_limit && !lm_tile_cache_is_idle(c); polls++) {
            lm_tile_cache_service(c, 0, 1);
        }
    }
}

/* Read the coarsest LOD, if it leaves half of the pool to the others. This happens once, before the
 * first picture. */
static void read_coarsest(struct lm_tile_cache *c, uint32_t poll_limit)
{
    const uint8_t lod = coarsest_lod(c);
    uint64_t total = 0;
    for (uint32_t b = 0; b < c->db->band_count; b++) {
        const struct lm_band *band = &c->db->bands[b];
        total += band->lod == lod ? (uint64_t)band->rows * band->columns : 0;
    }
    c->is_top_resident = total <= c->slot_count / 2;
    for (uint32_t b = 0; b < c->db->band_count && c->is_top_resident; b++) {
        if (c->db->bands[b].lod == lod) {
            read_band(c, &c->db->bands[b], poll_limit);
        }
    }
}

int lm_tile_cache_init(struct lm_tile_cache *c, const struct lm_db *db, void *pool,
                       size_t pool_bytes, uint32_t poll_limit)
{
    memset(c, 0, sizeof *c);
    c->db = db;
    c->pool = pool;
    const size_t slots = pool_bytes / sizeof(struct lm_tile);
    c->slot_count = slots < LM_TILE_SLOTS_MAX ? (uint32_t)slots : LM_TILE_SLOTS_MAX;
    c->reading_slot = LM_SLOT_NONE;
    for (uint32_t i = 0; i <= LM_TILE_SLOTS_MAX; i++) {
        c->slots[i].resident = LM_TILE_NO_NAME;
    }
    for (uint32_t lod = 0; lod < LM_DB_LODS_MAX; lod++) {
        for (uint32_t i = 0; i < LM_TILE_CHAINS; i++) {
            c->heads[lod][i] = LM_SLOT_NONE;
        }
    }
    if (c->slot_count < SLOTS_LEAST) {
        return LM_ERR_NO_MEMORY;
    }
    read_coarsest(c, poll_limit);
    return LM_OK;
}
