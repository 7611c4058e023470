#include "scene/render.h"

#include "noise.h"

#include "hs/error.h"
#include "hs/progress.h"

#include <math.h>
#include <stdlib.h>

enum { NOISE_SENSOR = 900, VARIANTS = 256 };

#define SHADE_LIGHT 0.42 /* of the light that remains in a shadow, from the sky */
#define NOISE_DN    22.0 /* one standard deviation of the sensor's noise, plus 0.8 % of the signal */
#define NOISE_SHARE 0.008

enum { REACH_MAX = 64 };

/* The spectra of all materials in all their looks, and the way of a ray towards the sun. */
struct palette {
    float reflectance[MATERIAL_COUNT][VARIANTS][BAND_COUNT];
    int reach; /* steps after which a ray is above everything */
    int dx[REACH_MAX], dy[REACH_MAX], rise_hm[REACH_MAX];
};

static void mix_palette(struct palette *p)
{
    static const double green_effect[BAND_COUNT] = {-0.5, -0.4, -1.0, 1.0, -0.2, -0.5};
    for (int m = 0; m < MATERIAL_COUNT; m++) {
        const struct material_look *look = material_look((enum material)m);
        for (int v = 0; v < VARIANTS; v++) {
            /* A uniform byte times this has variance 1; the sine makes a second, unrelated one. */
            const double bright = 1 + look->spread * (v - 127.5) / 73.9;
            const double green = look->greenness * 1.4 * sin(v * 0.37);
            for (int b = 0; b < BAND_COUNT; b++) {
                p->reflectance[m][v][b] =
                    (float)(look->reflectance[b] * bright * (1 + green * green_effect[b]));
            }
        }
    }
}

/* The highest thing stands 50 m tall. */
static void aim_at_sun(struct palette *p, double cell_m)
{
    const double flat = hypot(LAND_SUN_EAST, LAND_SUN_NORTH);
    const double rise_hm = 2 * cell_m * LAND_SUN_UP / flat;
    p->reach = 0;
    for (int k = 1; k * rise_hm < 100 && p->reach < REACH_MAX; k++) {
        p->dx[p->reach] = (int)lround(k * LAND_SUN_EAST / flat);
        p->dy[p->reach] = (int)lround(-k * LAND_SUN_NORTH / flat);
        p->rise_hm[p->reach++] = (int)(k * rise_hm);
    }
}

/* Does something towards the sun stand high enough to shade this sub-pixel? */
static bool is_shaded(const struct canvas *c, const struct palette *p, int x, int y)
{
    const int height = c->height_hm[(size_t)y * (size_t)c->side + (size_t)x];
    for (int k = 0; k < p->reach && height + p->rise_hm[k] < 100; k++) {
        const int sx = x + p->dx[k], sy = y + p->dy[k];
        if (sx >= c->side || sy >= c->side) {
            return false;
        }
        if (c->height_hm[(size_t)sy * (size_t)c->side + (size_t)sx] > height + p->rise_hm[k]) {
            return true;
        }
    }
    return false;
}

/* What the sub-pixels of one pixel come to. */
struct sum {
    double reflectance[BAND_COUNT];
    int votes[CLASS_COUNT];
    int standing;
    double height_hm;
};

static void add_sub_pixel(const struct scene *s, const struct palette *p, int x, int y,
                          struct sum *sum)
{
    const struct canvas *c = &s->canvas;
    const size_t i = (size_t)y * (size_t)c->side + (size_t)x;
    const float *look = p->reflectance[c->material[i]][c->variant[i]];
    const double light = is_shaded(c, p, x, y) ? SHADE_LIGHT : 1;
    for (int b = 0; b < BAND_COUNT; b++) {
        sum->reflectance[b] += light * (double)look[b];
    }
    sum->votes[material_look((enum material)c->material[i])->group]++;
    sum->standing += c->height_hm[i] > 0;
    sum->height_hm += c->height_hm[i];
}

static enum material_class winner(const int *votes)
{
    int best = 0;
    for (int k = 1; k < CLASS_COUNT; k++) {
        best = votes[k] > votes[best] ? k : best;
    }
    return (enum material_class)best;
}

/* Nearly normal, mean 0 and variance 1: the sum of four 16-bit numbers, with no logarithm. */
static double quick_normal(uint64_t bits)
{
    const double sum = (double)(bits & 0xffff) + (double)(bits >> 16 & 0xffff) +
                       (double)(bits >> 32 & 0xffff) + (double)(bits >> 48);
    return (sum - 131070.0) / 37837.0;
}

static void finish_pixel(const struct scene *s, const struct sum *sum, double sun, int x, int y,
                         struct picture *p)
{
    const double parts = CANVAS_SUB * CANVAS_SUB;
    const size_t i = (size_t)y * (size_t)s->size + (size_t)x;
    const enum material_class group = winner(sum->votes);
    /* Water has no slope to be lit by, and a little of the light is from the whole sky. */
    const double light = group == CLASS_WATER ? 1 : 0.25 + 0.75 * sun;
    for (int b = 0; b < BAND_COUNT; b++) {
        const double signal = light * sum->reflectance[b] / parts;
        const uint64_t bits = noise_hash(s->seed + NOISE_SENSOR, (int64_t)i, b);
        const double dn = signal + (NOISE_DN + NOISE_SHARE * signal) * quick_normal(bits);
        p->image[i * BAND_COUNT + (size_t)b] = (uint16_t)(fmin(fmax(dn, 1), 65534) + 0.5);
    }
    p->truth[i] = (uint8_t)group;
    p->height_m[i] =
        sum->standing * 2 >= (int)parts ? (float)(0.5 * sum->height_hm / sum->standing) : 0;
}

static void render_row(const struct scene *s, const struct palette *palette, int y,
                       struct picture *p)
{
    const double half_m = 0.5 * s->size * s->cell_m;
    for (int x = 0; x < s->size; x++) {
        struct sum sum = {0};
        for (int k = 0; k < CANVAS_SUB * CANVAS_SUB; k++) {
            add_sub_pixel(s, palette, CANVAS_SUB * x + k % CANVAS_SUB,
                          CANVAS_SUB * y + k / CANVAS_SUB, &sum);
        }
        const struct land_reader r = land_reader_at(&s->land, (x + 0.5) * s->cell_m - half_m,
                                                    half_m - (y + 0.5) * s->cell_m);
        finish_pixel(s, &sum, land_read(&r, s->land.light), x, y, p);
    }
}

int render_picture(const struct scene *s, struct picture *p)
{
    const size_t n = (size_t)s->size * (size_t)s->size;
    struct palette *palette = malloc(sizeof *palette);
    p->image = malloc(n * BAND_COUNT * sizeof *p->image);
    p->truth = malloc(n);
    p->height_m = malloc(n * sizeof *p->height_m);
    if (!palette || !p->image || !p->truth || !p->height_m) {
        free(palette);
        render_free(p);
        return hs_error("image", "make the scene smaller", "out of memory");
    }
    mix_palette(palette);
    aim_at_sun(palette, s->canvas.cell_m);
    struct hs_progress progress;
    hs_progress_begin(&progress, "imaging the scene", (uint64_t)s->size);
    for (int y = 0; y < s->size; y++) {
        render_row(s, palette, y, p);
        hs_progress_update(&progress, (uint64_t)y);
    }
    hs_progress_end(&progress);
    free(palette);
    return 0;
}

void render_free(struct picture *p)
{
    free(p->image);
    free(p->truth);
    free(p->height_m);
    *p = (struct picture){0};
}
