/* Specific targets: a few scatterers each, standing at known places, added to the picture's
 * clutter. [Heaton], "High resolution radar targets"; equations: docs/EQUATIONS.md, "Targets";
 * records: docs/FORMATS.md, 1.8.
 *
 * One rule gives both of the paper's cases. Scatterers that share a resolution cell are summed as
 * phasors, so a coarse cell fluctuates with aspect; where the cells are so small that each
 * scatterer has one of its own, each is steady at its place. */
#ifndef LM_TARGET_H
#define LM_TARGET_H

#include <stdint.h>

#include "lm/db.h"
#include "lm/geo.h"
#include "lm/rcs.h"

enum {
    LM_SCATTERERS_MAX = 16,
    LM_TARGET_OFFSET_MAX_MM = 1 << 18, /* 262 m each way, so at most 454 m from the origin */
    LM_TARGET_SWERLING_MAX = 4,
    LM_TARGET_RCS_MAX_Q8 = 100 * 256, /* of a mean: either way */
    LM_TARGET_SPEED_MAX_MM_S = 1 << 20,
    LM_TARGET_LEG_MAX_M = 100000,
    LM_TARGET_LEGS_MAX = 32
};

/* Flags of a target, bits. */
enum {
    LM_TARGET_ABOVE_GROUND = 1,
    LM_TARGET_HAS_SIGNATURE = 2,
    LM_TARGET_HAS_PATH = 4,
    LM_TARGET_FLAGS = 7
};

/* One body of a target. Its boresight points to azimuth (from forward towards right) and elevation;
 * its right axis is then level, and roll turns it towards its up axis. */
struct lm_scatterer {
    uint8_t kind; /* enum lm_shape_kind */
    uint8_t is_two_sided;
    uint16_t reserved;
    uint32_t size_mm[2];
    int32_t offset_mm[3]; /* forward, right, up of the target's origin */
    fx_bam_t azimuth, elevation, roll;
};
_Static_assert(sizeof(struct lm_scatterer) == 36, "the record must be what FORMATS.md says");

/* One leg of a way: where it begins, where it leads, and how long it is. The next one begins at its
 * end, as lm_geo_direct finds it. */
struct lm_path_leg {
    fx_bam_t latitude, longitude, heading;
    uint32_t length_mm; /* 1000..LM_TARGET_LEG_MAX_M * 1000 */
};
_Static_assert(sizeof(struct lm_path_leg) == 16, "the record must be what FORMATS.md says");

/* A record of the image's section TARGETS. */
struct lm_target {
    uint32_t crc; /* CRC-32C of all bytes after this field */
    uint32_t id;  /* of its own in the image: what its fluctuation is drawn by */
    fx_bam_t latitude, longitude;
    int32_t elevation_m_q6;   /* of the origin, metres * 64: above mean sea level, or as flagged */
    fx_bam_t heading;         /* of the forward axis, from north by east */
    uint8_t scatterer_count;  /* 0..16; 0: a signature, or a point that fluctuates by itself */
    uint8_t swerling;         /* 0..4, of such a point */
    uint16_t flags;           /* LM_TARGET_...; others make it unsound */
    int32_t mean_rcs_dbsm_q8; /* of such a point, dBsm * 256 */
    char name[16];            /* zero-padded; may fill all 16 */
    union {
        struct lm_scatterer scatterers[LM_SCATTERERS_MAX];
        struct lm_path_leg path[LM_TARGET_LEGS_MAX]; /* when flagged; the first begins here */
    };
    uint32_t speed_mm_s; /* along the heading, or the path, and back again; 0: stands still */
    uint32_t leg_m; /* along the heading, 1..LM_TARGET_LEG_MAX_M; 0 with a path or without speed */
    uint8_t signature; /* which one of the image's, when flagged; the target then has no bodies */
    uint8_t
        path_legs; /* 1..LM_TARGET_LEGS_MAX with a path, which needs speed and no bodies, else 0 */
    uint8_t path_is_round; /* 0 or 1: the path ends where it began, and begins anew */
    uint8_t reserved[5];
};
_Static_assert(sizeof(struct lm_target) == LM_TARGET_BYTES,
               "the record must be what FORMATS.md says");

/* Check a record: checksum, and that every number is one that the functions below take. LM_OK or
 * LM_ERR_CORRUPT. Cost: one CRC over 640 bytes. */
int lm_target_check(const struct lm_target *t);

/* Read record `index` of the image's targets. Blocks, polling at most `poll_limit` times: for
 * start-up, when no tile is being read. LM_OK; LM_ERR_RANGE when there are not so many (db->
 * target_count); LM_ERR_IO or LM_ERR_CORRUPT with *t unspecified. */
int lm_target_read(const struct lm_db *db, uint32_t index, struct lm_target *t,
                   uint32_t poll_limit);

struct lm_shape lm_scatterer_shape(const struct lm_scatterer *s);

/* ---- one target from one place ---- */

struct lm_target_view {
    fx_bam_t bearing;      /* of the radar from the target, from its forward towards its right */
    fx_bam_t elevation;    /* of the radar above the target's horizon */
    uint32_t range_mm;     /* along the ray, from 10^6 up */
    int32_t toward_q30[3]; /* the radar: forward, right, up */
};

/* The view from a bearing and an elevation above the target's horizon, `range_mm` away; ranges
 * below 1 km are taken as 1 km. Cost: about 150 instructions. */
void lm_target_view_set(struct lm_target_view *v, fx_bam_t bearing, fx_bam_t elevation,
                        uint32_t range_mm);

/* What one scatterer returns. */
struct lm_return {
    int32_t rcs_dbsm_q8; /* dBsm * 256 */
    fx_bam_t phase;      /* of the way out and back, against the target's origin */
    int32_t along_mm, across_mm,
        up_mm; /* from the origin: away from the radar, right as it looks */
};

/* All scatterers' returns; returns their number. The way to each is its true length, not the far
 * field's: worst error 10 um, so 0.12 degree of phase at 31 mm
 * (tests/unit/firmware/targets/test_target.c). Cost: 500 to 900 instructions a scatterer, six of
 * them divisions of 64 bits. */
uint32_t lm_target_returns(const struct lm_target *t, const struct lm_target_view *v,
                           uint32_t wavelength_um, struct lm_return returns[LM_SCATTERERS_MAX]);

/* |sum of sqrt(rcs) exp(j phase)|^2 of the returns whose bit is set in `mask`, dBsm * 256;
 * LM_RCS_NONE_DBSM_Q8 for none. Worst error 0.14 dB down to 20 dB below the strongest return, most
 * of it from the phases.
 * Cost: about 180 instructions a return. */
int32_t lm_returns_sum_dbsm_q8(const struct lm_return *returns, uint32_t mask);

/* One draw of a fluctuating point (Swerling 1960): case 0 is steady; 1 and 2 have an exponential
 * cross section (chi-square of 2 degrees of freedom), 3 and 4 one of 4 degrees; 1 and 3 keep theirs
 * during a scan, 2 and 4 draw anew for every pulse. Without a state: the same numbers give the same
 * draw. LM_RCS_NONE_DBSM_Q8 at the least. Cost: about 170 instructions. */
int32_t lm_swerling_dbsm_q8(uint8_t swerling, int32_t mean_dbsm_q8, uint32_t id, uint32_t scan,
                            uint32_t pulse);

#endif
