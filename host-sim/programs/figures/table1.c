#include "figures.h"

#include "hs/chart.h"
#include "lm/rcs.h"

#include <math.h>
#include <stdio.h>

static const double pi = 3.14159265358979323846;

/* Heaton, Table 1 as printed; its angles are those of a one-way pattern. */
static const struct row {
    double wavelengths, printed_deg, axis_deg, step_deg;
} rows[4] = {{3, 38, 30, 10}, {10, 12, 10, 2}, {100, 1, 1, 0.2}, {1000, 0.1, 0.1, 0.05}};

/* Both in decibels below the peak, at degrees from the normal. */
static double one_way_db(void *ctx, double degrees)
{
    const struct row *r = ctx;
    const double phase = pi * r->wavelengths * sin(degrees * pi / 180);
    return phase == 0 ? 0 : 20 * log10(fabs(sin(phase) / phase));
}

static double returned_db(void *ctx, double degrees)
{
    const struct row *r = ctx;
    const uint32_t side_mm = (uint32_t)lround(r->wavelengths * FIGURE_WAVELENGTH_M * 1e3);
    const struct lm_shape plate = {LM_SHAPE_PLATE, false, {side_mm, side_mm}};
    const uint32_t wavelength_um = (uint32_t)lround(FIGURE_WAVELENGTH_M * 1e6);
    const double angle = degrees * pi / 180, one = 1 << 30;
    const struct lm_direction ahead = {1 << 30, 0, 0};
    const struct lm_direction aside = {(int32_t)lround(cos(angle) * one),
                                       (int32_t)lround(sin(angle) * one), 0};
    return (lm_rcs_dbsm_q8(&plate, wavelength_um, aside) -
            lm_rcs_dbsm_q8(&plate, wavelength_um, ahead)) /
           256.0;
}

int table1_draw(const char *path)
{
    struct sheet sheet;
    if (sheet_open(&sheet, 1280, 840) != 0) {
        return -1;
    }
    for (int i = 0; i < 4; i++) {
        struct row r = rows[i];
        char title[80];
        snprintf(title, sizeof title, "PLATE OF %.0f WAVELENGTHS - DB BELOW PEAK", r.wavelengths);
        const struct chart c = {.sheet = &sheet,
                                .left = 80 + i % 2 * 640,
                                .top = 40 + i / 2 * 390,
                                .width = 520,
                                .height = 280,
                                .x_low = -r.axis_deg,
                                .x_high = r.axis_deg,
                                .x_step = r.step_deg,
                                .y_low = -40,
                                .y_high = 0,
                                .y_step = 10,
                                .title = title,
                                .x_name = "DEGREES FROM THE NORMAL"};
        chart_axes(&c);
        chart_curve(&c, one_way_db, &r, 1500, INK_RED);
        chart_curve(&c, returned_db, &r, 1500, INK_BLUE);
        for (int side = -1; side <= 1; side += 2) {
            chart_upright(&c, side * r.printed_deg / 2, INK_RED);
            chart_upright(&c, side * asin(1 / (2 * r.wavelengths)) * 180 / pi, INK_BLUE);
        }
    }
    sheet_text(&sheet, 80, 804, "RED - ONE WAY - DASHED THE NULLS AS HEATON PRINTS THEM", INK_RED);
    sheet_text(&sheet, 80, 822, "BLUE - THE RETURN OUT AND BACK AS THE FIRMWARE HAS IT", INK_BLUE);
    return sheet_close(&sheet, path);
}
