/* A fixed pool of tiles between the flash and the scan line. The sweep never waits for it: a lookup
 * answers at once from what is resident, and what is missing is read in the background, one record
 * at a time.
 *
 * A tile that is late, lost or corrupt is answered by its nearest resident ancestor and counted;
 * the coarsest level is read at the start and never leaves, so there is always one inside the map.
 */
#ifndef LM_TILE_CACHE_H
#define LM_TILE_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lm/config.h"
#include "lm/db.h"

enum lm_slot_state {
    LM_SLOT_FREE = 0,
    LM_SLOT_READING,
    LM_SLOT_RESIDENT, /* checked and usable */
    LM_SLOT_ABSENT, /* the image has no such tile: remembered, so that it is not looked up each line
                     */
    LM_SLOT_BAD     /* could not be read or checked; tried again after LM_TILE_RETRY_US */
};

enum { LM_TILE_RETRY_US = 1000000 };

/* What the cells of a tile need to be read by lm_tile_read. */
struct lm_tile_base {
    uint32_t record; /* points from the pool's first record to its own */
    int32_t scale;   /* lm_tile_base_of */
};

struct lm_tile_slot {
    uint64_t resident; /* lm_tile_name of the tile that it answers with, or LM_TILE_NO_NAME */
    struct lm_tile_base base;
    uint64_t failed_us;
    uint32_t last_use; /* the cache's clock when it was last answered from or asked for */
    uint32_t row, column;
    uint16_t next; /* in its chain, or LM_SLOT_NONE */
    uint8_t lod, state;
};

enum { LM_SLOT_NONE = LM_TILE_SLOTS_MAX, LM_TILE_CHAINS = 1024 };

struct lm_tile_key {
    uint32_t row, column, entry; /* entry: in the directory */
    uint8_t lod;
};

/* A read of somebody else's, taken between two tiles: the flash does one at a time. */
struct lm_flash_request {
    uint64_t offset;
    void *destination;
    uint32_t length;
    int status; /* LM_BUSY until it is done; then LM_OK or LM_ERR_IO */
};

struct lm_tile_cache {
    const struct lm_db *db; /* borrowed */
    struct lm_tile *pool;   /* borrowed: one record a slot */
    uint32_t slot_count;
    uint32_t clock;  /* look-ups so far */
    uint64_t now_us; /* of the last service */

    struct lm_tile_slot
        slots[LM_TILE_SLOTS_MAX + 1];               /* the last one, at which chains end, is free */
    uint16_t heads[LM_DB_LODS_MAX][LM_TILE_CHAINS]; /* first slots of the chains of each level */
    struct lm_tile_key wanted[LM_TILE_REQUESTS];    /* ring */
    uint32_t wanted_head, wanted_tail;

    /* The read under way. */
    uint16_t reading_slot; /* LM_SLOT_NONE when idle */
    bool is_reading_entry; /* first the directory entry, then the record */
    uint32_t reading_entry;
    uint32_t entry_bytes[2];
    struct lm_flash_request *request; /* borrowed: waits or is being read; NULL: none */
    bool is_reading_request;

    struct {
        uint32_t not_exact;   /* lookups not answered by the tile asked for */
        uint32_t misses;      /* of those: although it exists */
        uint32_t substituted; /* misses answered by an ancestor */
        uint32_t off_map;     /* lookups that nothing answers: no data here */
        uint32_t tiles_read;
        uint32_t io_errors, corrupt; /* reads that failed, records or entries that did not check */
        uint32_t requests_dropped;   /* ring full */
        uint32_t evicted;
        uint64_t bytes_read;
    } count; /* only ever grow */
};

/* Lend `pool_bytes` at `pool` (8-byte aligned) and read the coarsest level into it, which stays.
 * LM_OK; LM_ERR_NO_MEMORY when the pool cannot hold the coarsest level and 16 more tiles; tiles of
 * the coarsest level that fail are counted, not fatal. Polls each read at most `poll_limit` times.
 */
int lm_tile_cache_init(struct lm_tile_cache *c, const struct lm_db *db, void *pool,
                       size_t pool_bytes, uint32_t poll_limit);

/* The tile itself when it is resident; otherwise asks for it and answers its nearest resident
 * ancestor, or NULL where the map has nothing. The pointer is good until the next
 * lm_tile_cache_service. Cost: one chain a level tried. */
const struct lm_tile *lm_tile_cache_get(struct lm_tile_cache *c, uint8_t lod, uint32_t row,
                                        uint32_t column);

/* Lookups answered by the tile asked for. */
static inline uint32_t lm_tile_cache_hits(const struct lm_tile_cache *c)
{
    return c->clock - c->count.not_exact;
}

/* A tile of a level in one word. Rows are below 2^22: a tile is 2^10 BAM high at least. */
#define LM_TILE_NO_NAME UINT64_MAX
static inline uint64_t lm_tile_name(uint32_t row, uint32_t column)
{
    return (uint64_t)row << 32 | column;
}

/* The chain of a tile: those of one chain are 34 tiles apart, so that the tiles about an aircraft
 * are the first of theirs. */
static inline uint32_t lm_tile_chain(uint32_t row, uint32_t column)
{
    return (row * 271 + column) % LM_TILE_CHAINS;
}

/* The same as lm_tile_cache_get for one who mostly finds: the slot of the tile if it is resident
 * and the first of its chain; NULL otherwise, and nothing is counted. Cost: some 12 instructions.
 */
static inline const struct lm_tile_slot *lm_tile_cache_peek(struct lm_tile_cache *c, uint8_t lod,
                                                            uint32_t row, uint32_t column)
{
    struct lm_tile_slot *s = &c->slots[c->heads[lod][lm_tile_chain(row, column)]];
    if (s->resident != lm_tile_name(row, column)) {
        return NULL;
    }
    s->last_use = ++c->clock;
    return s;
}

/* A tile's base, metres * 16384, with the shift that brings the Q16 of a post there in its lowest
 * byte, less than 0 as it goes to the right: a post step is 2^post_shift / 64 m, so that its Q16 is
 * Q22 of 2^post_shift m. The byte is left in where elevations are added up: it takes half a
 * millimetre from them. lm_tile_check holds |base| to 2^20 in Q6 and post_shift to 4. */
static inline struct lm_tile_base lm_tile_base_of(const struct lm_tile *pool,
                                                  const struct lm_tile *tile)
{
    const uint32_t bytes = (uint32_t)((const uint8_t *)tile - (const uint8_t *)pool); /* < 2^27 */
    return (struct lm_tile_base){.record = bytes / (uint32_t)sizeof(struct lm_tile_point),
                                 .scale = tile->base_m_q6 * 256 + (tile->post_shift - 8)};
}

/* Ask for a tile that will be needed soon. Does nothing when it is resident or already asked for.
 */
void lm_tile_cache_want(struct lm_tile_cache *c, uint8_t lod, uint32_t row, uint32_t column);

/* Read something else of the image before the next tile. `request`, its offset, destination and
 * length filled in, is borrowed until its status is no longer LM_BUSY. One at a time: false, and
 * nothing is taken, while another one waits. */
bool lm_tile_cache_read(struct lm_tile_cache *c, struct lm_flash_request *request);

/* Go on with the reading: at most `reads` polls or starts. Never waits. */
void lm_tile_cache_service(struct lm_tile_cache *c, uint64_t now_us, uint32_t reads);

/* True when nothing is wanted and nothing is being read. */
bool lm_tile_cache_is_idle(const struct lm_tile_cache *c);

#endif
