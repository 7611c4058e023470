/* Tile cache: a fixed pool of tiles between the flash and the scan lines.
 *
 * A look-up never waits. It answers at once from a resident tile, and a missing tile is read in the
 * background, one record at a time. For a tile that is late, lost or corrupt the nearest resident
 * ancestor answers, and the substitution is counted.
 *
 * Tiles of the coarsest LOD, the top, are read at the start and never evicted, so that an ancestor
 * is resident wherever the image has a map. A top that needs more than half of the pool, that of
 * the whole Earth, is not resident whole: lm_tile_cache_keep_around keeps nine tiles of it.
 *
 * States of a slot (enum lm_slot_state):
 *
 *               want  +---------+  entry and record are good
 *      FREE --------->|         |---------------------------------> RESIDENT
 *                     |         |  the image has no such tile
 *                     | READING |---------------------------------> ABSENT
 *                     |         |  a read or a check failed
 *                     |         |---------------------------------> BAD
 *                     +---------+                                    |
 *                          ^         want, LM_TILE_RETRY_US later    |
 *                          +-----------------------------------------+
 *
 * If no slot is free, the one used longest ago gets the next tile. That may be RESIDENT, ABSENT or
 * BAD, but not READING, and not a tile of a top that is resident whole.
 *
 * Flow of a request:
 *
 *     lm_tile_cache_get, _want --> ring of requests --> lm_tile_cache_service --> slot
 *                                                         | entry, record, unpacking;
 *                                                         | of several images fit and fill
 *                                                         v
 *                                                       flash
 *
 * Example: a step that draws from the cache.
 *
 *     lm_tile_cache_service(&cache, now_us, 8);                       goes on with the reading
 *     const struct lm_tile *tile = lm_tile_cache_get(&cache, lod, row, column);
 *     if (tile) {                                                     or an ancestor of it
 *         draw(tile);
 *     }
 *
 * The caller owns struct lm_tile_cache and the pool, and may read `count`. One thread calls all
 * functions. */
#ifndef LM_TILE_CACHE_H
#define LM_TILE_CACHE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lm/config.h"
#include "lm/db.h"
#include "lm/tile_fill.h"
#include "lm/tile_fit.h"
#include "lm/tile_unpack.h"

/* State of a slot. */
enum lm_slot_state {
    LM_SLOT_FREE = 0,
    LM_SLOT_READING,  /* its directory entry or its record is being read, or unpacked */
    LM_SLOT_RESIDENT, /* checked and usable */
    LM_SLOT_ABSENT,   /* the image has no such tile; remembered to spare a read for each line */
    LM_SLOT_BAD       /* could not be read or checked; tried again after LM_TILE_RETRY_US */
};

enum { LM_TILE_RETRY_US = 1000000 };

/* Start of a tile's points and elevations, as lm_tile_read needs them: lm_tile_base_of. */
struct lm_tile_base {
    uint32_t record; /* from the pool's first point to the tile's, in bytes */
    int32_t scale;   /* base elevation and shift of the posts */
};

/* Slot: the tile in one record of the pool. */
struct lm_tile_slot {
    uint64_t resident;        /* lm_tile_name of the resident tile, or LM_TILE_NO_NAME */
    struct lm_tile_base base; /* of the resident tile */
    uint64_t failed_us;       /* time of the failure, in state LM_SLOT_BAD */
    uint32_t last_use;        /* the cache's clock when the tile was last used or requested */
    uint32_t row, column;
    uint32_t detail_place; /* of its vector detail, as in struct lm_tile_entry */
    uint16_t next;         /* slot in its chain, or LM_SLOT_NONE */
    uint8_t lod, state;
    uint8_t detail_size; /* 0: it has none */
    uint8_t image;       /* that the tile is from: its first, if others filled it */
};

/* LM_SLOT_NONE is the index that ends a chain. Chains are per LOD. */
enum { LM_SLOT_NONE = LM_TILE_SLOTS_MAX, LM_TILE_CHAINS = 1024 };

/* A requested tile. */
struct lm_tile_key {
    uint32_t row, column;
    uint32_t entry; /* in the directory */
    uint8_t lod;    /* of the cache */
    uint8_t image;
};

/* Another part's read of the flash, done between two tiles because the flash does one at a time. */
struct lm_flash_request {
    uint64_t offset;   /* in the flash, bytes */
    void *destination; /* borrowed until the read is done */
    uint32_t length;   /* bytes */
    int status;        /* LM_BUSY until it is done, then LM_OK or LM_ERR_IO */
};

/* Tile cache. All members but `count` are private. */
struct lm_tile_cache {
    const struct lm_db *db; /* borrowed as long as the cache is in use; its LODs are the cache's */
    const struct lm_db *images; /* borrowed likewise: what is read, the finest first */
    uint32_t image_count;
    struct lm_tile *pool; /* borrowed as long, too: one record a slot */
    uint32_t slot_count;  /* of the pool; at most LM_TILE_SLOTS_MAX */
    bool has_spare;       /* the pool has one tile more, for filling */
    bool is_top_resident; /* the coarsest LOD is, whole */
    bool is_late;         /* the last look-up was answered though the map has a finer tile there */
    uint32_t clock;       /* look-ups so far */
    uint64_t now_us;      /* of the last service */

    struct lm_tile_slot
        slots[LM_TILE_SLOTS_MAX + 1];               /* the last one, at which chains end, is free */
    uint16_t heads[LM_DB_LODS_MAX][LM_TILE_CHAINS]; /* first slot of each chain, by LOD */
    struct lm_tile_key wanted[LM_TILE_REQUESTS];    /* ring of requests */
    uint32_t wanted_head, wanted_tail; /* requests taken and requests begun, modulo 2^32 */

    /* The read under way. */
    uint16_t reading_slot; /* LM_SLOT_NONE when idle */
    bool is_reading_entry; /* first the directory entry, then the record */
    bool is_unpacking;     /* then, if the record is compressed, no read: it is being unpacked */
    bool is_refused;       /* the flash has refused the read */
    bool is_stale;         /* it was begun before lm_tile_cache_mount: nobody wants it */
    struct lm_tile_unpack unpack;
    struct lm_tile_key reading; /* what is read into the slot, or to fill its gaps */
    bool has_gaps;              /* the slot's tile is there, and what is read fills its gaps */
    bool is_filling;            /* it is filled now, and no read is under way */
    struct lm_tile_fill fill;
    bool is_fitting; /* what was read is fitted to the other images now, and no read is under way */
    struct lm_tile_fit fit;
    struct lm_tile_entry entry;
    struct lm_flash_request *request; /* borrowed while it waits or is being read; NULL if none */
    bool is_reading_request;

    /* Counts since the start. They only grow, modulo their size. */
    struct {
        uint32_t not_exact;   /* look-ups not answered by the tile itself */
        uint32_t misses;      /* those of `not_exact` whose tile is in the image */
        uint32_t substituted; /* misses answered by an ancestor */
        uint32_t off_map;     /* look-ups without a resident ancestor: no data there */
        uint32_t tiles_read;
        uint32_t io_errors;        /* reads that failed */
        uint32_t corrupt;          /* records or directory entries that failed their check */
        uint32_t encodings;        /* those of `corrupt` that are of an unknown encoding */
        uint32_t requests_dropped; /* requests lost because the ring was full */
        uint32_t evicted;          /* tiles that lost their slot to another */
        uint64_t bytes_read;
    } count;
};

/* Start a cache with a pool of `pool_bytes` at `pool`, 8-byte aligned, and read the coarsest LOD
 * into it, if that fits half of it. For start-up only: it waits for the flash, at most `poll_limit`
 * steps a tile. The cache keeps `db` and `pool`. At most LM_TILE_SLOTS_MAX tiles of the pool are
 * used.
 *
 * Returns LM_OK, or LM_ERR_NO_MEMORY if the pool holds fewer than 20 tiles; the cache is then not
 * usable. A tile of the coarsest LOD that fails is counted, not fatal. */
int lm_tile_cache_init(struct lm_tile_cache *c, const struct lm_db *db, void *pool,
                       size_t pool_bytes, uint32_t poll_limit);

/* The same over several images in one flash (lm/images.h). `db` has the LODs of all of them. Of the
 * pool the last tile is kept for filling. */
int lm_tile_cache_init_over(struct lm_tile_cache *c, const struct lm_db *db,
                            const struct lm_db *images, uint32_t image_count, void *pool,
                            size_t pool_bytes, uint32_t poll_limit);

/* Of a coarsest LOD that is not resident whole, request the nine tiles around a place and mark them
 * as used: whatever is late within some hundred kilometres of it, one of them answers. Call in
 * every step, with the aircraft's position. Does nothing otherwise. Cost: nine look-ups, or none.
 */
void lm_tile_cache_keep_around(struct lm_tile_cache *c, struct lm_position place);

/* Look up a tile. Returns
 * - the tile, if it is resident,
 * - else its nearest resident ancestor: see its `lod`,
 * - NULL where the map has nothing.
 *
 * A tile that is in the image and not resident is requested. The pointer is valid until the next
 * lm_tile_cache_service. Cost: one chain for each LOD that is tried. */
const struct lm_tile *lm_tile_cache_get(struct lm_tile_cache *c, uint8_t lod, uint32_t row,
                                        uint32_t column);

/* The slot in which a tile is resident, or NULL. It is no look-up: nothing is counted or requested.
 * The pointer is valid until the next lm_tile_cache_service. */
const struct lm_tile_slot *lm_tile_cache_find(const struct lm_tile_cache *c, uint8_t lod,
                                              uint32_t row, uint32_t column);

/* Number of look-ups that found the tile itself. */
static inline uint32_t lm_tile_cache_hits(const struct lm_tile_cache *c)
{
    return c->clock - c->count.not_exact;
}

/* Name of a tile: row and column in one word. Rows are below 2^22, because a tile is at least 2^10
 * BAM high, so that no tile has LM_TILE_NO_NAME. */
#define LM_TILE_NO_NAME UINT64_MAX
static inline uint64_t lm_tile_name(uint32_t row, uint32_t column)
{
    return (uint64_t)row << 32 | column;
}

/* Chain of a tile, 0..LM_TILE_CHAINS - 1. Tiles of one chain are at least 34 tiles apart. Hence the
 * tiles around an aircraft are usually each the first of its chain. */
static inline uint32_t lm_tile_chain(uint32_t row, uint32_t column)
{
    return (row * 271 + column) % LM_TILE_CHAINS;
}

/* Look up a tile without requesting it: the fast path of lm_tile_cache_get. Returns the slot if the
 * tile is resident and the first of its chain, which is a look-up. Otherwise returns NULL and
 * counts nothing: call lm_tile_cache_get. The pointer is valid until the next
 * lm_tile_cache_service. Cost: some 12 instructions. */
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

/* Start and scale of a tile of the pool; the tile has passed lm_tile_check.
 *
 *     scale = base elevation, metres * 16384, a multiple of 256
 *           - right shift from posts to metres * 16384, 4..8
 *
 * An interpolated post is Q16 in steps of 2^post_shift / 64 metres, which is Q22 of 2^post_shift
 * metres. Hence the shift to Q14 is 8 - post_shift. Readers take it from the lowest byte. They
 * leave it in where they add the base, which lowers elevations by at most half a millimetre.
 * Ranges: lm_tile_check limits |base_m_q6| to 2^20 and post_shift to 4, so |scale| is at most 2^28
 * + 8. */
static inline struct lm_tile_base lm_tile_base_of(const struct lm_tile *pool,
                                                  const struct lm_tile *tile)
{
    const uint32_t bytes = (uint32_t)((const uint8_t *)tile - (const uint8_t *)pool); /* < 2^27 */
    return (struct lm_tile_base){.record = bytes,
                                 .scale = tile->base_m_q6 * 256 + (tile->post_shift - 8)};
}

/* Request a tile that will be needed soon, or the first ancestor that the image has. Does nothing
 * if it is resident or requested already. A full ring drops the request and counts it. */
void lm_tile_cache_want(struct lm_tile_cache *c, uint8_t lod, uint32_t row, uint32_t column);

/* Number of requests that wait for the flash. */
static inline uint32_t lm_tile_cache_waiting(const struct lm_tile_cache *c)
{
    return c->wanted_head - c->wanted_tail;
}

/* Read something else of the image before the next tile. The caller fills offset, destination and
 * length. True if taken: the cache borrows `request` until its status is no longer LM_BUSY. False,
 * with nothing taken, while another request waits or is being read. */
bool lm_tile_cache_read(struct lm_tile_cache *c, struct lm_flash_request *request);

/* Continue reading, with at most `reads` polls or starts of the flash, or parts of the unpacking of
 * a compressed record, or of several images of fitting and filling a tile. Never waits. Tiles that
 * lm_tile_cache_get returned before may be evicted. Cost: the check of a record for each tile that
 * is complete, a pass over the slots for each tile that is begun, and lm_tile_unpack_run for each
 * part, which costs half a check. */
void lm_tile_cache_service(struct lm_tile_cache *c, uint64_t now_us, uint32_t reads);

/* The images have changed, or the LODs of *db: these answer from now on; of none no tile is read.
 * All tiles leave the cache, and requests are forgotten. A coarsest LOD that was resident whole is
 * no longer. The last tile of the pool is kept for filling from the first time on that there are
 * several. */
void lm_tile_cache_mount(struct lm_tile_cache *c, const struct lm_db *images, uint32_t image_count);

/* True if no read is under way that was begun before lm_tile_cache_mount. */
bool lm_tile_cache_is_drained(const struct lm_tile_cache *c);

/* True if no request waits and nothing is being read. */
bool lm_tile_cache_is_idle(const struct lm_tile_cache *c);

#endif
