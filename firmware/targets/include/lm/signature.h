/* Signatures: radar pictures of one target from many sides, as a ray tracer or a network made them
 * [Niu]. Records of the image's section SIGNATURES; docs/FORMATS.md, 1.9.
 *
 * A chip is the target on level ground, seen from one bearing at one depression, in square pixels
 * of the ground: column 0 is leftmost as the radar looks, row 0 nearest to it. The target's origin
 * is at the corner where columns 31 and 32 and rows origin_row - 1 and origin_row meet. What stands
 * high lies nearer than its place, by its height times the tangent of the depression, as on any
 * radar picture. */
#ifndef LM_SIGNATURE_H
#define LM_SIGNATURE_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/db.h"
#include "lm/rcs.h"

enum {
    LM_CHIP_SIDE = 64, /* pixels either way */
    LM_SIGNATURE_ASPECTS_MAX = 128,
    LM_SIGNATURE_DEPRESSIONS_MAX = 8,
    LM_SIGNATURE_PIXEL_MIN_MM = 10,
    LM_SIGNATURE_PIXEL_MAX_MM = 16000,
    LM_SIGNATURE_HEIGHT_MAX_MM = 200000
};

/* Cross sections as codes: dBsm = code / 2 - 80, so -79.5 .. +47.5; 0: nothing at all. */
enum { LM_SIGNATURE_CODE_STEP_DB_Q8 = 128, LM_SIGNATURE_CODE_ZERO_DBSM_Q8 = -80 * 256 };

struct lm_signature {
    uint32_t crc; /* CRC-32C of all bytes after this field */
    char name[16];
    uint16_t aspects;    /* 1..128, evenly around; 0 is from ahead, then from the target's right */
    uint8_t depressions; /* 1..8 */
    uint8_t origin_row;  /* 0..64 */
    uint32_t pixel_mm;
    uint32_t height_mm; /* of the target's top above its origin */
    uint32_t chip0;     /* the first of its aspects * depressions chips in the section */
    fx_bam_t depression[LM_SIGNATURE_DEPRESSIONS_MAX]; /* 0 < each < 90 degrees, rising; then 0 */
    uint8_t reserved[60];
    /* Cross section of the whole target; 0 in what is not used. */
    uint8_t rcs[LM_SIGNATURE_DEPRESSIONS_MAX][LM_SIGNATURE_ASPECTS_MAX];
};
_Static_assert(sizeof(struct lm_signature) == LM_SIGNATURE_BYTES,
               "the record must be what FORMATS.md says");

/* The chip of aspect a and depression d is number chip0 + d * aspects + a. */
struct lm_chip {
    uint32_t crc; /* CRC-32C of all bytes after this field */
    uint16_t signature, aspect;
    uint8_t depression;
    uint8_t reserved[55];
    uint8_t level[LM_CHIP_SIDE][LM_CHIP_SIDE];      /* [row][column]: cross section of a pixel */
    uint8_t shadow[LM_CHIP_SIDE][LM_CHIP_SIDE / 8]; /* bit column % 8 of byte column / 8: ground
                                                       that the target hides from the radar */
};
_Static_assert(sizeof(struct lm_chip) == LM_CHIP_BYTES, "the record must be what FORMATS.md says");

/* Check a record: checksum and bounds; `chips` is the number of chips in the section. LM_OK or
 * LM_ERR_CORRUPT. Cost: one CRC over 1152 bytes. */
int lm_signature_check(const struct lm_signature *s, uint32_t chips);

/* Check a chip: checksum, and that it is the one asked for. Cost: one CRC over 4672 bytes. */
int lm_chip_check(const struct lm_chip *c, uint32_t signature, uint32_t aspect,
                  uint32_t depression);

/* Read record `index` of the image's signatures, as lm_target_read does. */
int lm_signature_read(const struct lm_db *db, uint32_t index, struct lm_signature *s,
                      uint32_t poll_limit);

/* Which chip shows the target best: bearing of the radar from the target's nose towards its right,
 * and elevation of the radar above its horizon. */
struct lm_chip_choice {
    uint32_t aspect, depression;
    fx_bam_t turn; /* bearing less that of the chip: the picture is to be turned so far */
};
struct lm_chip_choice lm_signature_choose(const struct lm_signature *s, fx_bam_t bearing,
                                          fx_bam_t elevation);

/* Cross section of the whole target from there, dBsm * 256: of the nearest chip;
 * LM_RCS_NONE_DBSM_Q8 when that is empty. */
int32_t lm_signature_rcs_dbsm_q8(const struct lm_signature *s, fx_bam_t bearing,
                                 fx_bam_t elevation);

#endif
