#include "lm/target.h"

#include "fx/const.h"
#include "fx/crc32c.h"
#include "fx/hash.h"
#include "fx/log.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/units.h"

/* ---- records ---- */

enum { ELEVATION_MAX_Q6 = 1 << 20 };

static bool is_within(int32_t x, int32_t limit)
{
    return x >= -limit && x <= limit;
}

static bool is_size(uint32_t size_mm)
{
    return size_mm >= 1 && size_mm <= LM_SHAPE_SIZE_MAX_MM;
}

static bool scatterer_is_sound(const struct lm_scatterer *s)
{
    const bool has_second = s->kind == LM_SHAPE_PLATE || s->kind == LM_SHAPE_DIHEDRAL;
    bool is_sound = s->kind >= LM_SHAPE_SPHERE && s->kind < LM_SHAPE_KINDS &&
                    s->is_two_sided <= 1 && is_size(s->size_mm[0]) &&
                    (!has_second || is_size(s->size_mm[1]));
    for (int i = 0; i < 3; i++) {
        is_sound = is_sound && is_within(s->offset_mm[i], LM_TARGET_OFFSET_MAX_MM);
    }
    return is_sound;
}

static bool path_is_sound(const struct lm_target *t)
{
    bool is_sound = t->scatterer_count == 0 && t->leg_m == 0 && t->path_legs >= 1 &&
                    t->path_legs <= LM_TARGET_LEGS_MAX && t->path_is_round <= 1;
    for (uint32_t i = 0; is_sound && i < t->path_legs; i++) {
        const struct lm_path_leg *leg = &t->path[i];
        is_sound = fx_abs_u32((int32_t)leg->latitude) <= FX_BAM_90 && leg->length_mm >= 1000 &&
                   leg->length_mm <= lm_mm_of_m(LM_TARGET_LEG_MAX_M);
    }
    return is_sound;
}

static bool motion_is_sound(const struct lm_target *t)
{
    if (t->flags & LM_TARGET_HAS_PATH) {
        return t->speed_mm_s >= 1 && t->speed_mm_s <= LM_TARGET_SPEED_MAX_MM_S && path_is_sound(t);
    }
    const bool is_leg_sound = t->speed_mm_s == 0
                                  ? t->leg_m == 0
                                  : t->speed_mm_s <= LM_TARGET_SPEED_MAX_MM_S && t->leg_m >= 1 &&
                                        t->leg_m <= LM_TARGET_LEG_MAX_M;
    return is_leg_sound && t->path_legs == 0 && t->path_is_round == 0;
}

/* Scatterers, a signature, or neither (a fluctuating point, a beacon): not two of them. */
static bool kind_is_sound(const struct lm_target *t)
{
    const uint32_t kind = t->flags & (LM_TARGET_HAS_SIGNATURE | LM_TARGET_IS_BEACON);
    return kind == 0 ? t->scatterer_count <= LM_SCATTERERS_MAX && t->signature == 0
                     : t->scatterer_count == 0 &&
                           (kind == LM_TARGET_IS_BEACON || (kind == LM_TARGET_HAS_SIGNATURE &&
                                                            t->signature < LM_DB_SIGNATURES_MAX));
}

int lm_target_check(const struct lm_target *t)
{
    const uint8_t *bytes = (const uint8_t *)t;
    bool is_sound = fx_crc32c(0, bytes + 4, LM_TARGET_BYTES - 4) == t->crc &&
                    fx_abs_u32((int32_t)t->latitude) <= FX_BAM_90 &&
                    is_within(t->elevation_m_q6, ELEVATION_MAX_Q6) && kind_is_sound(t) &&
                    (t->flags & ~LM_TARGET_FLAGS) == 0 && motion_is_sound(t) &&
                    t->swerling <= LM_TARGET_SWERLING_MAX &&
                    is_within(t->mean_rcs_dbsm_q8, LM_TARGET_RCS_MAX_Q8);
    for (uint32_t i = 0; is_sound && i < t->scatterer_count; i++) {
        is_sound = scatterer_is_sound(&t->scatterers[i]);
    }
    return is_sound ? LM_OK : LM_ERR_CORRUPT;
}

int lm_target_read(const struct lm_db *db, uint32_t index, struct lm_target *t, uint32_t poll_limit)
{
    if (index >= db->target_count) {
        return LM_ERR_RANGE;
    }
    const uint64_t offset = db->targets_offset + (uint64_t)index * LM_TARGET_BYTES;
    const int status = lm_db_read(db->flash, offset, t, LM_TARGET_BYTES, poll_limit);
    return status == LM_OK ? lm_target_check(t) : status;
}

struct lm_shape lm_scatterer_shape(const struct lm_scatterer *s)
{
    return (struct lm_shape){.kind = s->kind,
                             .is_two_sided = s->is_two_sided != 0,
                             .size_mm = {s->size_mm[0], s->size_mm[1]}};
}

/* ---- geometry ---- */

enum { RANGE_MIN_MM = 1000000 };

/* a cos + b sin, for components of vectors of length one: at most 2^60. */
static int32_t turn(int64_t a_q30, int64_t cos_q30, int64_t b_q30, int64_t sin_q30)
{
    return (int32_t)((a_q30 * cos_q30 + b_q30 * sin_q30 + (1 << 29)) >> 30);
}

void lm_target_view_set(struct lm_target_view *v, fx_bam_t bearing, fx_bam_t elevation,
                        uint32_t range_mm)
{
    const int32_t level_q30 = fx_cos_q30(elevation);
    v->bearing = bearing;
    v->elevation = elevation;
    v->range_mm = fx_max_u32(range_mm, RANGE_MIN_MM);
    v->toward_q30[0] = turn(level_q30, fx_cos_q30(bearing), 0, 0);
    v->toward_q30[1] = turn(level_q30, fx_sin_q30(bearing), 0, 0);
    v->toward_q30[2] = fx_sin_q30(elevation);
}

/* Direction to the radar in the scatterer's axes: turned by azimuth, elevation and roll, in this
 * order. */
static struct lm_direction in_axes_of(const struct lm_scatterer *s, const int32_t toward_q30[3])
{
    const int32_t cos_az = fx_cos_q30(s->azimuth), sin_az = fx_sin_q30(s->azimuth);
    const int32_t cos_el = fx_cos_q30(s->elevation), sin_el = fx_sin_q30(s->elevation);
    const int32_t cos_roll = fx_cos_q30(s->roll), sin_roll = fx_sin_q30(s->roll);
    const int32_t out = turn(toward_q30[0], cos_az, toward_q30[1], sin_az);
    const int32_t right = turn(toward_q30[1], cos_az, toward_q30[0], -sin_az);
    const int32_t up = turn(toward_q30[2], cos_el, out, -sin_el);
    return (struct lm_direction){
        .ahead_q30 = turn(out, cos_el, toward_q30[2], sin_el),
        .right_q30 = turn(right, cos_roll, up, sin_roll),
        .up_q30 = turn(up, cos_roll, right, -sin_roll),
    };
}

/* Extra length of the way to a scatterer, compared with the origin, mm * 256.
 *
 * Let o be the scatterer's offset, s its component towards the radar, R the range and D the answer.
 * Then (R + D)^2 = R^2 - 2 R s + o^2, so D = e - s with e^2 + 2 (R - s) e = o^2 - s^2. Newton's
 * method solves that. R - s is more than 546,000 mm and e at most 189,000 mm. An error of d leaves
 * one of d^2 / (2 (R - s)). Three rounds from the linear answer leave less than the unit even at 1
 * km.
 *
 * Range: s is at most 3 * 2^18 * 2^30 in Q30, and 2^28 in Q8. o^2 is at most 3 * 2^36 mm2. Both
 * squares are below 2^56 in Q16. */
static int64_t path_q8(const struct lm_target_view *v, const int32_t offset_mm[3])
{
    int64_t part_q30 = 0, square_mm2 = 0;
    for (int i = 0; i < 3; i++) {
        part_q30 += (int64_t)v->toward_q30[i] * offset_mm[i];
        square_mm2 += (int64_t)offset_mm[i] * offset_mm[i];
    }
    const int64_t part_q8 = (part_q30 + (1 << 21)) >> 22;
    const int64_t across_q16 = square_mm2 * 65536 - part_q8 * part_q8;
    const int64_t twice_q8 = 2 * (lm_mm_q8_of_mm(v->range_mm) - part_q8);
    int64_t bend_q8 = across_q16 / twice_q8;
    for (int i = 0; i < 3; i++) {
        const int64_t divisor_q8 = twice_q8 + 2 * bend_q8;
        bend_q8 = (across_q16 + bend_q8 * bend_q8 + divisor_q8 / 2) / divisor_q8;
    }
    return bend_q8 - part_q8;
}

/* Phase of a way out and back that is longer by path_q8, mm * 256: 2 path / wavelength turns. The
 * path is below 2^27 (454 m); 2^27 * 1000 * 2^25 is below 2^62. */
static fx_bam_t phase_of(int64_t path_q8, uint32_t wavelength_um)
{
    return (fx_bam_t)(path_q8 * (1000LL << 25) / (int64_t)wavelength_um);
}

/* a cos + b sin of offsets: below 2^19 mm. */
static int32_t turn_mm(int32_t a_mm, int32_t cos_q30, int32_t b_mm, int32_t sin_q30)
{
    return (int32_t)(((int64_t)a_mm * cos_q30 + (int64_t)b_mm * sin_q30 + (1 << 29)) >> 30);
}

uint32_t lm_target_returns(const struct lm_target *t, const struct lm_target_view *v,
                           uint32_t wavelength_um, struct lm_return returns[LM_SCATTERERS_MAX])
{
    const int32_t cos_q30 = fx_cos_q30(v->bearing), sin_q30 = fx_sin_q30(v->bearing);
    for (uint32_t i = 0; i < t->scatterer_count; i++) {
        const struct lm_scatterer *s = &t->scatterers[i];
        const struct lm_shape shape = lm_scatterer_shape(s);
        const int32_t *o = s->offset_mm;
        returns[i] = (struct lm_return){
            .rcs_dbsm_q8 = lm_rcs_dbsm_q8(&shape, wavelength_um, in_axes_of(s, v->toward_q30)),
            .phase = phase_of(path_q8(v, o), wavelength_um),
            .along_mm = -turn_mm(o[0], cos_q30, o[1], sin_q30),
            .across_mm = turn_mm(o[0], sin_q30, o[1], -cos_q30),
            .up_mm = o[2],
        };
    }
    return t->scatterer_count;
}

/* ---- sums and draws ---- */

/* |sum of a_i exp(j phi_i)|^2 with a_i = sqrt(sigma_i / sigma_max), then times sigma_max. Relative
 * to the strongest return no sum can overflow, and the weak ones keep what counts. */
int32_t lm_returns_sum_dbsm_q8(const struct lm_return *returns, uint32_t mask)
{
    int32_t strongest_dbsm_q8 = LM_RCS_NONE_DBSM_Q8;
    for (uint32_t i = 0; mask >> i != 0; i++) {
        if (mask >> i & 1) {
            strongest_dbsm_q8 = fx_max_i32(strongest_dbsm_q8, returns[i].rcs_dbsm_q8);
        }
    }
    /* Amplitudes relative to the strongest return have half its decibels, and are at most 2^16. 16
     * of them times 2^30 are below 2^50. Cut to Q20, their squares are below 2^49. */
    int64_t re_q46 = 0, im_q46 = 0;
    for (uint32_t i = 0; mask >> i != 0; i++) {
        if (mask >> i & 1) {
            const int64_t amplitude_q16 =
                fx_power_q16_from_db_q8((returns[i].rcs_dbsm_q8 - strongest_dbsm_q8) / 2);
            re_q46 += amplitude_q16 * fx_cos_q30(returns[i].phase);
            im_q46 += amplitude_q16 * fx_sin_q30(returns[i].phase);
        }
    }
    const int64_t re_q20 = re_q46 >> 26, im_q20 = im_q46 >> 26;
    const uint64_t power_q40 = (uint64_t)(re_q20 * re_q20 + im_q20 * im_q20);
    const int32_t sum_dbsm_q8 =
        strongest_dbsm_q8 + fx_db_q8_of_log2_q16(fx_log2_q16_u64(power_q40) - 40 * 65536);
    return mask == 0 ? LM_RCS_NONE_DBSM_Q8 : fx_max_i32(sum_dbsm_q8, LM_RCS_NONE_DBSM_Q8);
}

/* Exponential variable: -ln of a uniform draw of (0, 1), below 22.2 * 65536. */
static uint32_t exponential_q16(uint32_t hash)
{
    const uint32_t minus_log2_q16 = 32u * 65536u - (uint32_t)fx_log2_q16(hash | 1u);
    return (uint32_t)((uint64_t)minus_log2_q16 * FX_LN2_Q32 >> 32);
}

/* Cases 3 and 4 are the mean of two exponential variables: chi-square of four degrees of freedom.
 * Even cases take a hash of the pulse as well. Each pulse owns two draws, 2 pulse and 2 pulse + 1.
 */
int32_t lm_swerling_dbsm_q8(uint8_t swerling, int32_t mean_dbsm_q8, uint32_t id, uint32_t scan,
                            uint32_t pulse)
{
    if (swerling == 0) {
        return mean_dbsm_q8;
    }
    const uint32_t draw = swerling % 2 == 0 ? 2 * pulse : 0;
    uint32_t power_q16 = exponential_q16(fx_hash3(id, draw, scan));
    if (swerling >= 3) {
        power_q16 = (power_q16 + exponential_q16(fx_hash3(id, draw + 1, scan))) / 2;
    }
    const int32_t drawn_dbsm_q8 = mean_dbsm_q8 + fx_db_q8(power_q16) - fx_db_q8(65536);
    return fx_max_i32(drawn_dbsm_q8, LM_RCS_NONE_DBSM_Q8);
}
