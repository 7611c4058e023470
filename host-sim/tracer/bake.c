#include "tracer/bake.h"

#include "hs/angle.h"
#include "hs/error.h"
#include "hs/progress.h"
#include "tracer/scene.h"
#include "tracer/trace.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = LM_CHIP_SIDE * LM_CHIP_SIDE, CODE_MAX = 255, SHADOW_RAYS = 4 /* a pixel, aside */ };

static const double pi = 3.14159265358979323846;

/* Ground is looked at from so high: clear of the rounding of single precision. */
static const double ground_lift_m = 1e-3;

struct baking {
    const struct bake_order *order;
    struct scene scene;       /* owned */
    float *power;             /* owned: PIXELS of each chip */
    double total_m2, lost_m2; /* before the gain; lost: outside the chips */
};

/* ---- where echoes lie on the ground ---- */

/* Part of the stretch low..high that lies in low pixel `i`. */
static double share_in(double low, double high, int i)
{
    return fmax(fmin(high, i + 1) - fmax(low, i), 0) / (high - low);
}

/* Cut to the pixels of a chip. */
static int pixel_of(double at)
{
    return (int)fmin(fmax(floor(at), 0), LM_CHIP_SIDE - 1);
}

/* Add the power of a cell that covers these stretches of rows and columns to the pixels it covers.
 */
static void add_cell(float *chip, const double rows[2], const double columns[2], double power)
{
    for (int r = pixel_of(rows[0]); r <= pixel_of(rows[1]); r++) {
        const double in_row = power * share_in(rows[0], rows[1], r);
        for (int c = pixel_of(columns[0]); c <= pixel_of(columns[1]); c++) {
            chip[r * LM_CHIP_SIDE + c] += (float)(in_row * share_in(columns[0], columns[1], c));
        }
    }
}

static double sum_of(const float *power, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        sum += (double)power[i];
    }
    return sum;
}

/* From cells of slant range to pixels of ground. */
static void lay_down(struct baking *b, const struct trace_records *r, const float *cells,
                     float *chip)
{
    const struct trace_grid *g = &r->grid;
    const double pixel_m = b->order->layout.pixel_mm / 1000.0;
    const double across_px = g->cell_m / pixel_m;
    const double range_px = across_px / cos(r->look.depression_deg * pi / 180);
    for (uint32_t i = 0; i < g->cells_across * g->cells_range; i++) {
        if (cells[i] > 0) {
            const double row = (double)(i / g->cells_across) - g->cells_range / 2.0;
            const double column = (double)(i % g->cells_across) - g->cells_across / 2.0;
            const double row_px = b->order->layout.origin_row + row * range_px;
            const double column_px = LM_CHIP_SIDE / 2 + column * across_px;
            add_cell(chip, (const double[2]){row_px, row_px + range_px},
                     (const double[2]){column_px, column_px + across_px}, (double)cells[i]);
        }
    }
    const double all_m2 = sum_of(cells, (size_t)g->cells_across * g->cells_range);
    b->total_m2 += all_m2;
    b->lost_m2 += all_m2 - sum_of(chip, PIXELS);
}

/* ---- one look ---- */

/* The ground's first reflection is the scene's, not the target's. */
static void mute_ground(struct trace_records *r)
{
    for (uint32_t i = 0; i < r->bounces[0].count; i++) {
        struct trace_record *t = &r->bounces[0].records[i];
        if (strcmp(r->materials[t->material], "ground") == 0) {
            t->flags |= TRACE_BLOCKED;
        }
    }
}

static struct trace_order trace_order_of(const struct bake_order *o, long aspect, int depression)
{
    const double depression_deg = o->looks.depression_deg[depression];
    const double quarter_m = o->layout.pixel_mm / 4000.0;
    return (struct trace_order){
        .look = {bake_azimuth_deg(&o->looks, aspect), depression_deg, o->wavelength_m},
        .grid =
            o->grid.cells_across > 0 ? o->grid : bake_grid(&o->layout, quarter_m, depression_deg),
        .rays_per_cell = o->rays_per_cell,
        .bounces = o->bounces,
        .threads = o->threads,
    };
}

static int draw_cells(struct baking *b, const struct trace_records *r, float *chip)
{
    float *cells = malloc((size_t)r->grid.cells_across * r->grid.cells_range * sizeof *cells);
    if (!cells) {
        return hs_error("chip", "bake with larger pixels", "out of memory");
    }
    const int result = b->order->maker.draw(b->order->maker.ctx, r, cells);
    if (result == 0) {
        lay_down(b, r, cells, chip);
    }
    free(cells);
    return result;
}

static int draw_look(struct baking *b, const struct trace_order *order, float *chip)
{
    struct trace_records r;
    if (trace_run(&b->scene, order, b->order->place, &r, NULL) != 0) {
        return -1;
    }
    mute_ground(&r);
    const int result = draw_cells(b, &r, chip);
    trace_records_free(&r);
    return result;
}

/* Is most of the ground of a pixel hidden? */
static bool is_in_shadow(const struct baking *b, const struct trace_axes *axes, int row, int column)
{
    const double pixel_m = b->order->layout.pixel_mm / 1000.0;
    int hidden = 0;
    for (int first = 0; first < SHADOW_RAYS * SHADOW_RAYS; first += SCENE_PACKET) {
        struct scene_rays rays = {.count = 0};
        for (int k = 0; k < SCENE_PACKET; k++) {
            const int ray = first + k;
            const double down = row + (ray / SHADOW_RAYS + 0.5) / SHADOW_RAYS;
            const double aside = column + (ray % SHADOW_RAYS + 0.5) / SHADOW_RAYS;
            const double away_m = (down - b->order->layout.origin_row) * pixel_m;
            struct vec from = vec_mad(vec_scale(axes->away, away_m), axes->across,
                                      (aside - LM_CHIP_SIDE / 2) * pixel_m);
            from.z = ground_lift_m;
            scene_rays_add(&rays, from, vec_scale(axes->sight, -1));
        }
        hidden += __builtin_popcount(scene_is_blocked(&b->scene, &rays));
    }
    return hidden * 2 > SHADOW_RAYS * SHADOW_RAYS;
}
_Static_assert(SHADOW_RAYS *SHADOW_RAYS % SCENE_PACKET == 0, "packets are full");

static void cast_shadow(const struct baking *b, const struct trace_look *look, struct lm_chip *chip)
{
    const struct trace_axes axes = trace_axes_of(look);
    for (int row = 0; row < LM_CHIP_SIDE; row++) {
        for (int column = 0; column < LM_CHIP_SIDE; column++) {
            const int bit = is_in_shadow(b, &axes, row, column) << column % 8;
            chip->shadow[row][column / 8] |= (uint8_t)bit;
        }
    }
}

static int draw_all(struct baking *b, struct db_signature *s)
{
    const long aspects = b->order->looks.aspects;
    const uint32_t chips = db_signature_chips(&s->head);
    struct hs_progress progress;
    int result = 0;
    hs_progress_begin(&progress, "looks", chips);
    for (uint32_t i = 0; result == 0 && i < chips; i++) {
        const struct trace_order order =
            trace_order_of(b->order, i % (uint32_t)aspects, (int)(i / (uint32_t)aspects));
        result = draw_look(b, &order, b->power + (size_t)i * PIXELS);
        if (result == 0) {
            cast_shadow(b, &order.look, &s->chips[i]);
        }
        hs_progress_update(&progress, i + 1);
    }
    hs_progress_end(&progress);
    return result;
}

/* ---- codes ---- */

static double dbsm_of(double rcs_m2)
{
    return rcs_m2 > 0 ? 10 * log10(rcs_m2) : -INFINITY;
}

/* Before rounding and the ends of the scale. */
static double half_decibels(double rcs_m2)
{
    return 2 * (dbsm_of(rcs_m2) + 80);
}

uint8_t bake_code(double rcs_m2)
{
    return (uint8_t)lround(fmin(fmax(half_decibels(rcs_m2), 0), CODE_MAX));
}

static double find_gain(const struct baking *b, uint32_t chips)
{
    const double mean_m2 = sum_of(b->power, (size_t)chips * PIXELS) / chips;
    return isnan(b->order->mean_dbsm) ? pow(10, b->order->gain_db / 10)
                                      : pow(10, b->order->mean_dbsm / 10) / mean_m2;
}

static void write_codes(const struct baking *b, double gain, struct db_signature *s,
                        struct bake_report *report)
{
    const uint32_t chips = db_signature_chips(&s->head);
    double sum = 0, least = INFINITY, most = 0;
    for (uint32_t i = 0; i < chips; i++) {
        const float *power = b->power + (size_t)i * PIXELS;
        const double whole_m2 = gain * sum_of(power, PIXELS);
        s->head.rcs[i / s->head.aspects][i % s->head.aspects] = bake_code(whole_m2);
        for (int k = 0; k < PIXELS; k++) {
            const double rcs_m2 = gain * (double)power[k];
            s->chips[i].level[k / LM_CHIP_SIDE][k % LM_CHIP_SIDE] = bake_code(rcs_m2);
            report->saturated += half_decibels(rcs_m2) > CODE_MAX + 0.5;
        }
        sum += whole_m2;
        least = fmin(least, whole_m2);
        most = fmax(most, whole_m2);
    }
    report->gain_db = 10 * log10(gain);
    report->mean_dbsm = dbsm_of(sum / chips);
    report->least_dbsm = dbsm_of(least);
    report->most_dbsm = dbsm_of(most);
    report->lost_share = b->total_m2 > 0 ? b->lost_m2 / b->total_m2 : 0;
}

/* ---- all of it ---- */

static void write_head(const struct bake_order *o, struct lm_signature *head)
{
    *head = (struct lm_signature){
        .aspects = (uint16_t)o->looks.aspects,
        .depressions = (uint8_t)o->looks.depressions,
        .origin_row = (uint8_t)o->layout.origin_row,
        .pixel_mm = o->layout.pixel_mm,
        .height_mm = (uint32_t)lround(o->layout.height_m * 1000),
    };
    memcpy(head->name, o->name, strlen(o->name));
    for (int d = 0; d < o->looks.depressions; d++) {
        head->depression[d] = hs_bam(o->looks.depression_deg[d]);
    }
}

/* Ground for the look that sees most of it. */
static int open_scene(struct baking *b, const struct mesh *m)
{
    double half_m = 0;
    for (int d = 0; d < b->order->looks.depressions; d++) {
        const struct trace_order order = trace_order_of(b->order, 0, d);
        half_m = fmax(half_m, trace_ground_half_m(&order.grid, order.look.depression_deg));
    }
    return scene_open(&b->scene, m, half_m, b->order->place);
}

static int bake_scene(struct baking *b, struct db_signature *s, struct bake_report *report)
{
    if (draw_all(b, s) != 0) {
        return -1;
    }
    if (!(b->total_m2 - b->lost_m2 > 0)) {
        return hs_error(b->order->place, "look at it with `landmass-target sheet`",
                        "returns nothing to the radar from any side");
    }
    write_codes(b, find_gain(b, db_signature_chips(&s->head)), s, report);
    return 0;
}

int bake(const struct bake_order *o, const struct mesh *m, struct db_signature *s,
         struct bake_report *report)
{
    struct baking b = {.order = o};
    *s = (struct db_signature){.chips = NULL};
    *report = (struct bake_report){0};
    if (o->layout.height_m * 1000 > LM_SIGNATURE_HEIGHT_MAX_MM) {
        return hs_error(o->place, "give its size in metres with --scale", "is %.0f m high",
                        o->layout.height_m);
    }
    if (open_scene(&b, m) != 0) {
        return -1;
    }
    write_head(o, &s->head);
    const uint32_t chips = db_signature_chips(&s->head);
    s->chips = calloc(chips, sizeof *s->chips);
    b.power = calloc((size_t)chips * PIXELS, sizeof *b.power);
    const int result =
        s->chips && b.power ? bake_scene(&b, s, report) : hs_error(o->place, NULL, "out of memory");
    free(b.power);
    scene_close(&b.scene);
    if (result != 0) {
        db_signature_free(s);
    }
    return result;
}
