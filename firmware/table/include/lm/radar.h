/* The radar parameter table: every number that belongs to the radar and not to the display. An
 * integrator replaces the table (firmware/table/radar.c), not the code. Equations of all of it:
 * docs/DESIGN.md, "The picture, as equations". */
#ifndef LM_RADAR_H
#define LM_RADAR_H

#include <stdbool.h>
#include <stdint.h>

#include "fx/types.h"
#include "lm/class_kind.h"

enum { LM_RANGES = 4, LM_AZIMUTHS = 3 };

/* An edge is a byte of eighths of a decibel. With a code and a rise in decibels it takes 16 bits.
 */
enum { LM_EDGE_MAX_Q8 = 255 * 32 };

struct lm_aspect_config {
    int16_t edge_structure_q8, edge_trees_q8; /* leading edges, dB; 0..LM_EDGE_MAX_Q8 is taken */
    int16_t shore_q8;                         /* far shore, dB */
    uint16_t shore_width_m;
};

struct lm_speckle_config {
    uint8_t looks_log2; /* 0..4 */
};

/* Shape of the texture by kind of class (enum lm_kind), as log2 nu of 0..4, or LM_TEXTURE_NONE. */
enum { LM_TEXTURE_NONE = 5 };
struct lm_texture_config {
    uint8_t shape_log2[LM_KINDS];
};

struct lm_tone_config {
    int16_t black_q8, white_q8; /* levels in 1/256 dB; white 1 to 255 dB above black */
    uint16_t gamma_q8;          /* exponent, 26..1024 (0.1..4.0) */
};

/* Kinds of picture that the radar page can show. */
enum lm_picture_kind {
    LM_PICTURE_SECTOR, /* real beam and Doppler beam sharpening, swept over and over */
    LM_PICTURE_PATCH,  /* synthetic aperture, drawn once */
    LM_PICTURES
};

/* What a sector shows. */
enum lm_sector_mode { LM_SECTOR_GM, LM_SECTOR_GMT, LM_SECTOR_SEA, LM_SECTOR_MODES };

/* How much of it, and how sharp: the whole sector, or a window around the cursor. */
enum lm_field { LM_FIELD_NORM, LM_FIELD_EXP, LM_FIELD_DBS1, LM_FIELD_DBS2, LM_FIELDS };

struct lm_sector_mode_row {
    uint32_t bam_per_s;    /* antenna rate */
    uint8_t range_last;    /* index of the largest scale */
    uint8_t field_last;    /* enum lm_field */
    uint8_t bars;          /* swept in turn, 1..8 */
    uint16_t clutter_q8;   /* how much of what stands still is cancelled, dB */
    uint32_t gate_mm_s[2]; /* closing speeds, either way, of what is shown; [1] is 0: all */
    struct lm_speckle_config speckle;
    struct lm_tone_config tone;
};

struct lm_field_row {
    uint32_t bam_per_s;        /* antenna rate; 0: the mode's */
    uint8_t range_last;        /* index of the largest scale */
    uint8_t slew_percent;      /* pace of the cursor over the glass, of that in NORM */
    uint16_t window_permille;  /* half the window's side, of the range scale; 0: the sector */
    fx_bam_t azimuth_half_max; /* of a window, as swept */
    uint16_t sharpening;       /* azimuth cells in a beam width, a power of two; 1: real beam */
    uint16_t sharpening_least; /* real beam where there is less than this */
    uint8_t azimuths_log2;     /* traced across a sample of real beam: lm/footprint.h */
    uint32_t pulse_ns[LM_RANGES];
};

struct lm_antenna_table {
    fx_bam_t azimuth_beam, elevation_beam; /* one-way half-power widths */
    fx_bam_t fan;                          /* the beam is spoiled so far below its axis */
    fx_bam_t bar_spacing;
    fx_bam_t azimuth_limit; /* off the nose, either way */
    fx_bam_t tilt_max;      /* manual, up or down */
};

struct lm_receiver_table {
    int16_t noise_end_q8[LM_RANGES]; /* noise-equivalent gamma at the end of each scale, dB */
    uint32_t stc_m[LM_RANGES];       /* slant range where the time gain ends */
    uint8_t noise_looks_log2;
};

struct lm_sar_table {
    uint16_t cells; /* of a patch, both ways */
    uint32_t cell_min_mm, cell_max_mm;
    fx_bam_t squint_min; /* between velocity and line of sight */
    uint32_t dwell_max_ms;
    uint32_t reference_speed_mm_s;     /* paces a patch that was commanded with its geometry */
    uint16_t mocomp_residual_permille; /* of a lateral acceleration; 0: compensation is perfect */
    int16_t noise_floor_q8;            /* dB of gamma */
    struct lm_speckle_config speckle;
    struct lm_tone_config tone;
};

struct lm_radar {
    uint32_t range_m[LM_RANGES];        /* display scales */
    uint16_t range_nm[LM_RANGES];       /* the same, as the pilot reads them */
    fx_bam_t azimuth_half[LM_AZIMUTHS]; /* of the sector: A6, A3, A1 */
    uint32_t wavelength_um;             /* LM_WAVELENGTH_MIN_UM..MAX_UM (lm/rcs.h) */
    uint16_t cells;                     /* range cells of a sector line */
    fx_bam_t line;                      /* azimuth of a line of the whole sector */
    fx_bam_t sample;                    /* between azimuths sampled in real beam: lm/beam.h */
    struct lm_antenna_table antenna;
    struct lm_receiver_table receiver;
    struct lm_sector_mode_row mode[LM_SECTOR_MODES];
    struct lm_field_row field[LM_FIELDS];
    struct lm_sar_table sar;
    struct lm_aspect_config aspect;
    struct lm_texture_config texture;
};

extern const struct lm_radar lm_radar_default;

#endif
