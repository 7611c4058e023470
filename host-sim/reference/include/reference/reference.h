/* The radar picture in double precision: the judge of the fixed-point firmware.
 *
 * Written from docs/EQUATIONS.md ("The picture, as equations") and docs/FORMATS.md (section 1) and
 * from nothing else; of the firmware it uses only the record structures of lm/db.h, and of fixed/
 * the checksum and the speckle hash, which are exact integers by definition. Where EQUATIONS.md
 * leaves a choice, the choice is stated here with the word "assumed".
 *
 * Every stage works on an array of struct ref_bin, one element a range cell, near to far, and fills
 * its own fields from those of the stages before: a test may fill any of them by hand instead.
 * Angles are degrees, lengths metres, levels decibels (10 log10 of power). */
#ifndef REFERENCE_H
#define REFERENCE_H

#include "lm/db.h"
#include "lm/noise.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A patch's first traced cell does not begin nearer. */
#define REF_TRACED_FROM_M 4096.0

#define REF_EARTH_M           6371000.0 /* mean radius, EQUATIONS.md */
#define REF_EFFECTIVE_EARTH_M (4.0 / 3.0 * REF_EARTH_M)
#define REF_MERIDIAN_M        40007862.9 /* around the Earth through the poles: 2^32 BAM of latitude */

enum {
    REF_SPECKLE_SLICES = 1024,
    REF_GRAIN_VALUES = 256,
    REF_GRAIN_HALVES = 17,
    REF_OVERSCAN_MAX = 48,                      /* cells at either end */
    REF_LINE_MAX = 4096 + 2 * REF_OVERSCAN_MAX, /* bins of a patch's line */
    REF_COARSE_CELLS = 128
};

struct ref_place {
    double latitude_deg, longitude_deg; /* longitude: any turn */
};

/* A range cell and what every stage found for it. */
struct ref_bin {
    /* geo, ground_path */
    double range_m;
    struct ref_place place; /* of the centre */
    /* scan_line */
    bool has_data; /* false: class 15, or no tile */
    int class_index;
    int kind;   /* enum lm_class_kind */
    int facing; /* of the class: 0, or 1 + direction of its walls / 11.25 degrees */
    double gamma_db, height_m, elevation_m;
    /* aspect */
    double tangent, horizon, rise; /* t, T, d */
    bool is_lit;
    double gain_db, edge_db; /* K, E */
    double level_db;         /* the noise floor where there is no echo */
    /* speckle and noise */
    double class_gain_db; /* of the state of the sea and the facing of walls */
    int grain;            /* drawn for speckle: 1/32 of a standard deviation */
    double ground;        /* of a patch: power of the ground behind rain */
    double loss_db, veil; /* of a patch, by rain: taken from the echo, and added to the noise */
    double speckle_db, echo_db;
    /* tone */
    double brightness; /* v, before the table */
    uint8_t grey;
};

/* Every choice that is not geometry. */
struct ref_params {
    double edge_structure_db, edge_trees_db; /* leading edges */
    double shore_db, shore_width_m;          /* far shore */
    double noise_floor_db;
    double leak_db, leak_most_db; /* what the ground leaves in the dark of a patch */
    struct ref_side_lobes {
        double over_shadow_db, above_db; /* how a strong cell stands out */
        double a_line;                   /* as many, the strongest */
    } side_lobes;
    unsigned looks;            /* 1..64 */
    double black_db, white_db; /* white_db > black_db */
    double gamma_exponent;     /* > 0 */
    double sea_db;             /* ref_sea_db of the state of the sea */
    struct ref_lean {
        double cells_m;     /* of a patch: cells that a top is nearer for a metre of height */
        double reference_m; /* where it is not */
    } lean;
    struct ref_sea {
        double critical; /* critical grazing angle, radians; 0: none */
        bool has_wind;
        double wind_from_deg, upwind_db, crosswind_db, downwind_db;
    } sea;
    double lobe_half_deg;   /* half-power half-width of the lobe of walls, > 0 */
    double wall_floor;      /* power of walls from whatever side, of their mean */
    bool has_exact_weights; /* bilinear weights not cut to 8 bits */
};

/* 6, 3 and 8 dB of edges, 90 m of shore, lobes of 8 degrees over 0.1, floor and black -45 dB,
 * white 5 dB, 4 looks, exponent 1. Values to look at pictures with; the firmware's come from its
 * own parameter table. */
struct ref_params ref_params_default(void);

/* ---- the image (image.c) ---- */

struct ref_db {
    uint8_t *bytes; /* owned: the whole file */
    size_t size;
    const struct lm_classes *classes;
    const struct lm_band *bands;
    const uint8_t *directory, *records;
    uint64_t tiles_bytes; /* of `records` */
    uint32_t band_count, entry_count, record_count, level_count, shift0;
    double mean_elevation_m, geoid_m;
    const uint8_t *geoid; /* section GEOID, or NULL */
    struct ref_place centre;
    uint8_t *verdicts;         /* owned: by entry, whether its record's checksum was found good */
    struct lm_tile **unpacked; /* owned: by entry, the tile of a compressed record met so far */
};

/* Read and check header, classes, bands and the bounds of everything. Records are checked when
 * first used; a bad one counts as a missing tile. Returns 0, or -1 with the error reported. */
int ref_db_open(struct ref_db *db, const char *path);

/* The same for an image in memory, which is copied; `name` is for messages. */
int ref_db_open_memory(struct ref_db *db, const void *bytes, size_t size, const char *name);

void ref_db_close(struct ref_db *db);

/* Height of mean sea level above the ellipsoid: of the section GEOID, or else of the header. */
double ref_db_geoid_m(const struct ref_db *db, struct ref_place place);

/* Height of a cell along the meridian, and the level to read for range cells of `cell_m`: the
 * largest cell not longer than 9/8 of that. Assumed: level 0 when every cell is longer, and the
 * length of a cell is its share of the meridian, whatever the latitude. */
double ref_db_cell_m(const struct ref_db *db, unsigned level);
unsigned ref_db_level_for(const struct ref_db *db, double cell_m);

/* Fill the scan_line fields `has_data`, `class_index`, `kind`, `gamma_db`, `height_m` from the cell
 * that holds the place, at `level` or in the nearest coarser level that has the tile. Without any:
 * class 15. */
void ref_db_cell(const struct ref_db *db, unsigned level, struct ref_place place,
                 struct ref_bin *bin);

/* Terrain elevation, bilinear between the four posts around the place, with the weights cut to 8
 * bits unless `is_exact`. False, with *elevation_m 0, where no level has a tile. */
bool ref_db_elevation(const struct ref_db *db, unsigned level, struct ref_place place,
                      bool is_exact, double *elevation_m);

/* ---- what lies between the cells (blend.c) ---- */

/* The four cells whose middles are around a point: south-west, south-east, north-west, north-east,
 * and the point's place between them, 0..1. The place in texels of what has grown, modulo 64. */
struct ref_corners {
    uint16_t cell[4];
    double north, east;
    double texel_row, texel_column;
    bool has_crowns;
};

/* Fill the fields of ref_db_cell with what lies between four cells. */
void ref_blend_cells(const struct ref_db *db, const struct ref_corners *corners,
                     struct ref_bin *bin);

/* n and C of the page at a place of the pattern, 0..64. */
double ref_grown_bend(double row, double column);
double ref_grown_crown(double row, double column);

/* The same for a range cell of `cell_m`: blended where that is finer than the map, with the weights
 * cut to 1/128 unless `is_exact`. */
void ref_db_ground(const struct ref_db *db, double cell_m, struct ref_place place, bool is_exact,
                   struct ref_bin *bin);

/* ---- geometry (geo.c) ---- */

/* The place at a distance and azimuth (clockwise from north) on WGS-84, by EQUATIONS.md's
 * formula. */
struct ref_place ref_geo_direct(struct ref_place from, double azimuth_deg, double distance_m);

/* The other way round: azimuth and distance that lead from one place to another, up to 300 km away,
 * found by trying. */
void ref_geo_inverse(struct ref_place from, struct ref_place to, double *azimuth_deg,
                     double *distance_m);

/* The parabola through the points at u = 0, 1/2 and 1 of a line. Longitudes do not jump. */
struct ref_path {
    double latitude_deg[3], longitude_deg[3];
};
struct ref_path ref_gm_path(struct ref_place antenna, double azimuth_deg, double length_m);
struct ref_place ref_path_at(const struct ref_path *path, double u);

/* The place `across_m` to the right of the line of sight through a patch's centre, and `along_m`
 * beyond the centre along it. Assumed: `azimuth_deg` is the line of sight's at the centre, pointing
 * away from the radar; the point at across x and along y lies at azimuth + atan2(x, y) and distance
 * hypot(x, y) from the centre. */
struct ref_place ref_patch_offset(struct ref_place centre, double azimuth_deg, double across_m,
                                  double along_m);

/* Cells of a patch's line that are traced besides the shown ones: before the patch, and behind it.
 * Each up to REF_OVERSCAN_MAX. */
struct ref_overscan {
    unsigned before, behind;
};

/* The biquadratic surface through nine points of the fan of a patch's lines: [across][along] at -w,
 * 0, +w, as it is at the centre's range, and at the near end of the traced cells, half-way, and at
 * their far end. w is half the number of lines. */
struct ref_sar;
struct ref_surface {
    double near_m, far_m; /* from the centre */
    double side_m;        /* w */
    double latitude_deg[3][3], longitude_deg[3][3];
};
struct ref_surface ref_sar_surface(const struct ref_sar *sar, struct ref_overscan overscan);

/* The place of x_k and y_i. */
struct ref_place ref_surface_at(const struct ref_surface *surface, double across_m, double along_m);

/* ---- illumination (illumination.c) ---- */

struct ref_view {
    double antenna_m;   /* H, above mean sea level */
    double reference_m; /* z0, of the receiver's time gain */
    double cell_m;      /* ds */
};

/* t: tangent of the elevation angle at which a point at height `top_m` appears. */
double ref_tangent(double antenna_m, double range_m, double top_m);

/* g and K of a cell and the range of the cell before it (the first cell: its own). */
double ref_grazing(const struct ref_view *view, double range_m, double before_m);
double ref_gain_db(const struct ref_view *view, double range_m, double before_m);

/* Index of the first bin that is shown: those nearer than 256 m or half the antenna's height are
 * dark and take no part. `count` when none is. */
size_t ref_first_shown(const struct ref_bin *bins, size_t count, const struct ref_view *view);

/* T_0 of a GM line, whose first cell shows flat ground's share. */
double ref_gm_horizon(const struct ref_bin *first, const struct ref_view *view);

/* T_0 of a line behind a foreground, whose horizon is given: the first bin that is shown rises over
 * it at most as the second does over the first, or as flat ground where the second does not. */
double ref_behind_foreground(const struct ref_bin *bins, size_t count, const struct ref_view *view,
                             double horizon);

/* Largest t of the bins (range, elevation and height are read), -INFINITY for none. */
double ref_highest_tangent(const struct ref_bin *bins, size_t count, double antenna_m);

/* Raise elevations to the crests between cells: EQUATIONS.md, "Crests between cells". */
void ref_raise_crests(struct ref_bin *bins, size_t count, const struct ref_view *view);

/* Fill the aspect fields from range and scan_line fields, near to far, starting below `horizon`.
 * The first bin shown enters nothing and follows no water; a bin without data is ground of -80
 * dB. */
void ref_illuminate(struct ref_bin *bins, size_t count, const struct ref_view *view,
                    const struct ref_params *params, double horizon);

/* ---- speckle (speckle.c) ---- */

/* 10 log10 of the mean of each of 1024 equally likely slices of a Gamma variable of shape `looks`
 * and mean 1, from the incomplete gamma function. looks 1..64. */
void ref_speckle_table(unsigned looks, double table_db[REF_SPECKLE_SLICES]);

/* The slice that a cell draws which is the cell-th of its line and lies in a column of a raster. */
unsigned ref_draw(enum lm_noise_kind kind, uint32_t column, uint32_t cell, uint32_t epoch);

/* 10 log10 of a Gamma variable of shape `looks` (1 or more) and mean 1 that is as probable as a
 * Gaussian one of z; and of z = -4, -4 + 1/32, .. */
double ref_grain_db(double looks, double z);
void ref_grain_table(double looks, double table_db[REF_GRAIN_VALUES]);

/* The number of the field of grain at a place, 1/32 of a standard deviation. The field itself is
 * that of lm/grain.h, by definition; its statistics are tested by themselves. */
int ref_grain(uint32_t row, uint32_t column);

/* ref_grain_db at z = -4, -3.5, .. 4. */
void ref_grain_halves(double looks, double half_db[REF_GRAIN_HALVES]);

/* Power of the speckle at a place between rows and columns of the field: linear in decibels
 * between the numbers of ref_grain_halves. */
double ref_grain_power(const double half_db[REF_GRAIN_HALVES], uint32_t start_row,
                       uint32_t start_column, double row, double column);

/* The running mean of the ground: zero before its first line. */
struct ref_leak {
    double mean, shadow_db; /* of the line last taken: level of its shadows without rain */
    unsigned lines;
};

/* Take the powers of a line's cells into the mean of `lines_max` lines; none counts above most_db.
 */
void ref_leak_line(struct ref_leak *leak, double most_db, unsigned lines_max, unsigned line,
                   const double *power, size_t count);

/* Bins of a stretch of a sector's ground, bins of `step_m`. */
size_t ref_leak_bins(double step_m);

/* The same for each stretch of `length` bins of a sector's line, the last of which has the rest,
 * and the power `mean` of the ground about each bin: linear between the stretches' middles. */
enum { REF_LEAK_STRETCHES = 32 };
void ref_leak_sector(struct ref_leak stretches[REF_LEAK_STRETCHES], size_t length, double most_db,
                     unsigned lines_max, unsigned line, const double *power, size_t count,
                     double *mean);

/* Power that the ground leaves in each cell of a patch's line, from the `ground` and `veil` of its
 * bins. The line is taken into the mean first. */
double ref_leak(struct ref_leak *leak, const struct ref_params *params, unsigned line,
                const struct ref_bin *shown, size_t count);

/* The bins of a patch's line: all, and of them those that are shown, from `first` on. */
struct ref_patch_line {
    size_t count, first, shown;
};

/* Fill `ground`, `speckle_db` and `echo_db` of a patch's line: ground where it is displayed, floor
 * and veil as powers, + the speckle of `grain`. */
void ref_patch_echo(struct ref_bin *bins, const struct ref_patch_line *cells,
                    const double table_db[REF_GRAIN_VALUES], const struct ref_params *params,
                    struct ref_leak *leak, unsigned line);

/* Level that a sea state (0..8) adds to water. */
double ref_sea_db(int state);

/* Critical grazing angle of a sea state (0..8), radians. */
double ref_sea_critical(int state, double wavelength_m);

/* dB that water gains at a grazing angle over the critical one, and at a look `off_deg` from where
 * the wind comes from. */
double ref_sea_grazing_db(double over);
double ref_sea_wind_db(double off_deg, const struct ref_sea *sea);

/* Add to `class_gain_db` of water what the grazing angle and the wind do, seen along the azimuth
 * `look_deg`. After ref_class_gain. */
void ref_sea(struct ref_bin *bins, size_t count, const struct ref_view *view,
             const struct ref_params *params, double look_deg);

/* dB that walls gain whose direction is `off_deg` from the line of sight. */
double ref_facing_db(double off_deg, const struct ref_params *params);

/* Fill `class_gain_db` from `kind` and `facing`: over water what the state of the sea adds to the
 * level, over walls what their direction does, seen along the azimuth `look_deg`. */
void ref_class_gain(struct ref_bin *bins, size_t count, const struct ref_params *params,
                    double look_deg);

/* Fill `speckle_db` from `grain`, and echo_db = the sum of the powers, level_db +
 * class_gain_db - loss_db (of a lit bin), floor and veil, + speckle_db. */
void ref_speckle(struct ref_bin *bins, size_t count, const double table_db[REF_GRAIN_VALUES],
                 double noise_floor_db);

/* ---- tone (tone.c) ---- */

/* v, the level's place in the window, clamped to 0..1, and the grey level round(255 v^gamma). */
double ref_brightness(double level_db, const struct ref_params *params);
uint8_t ref_grey(double brightness, const struct ref_params *params);
void ref_tone(struct ref_bin *bins, size_t count, const struct ref_params *params);

/* ---- real beam: the receiver (receiver.c) ---- */

enum { REF_PULSE_REACH = 4, REF_CELLS_MAX = 1024 };

/* Bins of a display line, equally spaced in slant range. */
struct ref_bins {
    double first_m, step_m; /* centre of bin 0; from centre to centre */
    size_t count;           /* up to REF_CELLS_MAX */
};

/* Noise that is as strong as the echo of flat ground of `gamma_db`, seen `height_m` above it at a
 * slant range with a simple pulse. */
struct ref_noise_anchor {
    double gamma_db, range_m, height_m, pulse_s;
};

struct ref_receiver {
    struct ref_bins bins;
    double height_m; /* h = H - z0 */
    struct ref_noise_anchor noise;
    double code_gain_db;          /* C */
    double air_loss_db_km;        /* there and back */
    const double *noise_table_db; /* borrowed: ref_speckle_table of the noise's looks */
    const double *speckle;        /* borrowed: power of the ground's in each bin; NULL: none */
    struct ref_leak *leak;        /* borrowed: REF_LEAK_STRETCHES of it; NULL: nothing leaks */
    double leak_db, leak_most_db; /* what is left of it, and what a bin counts for at most */
    unsigned leak_lines;          /* that the beam is wide */
    double unlit_m;               /* slant range from which on it leaks: ref_unlit_m */
    double stc_m;                 /* r_s */
    double pulse_s;
};

/* Effect of the weather on each bin of a line. */
struct ref_weather_line {
    double jam; /* what jammers add to the noise, in units of it */
    double pass[REF_CELLS_MAX], rain[REF_CELLS_MAX];
};

/* s of a slant range r over flat ground `height_m` below; 0 in the altitude hole. */
double ref_ground_of_slant(double slant_m, double height_m);

/* The sampled cell of a bin, of `cells` that begin at `near_edge_m`; `cells` where there is
 * none. */
size_t ref_slant_cell(double slant_m, double height_m, double near_edge_m, double cell_m,
                      size_t cells);

/* g of a slant range: flat ground's grazing, 1/256..2. */
double ref_slant_grazing(double slant_m, double height_m);

double ref_noise_db(const struct ref_receiver *r, double slant_m);
double ref_stc_fall_db(const struct ref_receiver *r, double slant_m);

/* q, and the share of bin i + m in bin i for a pulse `bins` bins long. */
double ref_pulse_m(double pulse_s);
double ref_pulse_share(double bins, int m);

/* Mean of the powers over the pulse, in place. count up to REF_CELLS_MAX. */
void ref_pulse(double *power, size_t count, double bins);

/* Everything from the powers of a line's bins to their levels; the powers are changed. `weather`
 * may be NULL. */
void ref_receive(const struct ref_receiver *r, const struct ref_weather_line *weather,
                 uint32_t line, uint32_t sweep, double *power, double *level_db);

/* ---- real beam: rain and jammers (weather.c) ---- */

struct ref_rain {
    double distance_m, off_deg; /* of its centre, from the antenna and off the line */
    double radius_m, mm_per_h;
};

struct ref_jammer {
    double distance_m, off_deg;
    double ratio_db; /* to the noise, on the axis at ten nautical miles */
};

struct ref_environment {
    struct ref_rain rain[4];
    struct ref_jammer jammer[4];
    size_t rain_count, jammer_count;
};

/* One way, ITU-R P.838-3 at 10 GHz, horizontal. */
double ref_rain_loss_db_km(double mm_per_h);

/* Cross section of a cubic metre of rain, 1 / m. */
double ref_rain_eta(double mm_per_h, double wavelength_m);

/* The jammer's noise beside the receiver's. */
double ref_jam(const struct ref_jammer *j, double beam_deg);

/* Part of a line that is in the rain. False if none is; both results are then meaningless. */
bool ref_rain_chord(const struct ref_rain *rain, double *from_m, double *to_m);

/* Weather of bin i: share of the power that passes, and the rain's own as gamma, weakened. */
void ref_weather_at(const struct ref_environment *e, double wavelength_m, double elevation_beam_deg,
                    double height_m, const struct ref_bins *bins, size_t i, double *pass,
                    double *rain);

/* The weather of a line. */
void ref_weather(const struct ref_environment *e, double wavelength_m, double azimuth_beam_deg,
                 double elevation_beam_deg, double height_m, const struct ref_bins *bins,
                 struct ref_weather_line *weather);

/* Rain that a patch is seen through. */
struct ref_patch_rain {
    struct ref_environment environment; /* seen from the antenna, off the patch's line of sight */
    double wavelength_m, azimuth_beam_deg, elevation_beam_deg;
    double slant; /* metres of the way for each metre along the ground */
};

/* Loss by rain of the echo of a cell of `cell_m` at `range_m`, dB there and back, on the line in
 * direction `aside_deg` to the right of the line of sight. Lengths are along that line of sight. */
double ref_patch_loss_db(const struct ref_patch_rain *w, double aside_deg, double range_m,
                         double cell_m);

/* Echo of rain in such a cell, as gamma. */
double ref_patch_veil(const struct ref_patch_rain *w, const struct ref_view *view, double range_m,
                      double aside_deg);

/* ---- real beam: the antenna (beam.c), and a line (sector.c) ---- */

enum { REF_BEAM_SAMPLES = 8 };

struct ref_beam {
    double beam_deg; /* B, one-way half-power width */
    double line_deg; /* D0 */
    double ratio;    /* N >= 1; 1: real beam */
};

/* A line of the display: samples first .. first + 7, whose weights add up to 1. */
struct ref_beam_look {
    long first;
    double weight[REF_BEAM_SAMPLES];
};

/* 2^k, D, and the azimuth of a sample from the sector's middle. */
double ref_beam_fineness(const struct ref_beam *b);
double ref_beam_spacing_deg(const struct ref_beam *b);
double ref_beam_azimuth_deg(const struct ref_beam *b, long sample);

/* Two-way pattern, 1 on the axis. */
double ref_beam_pattern(const struct ref_beam *b, double off_deg);

struct ref_beam_look ref_beam_look(const struct ref_beam *b, double azimuth_deg);

/* The line drawn from its samples, power[j] that of sample first + j. */
void ref_beam_sum(const struct ref_beam_look *look, const double *const power[REF_BEAM_SAMPLES],
                  double *sum, size_t count);

struct ref_antenna {
    double elevation_beam_deg; /* b, one-way half-power width */
    double fan_deg;            /* f */
    double bar_spacing_deg;
};

/* Elevation pattern at a tangent, in dB: at most 0, which is its value within the fan. Tilts are
 * positive upwards. */
double ref_elevation_db(const struct ref_antenna *a, double tilt_deg, double tangent);

/* Slant range of flat ground `height_m` below at the lower half-power edge of the beam. */
double ref_unlit_m(const struct ref_antenna *a, double tilt_deg, double height_m);

/* Tilt towards flat ground `height_m` below at `range_m`, and that of bar 0..bars-1. */
double ref_auto_tilt_deg(double height_m, double range_m);
double ref_bar_tilt_deg(const struct ref_antenna *a, double tilt_deg, int bar, int bars);

/* Power of each cell of a sampled line, from `echo_db`, `is_lit` and `tangent`. */
void ref_sample_power(const struct ref_bin *cells, size_t count, const struct ref_antenna *a,
                      double tilt_deg, double *power);

/* Power of each bin from the ground's `cells`, the first of which begins at `near_edge_m`. */
void ref_slant_power(const struct ref_bins *bins, double height_m, double near_edge_m,
                     double cell_m, const double *ground, size_t cells, double *power);

/* Everything that a line of a sector is made of, but for its samples. */
struct ref_sector_line {
    struct ref_beam_look look;
    struct ref_antenna antenna;
    double tilt_deg;            /* of the bar */
    double near_edge_m, cell_m; /* of the ground's cells */
    struct ref_receiver receiver;
    uint32_t line, sweep;
    double looks;     /* of the ground's speckle; 0: none */
    double grain_row; /* of the line, from where the sweep's grain begins */
};

/* Looks that a dwell with a ratio `had` leaves where `used` is used. */
double ref_dbs_looks(double had, double used);

/* Lines that the beam is wide, of whose ground the mean is taken; 1 or more. */
unsigned ref_leak_lines(double beam_deg, double line_deg);

/* Rows of the grain from one line to the next, `width_deg` apart: a row is a two-way beam wide. */
double ref_grain_rows(const struct ref_beam *beam, double width_deg);

/* Power of the speckle in each bin of a line whose pulse is `pulse_bins` bins long. */
void ref_line_speckle(double looks, uint32_t sweep, double grain_row, double pulse_bins,
                      double *speckle, size_t count);

/* Levels of a line's bins from 8 sampled lines of `cells` cells each (up to REF_CELLS_MAX), whose
 * `echo_db` is known; NULL `weather`: fair. */
void ref_sector_line(const struct ref_sector_line *s, const struct ref_bin *const samples[],
                     size_t cells, const struct ref_weather_line *weather, double *level_db);

/* ---- Doppler beam sharpening and movers (doppler.c) ---- */

struct ref_dbs {
    double speed_m_s; /* V, horizontal */
    double beam_deg, wavelength_m;
    double rate_deg_s; /* w, of the antenna */
};

/* N(o), what is to be had at `off_deg` from the velocity. */
double ref_dbs_ratio(const struct ref_dbs *d, double off_deg);

/* Angle off the velocity from which a ratio is to be had; NAN when it is nowhere. */
double ref_dbs_notch_deg(const struct ref_dbs *d, double ratio);

/* The ratio that is used at an angle off the velocity, with lines `line_deg` apart: 1 in the notch.
 */
double ref_dbs_used(const struct ref_dbs *d, double off_deg, double line_deg, double wanted);

/* Power of a sharpened line at an azimuth from the sector's middle, beside the beam positions
 * `step_deg` apart; 0: no positions. */
double ref_dbs_scallop(double beam_deg, double step_deg, double ratio, double azimuth_deg);

/* How far a target that closes seems to lie nearer to the velocity vector: as an angle, NAN where
 * no still ground has its Doppler shift; and, to the first order, on the ground of a patch at
 * ground range `range_m`. */
double ref_mover_shift_deg(double closing_m_s, double speed_m_s, double off_deg);
double ref_mover_shift_m(double closing_m_s, double speed_m_s, double off_deg, double range_m);

/* The least closing speed, either way, that GMT shows `off_deg` from the velocity. */
double ref_gmt_least_m_s(double gate_m_s, double speed_m_s, double beam_deg, double off_deg);

/* ---- synthetic aperture (aperture.c) ---- */

double ref_sar_dwell_s(double wavelength_m, double slant_m, double speed_m_s, double cell_m,
                       double squint_deg);

/* q: lines over which an uncompensated lateral acceleration spreads a point. */
double ref_mocomp_cells(double wavelength_m, double residual_m_s2, double dwell_s);

/* Line `line` of `lines` lines of `count` powers, spread over `width` lines. Beyond the edges the
 * first and the last line are repeated. */
void ref_mocomp(const double *const power[], size_t lines, size_t line, double width, double *mean,
                size_t count);

/* A line in slant-range presentation: each power moves nearer by so many cells and is shared
 * between the two bins that it falls between. */
void ref_layover(const double *power, const double *nearer_cells, size_t count, double *laid);

struct ref_taylor {
    double side_lobe_db; /* below the peak, > 0 */
    int nbar;            /* 1: uniform weighting */
};

/* Weight at u = -1/2..1/2 of the aperture (mean 1), and the response to a point, x in units of the
 * aperture's own resolution, in amplitude. */
double ref_taylor_weight(const struct ref_taylor *t, double u);
double ref_taylor_amplitude(const struct ref_taylor *t, double x);

/* h: amplitude of a point's return in a patch, x cells from it one way, without the table's steps.
 * Both ways multiply. */
double ref_point_response(double x);

/* Add the side lobes of strong cells to a patch's levels, lines x cells, speckle included, whose
 * shadows have those levels. 0, or -1 with the error reported. */
int ref_side_lobes(const struct ref_side_lobes *law, double *level_db, const double *shadow_db,
                   size_t lines, size_t cells, uint32_t seed);

/* A point of a patch that moves: where it appears in the middle of the dwell, how far, in cells,
 * its displacement drifts across and it goes itself away from the radar until the dwell's end. */
struct ref_mover {
    double line, cell, across, along, power;
};

/* Add what the aperture makes of it to `power`, lines x cells: its echoes, weighed and summed with
 * the phase of each line. 0, or -1 without memory. */
int ref_add_mover(const struct ref_mover *m, size_t lines, size_t cells, double *power);

/* ---- whole pictures (picture.c) ---- */

struct ref_picture {
    unsigned line_count, cell_count;
    struct ref_overscan overscan; /* of a patch: cells before and behind the shown */
    struct ref_bin *bins;         /* owned: line_count x all of these cells */
    double *start_horizons;       /* owned: T before the first bin of each line */
    struct ref_view view;
    unsigned level; /* of the image */
};

struct ref_gm {
    struct ref_place antenna;
    double antenna_m, cell_m;
    double centre_azimuth_deg,
        half_angle_deg;              /* sector; line j is centred in wedge j of line_count */
    unsigned cell_count, line_count; /* >= 1 */
    uint32_t epoch;
};

struct ref_sar {
    struct ref_place centre;
    double azimuth_deg; /* of the line of sight at the centre, away from the radar */
    double range_m;     /* S, along the ground from antenna to centre; > half the patch */
    double antenna_m, cell_m;
    unsigned cell_count;              /* along either side of the square */
    bool is_plan;                     /* without layover */
    uint32_t grain_row, grain_column; /* of cell 0 of line 0 */
    uint32_t side_lobe_seed;          /* the centre's longitude, BAM */
    struct ref_patch_rain rain;       /* distances, angles and slant are filled from these places */
    struct ref_place rain_centre[4];
};

/* Number of lines of a patch: n of "Line of a patch". */
unsigned ref_sar_lines(const struct ref_sar *sar);

/* Layover of a patch: tan(psi) of flat ground at its centre, over the cell. */
struct ref_lean ref_sar_lean(const struct ref_sar *sar, double reference_m);

/* Overscan of a patch whose ground at the centre is reference_m high. */
struct ref_overscan ref_sar_overscan(const struct ref_db *db, const struct ref_sar *sar,
                                     const struct ref_params *params, double reference_m);

/* The tables of a picture. */
struct ref_tables {
    double grain_db[REF_GRAIN_VALUES];
};
void ref_tables_set(struct ref_tables *tables, const struct ref_params *params);

/* One GM line: all stages, into `bins` (gm->cell_count of them), with the speckle of sample number
 * `sample`. Returns T_0. */
double ref_gm_line(struct ref_bin *bins, const struct ref_db *db, const struct ref_gm *gm,
                   const struct ref_params *params, const struct ref_tables *tables,
                   double azimuth_deg, uint32_t sample);

/* Height of the antenna, that of the time gain's ground below it, and the cell. */
struct ref_view ref_gm_view(const struct ref_db *db, const struct ref_gm *gm,
                            const struct ref_params *params);

/* Azimuth of the middle of line j. */
double ref_gm_azimuth_deg(const struct ref_gm *gm, unsigned line);

/* T before the first traced cell of line k, of which `before` are overscan: the coarse line.
 * Assumed: the coarse line is the patch's line prolonged towards the radar, its places on the
 * parabola through the two ends and the middle; its cells end where the first traced cell begins.
 */
double ref_sar_horizon(const struct ref_db *db, const struct ref_sar *sar,
                       const struct ref_params *params, unsigned before, unsigned line);

/* Room for the picture's lines and cells, all zero. Returns 0, or -1 with the error reported. */
int ref_picture_allocate(struct ref_picture *picture);

/* Whole pictures. Return 0, or -1 with the error reported (no memory); ref_picture_free
 * afterwards. */
int ref_gm_sweep(struct ref_picture *picture, const struct ref_db *db, const struct ref_gm *gm,
                 const struct ref_params *params);
int ref_sar_patch(struct ref_picture *picture, const struct ref_db *db, const struct ref_sar *sar,
                  const struct ref_params *params);
void ref_picture_free(struct ref_picture *picture);

/* The bin of a line and cell. Overscan lies before cell 0 and from
 * cell_count on. */
struct ref_bin *ref_picture_bin(const struct ref_picture *picture, unsigned line, int cell);

/* ---- a sector as the receiver hands it on (sector.c) ---- */

/* A whole scale: the ground's cells begin at the antenna, and bins are as many and as long. */
struct ref_sector {
    struct ref_gm ground; /* its lines are those that are drawn, its cells those that are sampled */
    double beam_deg, sample_deg;      /* B, D0 */
    unsigned azimuths;                /* traced across a sample in real beam; 0 is 1 */
    double sharpening, beam_step_deg; /* 1 and 0: real beam */
    struct ref_dbs dbs;               /* not used by real beam */
    double track_deg;                 /* azimuth of the velocity, likewise */
    struct ref_antenna antenna;
    double tilt_deg;                    /* of the bar */
    struct ref_receiver receiver;       /* bins and height_m are filled by the sweep */
    struct ref_environment environment; /* distances and angles likewise, from these places */
    struct ref_place rain_centre[4], jammer_place[4];
};

/* The sector's lines, as bins of which range_m (slant), echo_db, brightness and grey mean
 * something. params->noise_floor_db is not used: the receiver has its own noise. Returns 0, or -1
 * with the error reported; ref_picture_free afterwards. */
int ref_sector_sweep(struct ref_picture *picture, const struct ref_db *db,
                     const struct ref_sector *sector, const struct ref_params *params);

/* ---- on the glass (glass.c) ---- */

/* A patch as `side` x `side` pixels: far on top, right of the line of sight to the right, the grey
 * of a pixel linear between the four cells around it. range_m is that of the centre. */
void ref_glass_sar(const struct ref_picture *picture, double range_m, unsigned side,
                   uint8_t *pixels);

/* A sweep seen from above, the sector's middle upwards: `width` x `height` pixels, the antenna in
 * the middle of the lower edge, the last cell's far end at the top. A pixel takes the line in whose
 * half-open wedge its centre lies and the cell of its projection on that line's middle. */
void ref_glass_gm(const struct ref_picture *picture, const struct ref_gm *gm, unsigned width,
                  unsigned height, uint8_t *pixels);

#endif
