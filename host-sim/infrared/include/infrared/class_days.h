/* Days of a class: how warm its ground is at each time, by what differs from place to place: the
 * albedo, the conductivity and the slope. Computed once for a few of each, and interpolated. */
#ifndef INFRARED_CLASS_DAYS_H
#define INFRARED_CLASS_DAYS_H

#include "hs/class_table.h"
#include "infrared/surface.h"

enum { IR_KNOTS = 5 };

struct ir_class_days {
    /* By the rank of albedo and conductivity in the class, -2, -1 .. 2 spreads, on level ground. */
    double property[IR_KNOTS][IR_KNOTS][IR_STEPS];
    /* By the rise towards east and north, -0.8, -0.4 .. 0.8, with the means of the class. */
    double slope[IR_KNOTS][IR_KNOTS][IR_STEPS];
    /* With the means of the class, level, where the sun never shines. */
    double shade[IR_STEPS];
};

/* Temperatures of a class at one time. */
struct ir_class_hour {
    double property[IR_KNOTS][IR_KNOTS], slope[IR_KNOTS][IR_KNOTS], shade;
};

/* What a place differs in. */
struct ir_place {
    double albedo_rank, conductivity_rank;
    double rise_east, rise_north;
    double hidden; /* share of the beam's warmth that did not reach it, 0..1 (past_suns.h) */
};

/* The surface that has the means of a class. */
struct ir_surface ir_surface_of_class(const struct db_thermal *t);

/* Compute all. Slopes are left out, and count as level, unless `has_slopes`. Some 1 ms a day, 26
 * or 51 days. */
void ir_class_days_make(struct ir_class_days *days, const struct db_thermal *t,
                        const struct ir_weather *w, bool has_slopes);

/* Shift all, so that the mean of the day on level ground is `kelvin`: for water, whose mean is that
 * of a season and of a current. */
void ir_class_days_set_mean(struct ir_class_days *days, double kelvin);

/* The temperatures at an hour, 0..24. */
void ir_class_hour_of(struct ir_class_hour *hour, const struct ir_class_days *days, double hour_h);

/* The temperature of a place in kelvin. Ranks and rises beyond the knots count as the last. */
double ir_class_hour_at(const struct ir_class_hour *hour, const struct ir_place *place);

#endif
