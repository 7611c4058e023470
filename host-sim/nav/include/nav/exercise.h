/* Exercise on the bus: frames of its clock and of its malfunctions as docs/bus.md, "Exercise
 * clock" and "Malfunctions", defines them. */
#ifndef NAV_EXERCISE_H
#define NAV_EXERCISE_H

#include "nav/canas.h"

#include <stdbool.h>

/* NODE: who sends them. */
enum { NAV_EXERCISE_NODE = 30 };

enum { NAV_EXERCISE_RATES = 8, NAV_EXERCISE_FRAMES = 3, NAV_MALFUNCTIONS = 12 };

/* A malfunction, told once a second from from_s until before until_s, and then cleared. */
struct nav_malfunction {
    int number;   /* of its kind on the bus */
    bool is_ramp; /* value[0] is an amount a minute since from_s */
    int values;   /* 0..2: the kinds number and number + 1 have one each */
    double value[2];
    double from_s, until_s;
};

/* All seconds count from the log's beginning. */
struct nav_exercise {
    bool has_clock, has_seed;
    double start_s; /* what the clock shows at the log's beginning */
    int32_t seed;
    struct {
        double rate, from_s; /* ascending in from_s */
    } rate[NAV_EXERCISE_RATES];
    int rate_count; /* before the first one the rate is 1 */
    struct nav_malfunction malfunction[NAV_MALFUNCTIONS];
    int malfunction_count;
};

/* Take RATE or RATE,FROM_S. False, with *x unchanged, when they are out of range (0..16, after the
 * rate before it) or there are NAV_EXERCISE_RATES already. */
bool nav_exercise_add_rate(struct nav_exercise *x, const double *value, int count);

/* Take NAME[=VALUE[,VALUE]][@FROM_S[,UNTIL_S]]. NULL; or why not, in static memory, with *x
 * unchanged. */
const char *nav_exercise_add_malfunction(struct nav_exercise *x, const char *text);

/* Likewise for the malfunctions: in each second, and once when one ends. */
int nav_malfunction_frames(const struct nav_exercise *x, struct canas_codes *codes, double now_s,
                           double period_s, struct canas_frame frames[2 * NAV_MALFUNCTIONS]);

/* What the clock shows at now_s, milliseconds. */
double nav_exercise_ms(const struct nav_exercise *x, double now_s);

/* The frames to send in the minor frame that begins `now_s` after the log's beginning and lasts
 * `period_s`; returns how many. They go out in each second and when the rate changes. The time is
 * that of `sent_s`, when the last of them is sent. */
int nav_exercise_frames(const struct nav_exercise *x, struct canas_codes *codes, double now_s,
                        double period_s, double sent_s,
                        struct canas_frame frames[NAV_EXERCISE_FRAMES]);

#endif
