#include "lm/radar.h"

/* Decibels as the table's 1/256. */
#define DB(d) ((d)*256)

const struct lm_radar lm_radar_default = {
    /* Scales 10, 20, 40, 80 nautical miles of 1852 m; sectors of 60, 30 and 10 degrees to each
     * side; 120 degrees a second in GM, one sweep of A6 in one second: FreeFalcon and FlightGear's
     * APG-68 agree on scales and sectors; the rate is FreeFalcon's (radardoppler.h: base 60 degrees
     * a second, twice that in GM). */
    .range_m = {18520, 37040, 74080, 148160},
    .range_nm = {10, 20, 40, 80},
    .azimuth_half = {FX_BAM_DEG(60), FX_BAM_DEG(30), FX_BAM_DEG(10)},
    /* X band, as papers A and B; neither gives the frequency. 9.6 GHz: UNSOURCED. */
    .wavelength_um = 31228,
    .sweep_bam_per_ms = FX_BAM_DEG(120) / 1000,
    /* 256 cells and 256 lines in 120 degrees: paper A's effective resolution, "Computational
       resources". */
    .gm_cells = 256,
    .gm_line = FX_BAM_DEG(120) / 256,
    .sar_cells = 256,
    /* UNSOURCED until dwell by formula comes in: a patch in two seconds. */
    .sar_lines_per_s = 128,
    .sar_cell_min_mm = 500,
    .sar_cell_max_mm = 40000,
    /* UNSOURCED, chosen by eye: a dihedral between wall and ground is some 6 dB above the wall
     * alone, a tree line 2 dB; far shores 5 dB over 60 m (paper A names the effects and gives no
     * figures). */
    .aspect = {.edge_structure_q8 = DB(6),
               .edge_trees_q8 = DB(2),
               .shore_q8 = DB(5),
               .shore_width_m = 60},
    /* Looks: UNSOURCED. Many pulses within a beam width average in real beam; SAR shown with four
       looks. */
    .gm_speckle = {.looks_log2 = 4, .noise_floor_q8 = DB(-46)},
    .sar_speckle = {.looks_log2 = 2, .noise_floor_q8 = DB(-46)},
    /* Window: from the sea's -40 dB, nearly black, to the brightest buildings.
     * UNSOURCED exponents. */
    .gm_tone = {.black_q8 = DB(-42), .white_q8 = DB(6), .gamma_q8 = 384},
    .sar_tone = {.black_q8 = DB(-42), .white_q8 = DB(12), .gamma_q8 = 384},
};
