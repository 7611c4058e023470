#include "infrared_curves.h"

#include "hs/atomic_file.h"
#include "hs/chart.h"
#include "hs/output_path.h"

#include <math.h>
#include <stdio.h>

enum { PATH_SIZE = 1024, MIDDLE = IR_KNOTS / 2 };

static double celsius(const struct ir_class_days *d, double hour)
{
    return ir_day_value(d->property[MIDDLE][MIDDLE], hour) - 273.15;
}

static int write_table(const char *folder, const struct db_class_table *table,
                       const struct ir_class_days *days)
{
    char path[PATH_SIZE];
    struct hs_atomic_file f;
    if (hs_output_path(path, sizeof path, folder, "infrared.csv") != 0 ||
        hs_atomic_open(&f, path) != 0) {
        return -1;
    }
    fputs("hour", f.stream);
    for (int c = 0; c < table->count; c++) {
        fprintf(f.stream, ",%s", table->items[c].name);
    }
    for (int half = 0; half < 48; half++) {
        fprintf(f.stream, "\n%g", half / 2.0);
        for (int c = 0; c < table->count; c++) {
            fprintf(f.stream, ",%.2f", celsius(&days[c], half / 2.0));
        }
    }
    fputc('\n', f.stream);
    return hs_atomic_commit(&f);
}

static double curve(void *days, double hour)
{
    return celsius(days, fmin(hour, 24));
}

static uint32_t ink_of(const struct db_class *c)
{
    return (uint32_t)c->colour[0] << 16 | (uint32_t)c->colour[1] << 8 | c->colour[2];
}

static int draw(const char *folder, const struct db_class_table *table,
                const struct ir_class_days *days)
{
    char path[PATH_SIZE];
    struct sheet sheet;
    if (hs_output_path(path, sizeof path, folder, "infrared.png") != 0 ||
        sheet_open(&sheet, 1000, 600) != 0) {
        return -1;
    }
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int c = 0; c < table->count; c++) {
        for (int i = 0; i < IR_STEPS; i++) {
            const double t = days[c].property[MIDDLE][MIDDLE][i] - 273.15;
            low = fmin(low, t);
            high = fmax(high, t);
        }
    }
    const struct chart chart = {.sheet = &sheet,
                                .left = 80,
                                .top = 40,
                                .width = 680,
                                .height = 480,
                                .x_high = 24,
                                .x_step = 3,
                                .y_low = 10 * floor(low / 10),
                                .y_high = 10 * ceil(high / 10 + 0.01),
                                .y_step = 10,
                                .title = "Surface temperature, C",
                                .x_name = "local solar hour"};
    chart_axes(&chart);
    for (int c = 0; c < table->count; c++) {
        const uint32_t ink = ink_of(&table->items[c]);
        chart_curve(&chart, curve, (void *)&days[c], 240, ink);
        sheet_text(&sheet, 780, 40 + 24 * c, table->items[c].name, ink);
    }
    return sheet_close(&sheet, path);
}

int infrared_curves_write(const char *folder, const struct db_class_table *table,
                          const struct ir_class_days *days)
{
    return write_table(folder, table, days) != 0 ? -1 : draw(folder, table, days);
}
