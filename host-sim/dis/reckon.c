#include "dis/reckon.h"

#include <math.h>
#include <string.h>

struct matrix {
    double m[3][3];
};

/* Axes of the world to those of the body. */
static struct matrix body_axes(const struct dis_motion *motion)
{
    const double sy = sin(motion->psi_rad), cy = cos(motion->psi_rad);
    const double sp = sin(motion->theta_rad), cp = cos(motion->theta_rad);
    const double sr = sin(motion->phi_rad), cr = cos(motion->phi_rad);
    return (struct matrix){{{cp * cy, cp * sy, -sp},
                            {sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, sr * cp},
                            {cr * sp * cy + sr * sy, cr * sp * sy - sr * cy, cr * cp}}};
}

static void to_world(const struct matrix *body, const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = body->m[0][i] * v[0] + body->m[1][i] * v[1] + body->m[2][i] * v[2];
    }
}

static void cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

/* k0 v + k1 W v + k2 W W v: every power series in W is one of these. */
static void series(const double turn[3], const double k[3], const double v[3], double out[3])
{
    double once[3], twice[3];
    cross(turn, v, once);
    cross(turn, once, twice);
    for (int i = 0; i < 3; i++) {
        out[i] = k[0] * v[i] + k[1] * once[i] + k[2] * twice[i];
    }
}

/* Coefficients of exp(W t) and of its integrals R1 and R2 (see the header). */
struct turning {
    double exp[3], r1[3], r2[3];
};

/* Below a tenth of a radian the closed forms lose digits by cancelling; four terms of the series
 * are then good to 1e-14. */
static struct turning small_turning(double w, double t)
{
    const double x = w * w * t * t;
    return (struct turning){
        {1, t * (1 - x / 6 * (1 - x / 20 * (1 - x / 42))),
         t * t * (0.5 - x / 24 * (1 - x / 30 * (1 - x / 56)))},
        {t, t * t * (0.5 - x / 24 * (1 - x / 30 * (1 - x / 56))),
         t * t * t * (1.0 / 6 - x / 120 * (1 - x / 42 * (1 - x / 72)))},
        {t * t / 2, t * t * t * (1.0 / 3 - x / 30 + x * x / 840 - x * x * x / 45360),
         t * t * t * t * (1.0 / 8 - x / 144 + x * x / 5760 - x * x * x / 403200)}};
}

static struct turning turning_of(const double turn[3], double t)
{
    const double w = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]);
    const double a = w * t, s = sin(a), c = cos(a);
    if (a < 0.1) {
        return small_turning(w, t);
    }
    return (struct turning){
        {1, s / w, (1 - c) / (w * w)},
        {t, (1 - c) / (w * w), (a - s) / (w * w * w)},
        {t * t / 2, (s - a * c) / (w * w * w), (a * a / 2 - c - a * s + 1) / (w * w * w * w)}};
}

/* What the letters of the model say. */
struct model {
    bool moves, rotates, accelerates, is_body;
};

static struct model model_of(const struct dis_motion *m)
{
    static const struct model models[] = {
        [DIS_STATIC] = {false, false, false, false}, [DIS_FPW] = {true, false, false, false},
        [DIS_RPW] = {true, true, false, false},      [DIS_RVW] = {true, true, true, false},
        [DIS_FVW] = {true, false, true, false},      [DIS_FPB] = {true, false, false, true},
        [DIS_RPB] = {true, true, false, true},       [DIS_RVB] = {true, true, true, true},
        [DIS_FVB] = {true, false, true, true},
    };
    const bool is_known = m->algorithm <= DIS_FVB && !m->is_frozen;
    return models[is_known && m->algorithm > 0 ? m->algorithm : DIS_STATIC];
}

/* Place and velocity of a model in world axes. */
static void move_in_world(const double v[3], const double a[3], double t, struct dis_state *s)
{
    for (int i = 0; i < 3; i++) {
        s->place_m[i] += v[i] * t + a[i] * t * t / 2;
        s->velocity_m_s[i] = v[i] + a[i] * t;
        s->acceleration_m_s2[i] = a[i];
    }
}

static void move_in_body(const struct matrix *body, const struct turning *k, const double turn[3],
                         const double v[3], const double a[3], double t, struct dis_state *s)
{
    double by_speed[3], by_acceleration[3], moved[3], now[3], turned[3];
    series(turn, k->r1, v, by_speed);
    series(turn, k->r2, a, by_acceleration);
    for (int i = 0; i < 3; i++) {
        moved[i] = by_speed[i] + by_acceleration[i];
        now[i] = v[i] + a[i] * t;
    }
    series(turn, k->exp, now, turned);
    to_world(body, turned, s->velocity_m_s);
    series(turn, k->exp, a, turned);
    to_world(body, turned, s->acceleration_m_s2);
    to_world(body, moved, by_speed);
    for (int i = 0; i < 3; i++) {
        s->place_m[i] += by_speed[i];
    }
}

struct dis_state dis_reckon(const struct dis_motion *motion, double after_s)
{
    static const double none[3] = {0, 0, 0}, ahead[3] = {1, 0, 0};
    const struct model model = model_of(motion);
    const struct matrix body = body_axes(motion);
    const double *turn = model.rotates ? motion->turn_rad_s : none;
    const double *speed = model.moves ? motion->velocity_m_s : none;
    const double *acceleration = model.accelerates ? motion->acceleration_m_s2 : none;
    const struct turning k = turning_of(turn, after_s);
    struct dis_state s;
    double forward[3];
    memcpy(s.place_m, motion->place_m, sizeof s.place_m);
    if (model.is_body) {
        move_in_body(&body, &k, turn, speed, acceleration, after_s, &s);
    } else {
        move_in_world(speed, acceleration, after_s, &s);
    }
    series(turn, k.exp, ahead, forward);
    to_world(&body, forward, s.forward);
    to_world(&body, turn, s.turn_rad_s); /* a turn keeps its own axis */
    return s;
}
