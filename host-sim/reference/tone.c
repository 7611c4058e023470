/* From decibels to grey: EQUATIONS.md, "Tone". */
#include "reference/reference.h"

#include <math.h>

struct ref_params ref_params_default(void)
{
    return (struct ref_params){.edge_structure_db = 6,
                               .edge_trees_db = 3,
                               .shore_db = 8,
                               .shore_width_m = 90,
                               .noise_floor_db = -45,
                               .leak_db = -16,
                               .leak_most_db = -10,
                               .side_lobes = {.over_shadow_db = 35, .above_db = 28, .a_line = 2},
                               .looks = 4,
                               .black_db = -45,
                               .white_db = 5,
                               .gamma_exponent = 1,
                               .lobe_half_deg = 8,
                               .wall_floor = 0.1};
}

double ref_brightness(double level_db, const struct ref_params *params)
{
    const double v = (level_db - params->black_db) / (params->white_db - params->black_db);
    return fmin(fmax(v, 0), 1);
}

uint8_t ref_grey(double brightness, const struct ref_params *params)
{
    return (uint8_t)lround(255 * pow(brightness, params->gamma_exponent));
}

void ref_tone(struct ref_bin *bins, size_t count, const struct ref_params *params)
{
    for (size_t i = 0; i < count; i++) {
        bins[i].brightness = ref_brightness(bins[i].echo_db, params);
        bins[i].grey = ref_grey(bins[i].brightness, params);
    }
}
