#include "lm/detail_reader.h"

static uint32_t row_of(const struct lm_db *db, fx_bam_t latitude)
{
    return (latitude + FX_BAM_90) >> (db->shift0 + db->finest + LM_TILE_CELLS_LOG2);
}

/* The zone is that of the southern border: a tile lies in one zone. */
struct lm_detail_ground lm_detail_ground_of(const struct lm_db *db, uint32_t row, uint32_t column)
{
    const uint32_t north_log2 = (uint32_t)db->shift0 + db->finest + LM_TILE_CELLS_LOG2;
    const fx_bam_t south = (row << north_log2) - FX_BAM_90;
    const uint32_t east_log2 = north_log2 + lm_db_zone(south);
    return (struct lm_detail_ground){{south, column << east_log2}, north_log2, east_log2};
}

/* Begin a row at its westernmost tile. */
static void start_row(struct lm_detail_reader *r, const struct lm_db *db)
{
    const uint32_t across_log2 = lm_detail_ground_of(db, r->row, 0).east_log2;
    const uint32_t round = UINT32_MAX >> across_log2;
    r->column = r->box.west >> across_log2;
    r->columns_left = (((r->box.east >> across_log2) - r->column) & round) + 1;
}

void lm_detail_reader_start(struct lm_detail_reader *r, const struct lm_db *db,
                            const struct lm_detail_box *box)
{
    r->box = *box;
    r->row = row_of(db, box->south);
    r->last_row = row_of(db, box->north);
    r->tiles_left = db->detail_size != 0 ? LM_DETAIL_TILES_MAX : 0;
    r->state = LM_DETAIL_LOOKING;
    start_row(r, db);
}

static void next_tile(struct lm_detail_reader *r, const struct lm_db *db)
{
    const uint32_t across_log2 = lm_detail_ground_of(db, r->row, 0).east_log2;
    r->tiles_left--;
    r->columns_left--;
    r->column = (r->column + 1) & (UINT32_MAX >> across_log2);
    if (r->columns_left == 0) {
        r->row++;
        start_row(r, db);
    }
}

static bool is_beyond(const struct lm_detail_reader *r)
{
    return r->tiles_left == 0 || r->row > r->last_row;
}

/* Start to read the record of the tile at hand, unless the flash is another reader's. */
static void start_read(struct lm_detail_reader *r, struct lm_tile_cache *tiles,
                       const struct lm_tile_slot *slot)
{
    r->bytes = (uint32_t)slot->detail_size * LM_DETAIL_UNIT_BYTES;
    r->read =
        (struct lm_flash_request){.offset = tiles->images[slot->image].detail_offset +
                                            (uint64_t)slot->detail_place * LM_DETAIL_UNIT_BYTES,
                                  .destination = &r->record,
                                  .length = r->bytes};
    if (lm_tile_cache_read(tiles, &r->read)) {
        r->under = tiles->pool[slot - tiles->slots].under;
        r->state = LM_DETAIL_READING;
    }
}

/* True if the record was read and is sound. A failed read is counted by the cache. */
static bool record_is_sound(const struct lm_detail_reader *r, struct lm_tile_cache *tiles)
{
    if (r->read.status != LM_OK) {
        return false;
    }
    const bool is_sound = lm_detail_check(&r->record, r->bytes, 0, r->row, r->column) == LM_OK;
    tiles->count.corrupt += !is_sound;
    return is_sound;
}

enum lm_detail_step lm_detail_reader_step(struct lm_detail_reader *r, struct lm_tile_cache *tiles)
{
    if (r->state == LM_DETAIL_READING) {
        if (r->read.status == LM_BUSY) {
            return LM_DETAIL_AWAITED;
        }
        r->state = LM_DETAIL_TAKEN;
        if (record_is_sound(r, tiles)) {
            return LM_DETAIL_ARRIVED;
        }
    }
    if (r->state == LM_DETAIL_TAKEN) {
        r->state = LM_DETAIL_LOOKING;
        next_tile(r, tiles->db);
    }
    for (; !is_beyond(r); next_tile(r, tiles->db)) {
        const struct lm_tile_slot *slot =
            lm_tile_cache_find(tiles, tiles->db->finest, r->row, r->column);
        if (slot && slot->detail_size != 0) {
            start_read(r, tiles, slot);
            return LM_DETAIL_AWAITED;
        }
    }
    return LM_DETAIL_ENDED;
}
