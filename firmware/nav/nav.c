#include "lm/nav.h"

#include <stddef.h>

#include "fx/const.h"
#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/geo.h"
#include "lm/units.h"

enum {
    POSITION_TOLERANCE = 238609, /* 0.02 degree */
    ANGLE_TOLERANCE = 59652324   /* 5 degrees */
};

/* A field of one sender at a given time. */
struct reading {
    enum lm_bus_field field;
    enum lm_nav_quality quality;
    int32_t value;  /* 0 when dead */
    int64_t age_us; /* 0 when dead, at most the row's dead_ms otherwise */
    uint32_t step;
    bool is_settled;
    struct lm_nav_origin origin;
};

struct velocity {
    enum lm_nav_quality quality;
    int32_t north_mm_s, east_mm_s;
    struct lm_nav_origin origin;
};

static enum lm_nav_quality worse_of(enum lm_nav_quality a, enum lm_nav_quality b)
{
    return a < b ? a : b;
}

static struct reading read_item(enum lm_bus_field field, const struct lm_nav_item *item,
                                uint64_t now_us)
{
    struct reading r = {.field = field, .quality = LM_NAV_DEAD};
    if (!item->has_value) {
        return r;
    }
    const uint64_t stale_us = lm_us_of_ms(item->stale_ms), dead_us = lm_us_of_ms(item->dead_ms);
    const bool is_ahead = item->time_us > now_us;
    const uint64_t age_us = is_ahead ? 0 : now_us - item->time_us;
    if (age_us > dead_us || (is_ahead && item->time_us - now_us > stale_us)) {
        return r;
    }
    r.quality = age_us > stale_us ? LM_NAV_STALE : LM_NAV_GOOD;
    r.value = item->value;
    r.age_us = (int64_t)age_us;
    r.step = item->step;
    r.is_settled = now_us >= item->steady_us && now_us - item->steady_us >= LM_NAV_SETTLE_US;
    r.origin = (struct lm_nav_origin){(uint32_t)age_us, item->rank, item->row, item->node};
    return r;
}

/* Order of preference of senders: good and settled, good, stale, dead. */
static uint32_t merit_of(const struct reading *r)
{
    return r->quality == LM_NAV_GOOD ? (r->is_settled ? 3 : 2) : r->quality;
}

/* A sender's last value of a field; NULL if there is none. Items are filled from the first on. */
static const struct lm_nav_item *find_item(const struct lm_nav *n, enum lm_bus_field field,
                                           uint16_t rank)
{
    const struct lm_nav_item *item = n->item[field];
    for (uint32_t i = 0; i < LM_NAV_SOURCES && item[i].has_value; i++) {
        if (item[i].rank == rank) {
            return &item[i];
        }
    }
    return NULL;
}

/* Values of two fields from one sender. */
struct pair {
    struct reading first, second;
};

/* Read both fields from the best sender that has both. They may be the same field. */
static struct pair read_pair(const struct lm_nav *n, enum lm_bus_field first,
                             enum lm_bus_field second, uint64_t now_us)
{
    const struct lm_nav_item *item = n->item[first];
    struct pair best = {.first = {.field = first}, .second = {.field = second}};
    uint32_t best_merit = 0;
    for (uint32_t i = 0; i < LM_NAV_SOURCES && item[i].has_value; i++) {
        const struct lm_nav_item *mate =
            first == second ? &item[i] : find_item(n, second, item[i].rank);
        if (mate == NULL) {
            continue;
        }
        struct pair p = {.first = read_item(first, &item[i], now_us)};
        p.second = mate == &item[i] ? p.first : read_item(second, mate, now_us);
        const uint32_t a = merit_of(&p.first), b = merit_of(&p.second), merit = a < b ? a : b;
        if (merit > best_merit ||
            (merit == best_merit && merit > 0 && item[i].rank < best.first.origin.rank)) {
            best = p;
            best_merit = merit;
        }
    }
    return best;
}

static struct reading read_field(const struct lm_nav *n, enum lm_bus_field field, uint64_t now_us)
{
    return read_pair(n, field, field, now_us).first;
}

static enum lm_nav_quality quality_of(const struct pair *p)
{
    return worse_of(p->first.quality, p->second.quality);
}

static struct lm_nav_origin origin_of(const struct pair *p)
{
    struct lm_nav_origin origin = p->first.origin;
    if (p->second.origin.age_us > origin.age_us) {
        origin.age_us = p->second.origin.age_us;
    }
    return origin;
}

/* The first of two that is not dead. */
static struct reading first_alive(struct reading a, struct reading b)
{
    return a.quality != LM_NAV_DEAD ? a : b;
}

/* value * cosine, for |value| below 2^32. */
static int64_t times_q30(int64_t value, int32_t factor_q30)
{
    return (value * factor_q30) >> 30;
}

static struct velocity read_velocity(const struct lm_nav *n, uint64_t now_us)
{
    const struct pair v = read_pair(n, LM_BUS_NORTH_VELOCITY, LM_BUS_EAST_VELOCITY, now_us);
    if (quality_of(&v) != LM_NAV_DEAD) {
        return (struct velocity){quality_of(&v), v.first.value, v.second.value, origin_of(&v)};
    }
    const struct pair polar = read_pair(n, LM_BUS_GROUND_SPEED, LM_BUS_TRUE_TRACK, now_us);
    const int32_t speed = polar.first.value;
    const fx_bam_t track = (fx_bam_t)polar.second.value;
    return (struct velocity){
        .quality = quality_of(&polar),
        .north_mm_s = (int32_t)times_q30(speed, fx_cos_q30(track)),
        .east_mm_s = (int32_t)times_q30(speed, fx_sin_q30(track)),
        .origin = origin_of(&polar),
    };
}

static struct reading read_height(const struct lm_nav *n, uint64_t now_us)
{
    const struct reading true_height = first_alive(read_field(n, LM_BUS_ELLIPSOID_HEIGHT, now_us),
                                                   read_field(n, LM_BUS_TRUE_ALTITUDE, now_us));
    const struct reading baro = read_field(n, LM_BUS_BARO_ALTITUDE, now_us);
    return n->is_baro_preferred ? first_alive(baro, true_height) : first_alive(true_height, baro);
}

static void set_velocity(struct lm_ownship *out, const struct velocity *v)
{
    out->velocity_quality = v->quality;
    out->velocity_origin = v->origin;
    out->velocity_north_mm_s = v->north_mm_s;
    out->velocity_east_mm_s = v->east_mm_s;
    out->ground_speed_mm_s = (int32_t)fx_hypot_u32(v->north_mm_s, v->east_mm_s);
    out->track = fx_atan2(v->east_mm_s, v->north_mm_s);
}

static void set_height(struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const struct reading height = read_height(n, now_us);
    const struct reading rate = first_alive(read_field(n, LM_BUS_UP_VELOCITY, now_us),
                                            read_field(n, LM_BUS_ALTITUDE_RATE, now_us));
    out->height_quality = height.quality;
    out->height_source = height.field;
    out->height_origin = height.origin;
    /* mm/s * us are nanometres, at most 500,000 * 65,535,000. */
    out->height_m_q6 = height.value + lm_m_q6_of_nm(rate.value * height.age_us);
}

/* Angle in BAM that a point moves in `age_us` at `speed_mm_s` on a circle. The way is below 1.5 *
 * 10^6 mm/s * 2 s = 3 * 10^9 um, times 2^32 / (2 pi) below 2^61; the radius, 2^31, takes 2^43 as
 * micrometres. */
static int64_t arc_bam(int32_t speed_mm_s, int64_t age_us, int64_t radius_m_q8)
{
    const int64_t way_um = lm_um_of_nm(speed_mm_s * age_us);
    return way_um * FX_BAM_PER_RADIAN / lm_um_of_m_q8(radius_m_q8);
}

/* Extrapolate a latitude by `age_us`. */
static int32_t carry_latitude(int32_t latitude, int64_t age_us, const struct lm_geo_origin *origin,
                              int64_t height_m_q8, const struct velocity *v)
{
    const int64_t moved =
        latitude + arc_bam(v->north_mm_s, age_us, origin->meridian_radius_m_q8 + height_m_q8);
    const int32_t pole = (int32_t)FX_BAM_90;
    return (int32_t)fx_clamp_i64(moved, -pole, pole);
}

/* Extrapolate a longitude by `age_us`; `latitude` is the latitude at the end. The circle is that of
 * the latitude half way, which is exact to second order for a course of constant velocity. */
static int32_t carry_longitude(int32_t longitude, int64_t age_us, fx_bam_t latitude,
                               const struct lm_geo_origin *origin, int64_t height_m_q8,
                               const struct velocity *v)
{
    const int64_t least_radius_m_q8 = LM_M_Q8(64000); /* 0.6 degree from the pole */
    const int64_t meridian_m_q8 = origin->meridian_radius_m_q8 + height_m_q8;
    const fx_bam_t half_way =
        latitude - (fx_bam_t)(arc_bam(v->north_mm_s, age_us, meridian_m_q8) / 2);
    const int64_t circle_m_q8 =
        times_q30(origin->prime_vertical_radius_m_q8 + height_m_q8, fx_cos_q30(half_way));
    const int64_t moved = arc_bam(
        v->east_mm_s, age_us, circle_m_q8 > least_radius_m_q8 ? circle_m_q8 : least_radius_m_q8);
    return (int32_t)((uint32_t)longitude + (uint32_t)moved);
}

/* Extrapolate both coordinates, each from its own time. */
static void set_position(struct lm_ownship *out, const struct lm_nav *n, const struct velocity *v,
                         uint64_t now_us)
{
    const struct pair p = read_pair(n, LM_BUS_LATITUDE, LM_BUS_LONGITUDE, now_us);
    out->position_quality = quality_of(&p);
    if (out->position_quality == LM_NAV_DEAD) {
        return;
    }
    if (v->quality == LM_NAV_DEAD || p.first.step > LM_NAV_COARSE_BAM ||
        p.second.step > LM_NAV_COARSE_BAM) {
        out->position_quality = LM_NAV_STALE;
    }
    out->position_origin = origin_of(&p);
    const int64_t height_m_q8 = lm_m_q8_of_m_q6(out->height_m_q6);
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, (struct lm_position){(fx_bam_t)p.first.value, 0});
    out->latitude =
        (fx_bam_t)carry_latitude(p.first.value, p.first.age_us, &origin, height_m_q8, v);
    out->longitude = (fx_bam_t)carry_longitude(p.second.value, p.second.age_us, out->latitude,
                                               &origin, height_m_q8, v);
}

static void set_attitude(struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const struct pair p = read_pair(n, LM_BUS_PITCH, LM_BUS_ROLL, now_us);
    out->attitude_quality = quality_of(&p);
    out->attitude_origin = origin_of(&p);
    out->pitch = p.first.value;
    out->roll = p.second.value;
}

/* Rate of turn of the heading, BAM a second: (q sin(roll) + r cos(roll)) / cos(pitch), the third of
 * Euler's kinematic equations. 0 if a number that it needs is not good, and beyond 80 degrees of
 * pitch, where heading has no meaning. Rates are below 2^31, so their mix is below 2^32 and the
 * quotient below 2^35. */
static int64_t heading_rate(const struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const int32_t cos_80_q30 = 186453111; /* cos(80 degrees) * 2^30 */
    const struct pair rates = read_pair(n, LM_BUS_PITCH_RATE, LM_BUS_YAW_RATE, now_us);
    const int32_t cos_pitch_q30 = fx_cos_q30((fx_bam_t)out->pitch);
    if (worse_of(quality_of(&rates), out->attitude_quality) != LM_NAV_GOOD ||
        cos_pitch_q30 < cos_80_q30) {
        return 0;
    }
    const int64_t mix = times_q30(rates.first.value, fx_sin_q30((fx_bam_t)out->roll)) +
                        times_q30(rates.second.value, fx_cos_q30((fx_bam_t)out->roll));
    return mix * (1 << 30) / cos_pitch_q30;
}

/* The heading to use. A magnetic one with a variation is certain, one that does not say what it is
 * is not. Variation changes slowly: its age does not make the heading old. */
static struct reading read_heading(const struct lm_nav *n, uint64_t now_us, bool *is_magnetic)
{
    const struct reading of_true = read_field(n, LM_BUS_TRUE_HEADING, now_us),
                         plain = read_field(n, LM_BUS_HEADING, now_us),
                         compass = read_field(n, LM_BUS_MAGNETIC_HEADING, now_us),
                         variation = read_field(n, LM_BUS_MAGNETIC_VARIATION, now_us);
    const bool is_plain_used =
        compass.quality == LM_NAV_DEAD || (variation.quality == LM_NAV_DEAD &&
                                           plain.quality != LM_NAV_DEAD && !n->is_heading_magnetic);
    struct reading r = is_plain_used ? plain : compass;
    *is_magnetic = false;
    if (of_true.quality != LM_NAV_DEAD) {
        return of_true;
    }
    if (r.quality != LM_NAV_DEAD && (!is_plain_used || n->is_heading_magnetic)) {
        *is_magnetic = variation.quality == LM_NAV_DEAD;
        r.value = (int32_t)((uint32_t)r.value + (uint32_t)variation.value);
    }
    return r;
}

static void set_heading(struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const struct reading heading = read_heading(n, now_us, &out->is_heading_magnetic);
    out->heading_quality = heading.quality;
    out->heading_source = heading.field;
    out->heading_origin = heading.origin;
    /* A good attitude and rates keep the rate below 2^35, and no age passes 65.5 s, 2^26 us. */
    const int64_t rate = heading_rate(out, n, now_us);
    out->heading = (fx_bam_t)heading.value + (fx_bam_t)(rate * heading.age_us / 1000000);
    out->turn_bam_s = fx_sat_i32(rate);
}

static void set_steerpoint(struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const struct pair p =
        read_pair(n, LM_BUS_STEERPOINT_LATITUDE, LM_BUS_STEERPOINT_LONGITUDE, now_us);
    out->steerpoint_quality = quality_of(&p);
    out->steerpoint = (struct lm_position){(fx_bam_t)p.first.value, (fx_bam_t)p.second.value};
}

static void set_utc(struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const struct reading utc = read_field(n, LM_BUS_UTC, now_us);
    out->utc_quality = utc.quality;
    out->utc_origin = utc.origin;
    out->utc_s = (int32_t)((utc.value + utc.age_us / 1000000) % 86400);
}

void lm_nav_at(const struct lm_nav *n, uint64_t now_us, struct lm_ownship *out)
{
    *out = (struct lm_ownship){0};
    const struct velocity v = read_velocity(n, now_us);
    set_velocity(out, &v);
    set_height(out, n, now_us);
    set_position(out, n, &v, now_us);
    set_attitude(out, n, now_us);
    set_heading(out, n, now_us);
    set_steerpoint(out, n, now_us);
    set_utc(out, n, now_us);
}

void lm_nav_init(struct lm_nav *n)
{
    *n = (struct lm_nav){0};
}

/* True if a new value of this coordinate is farther from the sender's last one than an aircraft can
 * have flown. A count of latitude is 9.31 to 9.36 mm, one of longitude 9.33 mm times the cosine of
 * latitude. */
static bool is_jump(const struct lm_nav *n, const struct lm_nav_item *last,
                    const struct lm_bus_event *fix)
{
    const struct lm_nav_item *latitude = find_item(n, LM_BUS_LATITUDE, last->rank);
    const bool is_longitude = fix->field == LM_BUS_LONGITUDE && latitude != NULL;
    const int32_t cosine_q30 = is_longitude ? fx_cos_q30((fx_bam_t)latitude->value) : 1 << 30;
    const uint32_t apart = fx_abs_u32((int32_t)((uint32_t)fix->value - (uint32_t)last->value));
    const uint32_t way = apart > fix->step ? apart - fix->step : 0;
    const int64_t way_mm = times_q30(way, cosine_q30) * 933 / 100;

    const uint64_t period_us = fix->period_us, day_us = 86400000000ull;
    uint64_t time_us = fix->time_us > last->time_us ? fix->time_us - last->time_us : 0;
    time_us = time_us < period_us ? period_us : time_us > day_us ? day_us : time_us;
    return way_mm > (int64_t)(time_us * LM_NAV_JUMP_M_S / 1000);
}

/* Smooth a coordinate that is known to within half a step: the last one extrapolated, then moved
 * into that half step. Differences of angles below half a circle survive the wrap. */
static int32_t smooth(const struct lm_nav *n, const struct lm_nav_item *last,
                      const struct lm_bus_event *fix)
{
    const enum lm_bus_field field = (enum lm_bus_field)fix->field;
    const struct reading before = read_item(field, last, fix->time_us);
    const struct velocity v = read_velocity(n, fix->time_us);
    const struct lm_nav_item *latitude = find_item(n, LM_BUS_LATITUDE, last->rank);
    if (before.quality == LM_NAV_DEAD || v.quality == LM_NAV_DEAD || latitude == NULL) {
        return fix->value;
    }
    const int64_t height_m_q8 = lm_m_q8_of_m_q6(read_height(n, fix->time_us).value);
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, (struct lm_position){(fx_bam_t)latitude->value, 0});
    const int32_t carried =
        field == LM_BUS_LATITUDE
            ? carry_latitude(last->value, before.age_us, &origin, height_m_q8, &v)
            : carry_longitude(last->value, before.age_us, (fx_bam_t)latitude->value, &origin,
                              height_m_q8, &v);
    const int32_t off = (int32_t)((uint32_t)carried - (uint32_t)fix->value);
    const int32_t half = fix->step > INT32_MAX ? INT32_MAX / 2 : (int32_t)(fix->step / 2);
    const int32_t held = fx_clamp_i32(off, -half, half);
    return (int32_t)((uint32_t)fix->value + (uint32_t)held);
}

/* Item for a sender's value: its own, or an empty one, or that of the worst other sender if that
 * one is dead or of a higher rank. NULL if there is none. */
static struct lm_nav_item *slot_for(struct lm_nav *n, const struct lm_bus_event *event,
                                    uint16_t rank)
{
    const enum lm_bus_field field = (enum lm_bus_field)event->field;
    struct lm_nav_item *worst = &n->item[field][0];
    uint32_t worst_rank = 0;
    for (uint32_t i = 0; i < LM_NAV_SOURCES; i++) {
        struct lm_nav_item *item = &n->item[field][i];
        if (item->has_value && item->rank == rank) {
            return item;
        }
        const struct reading r = read_item(field, item, event->time_us);
        const uint32_t its_rank = r.quality == LM_NAV_DEAD ? UINT32_MAX - i : item->rank;
        if (its_rank > worst_rank) {
            worst = item;
            worst_rank = its_rank;
        }
    }
    return worst_rank > rank ? worst : NULL;
}

/* By how much two good senders of a field may differ, in its unit; 0: they are not compared. In
 * 0.3 s, the age of a good position, 300 m/s are 0.001 degree. UNSOURCED. */
static const int32_t tolerance[LM_BUS_NAV_FIELDS] = {
    [LM_BUS_LATITUDE] = POSITION_TOLERANCE,
    [LM_BUS_LONGITUDE] = POSITION_TOLERANCE,
    [LM_BUS_ELLIPSOID_HEIGHT] = 100 << 6,
    [LM_BUS_GROUND_SPEED] = 20000,
    [LM_BUS_PITCH] = ANGLE_TOLERANCE,
    [LM_BUS_ROLL] = ANGLE_TOLERANCE,
    [LM_BUS_HEADING] = ANGLE_TOLERANCE,
    [LM_BUS_TRUE_HEADING] = ANGLE_TOLERANCE,
    [LM_BUS_BARO_ALTITUDE] = 100 << 6,
    [LM_BUS_TRUE_ALTITUDE] = 100 << 6,
    [LM_BUS_ALTITUDE_RATE] = 20000,
    [LM_BUS_EAST_VELOCITY] = 20000,
    [LM_BUS_NORTH_VELOCITY] = 20000,
    [LM_BUS_UP_VELOCITY] = 20000,
    [LM_BUS_MAGNETIC_HEADING] = ANGLE_TOLERANCE,
    [LM_BUS_UTC] = 5,
};

/* Compare a sender's new value with those of the others. Differences of angles wrap. */
static void compare_senders(struct lm_nav *n, const struct lm_nav_item *item,
                            const struct lm_bus_event *event)
{
    const enum lm_bus_field field = (enum lm_bus_field)event->field;
    const uint32_t most = (uint32_t)tolerance[field] + event->step;
    for (uint32_t i = 0; i < LM_NAV_SOURCES && tolerance[field] != 0; i++) {
        const struct lm_nav_item *other = &n->item[field][i];
        if (other == item || read_item(field, other, event->time_us).quality != LM_NAV_GOOD) {
            continue;
        }
        const uint32_t apart =
            fx_abs_u32((int32_t)((uint32_t)item->value - (uint32_t)other->value));
        if (apart > most && apart - most > other->step) {
            n->disagreements++;
            n->disagreeing = event->field;
        }
    }
}

void lm_nav_take(struct lm_nav *n, const struct lm_bus_event *event)
{
    if (event->field >= LM_BUS_NAV_FIELDS) {
        return;
    }
    const uint16_t rank = (uint16_t)(event->priority << 8 | event->channel);
    struct lm_nav_item *item = slot_for(n, event, rank);
    if (item == NULL) {
        n->crowded++;
        return;
    }
    const bool is_known = item->has_value && item->rank == rank;
    const bool goes_on = is_known && event->time_us >= item->time_us &&
                         event->time_us - item->time_us <= lm_us_of_ms(item->stale_ms);
    if (goes_on && item->node != event->node) {
        n->rivals++;
        n->rival_node = event->node;
        return;
    }
    int32_t value = event->value;
    if (is_known && event->field <= LM_BUS_LONGITUDE) {
        if (is_jump(n, item, event)) {
            n->position_jumps++;
        } else if (event->step > 0) {
            value = smooth(n, item, event);
        }
    }
    *item = (struct lm_nav_item){
        .time_us = event->time_us,
        .steady_us = goes_on ? item->steady_us : event->time_us,
        .value = value,
        .step = event->step,
        .stale_ms = event->stale_ms,
        .dead_ms = event->dead_ms,
        .rank = rank,
        .row = event->row,
        .node = event->node,
        .has_value = true,
    };
    compare_senders(n, item, event);
}
