/* The kernels of c/ by the names that they have where another folder's are linked beside them: its
 * tails call them, and a test compares the two (tests/kernels). lm_k_tone_c is lm_k_tone of c/. */
#ifndef PLAIN_H
#define PLAIN_H

#include "lm/kernels_clutter.h"
#include "lm/kernels_display.h"
#include "lm/kernels_map.h"
#include "lm/kernels_radar.h"

extern __typeof__(lm_k_tile_read) lm_k_tile_read_c;
extern __typeof__(lm_k_tile_blend) lm_k_tile_blend_c;
extern __typeof__(lm_k_tile_row) lm_k_tile_row_c;
extern __typeof__(lm_k_replace) lm_k_replace_c;
extern __typeof__(lm_k_highest_tangent) lm_k_highest_tangent_c;
extern __typeof__(lm_k_light) lm_k_light_c;
extern __typeof__(lm_k_water_gain) lm_k_water_gain_c;
extern __typeof__(lm_k_layover) lm_k_layover_c;
extern __typeof__(lm_k_grain_add) lm_k_grain_add_c;
extern __typeof__(lm_k_grain_floor) lm_k_grain_floor_c;
extern __typeof__(lm_k_grain_stretch) lm_k_grain_stretch_c;
extern __typeof__(lm_k_gather) lm_k_gather_c;
extern __typeof__(lm_k_powers_of_levels) lm_k_powers_of_levels_c;
extern __typeof__(lm_k_sum_powers) lm_k_sum_powers_c;
extern __typeof__(lm_k_levels_add) lm_k_levels_add_c;
extern __typeof__(lm_k_levels_mean) lm_k_levels_mean_c;
extern __typeof__(lm_k_highest) lm_k_highest_c;
extern __typeof__(lm_k_stand_out) lm_k_stand_out_c;
extern __typeof__(lm_k_side_lobes) lm_k_side_lobes_c;
extern __typeof__(lm_k_beam_sum) lm_k_beam_sum_c;
extern __typeof__(lm_k_add_slope) lm_k_add_slope_c;
extern __typeof__(lm_k_fade) lm_k_fade_c;
extern __typeof__(lm_k_detect) lm_k_detect_c;
extern __typeof__(lm_k_detect_in_rain) lm_k_detect_in_rain_c;
extern __typeof__(lm_k_tone) lm_k_tone_c;
extern __typeof__(lm_k_patch_hold) lm_k_patch_hold_c;
extern __typeof__(lm_k_patch_paint) lm_k_patch_paint_c;
extern __typeof__(lm_k_colour_area) lm_k_colour_area_c;

#endif
