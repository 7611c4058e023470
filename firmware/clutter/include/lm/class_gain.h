/* Class gain: what a picture adds to the level of each class of ground: its gain in the LOD that is
 * read, the sea state, the clutter that GMT cancels, and how its walls face the line of sight. Law:
 * docs/EQUATIONS.md, "Class gain". */
#ifndef LM_CLASS_GAIN_H
#define LM_CLASS_GAIN_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/db.h"
#include "lm/environment.h"
#include "lm/radar.h"
#include "lm/units.h"

enum {
    LM_CLUTTER_LOSS_MAX_DB_Q8 = LM_DB_Q8(64),
    LM_CLASS_GAIN_MAX_DB_Q8 = LM_DB_Q8(25) /* what the highest sea state gives water */
};

/* Steps of the lobe of walls, from square to the line of sight to 45 degrees off. */
enum { LM_FACING_STEPS = 64 };

/* Gain of each class. The caller owns it. */
struct lm_class_gain {
    int16_t of_class_db_q8[LM_DB_CLASSES];   /* -109..25 dB: what lm_illuminate adds */
    bool is_faced;                           /* true if a class has a facing */
    uint8_t facing[LM_DB_CLASSES];           /* of struct lm_class */
    int32_t unfaced_db_q8[LM_DB_CLASSES];    /* gain without that of the facing; -89..25 dB */
    int16_t lobe_db_q8[LM_FACING_STEPS + 1]; /* -20..14 dB; set if is_faced */
};

/* Set the gains: that of the class in the LOD that the map is read from, plus that of the sea state
 * for water, less loss_db_q8 for all. lm_class_gain_look adds those of facings.
 *
 * - An LOD is below LM_DB_LODS_MAX.
 * - A gain of class and sea state beyond LM_CLASS_GAIN_MAX_DB_Q8 either way counts as that.
 * - A sea state above LM_SEA_STATE_MAX counts as that.
 * - A loss above LM_CLUTTER_LOSS_MAX_DB_Q8 counts as that.
 *
 * `facing` and `classes` are borrowed for the call. Cost: 200 instructions, and 8,000 if a class
 * has a facing. */
void lm_class_gain_set(struct lm_class_gain *g, const struct lm_facing_config *facing,
                       const struct lm_classes *classes, uint8_t lod, uint8_t sea_state,
                       uint16_t loss_db_q8);

/* Look along an azimuth: classes that have a facing get its gain, with which they gain no more than
 * LM_CLASS_GAIN_MAX_DB_Q8. Cost: 150 instructions if a class
 * has one. */
void lm_class_gain_look(struct lm_class_gain *g, fx_bam_t azimuth);

#endif
