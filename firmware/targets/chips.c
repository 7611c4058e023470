#include "lm/chips.h"

#include "fx/log.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/units.h"

enum {
    ROWS_A_STEP = 16, /* rows of the chip before the reduction that one step reduces */
    SHIFT_MAX = 4,    /* smaller chips than 4 x 4 pixels are drawn as a point */
    POINT_BELOW_CELLS = 4
};

void lm_chips_init(struct lm_chips *c, const struct lm_chip_source *sources,
                   const struct lm_signature *signatures)
{
    memset(c, 0, sizeof *c);
    c->sources = sources;
    c->signatures = signatures;
}

enum { NO_SHIFT = 255 }; /* of a slot whose chip nobody wants: no key has it */

void lm_chips_empty(struct lm_chips *c)
{
    struct lm_chip_slot *const reading = c->is_reading ? c->busy : NULL;
    for (uint32_t i = 0; i < LM_CHIPS_MAX; i++) {
        if (&c->slots[i] != reading) {
            memset(&c->slots[i], 0, sizeof c->slots[i]);
        }
    }
    if (reading) {
        reading->is_in_use = false;
        reading->key.shift = NO_SHIFT;
    }
    c->busy = reading;
}

/* ---- choosing ---- */

static bool is_same(const struct lm_chip_key *a, const struct lm_chip_key *b)
{
    return a->signature == b->signature && a->aspect == b->aspect &&
           a->depression == b->depression && a->shift == b->shift;
}

/* Reduction of a chip: to the largest pixel that is not larger than the cell, and to at most
 * side_most pixels a row. */
static uint32_t shift_for(const struct lm_signature *s, const struct lm_chip_query *query)
{
    uint32_t shift = 0;
    while (shift < SHIFT_MAX && ((s->pixel_mm << (shift + 1)) <= query->cell_mm ||
                                 (uint32_t)LM_CHIP_SIDE >> shift > query->side_most)) {
        shift++;
    }
    return shift;
}

/* View of the radar from a candidate. */
static void view_of(struct lm_target_view *v, const struct lm_target_candidate *candidate,
                    const struct lm_chip_query *query)
{
    uint32_t range_m_q8;
    fx_bam_t back;
    lm_geo_inverse(candidate->state.position, query->radar, &range_m_q8, &back);
    lm_target_view_of(v, candidate, back, range_m_q8, &query->heights);
}

static bool is_large_and_near(const struct lm_signature *s,
                              const struct lm_target_candidate *candidate,
                              const struct lm_chip_query *query)
{
    uint32_t distance_m_q8;
    fx_bam_t azimuth;
    lm_geo_inverse(query->centre, candidate->state.position, &distance_m_q8, &azimuth);
    return lm_m_of_m_q8(distance_m_q8) <= query->reach_m + LM_TARGET_EXTENT_M &&
           s->pixel_mm * LM_CHIP_SIDE >= query->cell_mm * POINT_BELOW_CELLS;
}

/* Slot of a key; else one that is free or not in use; NULL if all are in use. The slot that is
 * being read or reduced is not given away. */
static struct lm_chip_slot *find_slot(struct lm_chips *c, const struct lm_chip_key *key)
{
    struct lm_chip_slot *unused = NULL;
    for (uint32_t i = 0; i < LM_CHIPS_MAX; i++) {
        struct lm_chip_slot *slot = &c->slots[i];
        if (slot->state != LM_CHIP_FREE && is_same(&slot->key, key)) {
            return slot;
        }
        if (!slot->is_in_use && slot != c->busy) {
            unused = slot;
        }
    }
    return unused;
}

static const struct lm_chip_slot *want(struct lm_chips *c, const struct lm_signature *s,
                                       const struct lm_chip_key *key)
{
    struct lm_chip_slot *slot = find_slot(c, key);
    if (!slot) {
        c->count.left_out++;
        return NULL;
    }
    if (slot->state == LM_CHIP_FREE || slot->state == LM_CHIP_BAD || !is_same(&slot->key, key)) {
        memset(slot, 0, sizeof *slot);
        slot->state = LM_CHIP_WANTED;
        slot->key = *key;
        slot->side = (uint8_t)(LM_CHIP_SIDE >> key->shift);
        slot->origin_row = s->origin_row;
        slot->pixel_mm = s->pixel_mm << key->shift;
    }
    slot->is_in_use = true;
    return slot;
}

/* Key of the chip that shows a candidate best. False if it has no signature, is out of reach, or is
 * so small that a point will do. */
static bool key_of(const struct lm_target_set *set, struct lm_target_candidate *candidate,
                   const struct lm_chip_query *query, struct lm_chip_key *key)
{
    const struct lm_signature *s = lm_target_signature(set, &candidate->body);
    candidate->chip = NULL;
    if (!s || !is_large_and_near(s, candidate, query)) {
        return false;
    }
    struct lm_target_view v;
    view_of(&v, candidate, query);
    const struct lm_chip_choice choice = lm_signature_choose(s, v.bearing, v.elevation);
    candidate->chip_turn = choice.turn;
    *key = (struct lm_chip_key){.signature = candidate->body.signature,
                                .aspect = (uint8_t)choice.aspect,
                                .depression = (uint8_t)choice.depression,
                                .shift = (uint8_t)shift_for(s, query)};
    return true;
}

void lm_chips_choose(struct lm_chips *c, struct lm_target_candidates *candidates,
                     const struct lm_chip_query *query)
{
    const struct lm_target_set *set = &candidates->set;
    struct lm_chip_key key[LM_TARGET_CANDIDATES_MAX];
    bool has_key[LM_TARGET_CANDIDATES_MAX];
    for (uint32_t i = 0; i < LM_CHIPS_MAX; i++) {
        c->slots[i].is_in_use = false;
    }
    /* Mark resident chips as in use first: the second loop then gives away only slots that nobody
     * needs. */
    for (uint32_t i = 0; i < candidates->count; i++) {
        has_key[i] = key_of(set, &candidates->candidate[i], query, &key[i]);
        for (uint32_t k = 0; has_key[i] && k < LM_CHIPS_MAX; k++) {
            struct lm_chip_slot *slot = &c->slots[k];
            slot->is_in_use |= slot->state != LM_CHIP_FREE && is_same(&slot->key, &key[i]);
        }
    }
    for (uint32_t i = 0; i < candidates->count; i++) {
        if (has_key[i]) {
            candidates->candidate[i].chip = want(c, &set->signatures[key[i].signature], &key[i]);
        }
    }
}

/* ---- reading ---- */

static void finish(struct lm_chips *c, enum lm_chip_state state)
{
    c->busy->state = (uint8_t)state;
    c->busy = NULL;
    c->is_reading = false;
}

static void start_read(struct lm_chips *c, struct lm_tile_cache *tiles, struct lm_chip_slot *slot)
{
    const struct lm_chip_key *key = &slot->key;
    const struct lm_signature *s = &c->signatures[key->signature];
    const uint64_t number = s->chip0 + (uint32_t)key->depression * s->aspects + key->aspect;
    c->read = (struct lm_flash_request){.offset = c->sources[key->signature].chips_offset +
                                                  number * LM_CHIP_BYTES,
                                        .destination = &c->stage,
                                        .length = LM_CHIP_BYTES};
    if (lm_tile_cache_read(tiles, &c->read)) {
        c->busy = slot;
        c->is_reading = true;
    }
}

static bool is_missing(const struct lm_chip_slot *slot)
{
    return slot->is_in_use && slot->state == LM_CHIP_WANTED;
}

static void start_next(struct lm_chips *c, struct lm_tile_cache *tiles)
{
    for (uint32_t i = 0; i < LM_CHIPS_MAX; i++) {
        if (is_missing(&c->slots[i])) {
            start_read(c, tiles, &c->slots[i]);
            return;
        }
    }
}

/* ---- reducing ---- */

/* Cross section of a pixel, m2: below 2^47.9 in Q32. The sum over a chip of 2^12 pixels is below
 * 2^60. */
static uint64_t rcs_m2_q32(uint8_t code)
{
    return code == 0 ? 0
                     : fx_power_q32_vec(LM_SIGNATURE_CODE_ZERO_DBSM_Q8 +
                                        code * LM_SIGNATURE_CODE_STEP_DB_Q8);
}

/* Level of such a sum, dBsm. */
static int32_t level_dbsm_q8(uint64_t sum_q32)
{
    return sum_q32 == 0 ? LM_SIGNATURE_CODE_ZERO_DBSM_Q8
                        : fx_db_q8_u64(sum_q32) - fx_db_q8_u64((uint64_t)1 << 32);
}

static uint64_t total_m2_q32(const struct lm_chip *chip)
{
    uint64_t sum_q32 = 0;
    for (uint32_t row = 0; row < LM_CHIP_SIDE; row++) {
        for (uint32_t column = 0; column < LM_CHIP_SIDE; column++) {
            sum_q32 += rcs_m2_q32(chip->level[row][column]);
        }
    }
    return sum_q32;
}

/* Share of the total. Both are below 2^60; they are shifted alike until the total fits 32 bits, and
 * part << 31 fits 64. The error is below 2^-31 of the total. */
static uint32_t share_q31(uint64_t part_m2_q32, uint64_t total_m2_q32)
{
    const uint32_t cut = total_m2_q32 >> 32 == 0 ? 0 : 32 - (uint32_t)fx_clz64(total_m2_q32);
    return total_m2_q32 == 0 ? 0 : (uint32_t)((part_m2_q32 >> cut << 31) / (total_m2_q32 >> cut));
}

static void widen(struct lm_chip_box *box, uint32_t row, uint32_t column)
{
    const bool is_empty = box->row_end == 0;
    box->row = (uint8_t)(is_empty ? row : fx_min_u32(box->row, row));
    box->column = (uint8_t)(is_empty ? column : fx_min_u32(box->column, column));
    box->row_end = (uint8_t)fx_max_u32(box->row_end, row + 1);
    box->column_end = (uint8_t)fx_max_u32(box->column_end, column + 1);
}

/* Power and shadow of one pixel, or of the pixels before it in its row. */
struct amount {
    uint32_t power_q31, shadow;
};

/* Reduce one pixel: sum its 2^shift x 2^shift pixels of the chip. Shadow is 255 times the part of
 * them that is dark. */
static struct amount reduce_pixel(const struct lm_chips *c, uint32_t row, uint32_t column)
{
    const struct lm_chip *chip = &c->stage;
    const uint32_t shift = c->busy->key.shift, side = 1u << shift;
    uint64_t sum_q32 = 0;
    uint32_t dark = 0;
    for (uint32_t r = row << shift; r < (row << shift) + side; r++) {
        for (uint32_t k = column << shift; k < (column << shift) + side; k++) {
            sum_q32 += rcs_m2_q32(chip->level[r][k]);
            dark += (uint32_t)chip->shadow[r][k / 8] >> k % 8 & 1u;
        }
    }
    return (struct amount){share_q31(sum_q32, c->total_m2_q32), dark * 255 >> 2 * shift};
}

/* Reduce one row into the summed-area tables: S[row + 1][column + 1] = S[row][column + 1] + the
 * row's pixels up to this column. Power adds up to at most 2^31, shadow to 255 * 2^12. */
static void reduce_row(struct lm_chips *c, uint32_t row)
{
    struct lm_chip_slot *slot = c->busy;
    struct amount before = {0, 0};
    for (uint32_t column = 0; column < slot->side; column++) {
        const struct amount pixel = reduce_pixel(c, row, column);
        before.power_q31 += pixel.power_q31;
        before.shadow += pixel.shadow;
        slot->power_q31[row + 1][column + 1] = slot->power_q31[row][column + 1] + before.power_q31;
        slot->shadow[row + 1][column + 1] = slot->shadow[row][column + 1] + before.shadow;
        if (pixel.power_q31 != 0) {
            widen(&slot->lit, row, column);
        }
        if (pixel.shadow != 0) {
            widen(&slot->dark, row, column);
        }
    }
}

/* Reduce some rows of the chip that was read. It is resident when all are done. */
static void reduce_rows(struct lm_chips *c)
{
    struct lm_chip_slot *slot = c->busy;
    const uint32_t end = slot->rows_ready + ((uint32_t)ROWS_A_STEP >> slot->key.shift);
    for (; slot->rows_ready < end; slot->rows_ready++) {
        reduce_row(c, slot->rows_ready);
    }
    if (slot->rows_ready == slot->side) {
        c->count.read++;
        finish(c, LM_CHIP_RESIDENT);
    }
}

static void take_read(struct lm_chips *c)
{
    struct lm_chip_slot *slot = c->busy;
    const struct lm_chip_key *key = &slot->key;
    c->is_reading = false;
    if (key->shift == NO_SHIFT) {
        finish(c, LM_CHIP_FREE);
    } else if (c->read.status != LM_OK) {
        c->count.io_errors++;
        finish(c, LM_CHIP_BAD);
    } else if (lm_chip_check(&c->stage, c->sources[key->signature].number, key->aspect,
                             key->depression) != LM_OK) {
        c->count.corrupt++;
        finish(c, LM_CHIP_BAD);
    } else {
        c->total_m2_q32 = total_m2_q32(&c->stage);
        slot->total_dbsm_q8 = level_dbsm_q8(c->total_m2_q32);
    }
}

void lm_chips_service(struct lm_chips *c, struct lm_tile_cache *tiles)
{
    if (!c->busy) {
        start_next(c, tiles);
    } else if (!c->is_reading) {
        reduce_rows(c);
    } else if (c->read.status != LM_BUSY) {
        take_read(c);
    }
}

bool lm_chips_are_settled(const struct lm_chips *c)
{
    bool are_settled = true;
    for (uint32_t i = 0; i < LM_CHIPS_MAX; i++) {
        are_settled = are_settled && !is_missing(&c->slots[i]);
    }
    return are_settled;
}
