/* Radar parameter table: every number that belongs to the radar and not to the display. An
 * integrator replaces the table, not the code: by a text file (landmass-radar), which the image or
 * the board carries as a record (lm/radar_record.h). The built-in table is
 * firmware/table/radar.c. Equations of all of it: docs/EQUATIONS.md.
 *
 * Each field has its unit and the range that the code bears. lm_radar_check (lm/radar_check.h)
 * holds a table to the ranges and to these rules between fields:
 *  - scales rise, in metres and in nautical miles, and rows behind the last one are empty;
 *  - every mode and every field of view has the smallest scale; the first mode has that of the
 *    start;
 *  - names are letters, digits and + - . / : 1 to 5 of modes and fields of view, of which no two
 *    share one, whatever the case of their letters; 1 to 7 of the radar, with blanks between
 * words;
 *  - sectors are one line wide to each side or wider, and end within the antenna's limit;
 *  - samples lie 1/4 to 2/7 of the azimuth beam apart;
 *  - a gate's upper speed is 0 or not below its lower one;
 *  - white lies 1 dB or more above black;
 *  - an antenna rate of a field is 0 or LM_RADAR_RATE_MIN and more;
 *  - cells of a window are 1/4 m long or longer on the smallest scale;
 *  - a window may be one line wide to each side or wider;
 *  - beam positions are not farther apart than the azimuth beam is wide;
 *  - the largest cell of a patch is not smaller than the smallest.
 *
 * Angles and angular rates are BAM (2^32 is a circle), levels 1/256 dB. */
#ifndef LM_RADAR_H
#define LM_RADAR_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/config.h"
#include "lm/sensor.h"

/* Scales that a table may have, sectors that it has, and characters of a name of a mode or field
 * of view with its zero. */
enum { LM_RANGES_MAX = 8, LM_AZIMUTHS = 3, LM_NAME_SIZE = 6 };

/* Characters of the radar's own name with its zero. */
enum { LM_RADAR_NAME_SIZE = 8 };

/* Ends of ranges. The stages that a limit comes from assert that they bear it. */
enum {
    LM_RADAR_RANGE_MAX_M = 200000,               /* with a window behind it: below 400 km */
    LM_RADAR_CELLS_MAX = LM_CELLS_MAX * 16 / 23, /* a window has 23/16 of them */
    LM_RADAR_PATCH_CELLS_MAX = LM_CELLS_MAX,
    LM_RADAR_BEAM_MIN = 1 << 23,       /* 0.7 degree */
    LM_RADAR_RATE_MIN = 1 << 23,       /* 0.7 degree a second */
    LM_RADAR_SPEED_MAX_MM_S = 2000000, /* as fast as aircraft and targets are */
    LM_RADAR_SHARPENING_MAX = 256,
    LM_RADAR_AZIMUTHS_LOG2_MAX = 3, /* eight in a sample */
    LM_LOOKS_LOG2_MAX = 4,          /* 16 looks */
    LM_RADAR_SIDE_LOBES_MAX = 2,    /* cells of a line that have side lobes */
    LM_WAVELENGTH_MIN_UM = 1000,    /* 300 GHz */
    LM_WAVELENGTH_MAX_UM = 1000000
};
#define LM_RADAR_RATE_MAX    0x80000000u    /* 180 degrees a second */
#define LM_RADAR_AZIMUTH_MAX FX_BAM_DEG(85) /* a turn from limit to limit is below 2^31 */

/* An edge is a byte of eighths of a decibel. With a code and a rise in decibels it takes 16 bits.
 */
enum { LM_EDGE_MAX_DB_Q8 = 255 * 32 };

/* Brightness of what stands out of the ground. */
struct lm_illumination_config {
    int16_t edge_structure_db_q8; /* leading edge of a structure, dB; 0..LM_EDGE_MAX_DB_Q8 */
    int16_t edge_trees_db_q8;     /* leading edge of trees, dB; 0..LM_EDGE_MAX_DB_Q8 */
    int16_t shore_db_q8;          /* far shore at the water, dB; 0..LM_EDGE_MAX_DB_Q8 */
    uint16_t shore_width_m;       /* of the shore's fall to nothing; 0..10,000 */
};

/* Which cells of a patch have side lobes (docs/EQUATIONS.md, "Side lobes of the ground"). */
struct lm_side_lobe_config {
    int16_t over_shadow_db_q8; /* such a cell stands so high above a shadow; 0..100 dB */
    int16_t above_db_q8;       /* and above the cells four before and behind it; 0..100 dB */
    uint8_t a_line;            /* of a line, the strongest; 0 (none) ..LM_RADAR_SIDE_LOBES_MAX */
};

/* How walls return by the angle at which they face the radar (docs/EQUATIONS.md, "Class gain"). */
struct lm_facing_config {
    fx_bam_t lobe_half;      /* from the middle of the lobe to half its power; 4..45 degrees */
    uint16_t floor_permille; /* of the mean power, from whatever side; 10..1000 */
};

/* Speckle of a picture. */
struct lm_speckle_config {
    uint8_t looks_log2; /* 0..LM_LOOKS_LOG2_MAX */
};

/* Return of the sea by the wind: at looks against it, across it and with it, beside each other. */
struct lm_sea_config {
    int16_t upwind_db_q8, crosswind_db_q8, downwind_db_q8; /* dB; -10..10 dB each */
};

/* Tone window: which level is black, which is white, and the curve between them. */
enum { LM_TONE_GAMMA_MIN_Q8 = 26, LM_TONE_GAMMA_MAX_Q8 = 1024 };
struct lm_tone_config {
    int16_t black_db_q8,
        white_db_q8;   /* dB; white 1 to 255 dB above black; in a table -64..64 dB each */
    uint16_t gamma_q8; /* exponent; LM_TONE_GAMMA_MIN_Q8..MAX_Q8, 0.1..4; in a table 64 and more,
                        * for the page goes no lower */
};

/* Kinds of picture that the radar page can show. */
enum lm_picture_kind {
    LM_PICTURE_SECTOR, /* real beam and Doppler beam sharpening, swept over and over */
    LM_PICTURE_PATCH,  /* synthetic aperture, drawn once */
    LM_PICTURES
};

/* Mode of the sector: what it shows. A table has a row for each but the last: the beacon mode
 * sweeps as the first one does. */
enum lm_sector_mode {
    LM_SECTOR_GM,
    LM_SECTOR_GMT,
    LM_SECTOR_SEA,
    LM_SECTOR_MODES, /* rows of the table */
    LM_SECTOR_BEACON = LM_SECTOR_MODES,
    LM_SECTOR_CHOICES /* modes that can be selected */
};

/* Field of view: the whole sector or a window around the cursor, and how sharp it is. */
enum lm_fov { LM_FOV_NORM, LM_FOV_EXP, LM_FOV_DBS1, LM_FOV_DBS2, LM_FOVS };

/* A mode of the sector. */
struct lm_sector_mode_row {
    char name[LM_NAME_SIZE]; /* on the glass and, in either case, in scripts: "GMT" */
    uint32_t bam_per_s;      /* antenna rate; LM_RADAR_RATE_MIN..MAX */
    uint16_t range_max_nm;   /* the largest scale that it has; 1..999 */
    uint8_t fov_last;        /* enum lm_fov: the last that the mode has */
    uint8_t bars;            /* swept in turn; 1..8 */
    uint8_t stretch_cells;   /* cells before and behind its own that a target also fills; 0..4 */
    uint16_t clutter_db_q8;  /* how much of what stands still is cancelled, dB; 0..64 dB */
    uint32_t gate_mm_s[2];   /* closing speeds, either way, of what is shown; 0..
                              * LM_RADAR_SPEED_MAX_MM_S; [1] is 0: all */
    struct lm_tone_config tone;
};

/* A field of view. */
struct lm_fov_row {
    char name[LM_NAME_SIZE];   /* as a mode's: "EXP" */
    uint32_t bam_per_s;        /* antenna rate, LM_RADAR_RATE_MIN..MAX; 0: the mode's */
    uint16_t range_max_nm;     /* the largest scale that it has; 1..999 */
    uint8_t slew_percent;      /* pace of the cursor over the glass, of that in NORM; 1..200 */
    uint16_t window_permille;  /* half the window's side, of the range scale; 5..250, and 0 in NORM,
                                * which shows the sector */
    fx_bam_t azimuth_half_max; /* of a window, as swept; 0..LM_RADAR_AZIMUTH_MAX */
    uint16_t sharpening;       /* azimuth cells in a beam width; 1 (real beam) ..
                                * LM_RADAR_SHARPENING_MAX */
    fx_bam_t beam_step;        /* between two positions of the beam, whose dwells are processed by
                                * themselves; 0 (not seen) ..20 degrees */
    uint8_t azimuths_log2;     /* traced across a sample of real beam (lm/azimuth_average.h); 0..
                                * LM_RADAR_AZIMUTHS_LOG2_MAX */
    int16_t ground_leak_db_q8; /* what side lobes, ambiguities and quantisation leave of the
                                * ground's mean in every bin; -100..0 dB, below -48 none */
};

/* A display scale, and what the receiver does on it. Its name, on the glass, in commands and in
 * scripts, is the number of nautical miles. */
struct lm_range_row {
    uint32_t range_m;           /* 1,852..LM_RADAR_RANGE_MAX_M */
    uint16_t range_nm;          /* 1..999 */
    uint32_t stc_end_m;         /* slant range where sensitivity time control ends; 100..400,000 */
    uint32_t pulse_ns[LM_FOVS]; /* by field of view, compressed; 10..100,000 */
    uint16_t code_gain_db_q8[LM_FOVS]; /* of a coded pulse, and of what a sharpened field adds up,
                                        * over one simple pulse as long as pulse_ns; 0..40 dB */
};

/* The antenna and its gimbals. */
struct lm_antenna_table {
    fx_bam_t azimuth_beam;   /* one-way half-power width; LM_RADAR_BEAM_MIN..20 degrees */
    fx_bam_t elevation_beam; /* one-way half-power width; LM_RADAR_BEAM_MIN..60 degrees */
    fx_bam_t fan;            /* the beam is spoiled so far below its axis; 0..60 degrees */
    fx_bam_t bar_spacing;    /* 0..10 degrees */
    fx_bam_t azimuth_limit;  /* off the nose, either way; 2^20..LM_RADAR_AZIMUTH_MAX */
    fx_bam_t tilt_max;       /* manual, up or down; 0..60 degrees */
};

/* The receiver. Its noise at any range, height and pulse follows from one anchor: the gamma of flat
 * ground whose echo is as strong as the noise, seen from a height, at a slant range, with a simple
 * pulse (docs/EQUATIONS.md, "Noise"). */
struct lm_receiver_table {
    uint8_t noise_looks_log2;        /* 0..LM_LOOKS_LOG2_MAX */
    int16_t noise_db_q8;             /* dB of gamma; -100..20 dB */
    uint32_t noise_range_m;          /* 1,852..LM_RADAR_RANGE_MAX_M */
    uint16_t noise_height_m;         /* above the ground; 0..30,000 */
    uint32_t noise_pulse_ns;         /* 10..100,000 */
    uint16_t air_loss_db_per_km_q16; /* of clear air, there and back; 0..1/4 dB */
};

/* SAR patches. */
struct lm_sar_table {
    uint16_t cells;                    /* of a patch, both ways; 32..LM_RADAR_PATCH_CELLS_MAX */
    uint32_t cell_min_mm, cell_max_mm; /* 100..100,000 */
    fx_bam_t squint_min;               /* between velocity and line of sight; 0..80 degrees */
    uint32_t dwell_max_ms;             /* 1..131,071 */
    uint32_t reference_speed_mm_s;     /* paces a patch that was commanded with its geometry;
                                        * 1,000..LM_RADAR_SPEED_MAX_MM_S */
    uint16_t mocomp_residual_permille; /* of a lateral acceleration that motion compensation leaves;
                                        * 0 (none) ..1000 */
    int16_t noise_floor_db_q8;         /* dB of gamma; -100..20 dB */
    fx_bam_t line_lobe; /* half-power width in which a fence or wire glints; 2^20..90 degrees */
    int16_t ground_leak_db_q8;      /* what side lobes, ambiguities and quantisation leave of the
                                     * ground's mean in every cell; -100..0 dB */
    int16_t ground_leak_most_db_q8; /* a stronger cell counts as this one, here and in sectors,
                                     * because the side lobes of points are drawn or left out; dB
                                     * of gamma, -60..20 dB */
    struct lm_side_lobe_config side_lobes;
    struct lm_speckle_config speckle;
    struct lm_tone_config tone;
};

/* The table. */
struct lm_radar {
    char name[LM_RADAR_NAME_SIZE]; /* on the BIT page: "X" */
    uint8_t sensor; /* enum lm_sensor, LM_SENSOR_X..LM_SENSOR_MMW: images of it alone are shown */
    uint8_t ranges; /* rows of `range` in use; 1..LM_RANGES_MAX */
    struct lm_range_row range[LM_RANGES_MAX];
    uint16_t range_start_nm;            /* the scale after power-up; 1..999 */
    fx_bam_t azimuth_half[LM_AZIMUTHS]; /* of the sector: A6, A3, A1; 2^20..LM_RADAR_AZIMUTH_MAX */
    uint32_t wavelength_um;             /* LM_WAVELENGTH_MIN_UM..MAX_UM */
    uint16_t cells;                     /* range cells of a sector line; 64..LM_RADAR_CELLS_MAX */
    fx_bam_t line;                      /* azimuth of a line of the whole sector; 2^20 (0.09
                                         * degree) ..10 degrees */
    fx_bam_t sample;                    /* between azimuths sampled in real beam (lm/beam.h); 2^21
                                         * (0.18 degree) ..6 degrees */
    struct lm_antenna_table antenna;
    struct lm_receiver_table receiver;
    struct lm_sector_mode_row mode[LM_SECTOR_MODES];
    struct lm_fov_row fov[LM_FOVS];
    struct lm_sar_table sar;
    struct lm_illumination_config illumination;
    struct lm_sea_config sea;
    struct lm_facing_config facing;
};

extern const struct lm_radar lm_radar_default;

/* Row of a mode that can be selected. */
static inline const struct lm_sector_mode_row *lm_radar_mode(const struct lm_radar *radar,
                                                             uint32_t mode)
{
    return &radar->mode[mode < LM_SECTOR_MODES ? mode : LM_SECTOR_GM];
}

/* Its name, "BCN" of the beacon mode, and the last field of view that it has: replies of beacons
 * are not coherent, and nothing sharpens them. */
const char *lm_radar_mode_name(const struct lm_radar *radar, uint32_t mode);
uint32_t lm_radar_fov_last(const struct lm_radar *radar, uint32_t mode);

/* Index of the scale of so many nautical miles, of the mode or field of view of that name (in
 * either case), and of the sector of so many degrees to each side; -1 when the table has none. */
int32_t lm_radar_find_range(const struct lm_radar *radar, int32_t range_nm);
int32_t lm_radar_find_mode(const struct lm_radar *radar, const char *name);
int32_t lm_radar_find_fov(const struct lm_radar *radar, const char *name);
int32_t lm_radar_find_azimuth(const struct lm_radar *radar, int32_t degrees);

/* Index of the largest scale that both a mode and a field of view have. */
uint32_t lm_radar_range_last(const struct lm_radar *radar, uint32_t mode, uint32_t fov);

#endif
