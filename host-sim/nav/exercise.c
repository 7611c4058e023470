#include "nav/exercise.h"

#include "hs/number.h"

#include <math.h>
#include <string.h>

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
    frames[count++] =
        canas_float(codes, CANAS_EXERCISE_RATE, NAV_EXERCISE_NODE, rate_at(x, sent_s));
    if (x->has_seed) {
        frames[count++] = canas_long(codes, CANAS_EXERCISE_SEED, NAV_EXERCISE_NODE, x->seed);
    }
    frames[count++] = canas_long(codes, CANAS_EXERCISE_TIME, NAV_EXERCISE_NODE,
                                 (int32_t)lround(fmin(nav_exercise_ms(x, sent_s), INT32_MAX)));
    return count;
}

/* ---- malfunctions ---- */

static const struct kind {
    const char *name;
    int number, values;
    double least, most;
    bool is_ramp;
} kinds[] = {
    {"no-transmit", 0, 0, 0, 0, false},     {"weak-transmit", 1, 1, 0, 60, false},
    {"noise", 2, 1, 0, 60, false},          {"stuck-antenna", 3, 1, -180, 180, false},
    {"antenna-drift", 4, 1, -60, 60, true}, {"lost-sector", 5, 2, -180, 180, false},
    {"frozen-video", 7, 0, 0, 0, false},    {"tilt", 8, 1, -30, 30, false},
    {"dead-key", 9, 1, 1, 28, false},
};

static const struct kind *kind_named(const char *text, size_t length)
{
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        if (strlen(kinds[i].name) == length && memcmp(kinds[i].name, text, length) == 0) {
            return &kinds[i];
        }
    }
    return NULL;
}

static bool read_values(const struct kind *kind, const char *text, struct nav_malfunction *m)
{
    const int count = text[0] != '\0' ? hs_numbers(text, ',', m->value, 2) : 0;
    for (int i = 0; i < count; i++) {
        if (!(m->value[i] >= kind->least && m->value[i] <= kind->most)) {
            return false;
        }
    }
    return count == kind->values && (count < 2 || m->value[0] < m->value[1]);
}

static bool read_span(const char *text, struct nav_malfunction *m)
{
    double span[2] = {0, INFINITY};
    if (text && hs_numbers(text, ',', span, 2) < 1) {
        return false;
    }
    m->from_s = span[0];
    m->until_s = span[1];
    return m->from_s >= 0 && m->until_s > m->from_s;
}

const char *nav_exercise_add_malfunction(struct nav_exercise *x, const char *text)
{
    char words[96];
    if (x->malfunction_count == NAV_MALFUNCTIONS) {
        return "is one too many: twelve at most";
    }
    if (strlen(text) >= sizeof words) {
        return "is too long";
    }
    strcpy(words, text);
    char *span = strchr(words, '@'), *values = strchr(words, '=');
    const size_t length = strcspn(words, "=@");
    if (span) {
        *span++ = '\0';
    }
    const struct kind *kind = kind_named(words, length);
    if (!kind) {
        return "needs one of no-transmit, weak-transmit=DB, noise=DB, stuck-antenna=DEG, "
               "antenna-drift=DEG_A_MINUTE, lost-sector=FROM,TO, frozen-video, tilt=DEG, "
               "dead-key=N";
    }
    struct nav_malfunction m = {
        .number = kind->number, .values = kind->values, .is_ramp = kind->is_ramp};
    if (!read_values(kind, values ? values + 1 : "", &m)) {
        return "needs its value: 0..60 dB, -180..180 degrees (tilt: -30..30), FROM left of TO, "
               "-60..60 degrees a minute, or key 1..28; no-transmit and frozen-video have none";
    }
    if (!read_span(span, &m)) {
        return "needs @FROM_S[,UNTIL_S] in seconds";
    }
    x->malfunction[x->malfunction_count++] = m;
    return NULL;
}

static struct canas_frame frame_of(const struct nav_malfunction *m, int which, double now_s,
                                   struct canas_codes *codes)
{
    const double value = m->is_ramp ? m->value[0] * (now_s - m->from_s) / 60 : m->value[which];
    struct canas_frame f =
        canas_float(codes, CANAS_MALFUNCTION, NAV_EXERCISE_NODE, fmax(-180, fmin(180, value)));
    f.data[2] = (uint8_t)(m->number + which);
    return f;
}

int nav_malfunction_frames(const struct nav_exercise *x, struct canas_codes *codes, double now_s,
                           double period_s, struct canas_frame frames[2 * NAV_MALFUNCTIONS])
{
    int count = 0;
    for (int i = 0; i < x->malfunction_count; i++) {
        const struct nav_malfunction *m = &x->malfunction[i];
        const int frames_each = m->values == 2 ? 2 : 1;
        const bool is_told = is_due(ceil(now_s), now_s, period_s) ||
                             is_due(m->from_s + period_s, now_s + period_s / 2, period_s);
        const bool is_over = is_due(m->until_s + period_s, now_s + period_s / 2, period_s);
        for (int k = 0; k < frames_each; k++) {
            if (is_over) {
                frames[count++] = canas_uchar(codes, CANAS_MALFUNCTION_CLEAR, NAV_EXERCISE_NODE,
                                              (uint8_t)(m->number + k));
            } else if (is_told && now_s + period_s / 2 >= m->from_s && now_s < m->until_s) {
                frames[count++] = frame_of(m, k, now_s, codes);
            }
        }
    }
    return count;
}
