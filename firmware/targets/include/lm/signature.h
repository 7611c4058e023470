/* Signature: radar pictures (chips) of one target from many sides, made by a ray tracer or a
 * network [Niu]. Signatures and chips are records of the image's section SIGNATURES.
 *
 * A chip shows the target on level ground, from one bearing at one depression, in square pixels of
 * the ground. What stands high lies nearer than its position, by its height times the tangent of
 * the depression, as in any radar picture.
 *
 *     row 63  +---------------------+   away from the radar
 *             |                     |
 *             |          o----------|-- between rows origin_row - 1 and origin_row
 *             |          |          |
 *     row 0   +----------|----------+   nearest to the radar
 *         column 0       |      column 63
 *          (left)   between columns 31 and 32, as the radar looks; o is the target's origin
 *
 * Source: docs/EQUATIONS.md, "Signatures"; records in docs/FORMATS.md, 1.9. */
#ifndef LM_SIGNATURE_H
#define LM_SIGNATURE_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/db.h"
#include "lm/rcs.h"
#include "lm/units.h"

enum {
    LM_CHIP_SIDE = 64, /* rows, and columns, of a chip */
    LM_SIGNATURE_ASPECTS_MAX = 128,
    LM_SIGNATURE_DEPRESSIONS_MAX = 8,
    LM_SIGNATURE_PIXEL_MIN_MM = 10,
    LM_SIGNATURE_PIXEL_MAX_MM = 16000,
    LM_SIGNATURE_HEIGHT_MAX_MM = 200000
};

/* Code of a cross section: dBsm = code / 2 - 80, so -79.5 .. +47.5. Code 0 is no return. */
enum { LM_SIGNATURE_CODE_STEP_DB_Q8 = 128, LM_SIGNATURE_CODE_ZERO_DBSM_Q8 = LM_DB_Q8(-80) };

/* Record of one signature. */
struct lm_signature {
    uint32_t crc; /* CRC-32C of all bytes after this field */
    char name[16];
    uint16_t aspects;    /* 1..128, evenly around: 0 is from ahead, then from the target's right */
    uint8_t depressions; /* 1..8 */
    uint8_t origin_row;  /* 0..64 */
    uint32_t pixel_mm;   /* LM_SIGNATURE_PIXEL_MIN_MM..MAX_MM */
    uint32_t height_mm;  /* of the target's top above its origin, 0..LM_SIGNATURE_HEIGHT_MAX_MM */
    uint32_t chip0;      /* number of its first chip; it has aspects * depressions of them */
    fx_bam_t depression[LM_SIGNATURE_DEPRESSIONS_MAX]; /* rising, above 0 and below 90 degrees; the
                                                          rest is 0 */
    uint8_t reserved[60];
    /* Code of the whole target's cross section; 0 where not used. */
    uint8_t rcs[LM_SIGNATURE_DEPRESSIONS_MAX][LM_SIGNATURE_ASPECTS_MAX];
};
_Static_assert(sizeof(struct lm_signature) == LM_SIGNATURE_BYTES,
               "the record must be what FORMATS.md says");

/* Record of one chip. That of aspect a and depression d has the number chip0 + d * aspects + a. */
struct lm_chip {
    uint32_t crc; /* CRC-32C of all bytes after this field */
    uint16_t signature, aspect;
    uint8_t depression;
    uint8_t reserved[55];
    uint8_t level[LM_CHIP_SIDE]
                 [LM_CHIP_SIDE]; /* [row][column]: code of the pixel's cross section */
    uint8_t shadow[LM_CHIP_SIDE][LM_CHIP_SIDE / 8]; /* bit column % 8 of byte column / 8: ground
                                                       that the target hides from the radar */
};
_Static_assert(sizeof(struct lm_chip) == LM_CHIP_BYTES, "the record must be what FORMATS.md says");

/* Check a record: its checksum and the range of every field. `chips` is the number of chips in the
 * section. Returns LM_OK or LM_ERR_CORRUPT. Cost: one CRC over 1152 bytes. */
int lm_signature_check(const struct lm_signature *s, uint32_t chips);

/* Check a chip: its checksum, and that it is the one of these indices. Returns LM_OK or
 * LM_ERR_CORRUPT. Cost: one CRC over 4672 bytes. */
int lm_chip_check(const struct lm_chip *c, uint32_t signature, uint32_t aspect,
                  uint32_t depression);

/* Read and check record `index` of the image's signatures. Blocks, with at most `poll_limit` polls
 * of the flash: for start-up, when no tile is being read. Returns LM_OK, or
 * - LM_ERR_RANGE if index is db->signature_count or more, with *s unchanged;
 * - LM_ERR_IO if the flash fails or is late, with *s unspecified;
 * - LM_ERR_CORRUPT if the record does not pass lm_signature_check, with *s unspecified. */
int lm_signature_read(const struct lm_db *db, uint32_t index, struct lm_signature *s,
                      uint32_t poll_limit);

/* Choice of the chip that is nearest to a view. */
struct lm_chip_choice {
    uint32_t aspect, depression; /* indices */
    fx_bam_t turn; /* bearing less that of the chip: angle by which the picture is to be turned, at
                      most half an aspect either way */
};

/* Choose the chip for a view: `bearing` of the radar from the target's nose towards its right, and
 * `elevation` of the radar above the target's horizon. `s` is a checked record. */
struct lm_chip_choice lm_signature_choose(const struct lm_signature *s, fx_bam_t bearing,
                                          fx_bam_t elevation);

/* Cross section of the whole target in a view: that of the nearest chip, or LM_RCS_NONE_DBSM_Q8 if
 * its code is 0. */
int32_t lm_signature_rcs_dbsm_q8(const struct lm_signature *s, fx_bam_t bearing,
                                 fx_bam_t elevation);

#endif
