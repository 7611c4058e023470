/* Class gain: what a picture adds to the level of each class of ground: its gain in the LOD that is
 * read, the sea state, and the clutter that GMT cancels. Law: docs/EQUATIONS.md, "Class gain". */
#ifndef LM_CLASS_GAIN_H
#define LM_CLASS_GAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/db.h"
#include "lm/environment.h"
#include "lm/units.h"

enum {
    LM_CLUTTER_LOSS_MAX_DB_Q8 = LM_DB_Q8(64),
    LM_CLASS_GAIN_MAX_DB_Q8 = LM_DB_Q8(25) /* what the highest sea state gives water */
};

/* Gain of each class. The caller owns it. */
struct lm_class_gain {
    int32_t of_class_db_q8[LM_DB_CLASSES]; /* -89..25 dB; the kernel takes 16 bits */
    bool is_any;                           /* true if a class has a gain other than 0 */
};

/* Set the gains: that of the class in the LOD that the map is read from, plus that of the sea state
 * for water, less loss_db_q8 for all.
 *
 * - An LOD is below LM_DB_LODS_MAX.
 * - A gain of class and sea state beyond LM_CLASS_GAIN_MAX_DB_Q8 either way counts as that.
 * - A sea state above LM_SEA_STATE_MAX counts as that.
 * - A loss above LM_CLUTTER_LOSS_MAX_DB_Q8 counts as that.
 *
 * `classes` is borrowed for the call. Cost: 200 instructions. */
void lm_class_gain_set(struct lm_class_gain *g, const struct lm_classes *classes, uint8_t lod,
                       uint8_t sea_state, uint16_t loss_db_q8);

/* Add to the level of each cell the gain of its class, in place. `cell` is that of struct
 * lm_scan_line. Works on whole pairs of blocks of LM_LANES cells: arrays have room for them, and
 * what is written behind the last cell means nothing. LM_LEVEL_SHADOW stays below -80 dB, also
 * after speckle. Pointers are borrowed for the call. Cost: 3 instructions a cell if a class has a
 * gain, none otherwise. */
void lm_class_gain_run(const struct lm_class_gain *g, const uint32_t *cell, int32_t *level_db_q8,
                       uint32_t cells);

#endif
