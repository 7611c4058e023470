#include "lm/tile_cache.h"

#include "fx/mem.h"

enum {
    DUPLICATES_SEARCHED = 32, /* newest requests that are searched for a duplicate */
    SLOTS_LEAST = 20          /* the nine that lm_tile_cache_keep_around keeps, and as many more */
};

static bool has_several(const struct lm_tile_cache *c)
{
    return LM_IMAGES_MAX > 1 && c->image_count > 1;
}

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
                                        .image = key->image,
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

/* Start to read a part of a tile. A refusal counts as a failed read, when the service sees it. */
static void start_read(struct lm_tile_cache *c, uint64_t offset, void *to, uint32_t length)
{
    const struct lm_flash *flash = c->db->flash;
    c->count.bytes_read += length;
    c->is_refused = flash->read_start(flash->ctx, offset, to, length) != LM_OK;
}

/* LOD of an image that has the cells of an LOD of the cache; 255 or less, and no LOD of the image
 * if that has none of this size. */
static uint8_t lod_in(const struct lm_tile_cache *c, const struct lm_db *image, uint8_t lod)
{
    return (uint8_t)(lod + c->db->shift0 - image->shift0);
}

/* The first image from `first` on that may have a tile, into *key. False if none does. */
static bool find_entry(const struct lm_tile_cache *c, uint32_t first, uint8_t lod, uint32_t row,
                       uint32_t column, struct lm_tile_key *key)
{
    for (uint32_t i = first; i < LM_IMAGES_MAX && i < c->image_count; i++) {
        const struct lm_db *image = &c->images[i];
        const int64_t entry = lm_db_entry(image, lod_in(c, image, lod), row, column);
        if (entry >= 0) {
            *key = (struct lm_tile_key){row, column, (uint32_t)entry, lod, (uint8_t)i};
            return true;
        }
    }
    return false;
}

static void start_entry(struct lm_tile_cache *c)
{
    const struct lm_tile_key *key = &c->reading;
    c->is_reading_entry = true;
    start_read(c, lm_db_entry_offset(&c->images[key->image], key->entry), &c->entry,
               sizeof c->entry);
}

/* Go on with another image from `first` on: with the tile itself; or, where the gaps of a tile are
 * filled, with the finest from LOD `lod` of the first image, then of those behind it. False if
 * there is none. */
static bool go_on_with(struct lm_tile_cache *c, uint32_t first, uint8_t lod)
{
    if (!has_several(c)) {
        return false;
    }
    const struct lm_tile_slot *s = &c->slots[c->reading_slot];
    if (!c->has_gaps) {
        const bool is_found = find_entry(c, first, s->lod, s->row, s->column, &c->reading);
        if (is_found) {
            start_entry(c);
        }
        return is_found;
    }
    for (uint32_t i = first; i < c->image_count; i++, lod = s->lod) {
        for (; lod < c->db->lod_count; lod++) {
            const uint32_t up = (uint32_t)(lod - s->lod);
            struct lm_tile_key key;
            if (find_entry(c, i, lod, s->row >> up, s->column >> up, &key) && key.image == i) {
                c->reading = key;
                start_entry(c);
                return true;
            }
        }
    }
    return false;
}

/* The slot's tile is whole, or filled as far as it can be. */
static void settle(struct lm_tile_cache *c)
{
    struct lm_tile *tile = &c->pool[c->reading_slot];
    c->count.tiles_read++;
    c->slots[c->reading_slot].base = lm_tile_base_of(c->pool, tile);
    finish(c, LM_SLOT_RESIDENT);
}

/* What was read cannot be used: the next image answers, if there is one. */
static void fail(struct lm_tile_cache *c, uint32_t *counter)
{
    (*counter)++;
    if (!go_on_with(c, c->reading.image + 1u, c->slots[c->reading_slot].lod)) {
        if (has_several(c) && c->has_gaps) {
            settle(c);
        } else {
            finish(c, LM_SLOT_BAD);
        }
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
    c->reading = key;
    c->has_gaps = false;
    start_entry(c);
}

/* Memory of the record that is being read: the slot's, or the one for filling. */
static struct lm_tile *record_of(const struct lm_tile_cache *c)
{
    return &c->pool[has_several(c) && c->has_gaps ? c->slot_count : c->reading_slot];
}

/* The image leaves the tile out: look in the next one. */
static void take_absence(struct lm_tile_cache *c)
{
    const struct lm_tile_slot absent = c->slots[c->reading_slot];
    if (go_on_with(c, c->reading.image + !c->has_gaps, (uint8_t)(c->reading.lod + 1))) {
        return;
    }
    if (has_several(c) && c->has_gaps) {
        settle(c);
        return;
    }
    finish(c, LM_SLOT_ABSENT);
    lm_tile_cache_want(c, absent.lod, absent.row, absent.column); /* requests its parent */
}

/* The directory entry was read: begin to read the record that it names. */
static void take_entry(struct lm_tile_cache *c)
{
    const struct lm_tile_entry *entry = &c->entry;
    const struct lm_db *image = &c->images[c->reading.image];
    const int status = lm_db_entry_check(image, c->reading.entry, entry);
    if (status != LM_OK) {
        c->count.encodings += status == LM_ERR_VERSION;
        fail(c, &c->count.corrupt);
    } else if (entry->place == LM_TILE_ABSENT) {
        take_absence(c);
    } else {
        struct lm_tile_slot *s = &c->slots[c->reading_slot];
        c->is_reading_entry = false;
        if (!c->has_gaps) {
            s->image = c->reading.image;
            s->detail_place = entry->detail_place;
            s->detail_size = entry->detail_size;
        }
        start_read(c, lm_db_tile_offset(image, entry),
                   lm_tile_unpack_place(record_of(c), entry->size),
                   (uint32_t)LM_DB_PLACE_BYTES * entry->size);
    }
}

/* Look for what fills the gaps of the slot's tile in the images behind the one at hand. If there is
 * none, or nothing to fill, the tile is ready. */
static void fill_on(struct lm_tile_cache *c)
{
    const uint32_t next = c->reading.image + 1u;
    c->has_gaps =
        has_several(c) && next < c->image_count && lm_tile_has_gaps(&c->pool[c->reading_slot]);
    if (!c->has_gaps || !go_on_with(c, next, c->slots[c->reading_slot].lod)) {
        settle(c);
    }
}

static void go_on_filling(struct lm_tile_cache *c)
{
    c->is_filling = lm_tile_fill_run(&c->fill) == LM_BUSY;
    if (!c->is_filling) {
        fill_on(c);
    }
}

/* The tile is whole: make it resident, or fill its gaps, or those of another by it. */
static void use_tile(struct lm_tile_cache *c)
{
    const struct lm_tile_key *key = &c->reading;
    if (has_several(c) && c->has_gaps) {
        struct lm_tile *filled = &c->pool[c->reading_slot];
        lm_tile_fill_begin(&c->fill, filled, record_of(c), (uint32_t)(key->lod - filled->lod),
                           &c->db->classes);
        c->is_filling = true;
    } else {
        fill_on(c);
    }
}

static void go_on_fitting(struct lm_tile_cache *c, int status)
{
    c->is_fitting = status == LM_BUSY;
    if (!c->is_fitting) {
        use_tile(c);
    }
}

/* The record is whole: use it if it passes its check, fitted to those of other images. */
static void take_tile(struct lm_tile_cache *c)
{
    const struct lm_tile_key *key = &c->reading;
    const struct lm_db *image = &c->images[key->image];
    struct lm_tile *tile = record_of(c);
    const uint8_t lod = lod_in(c, image, key->lod);
    if (lm_tile_check(tile, lod, key->row, key->column) != LM_OK) {
        fail(c, &c->count.corrupt);
        return;
    }
    tile->lod = key->lod; /* of the cache from now on */
    if (has_several(c)) {
        go_on_fitting(
            c, lm_tile_fit_begin(&c->fit, tile, &image->classes, lod, &c->db->classes, key->lod));
    } else {
        use_tile(c);
    }
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
        go_on_unpacking(c, lm_tile_unpack_begin(&c->unpack, record_of(c), c->entry.size));
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

/* The read under way ends for nobody. */
static void discard(struct lm_tile_cache *c)
{
    c->is_stale = c->is_unpacking = c->is_fitting = c->is_filling = c->is_refused = false;
    unlink_slot(c, c->reading_slot);
    finish(c, LM_SLOT_FREE);
}

/* The read under way has ended, well or not. */
static void end_read(struct lm_tile_cache *c, bool is_ok)
{
    if (c->is_reading_request) {
        finish_request(c, is_ok);
    } else if (c->is_stale) {
        discard(c);
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
        if (has_several(c) && c->is_fitting) {
            go_on_fitting(c, lm_tile_fit_run(&c->fit));
            continue;
        }
        if (has_several(c) && c->is_filling) {
            i += lm_tile_fill_is_dear(&c->fill); /* counts as two */
            go_on_filling(c);
            continue;
        }
        if (c->is_refused) {
            c->is_refused = false;
            end_read(c, false);
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
        const struct lm_tile_key *other = &c->wanted[(c->wanted_head - back) % LM_TILE_REQUESTS];
        if (other->entry == key->entry && other->image == key->image) {
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
            /* Of several images the ancestor that answers may be another's, and not resident. */
            return c->slots[i].state != LM_SLOT_BAD || !has_several(c);
        }
    }
    struct lm_tile_key key;
    if (!find_entry(c, 0, lod, row, column, &key)) {
        return false;
    }
    queue_request(c, &key);
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
            c->is_late = is_wanted;
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
    const uint8_t lod = coarsest_lod(c);
    const uint32_t round = 1u << (32 - LM_TILE_CELLS_LOG2 - c->db->shift0 - lod - band->zone);
    for (uint32_t t = 0; t < band->rows * band->columns; t++) {
        const uint32_t column = (band->column0 + t % band->columns) & (round - 1);
        lm_tile_cache_want(c, lod, band->row0 + t / band->columns, column);
        for (uint32_t polls = 0; polls < poll_limit && !lm_tile_cache_is_idle(c); polls++) {
            lm_tile_cache_service(c, 0, 1);
        }
    }
}

/* Read the coarsest LOD, if it leaves half of the pool to the others. This happens once, before the
 * first picture. */
static void read_coarsest(struct lm_tile_cache *c, uint32_t poll_limit)
{
    uint64_t total = 0;
    for (uint32_t pass = 0; pass < 2; pass++) {
        for (uint32_t i = 0; i < c->image_count; i++) {
            const struct lm_db *image = &c->images[i];
            for (uint32_t b = 0; b < image->band_count; b++) {
                const struct lm_band *band = &image->bands[b];
                if (band->lod != lod_in(c, image, coarsest_lod(c))) {
                    continue;
                }
                total += (uint64_t)band->rows * band->columns;
                if (c->is_top_resident) {
                    read_band(c, band, poll_limit);
                }
            }
        }
        c->is_top_resident = total <= c->slot_count / 2;
        total = 0;
    }
}

static void init(struct lm_tile_cache *c, const struct lm_db *db, const struct lm_db *images,
                 uint32_t image_count)
{
    memset(c, 0, sizeof *c);
    c->db = db;
    c->images = images;
    c->image_count = image_count;
    c->reading_slot = LM_SLOT_NONE;
    for (uint32_t i = 0; i <= LM_TILE_SLOTS_MAX; i++) {
        c->slots[i].resident = LM_TILE_NO_NAME;
    }
    for (uint32_t i = 0; i < LM_TILE_CHAINS; i++) {
        c->heads[0][i] = LM_SLOT_NONE;
    }
    for (uint32_t lod = 1; lod < LM_DB_LODS_MAX; lod++) {
        memcpy(c->heads[lod], c->heads[0], sizeof c->heads[lod]);
    }
}

static int open_pool(struct lm_tile_cache *c, void *pool, size_t pool_bytes, uint32_t poll_limit)
{
    const size_t slots = pool_bytes / sizeof(struct lm_tile);
    c->pool = pool;
    c->slot_count = slots < LM_TILE_SLOTS_MAX ? (uint32_t)slots : LM_TILE_SLOTS_MAX;
    if (c->slot_count < SLOTS_LEAST) {
        return LM_ERR_NO_MEMORY;
    }
    read_coarsest(c, poll_limit);
    return LM_OK;
}

int lm_tile_cache_init(struct lm_tile_cache *c, const struct lm_db *db, void *pool,
                       size_t pool_bytes, uint32_t poll_limit)
{
    init(c, db, db, 1);
    return open_pool(c, pool, pool_bytes, poll_limit);
}

int lm_tile_cache_init_over(struct lm_tile_cache *c, const struct lm_db *db,
                            const struct lm_db *images, uint32_t image_count, void *pool,
                            size_t pool_bytes, uint32_t poll_limit)
{
    init(c, db, images, image_count);
    c->has_spare = true;
    return open_pool(c, pool,
                     pool_bytes < sizeof(struct lm_tile) ? 0 : pool_bytes - sizeof(struct lm_tile),
                     poll_limit);
}

void lm_tile_cache_mount(struct lm_tile_cache *c, const struct lm_db *images, uint32_t image_count)
{
    c->images = images;
    c->image_count = image_count;
    if (has_several(c) && !c->has_spare) {
        c->has_spare = true;
        c->slot_count--;
    }
    c->is_top_resident = false;
    c->wanted_tail = c->wanted_head;
    for (uint32_t i = 0; i < LM_TILE_SLOTS_MAX; i++) {
        if (c->slots[i].state != LM_SLOT_FREE && i != c->reading_slot) {
            unlink_slot(c, (uint16_t)i);
            c->slots[i] = (struct lm_tile_slot){.resident = LM_TILE_NO_NAME};
        }
    }
    c->is_stale = c->reading_slot != LM_SLOT_NONE;
    if (c->is_stale && (c->is_unpacking || c->is_fitting || c->is_filling || c->is_refused)) {
        discard(c);
    }
}

bool lm_tile_cache_is_drained(const struct lm_tile_cache *c)
{
    return !c->is_stale && !c->request;
}
