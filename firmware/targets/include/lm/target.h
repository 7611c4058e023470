/* Target: an object of a few scatterers at known positions, added to the picture's clutter.
 *
 * One rule gives both cases of [Heaton]. Scatterers that share a resolution cell are summed as
 * phasors, and a coarse cell fluctuates with aspect. In fine cells each scatterer has a cell of its
 * own and is steady.
 *
 * A target's own axes are forward, right and up:
 *
 *              forward (heading, from north)
 *                 ^
 *                 |    . radar at `bearing`, from forward towards right,
 *                 |  .   and `elevation` above the horizon
 *                 |.
 *          origin o--------> right                 up points to the reader
 *
 * Source: [Heaton], "High resolution radar targets"; equations in docs/EQUATIONS.md, "Targets";
 * records in docs/FORMATS.md, 1.8. */
#ifndef LM_TARGET_H
#define LM_TARGET_H

#include <stdint.h>

#include "lm/db.h"
#include "lm/geo.h"
#include "lm/rcs.h"
#include "lm/units.h"

enum {
    LM_SCATTERERS_MAX = 16,
    LM_TARGET_OFFSET_MAX_MM = 1 << 18, /* 262 m on each axis: at most 454 m from the origin */
    LM_TARGET_SWERLING_MAX = 4,
    LM_TARGET_RCS_MAX_Q8 = LM_DB_Q8(100), /* greatest mean; the least is its negative */
    LM_TARGET_SPEED_MAX_MM_S = 1 << 20,
    LM_TARGET_LEG_MAX_M = 100000,
    LM_TARGET_LEGS_MAX = 32
};

/* Flags of a target: bits of lm_target.flags. */
enum {
    LM_TARGET_ABOVE_GROUND = 1,
    LM_TARGET_HAS_SIGNATURE = 2,
    LM_TARGET_HAS_PATH = 4,
    LM_TARGET_IS_BEACON = 8,
    LM_TARGET_FLAGS = 15
};

/* Scatterer: one reflecting body of a target. Its boresight points to azimuth (from forward towards
 * right) and elevation. Its right axis is then level; roll turns it towards its up axis. */
struct lm_scatterer {
    uint8_t kind; /* enum lm_shape_kind */
    uint8_t is_two_sided;
    uint16_t reserved;
    uint32_t size_mm[2];
    int32_t offset_mm[3]; /* forward, right, up, from the target's origin */
    fx_bam_t azimuth, elevation, roll;
};
_Static_assert(sizeof(struct lm_scatterer) == 36, "the record must be what FORMATS.md says");

/* Leg of a path: its beginning, heading and length. The next leg begins at its end, as
 * lm_geo_direct computes that. */
struct lm_path_leg {
    fx_bam_t latitude, longitude, heading;
    uint32_t length_mm; /* 1000..LM_TARGET_LEG_MAX_M * 1000 */
};
_Static_assert(sizeof(struct lm_path_leg) == 16, "the record must be what FORMATS.md says");

/* Record of the image's section TARGETS. */
struct lm_target {
    uint32_t crc; /* CRC-32C of all bytes after this field */
    uint32_t id;  /* unique in the image; chooses the random draws of its fluctuation */
    fx_bam_t latitude, longitude;
    int32_t elevation_m_q6;   /* of the origin above mean sea level, or above ground if flagged */
    fx_bam_t heading;         /* of the forward axis, from north, clockwise */
    uint8_t scatterer_count;  /* 0..16; 0: it has a signature, or is a fluctuating point */
    uint8_t swerling;         /* Swerling case of a fluctuating point, 0..4 */
    uint16_t flags;           /* LM_TARGET_...; any other bit is an error */
    int32_t mean_rcs_dbsm_q8; /* of a fluctuating point, within LM_TARGET_RCS_MAX_Q8 */
    char name[16];            /* zero-padded; may fill all 16 */
    union {
        struct lm_scatterer scatterers[LM_SCATTERERS_MAX];
        struct lm_path_leg path[LM_TARGET_LEGS_MAX]; /* if flagged; leg 0 begins at the origin */
    };
    uint32_t speed_mm_s; /* along heading or path; 0: the target stands still */
    uint32_t leg_m; /* along the heading, 1..LM_TARGET_LEG_MAX_M; 0 with a path or without speed */
    uint8_t signature; /* index in the image, if flagged (it has no scatterers then); of a beacon,
                          which is a point, its reply (lm/beacon.h); else 0 */
    uint8_t path_legs; /* with a path 1..LM_TARGET_LEGS_MAX, a speed and no scatterers; else 0 */
    uint8_t path_is_round; /* 1: the path ends at its start and is flown round and round; else 0 */
    uint8_t reserved[5];
};
_Static_assert(sizeof(struct lm_target) == LM_TARGET_BYTES,
               "the record must be what FORMATS.md says");

/* Check a record: its checksum, and the range of every field. Returns LM_OK or LM_ERR_CORRUPT. The
 * other functions need a record that passed. Cost: one CRC over 640 bytes. */
int lm_target_check(const struct lm_target *t);

/* Read and check record `index` of the image's targets. Blocks, with at most `poll_limit` polls of
 * the flash: for start-up, when no tile is being read. Returns LM_OK, or
 * - LM_ERR_RANGE if index is db->target_count or more, with *t unchanged;
 * - LM_ERR_IO if the flash fails or is late, with *t unspecified;
 * - LM_ERR_CORRUPT if the record does not pass lm_target_check, with *t unspecified. */
int lm_target_read(const struct lm_db *db, uint32_t index, struct lm_target *t,
                   uint32_t poll_limit);

/* Shape of a scatterer, for lm_rcs_dbsm_q8. */
struct lm_shape lm_scatterer_shape(const struct lm_scatterer *s);

/* ---- one target, seen from one position ---- */

/* View that a target has of the radar. */
struct lm_target_view {
    fx_bam_t bearing;      /* of the radar, from the target's forward towards its right */
    fx_bam_t elevation;    /* of the radar above the target's horizon */
    uint32_t range_mm;     /* slant range, 10^6 or more */
    int32_t toward_q30[3]; /* unit vector to the radar: forward, right, up */
};

/* Set a view from bearing, elevation and slant range of the radar. Ranges below 1 km count as 1 km.
 * Cost: about 150 instructions. */
void lm_target_view_set(struct lm_target_view *v, fx_bam_t bearing, fx_bam_t elevation,
                        uint32_t range_mm);

/* Return of one scatterer. */
struct lm_return {
    int32_t rcs_dbsm_q8;
    fx_bam_t phase; /* of the way out and back, less that of the target's origin */
    int32_t along_mm, across_mm,
        up_mm; /* from the origin: away from the radar, to the right as it looks, up */
};

/* Compute the returns of all scatterers. Returns their number, t->scatterer_count. The phase is
 * that of the true length of the way, not of the far-field approximation. Worst error 10 um, so
 * 0.12 degree of phase at 31 mm (tests/unit/firmware/targets/test_target.c). Cost: 500 to 900
 * instructions a scatterer, six 64-bit divisions among them. */
uint32_t lm_target_returns(const struct lm_target *t, const struct lm_target_view *v,
                           uint32_t wavelength_um, struct lm_return returns[LM_SCATTERERS_MAX]);

/* Coherent sum of returns, |sum of sqrt(rcs) exp(j phase)|^2, of those whose bit is set in `mask`.
 * LM_RCS_NONE_DBSM_Q8 if mask is 0. Worst error 0.14 dB down to 20 dB below the strongest return,
 * most of it from the phases. Cost: about 180 instructions a return. */
int32_t lm_returns_sum_dbsm_q8(const struct lm_return *returns, uint32_t mask);

/* Draw the cross section of a fluctuating point (Swerling 1960):
 *
 *     case   cross section                              one draw for
 *     0      steady                                     -
 *     1, 2   chi-square of 2 degrees (exponential)      a scan (1), a pulse (2)
 *     3, 4   chi-square of 4 degrees                    a scan (3), a pulse (4)
 *
 * The draw is a hash of its arguments: the same arguments give the same draw, and no state is kept.
 * At least LM_RCS_NONE_DBSM_Q8. Cost: about 170 instructions. */
int32_t lm_swerling_dbsm_q8(uint8_t swerling, int32_t mean_dbsm_q8, uint32_t id, uint32_t scan,
                            uint32_t pulse);

#endif
