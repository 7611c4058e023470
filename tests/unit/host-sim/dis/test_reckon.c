/* The models of dead reckoning against motion that is integrated in small steps from what their
 * letters say, and against circles that are known without. */
#include "check.h"
#include "dis/reckon.h"
#include "hs/rng.h"

#include <math.h>
#include <string.h>

enum { STEPS = 20000 };

struct axes {
    double m[3][3]; /* rows: x, y, z of the body in the world */
};

static void turn_about(double v[3], const double axis[3], double rad)
{
    double across[3] = {axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2],
                        axis[0] * v[1] - axis[1] * v[0]};
    const double along = axis[0] * v[0] + axis[1] * v[1] + axis[2] * v[2];
    for (int i = 0; i < 3; i++) {
        v[i] = v[i] * cos(rad) + across[i] * sin(rad) + axis[i] * along * (1 - cos(rad));
    }
}

/* Turn the world's axes by psi about z, then theta about the new y, then phi about the new x. */
static struct axes begin_axes(const struct dis_motion *m)
{
    struct axes a = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    const double angles[3] = {m->phi_rad, m->theta_rad, m->psi_rad};
    for (int axis = 2; axis >= 0; axis--) {
        double about[3];
        memcpy(about, a.m[axis], sizeof about);
        for (int i = 0; i < 3; i++) {
            turn_about(a.m[i], about, angles[axis]);
        }
    }
    return a;
}

static void rotate_axes(struct axes *a, const double turn[3], double dt)
{
    double world[3], rate = 0;
    for (int i = 0; i < 3; i++) {
        world[i] = turn[0] * a->m[0][i] + turn[1] * a->m[1][i] + turn[2] * a->m[2][i];
        rate += world[i] * world[i];
    }
    rate = sqrt(rate);
    for (int i = 0; i < 3 && rate > 0; i++) {
        const double axis[3] = {world[0] / rate, world[1] / rate, world[2] / rate};
        turn_about(a->m[i], axis, rate * dt);
    }
}

/* Where the body is after `after_s`, by the middle of each small step. */
static void integrate(const struct dis_motion *m, double after_s, double place_m[3],
                      double forward[3])
{
    const bool rotates = strchr("3478", '0' + m->algorithm) != NULL;
    const bool has_rate = strchr("4589", '0' + m->algorithm) != NULL;
    const bool is_body = m->algorithm >= 6;
    struct axes a = begin_axes(m);
    const double dt = after_s / STEPS;
    memcpy(place_m, m->place_m, 3 * sizeof *place_m);
    for (int n = 0; n < STEPS && m->algorithm != 1; n++) {
        const double t = (n + 0.5) * dt;
        double v[3];
        for (int i = 0; i < 3; i++) {
            v[i] = m->velocity_m_s[i] + (has_rate ? m->acceleration_m_s2[i] * t : 0);
        }
        if (rotates) {
            rotate_axes(&a, m->turn_rad_s, dt / 2);
        }
        for (int i = 0; i < 3; i++) {
            place_m[i] +=
                dt * (is_body ? v[0] * a.m[0][i] + v[1] * a.m[1][i] + v[2] * a.m[2][i] : v[i]);
        }
        if (rotates) {
            rotate_axes(&a, m->turn_rad_s, dt / 2);
        }
    }
    memcpy(forward, a.m[0], 3 * sizeof *forward);
}

static double between(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static struct dis_motion any_motion(struct hs_rng *rng, uint8_t algorithm, double turn)
{
    struct dis_motion m = {.place_m = {3999544, -149846, 4949674}, .algorithm = algorithm};
    m.psi_rad = 6 * hs_rng_uniform(rng) - 3;
    m.theta_rad = 3 * hs_rng_uniform(rng) - 1.5;
    m.phi_rad = 6 * hs_rng_uniform(rng) - 3;
    for (int i = 0; i < 3; i++) {
        m.velocity_m_s[i] = 200 * hs_rng_normal(rng);
        m.acceleration_m_s2[i] = 5 * hs_rng_normal(rng);
        m.turn_rad_s[i] = turn * hs_rng_normal(rng);
    }
    return m;
}

TEST(each_model_ends_where_its_letters_lead)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 3);
    double worst_m = 0;
    for (int i = 0; i < 270; i++) {
        static const double turns[] = {0.3, 0.01, 1e-7};
        const struct dis_motion m = any_motion(&rng, (uint8_t)(1 + i % 9), turns[i / 9 % 3]);
        const double after_s = 5 * hs_rng_uniform(&rng);
        double place_m[3], forward[3];
        integrate(&m, after_s, place_m, forward);
        const struct dis_state s = dis_reckon(&m, after_s);
        worst_m = fmax(worst_m, between(s.place_m, place_m));
        assert_true(between(s.forward, forward) < 1e-8);
    }
    print_message("# worst: %.2g m\n", worst_m);
    assert_true(worst_m < 1e-4);
}

TEST(the_velocity_is_that_with_which_the_place_changes)
{
    struct hs_rng rng;
    hs_rng_seed(&rng, 4);
    for (int i = 0; i < 180; i++) {
        const struct dis_motion m = any_motion(&rng, (uint8_t)(1 + i % 9), i % 2 ? 0.4 : 1e-3);
        const double at_s = 4 * hs_rng_uniform(&rng) + 0.1, h = 1e-3;
        const struct dis_state before = dis_reckon(&m, at_s - h), s = dis_reckon(&m, at_s),
                               behind = dis_reckon(&m, at_s + h);
        for (int k = 0; k < 3; k++) {
            const double rate = (behind.place_m[k] - before.place_m[k]) / (2 * h);
            assert_true(fabs(rate - s.velocity_m_s[k]) < 1e-3);
        }
    }
}

TEST(a_car_that_turns_with_its_axes_drives_a_circle)
{
    /* 10 m/s ahead and 0.5 rad/s about its own down axis: a radius of 20 m, closed after 4 pi s. */
    const struct dis_motion m = {.place_m = {6378137, 0, 0},
                                 .velocity_m_s = {10, 0, 0},
                                 .turn_rad_s = {0, 0, 0.5},
                                 .algorithm = DIS_RPB};
    const double pi = 3.14159265358979323846;
    const struct dis_state half = dis_reckon(&m, 2 * pi), whole = dis_reckon(&m, 4 * pi);
    assert_true(fabs(between(half.place_m, m.place_m) - 40) < 1e-8);
    assert_true(between(whole.place_m, m.place_m) < 1e-8);
    assert_true(fabs(half.forward[0] + 1) < 1e-12);
}

TEST(what_is_frozen_static_or_unknown_stands)
{
    struct dis_motion m = {.place_m = {6378137, 0, 0},
                           .velocity_m_s = {10, 20, 30},
                           .turn_rad_s = {1, 1, 1},
                           .algorithm = DIS_RVB,
                           .is_frozen = true};
    assert_true(between(dis_reckon(&m, 3).place_m, m.place_m) == 0.0);
    m.is_frozen = false;
    static const uint8_t still[] = {0, 1, 10, 255};
    for (size_t i = 0; i < sizeof still; i++) {
        m.algorithm = still[i];
        const struct dis_state s = dis_reckon(&m, 3);
        assert_true(between(s.place_m, m.place_m) == 0.0 && s.velocity_m_s[0] == 0.0);
    }
}
