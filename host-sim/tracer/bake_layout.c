#include "tracer/bake_layout.h"

#include "hs/error.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double bake_azimuth_deg(const struct bake_looks *looks, long aspect)
{
    return 360.0 * (double)aspect / (double)looks->aspects;
}

/* How far the model and what belongs to it reach from the origin, on the ground, at most. */
struct extent {
    double across_m, near_m; /* near: towards the radar, the lean included */
    double body_m;           /* away from the radar, without any shadow: the model's radius */
    double shadow_m; /* the shadow's end at BAKE_SHADOW_DEG, or at a steeper flattest look */
    double whole_m;  /* the whole shadow's end */
    double height_m;
};

static double tan_deg(double degrees)
{
    return tan(degrees * pi / 180);
}

static void stretch(struct extent *e, const struct vec *v, double azimuth_deg,
                    const struct bake_looks *looks)
{
    const double flattest_deg = looks->depression_deg[0];
    const double steepest_deg = looks->depression_deg[looks->depressions - 1];
    const double turn = azimuth_deg * pi / 180, up_m = fmax(v->z, 0);
    const double away_m = -v->x * cos(turn) + v->y * sin(turn);
    e->height_m = fmax(e->height_m, up_m);
    e->across_m = fmax(e->across_m, fabs(v->x * sin(turn) + v->y * cos(turn)));
    e->near_m = fmax(e->near_m, up_m * tan_deg(steepest_deg) - away_m);
    e->body_m = fmax(e->body_m, away_m);
    e->shadow_m = fmax(e->shadow_m, away_m + up_m / tan_deg(fmax(flattest_deg, BAKE_SHADOW_DEG)));
    e->whole_m = fmax(e->whole_m, away_m + up_m / tan_deg(flattest_deg));
}

static struct extent extent_of(const struct mesh *m, const struct bake_looks *looks)
{
    struct extent e = {0};
    for (long a = 0; a < looks->aspects; a++) {
        for (uint32_t i = 0; i < m->vertex_count; i++) {
            stretch(&e, &m->vertices[i], bake_azimuth_deg(looks, a), looks);
        }
    }
    return e;
}

/* Smallest pixels for so much away from the radar. Two rows are lost where the origin must lie
 * between pixels. */
static double pixel_for(const struct extent *e, double far_m)
{
    return fmax(e->across_m / (LM_CHIP_SIDE / 2), (e->near_m + far_m) / (LM_CHIP_SIDE - 2));
}

static double choose_pixel_m(const struct extent *e)
{
    return fmax(pixel_for(e, e->shadow_m), fmin(pixel_for(e, e->whole_m), BAKE_PIXEL_ENOUGH_M));
}

int bake_layout(struct bake_layout *l, const struct mesh *m, const struct bake_looks *looks,
                double pixel_m, const char *place)
{
    const struct extent e = extent_of(m, looks);
    const double least_m = pixel_for(&e, e.body_m);
    const double wanted_m = pixel_m > 0 ? pixel_m : choose_pixel_m(&e);
    const double mm = fmax(ceil(wanted_m * 1000 - 1e-6), LM_SIGNATURE_PIXEL_MIN_MM);
    if (pixel_m > 0 && pixel_m < least_m) {
        return hs_error("--pixel", NULL, "%s needs pixels of %.3f m at least", place, least_m);
    }
    if (mm > LM_SIGNATURE_PIXEL_MAX_MM) {
        return hs_error(place, "bake a smaller model, or leave out steep looks",
                        "needs pixels of %.1f m, more than %g m", mm / 1000,
                        LM_SIGNATURE_PIXEL_MAX_MM / 1000.0);
    }
    *l = (struct bake_layout){
        .pixel_mm = (uint32_t)mm,
        .origin_row = (uint32_t)ceil(e.near_m * 1000 / mm),
        .height_m = e.height_m,
        .radius_m = e.body_m,
    };
    return 0;
}

struct trace_grid bake_grid(const struct bake_layout *l, double cell_m, double depression_deg)
{
    const double pixel_m = l->pixel_mm / 1000.0;
    const double rows = fmax(l->origin_row, LM_CHIP_SIDE - l->origin_row);
    const double reach_m =
        fmax(rows * pixel_m, l->radius_m + l->height_m / tan_deg(depression_deg));
    const double across = 2 * ceil(LM_CHIP_SIDE / 2 * pixel_m / cell_m - 1e-9);
    const double range = 2 * ceil(reach_m * cos(depression_deg * pi / 180) / cell_m);
    return (struct trace_grid){
        .cells_across = (uint32_t)fmin(across, TRACE_CELLS_MAX),
        .cells_range = (uint32_t)fmin(range, TRACE_CELLS_MAX),
        .cell_m = cell_m,
    };
}
