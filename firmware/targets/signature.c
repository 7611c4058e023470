#include "lm/signature.h"

#include "fx/crc32c.h"
#include "fx/sat.h"

static bool depressions_are_sound(const struct lm_signature *s)
{
    fx_bam_t last = 0;
    for (uint32_t d = 0; d < s->depressions; d++) {
        if (s->depression[d] <= last || s->depression[d] >= FX_BAM_90) {
            return false;
        }
        last = s->depression[d];
    }
    return true;
}

int lm_signature_check(const struct lm_signature *s, uint32_t chips)
{
    const uint8_t *bytes = (const uint8_t *)s;
    const uint32_t own_chips = (uint32_t)s->aspects * s->depressions;
    const bool is_sound =
        fx_crc32c(0, bytes + 4, LM_SIGNATURE_BYTES - 4) == s->crc && s->aspects >= 1 &&
        s->aspects <= LM_SIGNATURE_ASPECTS_MAX && s->depressions >= 1 &&
        s->depressions <= LM_SIGNATURE_DEPRESSIONS_MAX && s->origin_row <= LM_CHIP_SIDE &&
        s->pixel_mm >= LM_SIGNATURE_PIXEL_MIN_MM && s->pixel_mm <= LM_SIGNATURE_PIXEL_MAX_MM &&
        s->height_mm <= LM_SIGNATURE_HEIGHT_MAX_MM && own_chips <= chips &&
        s->chip0 <= chips - own_chips && depressions_are_sound(s);
    return is_sound ? LM_OK : LM_ERR_CORRUPT;
}

int lm_chip_check(const struct lm_chip *c, uint32_t signature, uint32_t aspect, uint32_t depression)
{
    const uint8_t *bytes = (const uint8_t *)c;
    const bool is_it =
        c->signature == signature && c->aspect == aspect && c->depression == depression;
    return is_it && fx_crc32c(0, bytes + 4, LM_CHIP_BYTES - 4) == c->crc ? LM_OK : LM_ERR_CORRUPT;
}

int lm_signature_read(const struct lm_db *db, uint32_t index, struct lm_signature *s,
                      uint32_t poll_limit)
{
    if (index >= db->signature_count) {
        return LM_ERR_RANGE;
    }
    const uint64_t offset = db->signatures_offset + (uint64_t)index * LM_SIGNATURE_BYTES;
    const int status = lm_db_read(db->flash, offset, s, LM_SIGNATURE_BYTES, poll_limit);
    return status == LM_OK ? lm_signature_check(s, db->chip_count) : status;
}

/* Index of the depression nearest to an elevation. */
static uint32_t nearest_depression(const struct lm_signature *s, fx_bam_t elevation)
{
    uint32_t best = 0, best_off = UINT32_MAX;
    for (uint32_t d = 0; d < s->depressions; d++) {
        const uint32_t off = fx_abs_u32((int32_t)(elevation - s->depression[d]));
        if (off < best_off) {
            best = d;
            best_off = off;
        }
    }
    return best;
}

struct lm_chip_choice lm_signature_choose(const struct lm_signature *s, fx_bam_t bearing,
                                          fx_bam_t elevation)
{
    /* Rounded to the nearest aspect; the product is below 2^40. */
    const uint64_t aspects = ((uint64_t)bearing * s->aspects + (1u << 31)) >> 32;
    const fx_bam_t seen_from = (fx_bam_t)((aspects << 32) / s->aspects);
    return (struct lm_chip_choice){
        .aspect = (uint32_t)(aspects % s->aspects),
        .depression = nearest_depression(s, elevation),
        .turn = bearing - seen_from,
    };
}

int32_t lm_signature_rcs_dbsm_q8(const struct lm_signature *s, fx_bam_t bearing, fx_bam_t elevation)
{
    const struct lm_chip_choice choice = lm_signature_choose(s, bearing, elevation);
    const int32_t code = s->rcs[choice.depression][choice.aspect];
    return code == 0 ? LM_RCS_NONE_DBSM_Q8
                     : LM_SIGNATURE_CODE_ZERO_DBSM_Q8 + code * LM_SIGNATURE_CODE_STEP_DB_Q8;
}
