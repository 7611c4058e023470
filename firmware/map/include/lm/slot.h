/* Slot: one of two places for a database image, so that one can be written while the other is
 * flown. docs/slots.md describes the record that says what a slot holds.
 *
 *     slot A   image 7 ............................ | record 0 | record 1 |   whole, load 12: flown
 *     slot B   image 8, being written ...           | record 0 | record 1 |   loading
 *
 * The two records of a slot are copies. They are written one after the other, each brought to the
 * medium before the next, so that one of them is sound whatever a power cut does to the other. */
#ifndef LM_SLOT_H
#define LM_SLOT_H

#include <stdbool.h>
#include <stdint.h>

enum { LM_SLOTS = 2, LM_SLOT_COPIES = 2, LM_SLOT_VERSION = 1 };

/* What a slot holds. Anything else than a whole image is not flown. */
enum lm_slot_content { LM_SLOT_LOADING = 1, LM_SLOT_WHOLE };

/* Record of a slot, little-endian. */
struct lm_slot_record {
    char magic[8];       /* "LMDBSLOT" */
    uint32_t version;    /* LM_SLOT_VERSION */
    uint32_t state;      /* enum lm_slot_content */
    uint64_t generation; /* of the record: of two sound copies the later one counts */
    uint64_t sequence;   /* of the load: of two whole slots the later one is flown; from 1 */
    uint64_t image_bytes;
    uint32_t image_crc; /* that of the image's header, which holds those of all its sections */
    uint8_t reserved[16];
    uint32_t crc; /* CRC-32C of the bytes before it */
};
_Static_assert(sizeof(struct lm_slot_record) == 64, "the record must be what docs/slots.md says");

/* The copy that counts: of those whose magic, version, state and checksum are right the one of the
 * later generation. NULL if neither is right. Pure; any bytes are safe. */
const struct lm_slot_record *lm_slot_of(const struct lm_slot_record copies[LM_SLOT_COPIES]);

/* The later of two slots that hold a whole image, or the one that does: 0 or 1. -1 if neither does.
 * Each may be NULL. Pure. */
int lm_slot_later(const struct lm_slot_record *a, const struct lm_slot_record *b);

/* Put the magic, the version and the checksum in. */
void lm_slot_seal(struct lm_slot_record *record);

#endif
