#include "build/canopy.h"

#include "fx/hash.h"
#include "image/codes.h"
#include "reflectivity/place.h"

#include <math.h>

static const double radians_per_bam = 3.14159265358979323846 / 2147483648.0;

/* a of the header. */
static double spread_of(const struct image_frame *f)
{
    return 0.25 * fmin(1, 7 / ((double)f->latitude_step * IMAGE_METRES_PER_BAM));
}

static double factor_at(const struct build_context *b, const struct image_frame *f, int r, int c)
{
    const double north = (double)f->south + (r + 0.5) * (double)f->latitude_step;
    const double east = (double)f->west + (c + 0.5) * (double)f->longitude_step;
    const struct reflect_place p =
        reflect_place_at(north * radians_per_bam, east * radians_per_bam);
    const double pattern = reflect_pattern_smooth(b->seed ^ 0x7ee5, p, 5);
    return fmin(fmax(1 + spread_of(f) * pattern, 0.4), 1.6);
}

/* The height code below or above, by a number of 0..1. */
static uint8_t code_by_chance(const uint16_t table_dm[16], double height_dm, double chance)
{
    int low = 0;
    while (low < 15 && table_dm[low + 1] <= height_dm) {
        low++;
    }
    const double step = low < 15 ? table_dm[low + 1] - table_dm[low] : 1;
    return (uint8_t)(low < 15 && height_dm - table_dm[low] > chance * step ? low + 1 : low);
}

void build_canopy(const struct build_context *b, const struct image_frame *f,
                  struct image_ground *ground)
{
    if (f->shift != b->plan.shift0) {
        return; /* levels above take their heights from below */
    }
    for (int r = 0; r < LM_TILE_CELLS; r++) {
        for (int c = 0; c < LM_TILE_CELLS; c++) {
            uint16_t *cell = &ground->cells[r][c];
            const uint8_t k = image_cell_class(*cell), code = image_cell_height(*cell);
            if (code == 0 || b->classes.entry[k].kind != LM_KIND_TREES) {
                continue;
            }
            const uint32_t row = f->row * LM_TILE_CELLS + (uint32_t)r;
            const uint32_t column = f->column * LM_TILE_CELLS + (uint32_t)c;
            const double chance = ldexp(fx_hash3(row, column, b->seed) >> 12, -20);
            const double height_dm = b->classes.height_dm[code] * factor_at(b, f, r, c);
            *cell = image_cell(image_cell_gamma(*cell), k,
                               code_by_chance(b->classes.height_dm, height_dm, chance));
        }
    }
}
