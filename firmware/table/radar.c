#include "lm/radar.h"

#include "lm/units.h"

/* Decibels as the table's 1/256. */

#define CODE_GAINS(norm, exp, dbs1, dbs2)                                                          \
    {                                                                                              \
        LM_DB_Q8(norm), LM_DB_Q8(exp), LM_DB_Q8(dbs1), LM_DB_Q8(dbs2)                              \
    }

const struct lm_radar lm_radar_default = {
    /* Keys in brackets are those of docs/EQUATIONS.md, Sources; what has no public source is called
     * UNSOURCED.
     *
     * Scales 10, 20, 40, 80 nautical miles of 1852 m; sectors of 60, 30 and 10 degrees to each
     * side; 120 degrees a second in GM, one sweep of A6 in one second: [FreeFalcon] and
     * [FlightGear] agree on scales and sectors; the rate is [FreeFalcon]'s, a base of 60 degrees a
     * second and twice that in GM. */
    .name = "X",
    .sensor = LM_SENSOR_X,
    .ranges = 4,
    /* Metres, nautical miles, end of sensitivity time control in metres; pulses in NORM, EXP, DBS1
     * and DBS2 in nanoseconds, and their code gains. UNSOURCED: time control that ends at three
     * quarters of a scale, and pulses that resolve 15 m to 960 m. So are the gains: pulses of NORM
     * are simple, and the shorter ones of a scale are coded and sent with the same energy. DBS adds
     * up coherently what a thousand pulses a second return from its dwell: 12 dB more than its
     * narrower cells lose. */
    .range = {{18520, 10, 13890, {400, 100, 100, 100}, CODE_GAINS(0, 6, 18, 18)},
              {37040, 20, 27780, {1000, 400, 100, 100}, CODE_GAINS(0, 4, 22, 22)},
              {74080, 40, 55560, {3200, 1000, 400, 100}, CODE_GAINS(0, 5, 21, 27)},
              {148160, 80, 111120, {6400, 3200, 400, 100}, CODE_GAINS(0, 3, 24, 30)}},
    .range_start_nm = 40,
    .azimuth_half = {FX_BAM_DEG(60), FX_BAM_DEG(30), FX_BAM_DEG(10)},
    /* X band, as [Heaton] and [Niu]; neither gives the frequency. 9.6 GHz: UNSOURCED. */
    .wavelength_um = 31228,
    /* 256 cells and 256 lines in 120 degrees: the effective resolution of [Heaton],
     * "Computational resources". */
    .cells = 256,
    .line = FX_BAM_DEG(120) / 256,
    /* Every other line: two and a half samples across the two-way beam. */
    .sample = FX_BAM_DEG(120) / 128,
    /* Everything of the antenna is UNSOURCED: 3.3 degrees, a usual width in X band; a beam a
     * little taller than wide, a fan that reaches from the horizon to well below the aircraft's
     * nose, gimbals of 60 degrees. */
    .antenna = {.azimuth_beam = FX_BAM_DEG(33) / 10,
                .elevation_beam = FX_BAM_DEG(46) / 10,
                .fan = FX_BAM_DEG(30),
                .bar_spacing = FX_BAM_DEG(22) / 10,
                .azimuth_limit = FX_BAM_DEG(60),
                .tilt_max = FX_BAM_DEG(30)},
    /* UNSOURCED: the anchor, a little below water at the end of the shortest scale with its pulse
     * in NORM; 3.6 dB of clear air, there and back, at 80 nautical miles. */
    .receiver = {.noise_looks_log2 = 4,
                 .noise_db_q8 = LM_DB_Q8(-40),
                 .noise_range_m = 18520,
                 .noise_height_m = 3000,
                 .noise_pulse_ns = 400,
                 .air_loss_db_per_km_q16 = 1592},
    /* Rates: [FreeFalcon], as above: base 60 degrees a second, twice that in GM; bars: one in
     * GM and four in GMT [FlightGear]. Gates: [FreeFalcon]'s 3 to 100, here knots. No 80 nm scale
     * in GMT and SEA. UNSOURCED: movers three cells
     * deep in GMT, which are four pixels on a glass of 480, 35 dB of clutter
     * cancelled, tone windows from the sea's -40 dB to the brightest buildings. */
    .mode = {[LM_SECTOR_GM] = {.name = "GM",
                               .bam_per_s = FX_BAM_DEG(120),
                               .range_max_nm = 80,
                               .fov_last = LM_FOV_DBS2,
                               .bars = 1,
                               .tone = {LM_DB_Q8(-42), LM_DB_Q8(6), 384}},
             [LM_SECTOR_GMT] = {.name = "GMT",
                                .bam_per_s = FX_BAM_DEG(60),
                                .range_max_nm = 40,
                                .fov_last = LM_FOV_EXP,
                                .bars = 4,
                                .stretch_cells = 1,
                                .clutter_db_q8 = LM_DB_Q8(35),
                                .gate_mm_s = {1543, 51444},
                                .tone = {LM_DB_Q8(-36), LM_DB_Q8(0), 256}},
             [LM_SECTOR_SEA] = {.name = "SEA",
                                .bam_per_s = FX_BAM_DEG(60),
                                .range_max_nm = 40,
                                .fov_last = LM_FOV_EXP,
                                .bars = 1,
                                .tone = {LM_DB_Q8(-48), LM_DB_Q8(-6), 320}}},
    /* What fills shadows: in DBS as in a patch below, by the same processing. UNSOURCED: in NORM
     * the antenna's side lobes, between those of a uniform and of a cosine aperture, -25 and -48 dB
     * both ways together; in EXP those of its code, between Barker's 13 chips as they are, -11.5
     * dB, and weighted ones.
     *
     * Windows, azimuth limits, paces of the cursor and DBS rates (a quarter and a twentieth of the
     * base): [FreeFalcon]; sharpening by 8:1 and 64:1, and beam positions 2/5 of the beam apart,
     * whose pattern is then 1 dB weaker half-way between: UNSOURCED. Azimuths across a sample:
     * enough for the ground to err less than the speckle does
     * (tests/unit/firmware/radar/test_azimuth_average.c). */
    .fov = {[LM_FOV_NORM] = {.name = "NORM",
                             .range_max_nm = 80,
                             .slew_percent = 100,
                             .sharpening = 1,
                             .azimuths_log2 = 1,
                             .ground_leak_db_q8 = LM_DB_Q8(-30)},
            [LM_FOV_EXP] = {.name = "EXP",
                            .range_max_nm = 80,
                            .slew_percent = 50,
                            .window_permille = 125,
                            .azimuth_half_max = FX_BAM_DEG(60),
                            .sharpening = 1,
                            .azimuths_log2 = 2,
                            .ground_leak_db_q8 = LM_DB_Q8(-20)},
            [LM_FOV_DBS1] = {.name = "DBS1",
                             .bam_per_s = FX_BAM_DEG(15),
                             .range_max_nm = 40,
                             .slew_percent = 75,
                             .window_permille = 125,
                             .azimuth_half_max = FX_BAM_DEG(15),
                             .sharpening = 8,
                             .beam_step = FX_BAM_DEG(132) / 100,
                             .azimuths_log2 = 2,
                             .ground_leak_db_q8 = LM_DB_Q8(-16)},
            [LM_FOV_DBS2] = {.name = "DBS2",
                             .bam_per_s = FX_BAM_DEG(3),
                             .range_max_nm = 40,
                             .slew_percent = 85,
                             .window_permille = 30,
                             .azimuth_half_max = FX_BAM_DEG(5),
                             .sharpening = 64,
                             .beam_step = FX_BAM_DEG(132) / 100,
                             .azimuths_log2 = 2,
                             .ground_leak_db_q8 = LM_DB_Q8(-16)}},
    /* UNSOURCED but for the formulas they go into: squints from 15 degrees, where Doppler
     * beam sharpening is usually said to begin, a minute of dwell at the most, a patch shown with
     * four looks, lines that glint within three degrees of broadside. */
    .sar = {.cells = 256,
            .cell_min_mm = 500,
            .cell_max_mm = 40000,
            .squint_min = FX_BAM_DEG(15),
            .dwell_max_ms = 60000,
            .reference_speed_mm_s = 250000,
            .mocomp_residual_permille = 10,
            .noise_floor_db_q8 = LM_DB_Q8(-46),
            .line_lobe = FX_BAM_DEG(6),
            /* MSTAR's chips are grass all around: 15.6 dB from it to their darkest 49 pixels,
             * median of 196, set noise included (docs/EQUATIONS.md, "Floor"). */
            .ground_leak_db_q8 = LM_DB_Q8(-16),
            .ground_leak_most_db_q8 = LM_DB_Q8(-10),
            /* UNSOURCED: cells whose highest side lobe, 35 dB down, shows in a shadow; that are
             * points and no edges; and as many of a line as there is time for. */
            .side_lobes = {.over_shadow_db_q8 = LM_DB_Q8(35),
                           .above_db_q8 = LM_DB_Q8(28),
                           .a_line = 2},
            .speckle = {.looks_log2 = 2},
            .tone = {LM_DB_Q8(-38), LM_DB_Q8(10), 384}},
    /* UNSOURCED, chosen by eye: a dihedral between wall and ground is some 6 dB above the wall
     * alone, a tree line 2 dB; far shores 5 dB over 60 m ([Heaton] names the effects and gives no
     * figures). */
    .illumination = {.edge_structure_db_q8 = LM_DB_Q8(6),
                     .edge_trees_db_q8 = LM_DB_Q8(2),
                     .shore_db_q8 = LM_DB_Q8(5),
                     .shore_width_m = 60},
    /* UNSOURCED: chosen so that levels inside the towns of a Sentinel-1 scene spread as they do
     * there, and its settlements differ; a grid town flashes by some 12 dB (docs/realism.md). */
    .facing = {.lobe_half = FX_BAM_DEG(5), .floor_permille = 300},
    /* UNSOURCED: a sea is brightest against the wind and darkest across it, by some 5 dB at X band;
     * [GIT] has 6 dB between up and down. */
    .sea = {.upwind_db_q8 = LM_DB_Q8(5), .crosswind_db_q8 = 0, .downwind_db_q8 = LM_DB_Q8(2)},
};
