/* Class order: rank and spread of the classes of a database beside a real radar's picture of the
 * same ground. */
#ifndef REALRADAR_CLASS_ORDER_H
#define REALRADAR_CLASS_ORDER_H

#include "hs/class_table.h"

#include <stddef.h>

/* Of the values of one class, in dB. */
struct rr_spread {
    double low, median, high; /* 5, 50 and 95 per cent lie below */
};

struct rr_class_row {
    int class_index;
    size_t pixels;
    struct rr_spread measured;     /* the real radar */
    struct rr_spread reflectivity; /* the database: gamma */
    struct rr_spread simulated;    /* the same with the firmware's speckle of RR_SIMULATED_LOOKS */
};

/* Sentinel-1's high resolution ground range product of the IW mode has 4.4 looks (ESA's product
 * definition); the nearest of the firmware's tables is 4. */
enum { RR_SIMULATED_LOOKS_LOG2 = 2, RR_SIMULATED_LOOKS = 1 << RR_SIMULATED_LOOKS_LOG2 };

struct rr_class_order {
    struct rr_class_row rows[DB_CLASS_MAX]; /* by the measured median, darkest first */
    int count;
    double class_correlation; /* Spearman's, of the medians of the classes; NaN below two classes */
    double pixel_correlation; /* Spearman's, of measured and simulated, over all pixels */
};

struct rr_class_source {
    const struct db_class_table *table;
    const char *class_raster, *reflectivity, *radar; /* one grid; the radar's first band, in dB */
};

/* Compare. Pixels without data in any of the three are left out, and classes of fewer than 50
 * pixels. Returns 0, or -1 with the error reported. Memory: 50 bytes a pixel. */
int rr_class_order_compare(struct rr_class_order *order, const struct rr_class_source *source);

/* Spearman's rank correlation; equal values share the mean of their ranks. NaN when either does not
 * vary, or on no memory. */
double rr_rank_correlation(const float *a, const float *b, size_t count);

/* Bars from 5 to 95 per cent with the median across, measured above simulated, a pair for each
 * class. Returns 0, or -1 with the error reported. */
int rr_class_order_plot(const struct rr_class_order *order, const struct db_class_table *table,
                        const char *path);

#endif
