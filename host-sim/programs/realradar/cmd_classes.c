/* landmass-realradar classes */
#include "commands.h"

#include "gis/gdal_start.h"
#include "hs/error.h"
#include "hs/options.h"
#include "hs/output_path.h"
#include "hs/report.h"
#include "realradar/class_order.h"

#include <stdio.h>

static const struct hs_usage usage = {
    "classes", "rank and spread of the classes of a database beside a real radar picture",
    "Rank the classes of a database by a real radar's picture of the same ground, and show the "
    "simulated values beside the measured ones.\n"
    "\n"
    "Another band, angle or number of looks than the simulation's shifts the real levels: then "
    "judge the order and the spread alone. The simulated column has the firmware's speckle of 4 "
    "looks on the reflectivity. Spread is from 5 to 95 per cent of the pixels."};

static void print_spread(const struct rr_spread *s)
{
    printf(" %7.1f (%6.1f ..%6.1f) |", s->median, s->low, s->high);
}

static void report_spread(const char *key, const struct rr_spread *s)
{
    hs_report_object(key);
    hs_report_put("median_db", s->median);
    hs_report_put("low_db", s->low);
    hs_report_put("high_db", s->high);
    hs_report_close();
}

static void report_row(const struct rr_class_row *row, const char *name)
{
    hs_report_object(NULL);
    hs_report_put("name", name);
    hs_report_put("pixels", row->pixels);
    report_spread("measured", &row->measured);
    report_spread("database", &row->reflectivity);
    report_spread("simulated", &row->simulated);
    hs_report_close();
}

static const char *name_of(const struct db_class_table *table, const struct rr_class_row *row)
{
    return table->items[row->class_index].name;
}

/* Rows are in the measured order, so a disagreement is a pair whose simulated medians fall. */
static int print_pairs(const struct rr_class_order *order, const struct db_class_table *table)
{
    int agreeing = 0;
    for (int i = 0; i < order->count; i++) {
        for (int k = i + 1; k < order->count; k++) {
            const struct rr_class_row *dark = &order->rows[i], *bright = &order->rows[k];
            if (dark->reflectivity.median < bright->reflectivity.median) {
                agreeing++;
                continue;
            }
            printf("differs: measured %s is %.1f dB below %s, simulated %.1f dB above\n",
                   name_of(table, dark), bright->measured.median - dark->measured.median,
                   name_of(table, bright), dark->reflectivity.median - bright->reflectivity.median);
        }
    }
    return agreeing;
}

static void print_order(const struct rr_class_order *order, const struct db_class_table *table)
{
    printf("Median (5 .. 95 %%) in dB, the darkest to the real radar first:\n\n");
    printf(
        "| class | pixels | measured | database | with speckle, %d looks "
        "|\n|---|---|---|---|---|\n",
        RR_SIMULATED_LOOKS);
    hs_report_array("classes");
    for (int i = 0; i < order->count; i++) {
        const struct rr_class_row *row = &order->rows[i];
        report_row(row, name_of(table, row));
        printf("| %-10s | %6zu |", name_of(table, row), row->pixels);
        print_spread(&row->measured);
        print_spread(&row->reflectivity);
        print_spread(&row->simulated);
        printf("\n");
    }
    hs_report_close();
    printf("\n");
    const int agreeing = print_pairs(order, table);
    printf("pairs of classes in the same order: %d of %d\n", agreeing,
           order->count * (order->count - 1) / 2);
    hs_report_put("pairs", order->count * (order->count - 1) / 2);
    hs_report_put("pairs_in_order", agreeing);
    hs_report_put("class_rank_correlation", order->class_correlation);
    hs_report_put("pixel_rank_correlation", order->pixel_correlation);
    printf("rank correlation: %.2f of the classes, %.2f of the pixels\n", order->class_correlation,
           order->pixel_correlation);
}

struct files {
    const char *table, *class_raster, *reflectivity, *radar, *out;
};

static bool read_options(struct files *f, int argc, char **argv, int *exit_code)
{
    const struct hs_option options[] = {
        {"classes", HS_INPUT, &f->table, 0, 0, "FILE", "the class table of landmass-db", true},
        {"class-raster", HS_INPUT, &f->class_raster, 0, 0, "FILE", "from landmass-db segment",
         true},
        {"reflectivity", HS_INPUT, &f->reflectivity, 0, 0, "FILE", "from landmass-db reflect, dB",
         true},
        {"radar", HS_INPUT, &f->radar, 0, 0, "FILE",
         "the real radar on the same grid; its first band, dB", true},
        {"out", HS_FOLDER, &f->out, 0, 0, "DIR", "leave classes.png there", false},
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           exit_code);
}

int rr_cmd_classes(int argc, char **argv)
{
    struct files f = {0};
    int exit_code;
    if (!read_options(&f, argc, argv, &exit_code)) {
        return exit_code;
    }
    struct db_class_table table;
    struct rr_class_order order;
    char path[4096];
    db_gdal_start();
    if (db_class_table_read(&table, f.table) != 0 ||
        rr_class_order_compare(&order, &(struct rr_class_source){&table, f.class_raster,
                                                                 f.reflectivity, f.radar}) != 0) {
        return HS_EXIT_FAILED;
    }
    print_order(&order, &table);
    if (f.out && (hs_output_path(path, sizeof path, f.out, "classes.png") != 0 ||
                  rr_class_order_plot(&order, &table, path) != 0)) {
        return HS_EXIT_FAILED;
    }
    return HS_EXIT_OK;
}
