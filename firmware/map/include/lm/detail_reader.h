/* Detail reader: the detail of all tiles of the finest LOD in a box, read one record at a time
 * between the tiles (lm_tile_cache_read). It never waits.
 *
 * Example: a step of a patch that is being acquired.
 *
 *     switch (lm_detail_reader_step(&reader, &tiles)) {
 *     case LM_DETAIL_ARRIVED: take(&reader.record, reader.tile); break;
 *     case LM_DETAIL_AWAITED: return;                     call again in the next step
 *     case LM_DETAIL_ENDED: is_complete = true; break;
 *     }
 *
 * A tile that is not resident, or has no detail, is passed over. A record that cannot be read or
 * fails its check counts in the cache (io_errors, corrupt), and its tile keeps its cells. */
#ifndef LM_DETAIL_READER_H
#define LM_DETAIL_READER_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/detail.h"
#include "lm/geo.h"
#include "lm/tile_cache.h"

/* Box of tiles of LOD 0 between two corners. It may cross the antimeridian and borders of zones. */
struct lm_detail_box {
    fx_bam_t south, north; /* latitudes */
    fx_bam_t west, east;   /* longitudes; eastwards from west */
};

enum lm_detail_step { LM_DETAIL_AWAITED, LM_DETAIL_ARRIVED, LM_DETAIL_ENDED };

enum lm_detail_reader_state {
    LM_DETAIL_LOOKING, /* at tiles, for one with detail */
    LM_DETAIL_READING,
    LM_DETAIL_TAKEN /* the record of the tile at hand has arrived, well or not */
};

/* State of a reader. The caller owns it; `record` and `row` .. `under` belong to the record that
 * arrived last. */
struct lm_detail_reader {
    struct lm_detail_box box;
    struct lm_flash_request read;
    uint32_t bytes;        /* of the record that is being read */
    uint32_t row, column;  /* tile at hand */
    uint32_t last_row;     /* northernmost row of the box */
    uint32_t columns_left; /* in the row, with the one at hand */
    uint32_t tiles_left;   /* that may still be looked at: bounds the work */
    uint16_t under;        /* cell of the ground under the structures of the tile at hand */
    enum lm_detail_reader_state state;
    struct lm_detail record;
};

/* Tiles of a box that are looked at. What lies beyond is left as its cells show it. */
enum { LM_DETAIL_TILES_MAX = 128 };

/* Where a tile of LOD 0 lies: its south-west corner, and log2 of its sides in BAM. */
struct lm_detail_ground {
    struct lm_position corner;
    uint32_t north_log2, east_log2;
};

struct lm_detail_ground lm_detail_ground_of(const struct lm_db *db, uint32_t row, uint32_t column);

/* Start with the south-west tile of the box. */
void lm_detail_reader_start(struct lm_detail_reader *r, const struct lm_db *db,
                            const struct lm_detail_box *box);

/* Continue: look at tiles until one has detail and its read can be started, or one has arrived.
 * Cost: some 60 instructions a tile, and lm_detail_check for a record that has arrived. */
enum lm_detail_step lm_detail_reader_step(struct lm_detail_reader *r, struct lm_tile_cache *tiles);

#endif
