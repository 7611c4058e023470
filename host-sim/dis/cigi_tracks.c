/* The host's entities, followed from message to message. */
#include "dis/cigi.h"
#include "dis/earth.h"
#include "dis/reckon.h"
#include "feed.h"
#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { IDS = 65536, SWEEP_US = 100000, DOMAIN_LAND = 1, DOMAIN_AIR = 2 };

/* Longer between two places, or faster than the bus carries: it did not go there. */
#define GAP_S         2.0
#define JUMP_M_S      1000.0
#define US_A_TICK     10
#define CLOCK_JUMP_US 10000000

static const double radian = 3.14159265358979323846 / 180;

struct track {
    bool is_there, has_rate;
    struct dis_cigi_entity last;
    struct dis_cigi_rate rate;
    double from_m[3]; /* where the span began that velocity is measured over */
    double velocity_m_s[3];
    int64_t from_us, last_us; /* on the host's clock */
    int64_t heard_us;         /* on ours */
};

struct dis_cigi {
    struct dis_gateway *gateway;
    struct dis_sea_level sea;
    struct track track[IDS];
    uint16_t used[IDS]; /* those that are there */
    uint32_t used_count;
    bool has_time;
    uint32_t time_10us;
    int64_t time_us; /* of the host's clock, without its wraps */
    int64_t sweep_us;
};

struct dis_cigi *dis_cigi_new(struct dis_gateway *gateway, const struct dis_sea_level *sea)
{
    struct dis_cigi *c = calloc(1, sizeof *c);
    if (c == NULL) {
        (void)hs_error("CIGI", NULL, "no memory for its entities");
        return NULL;
    }
    c->gateway = gateway;
    c->sea = *sea;
    return c;
}

void dis_cigi_free(struct dis_cigi *c)
{
    free(c);
}

/* ---- motion ---- */

static struct dis_place place_of(const struct dis_cigi *c, const struct dis_cigi_entity *e)
{
    struct dis_place place = {e->latitude_deg, e->longitude_deg, 0};
    place.height_m = dis_sea_level_m(&c->sea, &place) + (e->is_clamped ? 0 : e->height_m);
    return place;
}

/* Rates along the body's axes as north, east and down: turned by roll, then pitch, then yaw. */
static void rate_ned(const struct dis_cigi_rate *rate, const struct dis_cigi_entity *e,
                     double ned_m_s[3])
{
    const double *v = rate->rate_m_s;
    if (!rate->is_local) {
        memcpy(ned_m_s, v, 3 * sizeof *v);
        return;
    }
    const double r = e->roll_deg * radian, p = e->pitch_deg * radian, y = e->yaw_deg * radian;
    const double right = v[1] * cos(r) - v[2] * sin(r), below = v[1] * sin(r) + v[2] * cos(r);
    const double ahead = v[0] * cos(p) + below * sin(p);
    ned_m_s[0] = ahead * cos(y) - right * sin(y);
    ned_m_s[1] = ahead * sin(y) + right * cos(y);
    ned_m_s[2] = below * cos(p) - v[0] * sin(p);
}

/* A vector of north, east and down in geocentric axes. */
static void turn(const struct dis_axes *axes, const double ned[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = axes->north[i] * ned[0] + axes->east[i] * ned[1] - axes->up[i] * ned[2];
    }
}

static struct dis_entity_state state_of(const struct dis_cigi *c, const struct track *t)
{
    const struct dis_cigi_entity *e = &t->last;
    struct dis_entity_state s = {
        .id = {0, 0, e->id},
        .type = {.domain = e->is_clamped ? DOMAIN_LAND : DOMAIN_AIR, .country = e->type},
        .motion.algorithm = DIS_FPW};
    const struct dis_place place = place_of(c, e);
    const struct dis_axes axes = dis_axes_at(&place);
    const double yaw = e->yaw_deg * radian, pitch = e->pitch_deg * radian;
    const double nose[3] = {cos(yaw) * cos(pitch), sin(yaw) * cos(pitch), -sin(pitch)};
    double forward[3];
    dis_place_back(&place, s.motion.place_m);
    turn(&axes, nose, forward);
    s.motion.psi_rad = atan2(forward[1], forward[0]);
    s.motion.theta_rad = -asin(fmax(-1, fmin(1, forward[2])));
    if (t->has_rate) {
        double ned_m_s[3];
        rate_ned(&t->rate, e, ned_m_s);
        turn(&axes, ned_m_s, s.motion.velocity_m_s);
    } else {
        memcpy(s.motion.velocity_m_s, t->velocity_m_s, sizeof t->velocity_m_s);
    }
    return s;
}

/* Measure the velocity by the way since the span began. */
static void measure(struct track *t, const double place_m[3], int64_t time_us)
{
    const double since_last_s = (double)(time_us - t->last_us) * 1e-6;
    const double span_s = (double)(time_us - t->from_us) * 1e-6;
    bool is_jump = since_last_s < 0 || since_last_s > GAP_S;
    if (!is_jump && span_s < DIS_CIGI_SPAN_S) {
        return;
    }
    for (int i = 0; i < 3; i++) {
        t->velocity_m_s[i] = is_jump ? 0 : (place_m[i] - t->from_m[i]) / span_s;
    }
    is_jump = is_jump || dis_dot(t->velocity_m_s, t->velocity_m_s) > JUMP_M_S * JUMP_M_S;
    if (is_jump) {
        memset(t->velocity_m_s, 0, sizeof t->velocity_m_s);
    }
    memcpy(t->from_m, place_m, sizeof t->from_m);
    t->from_us = time_us;
}

/* ---- packets ---- */

static void remove_track(struct dis_cigi *c, uint16_t id, int64_t now_us)
{
    const struct dis_entity_state gone = {.id = {0, 0, id}, .is_deactivated = true};
    if (!c->track[id].is_there) {
        return;
    }
    memset(&c->track[id], 0, sizeof c->track[id]);
    for (uint32_t i = 0; i < c->used_count; i++) {
        if (c->used[i] == id) {
            c->used[i] = c->used[--c->used_count];
            break;
        }
    }
    if (id != 0) {
        dis_gateway_take_entity(c->gateway, &gone, now_us);
    }
}

static void take_entity(struct dis_cigi *c, const struct dis_cigi_entity *e, int64_t now_us)
{
    struct track *t = &c->track[e->id];
    struct dis_counts *count = dis_gateway_tally(c->gateway);
    count->attached += e->is_active && e->is_child;
    if (!e->is_active || e->is_child) {
        remove_track(c, e->id, now_us);
        return;
    }
    if (!t->is_there) {
        t->is_there = true;
        t->last_us = INT64_MIN / 2;
        c->used[c->used_count++] = e->id;
    }
    t->last = *e;
    const struct dis_place place = place_of(c, e);
    double place_m[3];
    dis_place_back(&place, place_m);
    measure(t, place_m, c->time_us);
    t->last_us = c->time_us;
    t->heard_us = now_us;
    const struct dis_entity_state s = state_of(c, t);
    dis_gateway_take_entity(c->gateway, &s, now_us);
}

/* What is not told of a clamped one stays as it was. */
static void take_clamped(struct dis_cigi *c, struct dis_cigi_entity *e, int64_t now_us)
{
    const struct track *t = &c->track[e->id];
    if (!t->is_there) {
        dis_gateway_tally(c->gateway)->update_of_unknown++;
        return;
    }
    e->type = t->last.type;
    e->is_clamped = t->last.is_clamped;
    e->height_m = t->last.height_m;
    e->pitch_deg = t->last.pitch_deg;
    e->roll_deg = t->last.roll_deg;
    take_entity(c, e, now_us);
}

static void take_rate(struct dis_cigi *c, const struct dis_cigi_rate *rate, int64_t now_us)
{
    struct track *t = &c->track[rate->id];
    if (!t->is_there || rate->is_of_part) {
        dis_gateway_tally(c->gateway)->update_of_unknown += !t->is_there;
        return;
    }
    const double *v = rate->rate_m_s;
    t->rate = *rate;
    t->has_rate = fabs(v[0]) + fabs(v[1]) + fabs(v[2]) > 0;
    /* It goes on from where it was told last. */
    if (t->heard_us == now_us) {
        const struct dis_entity_state s = state_of(c, t);
        dis_gateway_take_entity(c->gateway, &s, now_us);
    }
}

static enum dis_fault take_packet(struct dis_cigi *c, const struct dis_cigi_packet *p,
                                  int64_t now_us)
{
    struct dis_counts *count = dis_gateway_tally(c->gateway);
    struct dis_cigi_entity entity;
    struct dis_cigi_rate rate;
    enum dis_fault fault = DIS_FAULT_NONE;
    if (p->opcode == DIS_CIGI_ENTITY_CONTROL) {
        fault = dis_cigi_entity_read(p, &entity);
        if (fault == DIS_FAULT_NONE) {
            count->states++;
            take_entity(c, &entity, now_us);
        }
    } else if (p->opcode == DIS_CIGI_CLAMPED_ENTITY) {
        fault = dis_cigi_clamped_read(p, &entity);
        if (fault == DIS_FAULT_NONE) {
            count->updates++;
            take_clamped(c, &entity, now_us);
        }
    } else if (p->opcode == DIS_CIGI_RATE_CONTROL) {
        fault = dis_cigi_rate_read(p, &rate);
        if (fault == DIS_FAULT_NONE) {
            count->commands++;
            take_rate(c, &rate, now_us);
        }
    } else {
        count->other_pdus++;
    }
    return fault;
}

/* The host's clock without its wraps; one that is set begins anew with ours. */
static void advance(struct dis_cigi *c, const struct dis_cigi_message *m, int64_t now_us)
{
    const int64_t passed_us = (int64_t)(int32_t)(m->time_10us - c->time_10us) * US_A_TICK;
    const bool goes_on = c->has_time && m->has_time && passed_us >= 0 && passed_us < CLOCK_JUMP_US;
    c->time_us = goes_on ? c->time_us + passed_us : now_us;
    c->has_time = m->has_time;
    c->time_10us = m->time_10us;
}

/* What moved by its places and is not told any more stands. */
static void stop_silent(struct dis_cigi *c, int64_t now_us)
{
    if (now_us - c->sweep_us < SWEEP_US && now_us >= c->sweep_us) {
        return;
    }
    c->sweep_us = now_us;
    for (uint32_t i = 0; i < c->used_count; i++) {
        struct track *t = &c->track[c->used[i]];
        const bool moves = !t->has_rate && dis_dot(t->velocity_m_s, t->velocity_m_s) > 0;
        if (moves && (double)(now_us - t->heard_us) * 1e-6 > DIS_CIGI_STOP_S) {
            memset(t->velocity_m_s, 0, sizeof t->velocity_m_s);
            const struct dis_entity_state s = state_of(c, t);
            dis_gateway_take_entity(c->gateway, &s, now_us);
        }
    }
}

void dis_cigi_take(struct dis_cigi *c, const uint8_t *bytes, size_t length, int64_t now_us)
{
    struct dis_counts *count = dis_gateway_tally(c->gateway);
    struct dis_cigi_message m;
    struct dis_cigi_packet packet;
    count->datagrams++;
    count->bytes += length;
    enum dis_fault fault = dis_cigi_begin(&m, bytes, length);
    if (fault != DIS_FAULT_NONE) {
        count->fault[fault]++;
        return;
    }
    count->pdus++;
    advance(c, &m, now_us);
    dis_gateway_hear_all(c->gateway, now_us);
    enum dis_step step;
    while ((step = dis_cigi_next(&m, &packet, &fault)) == DIS_STEP_PDU) {
        count->pdus++;
        fault = take_packet(c, &packet, now_us);
        count->fault[fault] += fault != DIS_FAULT_NONE;
    }
    count->fault[fault] += step == DIS_STEP_BROKEN;
    stop_silent(c, now_us);
}
