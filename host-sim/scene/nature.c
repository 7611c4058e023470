/* What would be there without people. */
#include "noise.h"
#include "painters.h"

#include <math.h>

enum { NOISE_EDGE = 300 };

enum { TEXTURE_SIDE = 512 };

/* Noise made once and laid out like tiles: nature needs some at every sub-pixel. */
struct texture {
    float value[TEXTURE_SIDE * TEXTURE_SIDE]; /* -1..1 */
};

static void make_texture(struct texture *t, uint64_t seed)
{
    for (int y = 0; y < TEXTURE_SIDE; y++) {
        for (int x = 0; x < TEXTURE_SIDE; x++) {
            t->value[y * TEXTURE_SIDE + x] =
                (float)noise_fractal(noise_hash(seed, NOISE_EDGE, 0), x / 16.0, y / 16.0, 4);
        }
    }
}

/* A coordinate on a tile whose neighbours are its mirror images, so that no seam shows. */
static int mirrored(double x)
{
    const int i = (int)floor(x) & (2 * TEXTURE_SIDE - 1);
    return i < TEXTURE_SIDE ? i : 2 * TEXTURE_SIDE - 1 - i;
}

/* The texture at a place, `scale_m` to one of its cells. */
static double texture_at(const struct texture *t, double east_m, double north_m, double scale_m)
{
    return t->value[mirrored(north_m / scale_m) * TEXTURE_SIDE + mirrored(east_m / scale_m)];
}

/* The fields of the land at one place. */
struct site {
    double height_m, shore_m, lake_m, wood, slope;
    double edge;  /* fine noise, -1..1 */
    double broad; /* coarse noise, -1..1 */
    struct point at, mouth;
};

struct cell {
    enum material material;
    double height_m;
};

static struct cell sea_cell(const struct site *s)
{
    const double out = -s->shore_m + 60 * s->broad + 25 * s->edge;
    if (out + 0.12 * point_distance(s->at, s->mouth) < 420 + 150 * s->broad) {
        return (struct cell){SEA_TURBID, 0};
    }
    return (struct cell){out < 190 ? SEA_SHALLOW : SEA_DEEP, 0};
}

static struct cell shore_cell(const struct site *s)
{
    const double shore = s->shore_m + 6 * s->edge;
    if (s->slope > 0.22) {
        return (struct cell){ROCK, 0};
    }
    return (struct cell){shore < 9 ? SAND_WET : SAND, 0};
}

static struct cell wood_cell(const struct site *s)
{
    const bool is_conifer = s->broad + 0.0022 * (s->height_m - 190) + 0.25 * s->edge > 0;
    return (struct cell){is_conifer ? CONIFER : BROADLEAF, (is_conifer ? 16 : 12) + 3 * s->edge};
}

static struct cell land_cell(const struct site *s)
{
    const double beach = 34 + 26 * s->broad + 8 * s->edge;
    if (s->shore_m < (s->slope > 0.22 ? 22 : beach)) {
        return shore_cell(s);
    }
    if (s->slope > 0.98 + 0.2 * s->edge || s->height_m > 520 + 120 * s->edge + 90 * s->broad) {
        return (struct cell){ROCK, 0};
    }
    if (s->wood + 0.05 * s->edge > 0) {
        return wood_cell(s);
    }
    if (s->slope > 0.16 + 0.03 * s->edge || s->height_m > 190 + 40 * s->broad) {
        return s->broad + 0.5 * s->edge > -0.1 ? (struct cell){MAQUIS, 1} : (struct cell){GRASS, 0};
    }
    return (struct cell){MEADOW, 0};
}

static struct cell cell_at(const struct site *s)
{
    if (s->shore_m + 3 * s->edge < 0) {
        return sea_cell(s);
    }
    if (s->lake_m + 3 * s->edge > 0) {
        const bool has_algae = s->lake_m + 70 * s->edge < 60 && s->broad > 0;
        return (struct cell){has_algae ? LAKE_ALGAE : LAKE_WATER, 0};
    }
    return land_cell(s);
}

static void paint_row(struct scene *s, const struct texture *t, int y)
{
    struct canvas *c = &s->canvas;
    const double half_m = 0.5 * c->side * c->cell_m;
    const double north = half_m - (y + 0.5) * c->cell_m;
    const struct land *l = &s->land;
    for (int x = 0; x < c->side; x++) {
        const double east = (x + 0.5) * c->cell_m - half_m;
        const struct land_reader r = land_reader_at(l, east, north);
        const struct site site = {land_read(&r, l->height_m),
                                  land_read(&r, l->shore_m),
                                  land_read(&r, l->lake_m),
                                  land_read(&r, l->wood),
                                  land_read(&r, l->slope),
                                  texture_at(t, east, north, 3.1),
                                  texture_at(t, north, -east, 37),
                                  land_to_design(east, north),
                                  l->river[0]};
        const struct cell cell = cell_at(&site);
        const size_t i = (size_t)y * (size_t)c->side + (size_t)x;
        c->material[i] = (uint8_t)cell.material;
        c->height_hm[i] = (uint8_t)(2 * cell.height_m + 0.5);
        /* Two scales of difference from place to place, within one standard deviation or so. */
        const double shade = 128 + 60 * texture_at(t, -north, east, 9) + 50 * site.edge;
        c->variant[i] = (uint8_t)shade;
    }
}

void scene_paint_nature(struct scene *s)
{
    struct texture t;
    make_texture(&t, s->seed);
    for (int y = 0; y < s->canvas.side; y++) {
        paint_row(s, &t, y);
    }
}
