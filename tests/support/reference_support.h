/* What the firmware handed on, as the double-precision reference takes it; and the country that
 * both look at. */
#ifndef REFERENCE_SUPPORT_H
#define REFERENCE_SUPPORT_H

#include "hs/angle.h"
#include "lm/line.h"
#include "lm/radar.h"

#include "reference/reference.h"
#include "tiny_image.h"

#include <math.h>

/* Decibels of the firmware's 1/256. */
static inline double decibels(int32_t q8)
{
    return q8 / 256.0;
}

/* The radar table's choices. */
static inline struct ref_params params_of(const struct lm_radar *radar, double noise_floor_db,
                                          const struct lm_tone_config *tone,
                                          const struct lm_speckle_config *speckle)
{
    const struct lm_illumination_config *a = &radar->illumination;
    struct ref_params params = {
        .edge_structure_db = decibels(a->edge_structure_db_q8),
        .edge_trees_db = decibels(a->edge_trees_db_q8),
        .shore_db = decibels(a->shore_db_q8),
        .shore_width_m = a->shore_width_m,
        .noise_floor_db = noise_floor_db,
        .leak_db = decibels(radar->sar.ground_leak_db_q8),
        .leak_most_db = decibels(radar->sar.ground_leak_most_db_q8),
        .side_lobes = {decibels(radar->sar.side_lobes.over_shadow_db_q8),
                       decibels(radar->sar.side_lobes.above_db_q8), radar->sar.side_lobes.a_line},
        .looks = 1u << speckle->looks_log2,
        .black_db = decibels(tone->black_db_q8),
        .white_db = decibels(tone->white_db_q8),
        .gamma_exponent = decibels(tone->gamma_q8),
        .lobe_half_deg = hs_degrees(radar->facing.lobe_half),
        .wall_floor = radar->facing.floor_permille / 1000.0,
        .sea = {.critical = ref_sea_critical(LM_SEA_STATE_OF_IMAGE, radar->wavelength_um * 1e-6),
                .upwind_db = decibels(radar->sea.upwind_db_q8),
                .crosswind_db = decibels(radar->sea.crosswind_db_q8),
                .downwind_db = decibels(radar->sea.downwind_db_q8)}};
    return params;
}

/* The receiver of a scale and a field of view, `height_m` above flat ground. */
static inline struct ref_receiver ref_receiver_of(const struct lm_radar *radar, uint8_t range,
                                                  enum lm_fov fov, struct ref_bins bins,
                                                  double height_m, const double *noise_table_db)
{
    const struct lm_receiver_table *t = &radar->receiver;
    const struct lm_range_row *row = &radar->range[range];
    return (struct ref_receiver){.bins = bins,
                                 .height_m = height_m,
                                 .noise = {decibels(t->noise_db_q8), t->noise_range_m,
                                           t->noise_height_m, t->noise_pulse_ns * 1e-9},
                                 .code_gain_db = decibels(row->code_gain_db_q8[fov]),
                                 .air_loss_db_km = t->air_loss_db_per_km_q16 / 65536.0,
                                 .noise_table_db = noise_table_db,
                                 .leak_db = decibels(radar->fov[fov].ground_leak_db_q8),
                                 .leak_most_db = decibels(radar->sar.ground_leak_most_db_q8),
                                 .stc_m = row->stc_end_m,
                                 .pulse_s = row->pulse_ns[fov] * 1e-9};
}

/* The reference's bins filled with what the firmware found on the ground. */
static inline void take_ground(const struct lm_scan_line *ground, const struct lm_classes *classes,
                               struct ref_bin *bins, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i++) {
        const uint32_t cell = ground->cell[i];
        bins[i].class_index = (int)(cell >> 4 & 15);
        bins[i].has_data = bins[i].class_index != LM_DB_CLASS_NONE;
        bins[i].kind = classes->entry[bins[i].class_index].kind;
        bins[i].facing = classes->entry[bins[i].class_index].facing;
        bins[i].gamma_db = (cell >> 8 & 255) / 2.0 - 80 + ((int32_t)cell >> 16) / 256.0;
        bins[i].height_m = classes->height_dm[cell & 15] / 10.0;
        bins[i].elevation_m = ground->elevation_m_q14[i] / 16384.0;
    }
}

/* Lakes, woods, blocks of houses and fields over hills of 80 m; scale 1 for a patch, 8 for a
 * sector. */
static inline struct tiny_cell scene_cell(void *ctx, const struct tiny_place *p)
{
    const double scale = *(const double *)ctx, east = p->east_m / scale, north = p->north_m / scale;
    const double u = sin(east / 170) + sin(north / 230);
    if (u < -1.2) {
        return (struct tiny_cell){-40, TINY_WATER, 0};
    }
    if (fabs(remainder(east, 90)) < 14 && fabs(remainder(north, 110)) < 17) {
        return (struct tiny_cell){1, TINY_STRUCTURE, 5};
    }
    if (u > 0.9) {
        return (struct tiny_cell){-15, TINY_TREES, 7};
    }
    return (struct tiny_cell){-20 + 2 * sin(east / 31), TINY_SOIL, 0};
}

static inline double scene_elevation_m(void *ctx, const struct tiny_place *p)
{
    const double scale = *(const double *)ctx;
    return 90 + 80 * sin(p->east_m / (400 * scale)) * cos(p->north_m / (300 * scale));
}

#endif
