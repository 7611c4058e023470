/* The chips that a patch or a window shows: read from flash in the background, reduced to the
 * picture's cell and kept as long as they are wanted. docs/EQUATIONS.md, "Signatures".
 *
 * A target whose chip is not there, late, damaged, or left out because all places are taken, is
 * drawn as a point of its signature's cross section: wrong in shape, not in place or strength. */
#ifndef LM_CHIPS_H
#define LM_CHIPS_H

#include "lm/config.h"
#include "lm/target_view.h"
#include "lm/tile_cache.h"

/* Entries of a row and rows of the sums below: one more than pixels, and one that is read but
 * counts nothing. */
enum { LM_CHIP_ROOM = LM_CHIP_SIDE + 2 };

enum lm_chip_state { LM_CHIP_FREE = 0, LM_CHIP_WANTED, LM_CHIP_RESIDENT, LM_CHIP_BAD };

/* The rows and columns of a chip that hold something: up to, and without, the ends; all 0 when
 * nothing does. */
struct lm_chip_box {
    uint8_t row, row_end, column, column_end;
};

/* A chip with 2^shift pixels made one, either way. */
struct lm_chip_slot {
    uint8_t state; /* enum lm_chip_state */
    bool is_in_use;
    struct lm_chip_key {
        uint8_t signature, aspect, depression;
        uint8_t shift; /* the reduction's */
    } key;
    uint8_t side;                 /* pixels: LM_CHIP_SIDE >> shift */
    uint8_t origin_row;           /* as in the signature, before the reduction */
    uint8_t rows_ready;           /* reduced so far */
    uint32_t pixel_mm;            /* after the reduction */
    int32_t total_dbsm_q8;        /* cross section of it all, dBsm * 256 */
    struct lm_chip_box lit, dark; /* pixels with power, and with shadow */
    /* Sums over the pixels in the rows before `row` and the columns before `column`, at
     * [row][column]: what lies in any box is had from its four corners. Shares of the total, 2^31
     * for all of it at the most, and ground in shadow, 255 for all of a pixel. */
    uint32_t power_q31[LM_CHIP_ROOM][LM_CHIP_ROOM];
    uint32_t shadow[LM_CHIP_ROOM][LM_CHIP_ROOM];
};

/* What one pixel has of either sum. */
static inline uint32_t lm_chip_pixel(const uint32_t sum[][LM_CHIP_ROOM], uint32_t row,
                                     uint32_t column)
{
    return sum[row + 1][column + 1] - sum[row][column + 1] - sum[row + 1][column] +
           sum[row][column];
}

struct lm_chips {
    const struct lm_db *db; /* borrowed */
    struct lm_chip_slot slots[LM_CHIPS_MAX];
    const struct lm_signature *signatures; /* borrowed: those of the targets */
    struct lm_chip stage;                  /* what was read last, */
    uint64_t total_m2_q32;                 /* and its cross section, m2 */
    struct lm_flash_request read;
    struct lm_chip_slot *busy; /* being read or reduced; NULL when idle */
    bool is_reading;
    struct {
        uint32_t read, io_errors, corrupt;
        uint32_t left_out;       /* wanted, but there was no room */
        uint32_t cells_left_out; /* of a patch's lines that had enough of chips */
    } count;                     /* only ever grow */
};

/* Where the chips of a picture are seen from. */
struct lm_chip_query {
    struct lm_position centre; /* of patch or window */
    uint32_t reach_m;          /* half its diagonal: targets beyond it need no chip */
    struct lm_position radar;
    bool is_parallel; /* all is seen along `look`, from range_m_q8: a patch; else from `radar` */
    fx_bam_t look;
    uint32_t range_m_q8;
    struct lm_target_heights heights;
    uint32_t cell_mm;   /* chips are reduced to the largest pixel that is not larger, */
    uint32_t side_most; /* and to that many of them either way at most */
};

/* `signatures` are those of the targets that chips will be chosen for, checked. */
void lm_chips_init(struct lm_chips *c, const struct lm_db *db,
                   const struct lm_signature *signatures);

/* Choose chips for the targets near, and want those that are not there. Each item's `chip` and
 * `chip_turn` are set; chips that are no longer in use make room. Cost: 2500 instructions for each
 * near target with a signature. */
void lm_chips_choose(struct lm_chips *c, struct lm_target_candidates *candidates,
                     const struct lm_chip_query *query);

/* Go on with reading them, through the tile cache, and reduce what has come. Call once a step.
 * Cost: at most 80,000 instructions, for a chip four or five times. */
void lm_chips_service(struct lm_chips *c, struct lm_tile_cache *tiles);

/* Whether every chip that is in use is there or will not come. */
bool lm_chips_are_settled(const struct lm_chips *c);

/* The chip of an item when it is there, else NULL. */
static inline const struct lm_chip_slot *lm_chip_of(const struct lm_target_candidate *candidate)
{
    return candidate->chip && candidate->chip->state == LM_CHIP_RESIDENT ? candidate->chip : NULL;
}

#endif
