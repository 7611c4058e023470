/* Chips of a picture: those that a patch or a window shows. They are read from flash in the
 * background, reduced to the picture's cell, and kept as long as they are wanted.
 *
 * A target is drawn as a point of its signature's cross section while its chip is
 * - not read yet,
 * - damaged or not readable, or
 * - left out because all slots are in use.
 * Its position and strength are then right; its shape is not.
 *
 * Order of the calls: lm_chips_init once, lm_chips_choose for each picture, lm_chips_service once a
 * step. Source: docs/EQUATIONS.md, "Signatures". */
#ifndef LM_CHIPS_H
#define LM_CHIPS_H

#include "lm/config.h"
#include "lm/target_view.h"
#include "lm/tile_cache.h"

/* Rows and columns of the summed-area tables below: one more than pixels, and one that is read with
 * weight 0. */
enum { LM_CHIP_ROOM = LM_CHIP_SIDE + 2 };

enum lm_chip_state { LM_CHIP_FREE = 0, LM_CHIP_WANTED, LM_CHIP_RESIDENT, LM_CHIP_BAD };

/* Bounding box of the pixels that are not empty. The ends are exclusive; all 0 if every pixel is
 * empty. */
struct lm_chip_box {
    uint8_t row, row_end, column, column_end;
};

/* Slot for one chip, reduced: 2^shift x 2^shift pixels are made one. */
struct lm_chip_slot {
    uint8_t state; /* enum lm_chip_state */
    bool is_in_use;
    struct lm_chip_key {
        uint8_t signature, aspect, depression; /* indices of the chip */
        uint8_t shift;                         /* of the reduction */
    } key;
    uint8_t side;                 /* pixels of a row after the reduction: LM_CHIP_SIDE >> shift */
    uint8_t origin_row;           /* as in the signature, before the reduction */
    uint8_t rows_ready;           /* rows that are reduced */
    uint32_t pixel_mm;            /* after the reduction */
    int32_t total_dbsm_q8;        /* cross section of the whole chip */
    struct lm_chip_box lit, dark; /* pixels with power; pixels with shadow */
    /* Summed-area tables: entry [row][column] is the sum over all pixels in rows before `row` and
     * columns before `column`. The sum over any box is read from its four corners:
     *
     *     box = [r1][c1] - [r0][c1] - [r1][c0] + [r0][c0]
     *
     * Power is a share of the total, at most 2^31 for all of it. Shadow is 255 for a whole pixel.
     */
    uint32_t power_q31[LM_CHIP_ROOM][LM_CHIP_ROOM];
    uint32_t shadow[LM_CHIP_ROOM][LM_CHIP_ROOM];
};

/* Value of one pixel in a summed-area table. */
static inline uint32_t lm_chip_pixel(const uint32_t sum[][LM_CHIP_ROOM], uint32_t row,
                                     uint32_t column)
{
    return sum[row + 1][column + 1] - sum[row][column + 1] - sum[row + 1][column] +
           sum[row][column];
}

/* Where a signature's chips come from: one image of several. */
struct lm_chip_source {
    uint64_t chips_offset; /* of the image's first chip, in the flash */
    uint32_t number;       /* of the signature, in its image */
};

/* Cache of chips, and the read that is under way. The caller owns it. */
struct lm_chips {
    struct lm_chip_slot slots[LM_CHIPS_MAX];
    const struct lm_chip_source *sources;  /* borrowed: those of the signatures */
    const struct lm_signature *signatures; /* borrowed: those of the target set */
    struct lm_chip stage;  /* chip as it was read last, lent to the flash meanwhile */
    uint64_t total_m2_q32; /* cross section of the chip in `stage`, square metres */
    struct lm_flash_request read;
    struct lm_chip_slot *busy; /* slot being read or reduced; NULL when idle */
    bool is_reading;
    struct {
        uint32_t read, io_errors, corrupt; /* chips */
        uint32_t left_out;                 /* chips that were wanted while all slots were in use */
        uint32_t cells_left_out;           /* cells of a patch; see lm_target_patch_add_chips */
    } count;                               /* only ever grow */
};

/* Query for chips: the position that a picture is seen from, and its cells. */
struct lm_chip_query {
    struct lm_position centre; /* of the patch or window */
    uint32_t reach_m;          /* half its diagonal: targets beyond it need no chip */
    struct lm_position radar;  /* below the antenna, which sees each target from there */
    struct lm_target_heights heights;
    uint32_t cell_mm;   /* of the picture: chips are reduced to the largest pixel not above it */
    uint32_t side_most; /* most pixels of a row after the reduction */
};

/* Begin with an empty cache. `signatures` (checked, those of the target set) and where the chips of
 * each come from are borrowed for its lifetime. */
void lm_chips_init(struct lm_chips *c, const struct lm_chip_source *sources,
                   const struct lm_signature *signatures);

/* Empty the cache, because the signatures are others now. A read that is under way ends, and nobody
 * sees what it read. What borrowed the slots shows points. */
void lm_chips_empty(struct lm_chips *c);

/* Choose chips for the candidates, and want those that are not resident. Sets `chip` and
 * `chip_turn` of each candidate. Slots that this picture does not use may be taken for others; the
 * slots that it uses are lent to the candidates until the next call. Cost: 2500 instructions for
 * each candidate with a signature. */
void lm_chips_choose(struct lm_chips *c, struct lm_target_candidates *candidates,
                     const struct lm_chip_query *query);

/* Advance the reading by one step: start a read through the tile cache, take one that has ended, or
 * reduce some rows. Call it once a step of the unit. A chip that
 * cannot be read is counted, and not tried again before the next lm_chips_choose. Cost: at most
 * 80,000 instructions, four or five times for a chip. */
void lm_chips_service(struct lm_chips *c, struct lm_tile_cache *tiles);

/* True if every chip in use is resident or has failed. */
bool lm_chips_are_settled(const struct lm_chips *c);

/* Chip of a candidate if it is resident, else NULL. */
static inline const struct lm_chip_slot *lm_chip_of(const struct lm_target_candidate *candidate)
{
    return candidate->chip && candidate->chip->state == LM_CHIP_RESIDENT ? candidate->chip : NULL;
}

#endif
