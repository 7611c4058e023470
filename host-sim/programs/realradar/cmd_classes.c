/* landmass-realradar classes */
#include "commands.h"
#include "options.h"

#include "gis/gdal_start.h"
#include "hs/error.h"
#include "hs/output_path.h"
#include "realradar/class_order.h"

#include <stdio.h>

static const char help_text[] =
    "usage: landmass-realradar classes --classes FILE --class-raster FILE\n"
    "           --reflectivity FILE --radar FILE [--out DIR]\n"
    "Rank the classes of a database by a real radar's picture of the same ground, and show the\n"
    "simulated values beside the measured ones.\n"
    "\n"
    "  --classes FILE        the class table of landmass-db\n"
    "  --class-raster FILE   from landmass-db segment\n"
    "  --reflectivity FILE   from landmass-db reflect, dB\n"
    "  --radar FILE          the real radar on the same grid; its first band, dB\n"
    "  --out DIR             leave classes.png there\n"
    "  -h, --help            print this\n"
    "\n"
    "Another band, angle or number of looks than the simulation's shifts the real levels: then\n"
    "judge the order and the spread alone. The simulated column has the firmware's speckle of 4\n"
    "looks on the reflectivity. Spread is from 5 to 95 per cent of the pixels.\n";

static void print_spread(const struct rr_spread *s)
{
    printf(" %7.1f (%6.1f ..%6.1f) |", s->median, s->low, s->high);
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
    for (int i = 0; i < order->count; i++) {
        const struct rr_class_row *row = &order->rows[i];
        printf("| %-10s | %6zu |", name_of(table, row), row->pixels);
        print_spread(&row->measured);
        print_spread(&row->reflectivity);
        print_spread(&row->simulated);
        printf("\n");
    }
    printf("\n");
    const int agreeing = print_pairs(order, table);
    printf("pairs of classes in the same order: %d of %d\n", agreeing,
           order->count * (order->count - 1) / 2);
    printf("rank correlation: %.2f of the classes, %.2f of the pixels\n", order->class_correlation,
           order->pixel_correlation);
}

enum { TABLE = 1, CLASS_RASTER, REFLECTIVITY, RADAR, OUT, VALUES };

int rr_cmd_classes(int argc, char **argv)
{
    static const struct option options[] = {
        {"classes", required_argument, NULL, TABLE},
        {"class-raster", required_argument, NULL, CLASS_RASTER},
        {"reflectivity", required_argument, NULL, REFLECTIVITY},
        {"radar", required_argument, NULL, RADAR},
        {"out", required_argument, NULL, OUT},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    const char *values[VALUES] = {NULL};
    const int read = rr_read_options(argc, argv, options, help_text, values);
    if (read != HS_EXIT_OK) {
        return read < 0 ? HS_EXIT_OK : read;
    }
    if (!values[TABLE] || !values[CLASS_RASTER] || !values[REFLECTIVITY] || !values[RADAR] ||
        optind != argc) {
        hs_error("classes", "see landmass-realradar classes --help",
                 "needs --classes, --class-raster, --reflectivity and --radar, and no more");
        return HS_EXIT_USAGE;
    }
    struct db_class_table table;
    struct rr_class_order order;
    char path[4096];
    db_gdal_start();
    if (db_class_table_read(&table, values[TABLE]) != 0 ||
        rr_class_order_compare(&order, &(struct rr_class_source){&table, values[CLASS_RASTER],
                                                                 values[REFLECTIVITY],
                                                                 values[RADAR]}) != 0) {
        return HS_EXIT_FAILED;
    }
    print_order(&order, &table);
    if (values[OUT] && (hs_output_path(path, sizeof path, values[OUT], "classes.png") != 0 ||
                        rr_class_order_plot(&order, &table, path) != 0)) {
        return HS_EXIT_FAILED;
    }
    return HS_EXIT_OK;
}
