#include "netem/report.h"

#include "hs/chart.h"
#include "hs/error.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

static const uint32_t inks[] = {0x1040c0, 0xc02020, 0x208030, 0xb06000,
                                0x7030a0, 0x107080, 0x606060, 0x000000};
enum { INKS = sizeof inks / sizeof inks[0], LETTER = 12, SAMPLES = 721 };

/* Names of curves in their inks, below a chart. */
static void draw_key(struct sheet *s, int x, int y, const char *name, int curve)
{
    sheet_line(s, x, y + LETTER / 2, x + 22, y + LETTER / 2, inks[curve % INKS]);
    sheet_line(s, x, y + LETTER / 2 + 1, x + 22, y + LETTER / 2 + 1, inks[curve % INKS]);
    sheet_text(s, x + 28, y, name, INK_BLACK);
}

/* ---- losses ---- */

static double log_loss(const struct nm_loss_curve *curve, int i)
{
    const double loss = curve->epochs[i].validation;
    return loss > 0 ? log10(loss) : NAN;
}

static double loss_at(void *ctx, double epoch)
{
    const struct nm_loss_curve *curve = ctx;
    const int i = (int)fmin(fmax(floor(epoch) - 1, 0), curve->count - 1);
    const int next = i + 1 < curve->count ? i + 1 : i;
    const double from = log_loss(curve, i);
    return from + (log_loss(curve, next) - from) * (epoch - 1 - i);
}

static void loss_bounds(const struct nm_loss_curve *curves, int count, struct chart *c)
{
    double low = INFINITY, high = -INFINITY;
    int epochs = 2;
    for (int k = 0; k < count; k++) {
        epochs = curves[k].count > epochs ? curves[k].count : epochs;
        for (int i = 0; i < curves[k].count; i++) {
            const double loss = curves[k].epochs[i].validation;
            low = loss > 0 ? fmin(low, log10(loss)) : low;
            high = loss > 0 ? fmax(high, log10(loss)) : high;
        }
    }
    c->y_low = isfinite(low) ? floor(low * 4 - 0.5) / 4 : -4;
    c->y_high = isfinite(high) ? ceil(high * 4 + 0.5) / 4 : 0;
    c->y_step = c->y_high - c->y_low > 1.6 ? 0.5 : 0.25;
    c->x_low = 1;
    c->x_high = epochs;
    c->x_step = fmax(1, pow(10, floor(log10(epochs / 4.0))));
    c->x_step *= epochs / c->x_step > 12 ? 5 : 1;
}

int nm_report_losses(const char *path, const char *title, const struct nm_loss_curve *curves,
                     int count)
{
    struct sheet s;
    if (sheet_open(&s, 900, 520 + 22 * (count + 1)) != 0) {
        return -1;
    }
    struct chart c = {.sheet = &s, .left = 80, .top = 50, .width = 780, .height = 400};
    c.title = title;
    c.x_name = "epoch";
    loss_bounds(curves, count, &c);
    chart_axes(&c);
    sheet_text(&s, 80, 475, "log10 of the loss on validation chips", INK_BLACK);
    for (int k = 0; k < count; k++) {
        struct nm_loss_curve curve = curves[k];
        struct chart own = c;
        own.x_high = curves[k].count;
        own.width = (int)lround(c.width * (own.x_high - 1) / (c.x_high - 1));
        if (curves[k].count > 1) {
            chart_curve(&own, loss_at, &curve, 4 * curves[k].count, inks[k % INKS]);
        }
        draw_key(&s, 80, 500 + 22 * k, curves[k].name, k);
    }
    return sheet_close(&s, path);
}

/* ---- learned laws ---- */

struct law_line {
    const struct nm_model *model;
    const struct nm_materials *materials;
    const struct reflect_law *law;
    enum nm_direction direction;
    int material;
    double incidence_rad;
};

/* Fig. 20 runs over the angle of incidence; Fig. 21 over that of the echo, in the plane of
 * incidence, positive on the side that the ray comes from. */
static struct nm_reflection reflection_at(const struct law_line *line, double degrees)
{
    const double angle = degrees * pi / 180;
    const struct nm_surface surface = line->materials->surfaces[line->material];
    if (line->direction == NM_SP) {
        return (struct nm_reflection){angle, angle, 2 * angle, line->material, surface, 0};
    }
    return (struct nm_reflection){
        line->incidence_rad, fabs(angle), fabs(line->incidence_rad - angle),
        line->material,      surface,     0};
}

static double learned_at(void *ctx, double degrees)
{
    const struct law_line *line = ctx;
    const struct nm_reflection r = reflection_at(line, degrees);
    return nm_netem_ask(line->model->architecture, line->model->values, &r, line->direction, 1);
}

static void draw_law(const struct chart *c, struct law_line *line, int curve)
{
    chart_curve(c, learned_at, line, SAMPLES, inks[curve % INKS]);
    const double step = (c->x_high - c->x_low) / 45;
    for (double x = c->x_low; line->law && x <= c->x_high + 1e-9; x += step) {
        const struct nm_reflection r = reflection_at(line, x);
        const double y = nm_law_ask(line->law, &r, line->direction);
        const double px = c->left + c->width * (x - c->x_low) / (c->x_high - c->x_low);
        const double py = c->top + c->height * (c->y_high - fmin(y, c->y_high)) / c->y_high;
        for (int i = 0; i < 9; i++) {
            sheet_dot(c->sheet, (int)px + i % 3 - 1, (int)py + i / 3 - 1, inks[curve % INKS]);
        }
    }
}

static const char *material_name(const struct reflect_law *law, int material, char *text,
                                 size_t size)
{
    const char *name = law ? law->materials[material].name : "";
    snprintf(text, size, "material %d %s", material, name);
    return text;
}

int nm_report_specular(const char *path, const struct nm_model *model,
                       const struct nm_materials *materials, int material_count,
                       const struct reflect_law *law)
{
    struct sheet s;
    char text[64];
    if (sheet_open(&s, 760, 500 + 22 * material_count) != 0) {
        return -1;
    }
    const struct chart c = {&s,
                            60,
                            50,
                            660,
                            360,
                            0,
                            90,
                            10,
                            0,
                            1,
                            0.1,
                            "learned coefficient, specular",
                            "angle of incidence, degrees"};
    chart_axes(&c);
    for (int m = 0; m < material_count; m++) {
        struct law_line line = {model, materials, law, NM_SP, m, 0};
        draw_law(&c, &line, m);
        draw_key(&s, 60, 465 + 22 * m, material_name(law, m, text, sizeof text), m);
    }
    return sheet_close(&s, path);
}

/* The top of the scale: the largest learned value, rounded up to a tenth. */
static double back_top(const struct nm_model *model, const struct nm_materials *materials,
                       int material)
{
    double most = 0.1;
    for (int t = 0; t <= 75; t += 15) {
        struct law_line line = {model, materials, NULL, NM_BK, material, t * pi / 180};
        for (int x = -90; x <= 90; x += 5) {
            most = fmax(most, learned_at(&line, x));
        }
    }
    return ceil(most * 10 - 1e-9) / 10;
}

int nm_report_back(const char *path, const struct nm_model *model,
                   const struct nm_materials *materials, int material_count,
                   const struct reflect_law *law)
{
    struct sheet s;
    char text[64];
    if (sheet_open(&s, 760, 30 + 380 * material_count + 40) != 0) {
        return -1;
    }
    for (int m = 0; m < material_count; m++) {
        const double top = back_top(model, materials, m);
        const struct chart c = {&s,
                                60,
                                40 + 380 * m,
                                660,
                                290,
                                -90,
                                90,
                                15,
                                0,
                                top,
                                top / 5,
                                material_name(law, m, text, sizeof text),
                                "echo angle, deg; + where the ray came from"};
        chart_axes(&c);
        for (int t = 0; t <= 75; t += 15) {
            struct law_line line = {model, materials, law, NM_BK, m, t * pi / 180};
            draw_law(&c, &line, t / 15);
        }
    }
    for (int t = 0; t <= 75; t += 15) {
        snprintf(text, sizeof text, "in %d", t);
        draw_key(&s, 60 + 115 * (t / 15), 40 + 380 * material_count, text, t / 15);
    }
    return sheet_close(&s, path);
}

/* ---- kernels ---- */

static void draw_square(struct sheet *s, int left, int top, const double *values, int side,
                        int zoom, double low, double high)
{
    for (int i = 0; i < side * zoom * side * zoom; i++) {
        const int x = i % (side * zoom), y = i / (side * zoom);
        const double v = (values[y / zoom * side + x / zoom] - low) / (high - low);
        const uint32_t grey = (uint32_t)lround(255 * fmin(fmax(v, 0), 1));
        sheet_dot(s, left + x, top + y, grey << 16 | grey << 8 | grey);
    }
}

static void draw_large(struct sheet *s, int left, int top, const double *kernel, int zoom)
{
    double *db = malloc(NM_LARGE * NM_LARGE * sizeof *db), most = 0;
    for (int i = 0; i < NM_LARGE * NM_LARGE; i++) {
        most = fmax(most, fabs(kernel[i]));
    }
    for (int i = 0; db && i < NM_LARGE * NM_LARGE; i++) {
        db[i] = 20 * log10(fmax(fabs(kernel[i]), 1e-9 * most) / most);
    }
    if (db) {
        draw_square(s, left, top, db, NM_LARGE, zoom, -60, 0);
    }
    free(db);
}

int nm_report_kernels(const char *path, const struct nm_model *model)
{
    enum { ZOOM = 4, SMALL_ZOOM = 16, SIDE = NM_LARGE * ZOOM };
    struct sheet s;
    if (sheet_open(&s, 2 * SIDE + 60, SIDE + 60 + 2 * NM_SMALL * SMALL_ZOOM) != 0) {
        return -1;
    }
    const struct nm_pix_values *pix = nm_model_pix(model, model->values);
    sheet_text(&s, 20, 12, "impulse response, 60 dB", INK_BLACK);
    sheet_text(&s, 40 + SIDE, 12, "large kernel, 60 dB", INK_BLACK);
    draw_large(&s, 20, 36, model->kernel, ZOOM);
    draw_large(&s, 40 + SIDE, 36, pix->large, ZOOM);
    sheet_text(&s, 20, SIDE + 56, "small kernels, least to largest value", INK_BLACK);
    for (int k = 0; k < NM_SMALL_KERNELS; k++) {
        double low = INFINITY, high = -INFINITY;
        for (int i = 0; i < NM_SMALL * NM_SMALL; i++) {
            low = fmin(low, pix->small[k][i]);
            high = fmax(high, pix->small[k][i]);
        }
        draw_square(&s, 20 + k * (NM_SMALL * SMALL_ZOOM + 20), SIDE + 80, pix->small[k], NM_SMALL,
                    SMALL_ZOOM, low, high > low ? high : low + 1);
    }
    return sheet_close(&s, path);
}

/* ---- chips side by side ---- */

static void draw_chip(struct sheet *s, int left, int top, const double *pixels, int side, int zoom)
{
    for (int i = 0; i < side * zoom * side * zoom; i++) {
        const int x = i % (side * zoom), y = i / (side * zoom);
        const double v = sqrt(fmin(fmax(pixels[(side - 1 - y / zoom) * side + x / zoom], 0), 1));
        const uint32_t grey = (uint32_t)lround(255 * v);
        sheet_dot(s, left + x, top + y, grey << 16 | grey << 8 | grey);
    }
}

int nm_report_table(const char *path, const double *const *pictures, int count, int rows, int side,
                    const char *const *titles, const char *const *names)
{
    const int zoom = side <= 108 ? 2 : 1, cell = side * zoom + 12, left = 190;
    struct sheet s;
    if (sheet_open(&s, left + count * cell + 20, 40 + rows * cell + 10) != 0) {
        return -1;
    }
    for (int r = 0; r < rows; r++) {
        sheet_text(&s, 14, 40 + r * cell + cell / 2, titles[r], INK_BLACK);
        for (int k = 0; k < count; k++) {
            draw_chip(&s, left + k * cell, 40 + r * cell, pictures[k * rows + r], side, zoom);
        }
    }
    for (int k = 0; k < count; k++) {
        sheet_text(&s, left + k * cell, 16, names[k], INK_BLACK);
    }
    return sheet_close(&s, path);
}

/* ---- scores over azimuth ---- */

static void draw_marks(const struct chart *c, const struct nm_score_curve *curve, uint32_t ink)
{
    for (int i = 0; i < curve->count; i++) {
        const double turn = curve->azimuth_deg[i] - 360 * floor(curve->azimuth_deg[i] / 360);
        const double x = c->left + c->width * turn / 360;
        const double share = (curve->score[i] - c->y_low) / (c->y_high - c->y_low);
        const double y = c->top + c->height * (1 - fmin(fmax(share, 0), 1));
        for (int d = -3; d <= 3; d++) {
            sheet_line(c->sheet, x - 3 + abs(d), y + d, x + 3 - abs(d), y + d, ink);
        }
    }
}

int nm_report_scores(const char *path, const char *title, const struct nm_score_curve *curves,
                     int count)
{
    struct sheet s;
    double low = 1, high = 0;
    if (sheet_open(&s, 900, 500 + 22 * count) != 0) {
        return -1;
    }
    for (int k = 0; k < count; k++) {
        for (int i = 0; i < curves[k].count; i++) {
            low = fmin(low, curves[k].score[i]);
            high = fmax(high, curves[k].score[i]);
        }
    }
    const struct chart c = {&s,
                            70,
                            50,
                            790,
                            360,
                            0,
                            360,
                            30,
                            floor(low * 10) / 10,
                            ceil(high * 10) / 10,
                            0.05,
                            title,
                            "azimuth, degrees"};
    chart_axes(&c);
    for (int k = 0; k < count; k++) {
        draw_marks(&c, &curves[k], inks[k % INKS]);
        draw_key(&s, 70, 465 + 22 * k, curves[k].name, k);
    }
    return sheet_close(&s, path);
}
