#include "nav/exercise.h"

#include <math.h>

enum { NODE_INSTRUCTOR = 30 };

bool nav_exercise_add_rate(struct nav_exercise *x, const double *value, int count)
{
    const double from_s = count > 1 ? value[1] : 0;
    const int n = x->rate_count;
    if (n == NAV_EXERCISE_RATES || count < 1 || count > 2 || !(value[0] >= 0 && value[0] <= 16) ||
        !(from_s >= 0) || (n > 0 && from_s <= x->rate[n - 1].from_s)) {
        return false;
    }
    x->rate[n].rate = value[0];
    x->rate[n].from_s = from_s;
    x->rate_count++;
    return true;
}

static double rate_at(const struct nav_exercise *x, double now_s)
{
    double rate = 1;
    for (int i = 0; i < x->rate_count && x->rate[i].from_s <= now_s; i++) {
        rate = x->rate[i].rate;
    }
    return rate;
}

double nav_exercise_ms(const struct nav_exercise *x, double now_s)
{
    double shown_s = x->start_s, from_s = 0, rate = 1;
    for (int i = 0; i < x->rate_count && x->rate[i].from_s <= now_s; i++) {
        shown_s += (x->rate[i].from_s - from_s) * rate;
        from_s = x->rate[i].from_s;
        rate = x->rate[i].rate;
    }
    return (shown_s + (now_s - from_s) * rate) * 1000;
}

static bool is_due(double at_s, double now_s, double period_s)
{
    return at_s >= now_s && at_s < now_s + period_s;
}

int nav_exercise_frames(const struct nav_exercise *x, struct canas_codes *codes, double now_s,
                        double period_s, double sent_s,
                        struct canas_frame frames[NAV_EXERCISE_FRAMES])
{
    bool is_told = is_due(ceil(now_s), now_s, period_s);
    for (int i = 0; i < x->rate_count; i++) {
        /* The first minor frame in which the new rate holds. */
        is_told = is_told || is_due(x->rate[i].from_s + period_s, now_s + period_s / 2, period_s);
    }
    if (!x->has_clock || !is_told) {
        return 0;
    }
    int count = 0;
    frames[count++] = canas_float(codes, CANAS_EXERCISE_RATE, NODE_INSTRUCTOR, rate_at(x, sent_s));
    if (x->has_seed) {
        frames[count++] = canas_long(codes, CANAS_EXERCISE_SEED, NODE_INSTRUCTOR, x->seed);
    }
    frames[count++] = canas_long(codes, CANAS_EXERCISE_TIME, NODE_INSTRUCTOR,
                                 (int32_t)lround(fmin(nav_exercise_ms(x, sent_s), INT32_MAX)));
    return count;
}
