#include "lm/nav.h"

#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/geo.h"

/* A field as it stands at some moment. */
struct reading {
    enum lm_canas_field field;
    enum lm_nav_quality quality;
    int32_t value;  /* 0 when dead */
    int64_t age_us; /* 0 when dead, at most the row's dead_ms otherwise */
};

struct velocity {
    enum lm_nav_quality quality;
    int32_t north_mm_s, east_mm_s;
};

static enum lm_nav_quality worse_of(enum lm_nav_quality a, enum lm_nav_quality b)
{
    return a < b ? a : b;
}

static struct reading read_field(const struct lm_nav *n, enum lm_canas_field field, uint64_t now_us)
{
    const struct lm_nav_item *item = &n->item[field];
    const uint64_t stale_us = lm_canas_table[field].stale_ms * 1000ull;
    const uint64_t dead_us = lm_canas_table[field].dead_ms * 1000ull;
    const bool is_ahead = item->time_us > now_us;
    const uint64_t age_us = is_ahead ? 0 : now_us - item->time_us;
    struct reading r = {.field = field, .quality = LM_NAV_DEAD};
    if (!item->has_value || age_us > dead_us || (is_ahead && item->time_us - now_us > stale_us)) {
        return r;
    }
    r.quality = age_us > stale_us ? LM_NAV_STALE : LM_NAV_GOOD;
    r.value = item->value;
    r.age_us = (int64_t)age_us;
    return r;
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
    const struct reading north = read_field(n, LM_CANAS_NORTH_VELOCITY, now_us);
    const struct reading east = read_field(n, LM_CANAS_EAST_VELOCITY, now_us);
    const enum lm_nav_quality quality = worse_of(north.quality, east.quality);
    if (quality != LM_NAV_DEAD) {
        return (struct velocity){quality, north.value, east.value};
    }
    const struct reading speed = read_field(n, LM_CANAS_GROUND_SPEED, now_us);
    const struct reading track = read_field(n, LM_CANAS_TRUE_TRACK, now_us);
    if (worse_of(speed.quality, track.quality) == LM_NAV_DEAD) {
        return (struct velocity){LM_NAV_DEAD, 0, 0};
    }
    return (struct velocity){
        .quality = worse_of(speed.quality, track.quality),
        .north_mm_s = (int32_t)times_q30(speed.value, fx_cos_q30((fx_bam_t)track.value)),
        .east_mm_s = (int32_t)times_q30(speed.value, fx_sin_q30((fx_bam_t)track.value)),
    };
}

static void set_velocity(struct lm_ownship *out, const struct velocity *v)
{
    out->velocity_quality = v->quality;
    out->velocity_north_mm_s = v->north_mm_s;
    out->velocity_east_mm_s = v->east_mm_s;
    out->ground_speed_mm_s = (int32_t)fx_hypot_u32(v->north_mm_s, v->east_mm_s);
    out->track = fx_atan2(v->east_mm_s, v->north_mm_s);
}

static void set_height(struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const struct reading height =
        first_alive(first_alive(read_field(n, LM_CANAS_GPS_HEIGHT, now_us),
                                read_field(n, LM_CANAS_TRUE_ALTITUDE, now_us)),
                    read_field(n, LM_CANAS_BARO_ALTITUDE, now_us));
    const struct reading rate = first_alive(read_field(n, LM_CANAS_UP_VELOCITY, now_us),
                                            read_field(n, LM_CANAS_ALTITUDE_RATE, now_us));
    out->height_quality = height.quality;
    out->height_source = height.field;
    /* mm/s * us is 1e-9 m, of which 15,625,000 make a 64th. At most 500,000 * 5,000,000. */
    out->height_q6 = height.value + (int32_t)(rate.value * height.age_us / 15625000);
}

/* Angle in BAM that a point moves in `age_us` at `speed_mm_s` on a circle. The way is below 1.5 *
 * 10^6 mm/s * 2 s = 3 * 10^9 um, times 2^32 / (2 pi) = 683,565,276 below 2^61; the radius, 2^31,
 * takes 2^43 as micrometres. */
static int64_t arc_bam(int32_t speed_mm_s, int64_t age_us, int64_t radius_q8)
{
    const int64_t way_um = speed_mm_s * age_us / 1000;
    return way_um * 683565276 / (radius_q8 * 15625 / 4);
}

/* Both coordinates from their own times. The longitude's circle is that of the latitude half way
 * along, which makes a course of constant velocity right to second order. */
static void move_position(struct lm_ownship *out, const struct reading *latitude,
                          const struct reading *longitude, const struct velocity *v)
{
    const fx_bam_t least_radius_q8 = 64000 << 8; /* 0.6 degree from the pole */
    const int64_t height_q8 = (int64_t)out->height_q6 * 4;
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, (struct lm_place){(fx_bam_t)latitude->value, 0});

    const int64_t m_q8 = origin.meridian_radius_q8 + height_q8;
    const int64_t north = latitude->value + arc_bam(v->north_mm_s, latitude->age_us, m_q8);
    const int32_t pole = (int32_t)FX_BAM_90;
    out->latitude = (fx_bam_t)(north > pole ? pole : north < -pole ? -pole : (int32_t)north);

    const fx_bam_t half_way =
        out->latitude - (fx_bam_t)(arc_bam(v->north_mm_s, longitude->age_us, m_q8) / 2);
    const int64_t n_q8 = origin.prime_vertical_radius_q8 + height_q8;
    const int64_t circle_q8 = times_q30(n_q8, fx_cos_q30(half_way));
    out->longitude = (fx_bam_t)longitude->value +
                     (fx_bam_t)arc_bam(v->east_mm_s, longitude->age_us,
                                       circle_q8 > least_radius_q8 ? circle_q8 : least_radius_q8);
}

static void set_position(struct lm_ownship *out, const struct lm_nav *n, const struct velocity *v,
                         uint64_t now_us)
{
    const struct reading latitude = read_field(n, LM_CANAS_LATITUDE, now_us);
    const struct reading longitude = read_field(n, LM_CANAS_LONGITUDE, now_us);
    out->position_quality = worse_of(latitude.quality, longitude.quality);
    if (out->position_quality == LM_NAV_DEAD) {
        return;
    }
    if (v->quality == LM_NAV_DEAD || n->item[LM_CANAS_LATITUDE].is_coarse ||
        n->item[LM_CANAS_LONGITUDE].is_coarse) {
        out->position_quality = LM_NAV_STALE;
    }
    move_position(out, &latitude, &longitude, v);
}

static void set_attitude(struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const struct reading pitch = read_field(n, LM_CANAS_PITCH, now_us);
    const struct reading roll = read_field(n, LM_CANAS_ROLL, now_us);
    out->attitude_quality = worse_of(pitch.quality, roll.quality);
    if (out->attitude_quality != LM_NAV_DEAD) {
        out->pitch = pitch.value;
        out->roll = roll.value;
    }
}

/* How fast the nose turns about the vertical, BAM a second: (q sin(roll) + r cos(roll)) /
 * cos(pitch), the third of Euler's kinematic equations. 0 when a number that it needs is not good,
 * and beyond 80 degrees of pitch, where heading loses its meaning. Rates are below 2^31, so their
 * mix is below 2^32 and the quotient below 2^35. */
static int64_t heading_rate(const struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const int32_t cos_80_q30 = 186453111; /* cos(80 degrees) * 2^30 */
    const struct reading q = read_field(n, LM_CANAS_PITCH_RATE, now_us);
    const struct reading r = read_field(n, LM_CANAS_YAW_RATE, now_us);
    const int32_t cos_pitch_q30 = fx_cos_q30((fx_bam_t)out->pitch);
    if (worse_of(worse_of(q.quality, r.quality), out->attitude_quality) != LM_NAV_GOOD ||
        cos_pitch_q30 < cos_80_q30) {
        return 0;
    }
    const int64_t mix = times_q30(q.value, fx_sin_q30((fx_bam_t)out->roll)) +
                        times_q30(r.value, fx_cos_q30((fx_bam_t)out->roll));
    return mix * (1 << 30) / cos_pitch_q30;
}

static void set_heading(struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const struct reading heading = first_alive(read_field(n, LM_CANAS_TRUE_HEADING, now_us),
                                               read_field(n, LM_CANAS_HEADING, now_us));
    out->heading_quality = heading.quality;
    out->heading_source = heading.field;
    /* The age is at most 1 s, 2^20 us. */
    const int64_t turn = heading_rate(out, n, now_us) * heading.age_us / 1000000;
    out->heading = (fx_bam_t)heading.value + (fx_bam_t)turn;
}

static void set_utc(struct lm_ownship *out, const struct lm_nav *n, uint64_t now_us)
{
    const struct reading utc = read_field(n, LM_CANAS_UTC, now_us);
    out->utc_quality = utc.quality;
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
    set_utc(out, n, now_us);
}

void lm_nav_init(struct lm_nav *n)
{
    *n = (struct lm_nav){0};
    lm_canas_init(&n->canas);
}

/* Is a new fix of this coordinate further from the last one than an aircraft could have come? A
 * count of latitude is 9.31 to 9.36 mm, one of longitude 9.33 mm times the cosine of latitude. */
static bool is_jump(const struct lm_nav *n, const struct lm_canas_event *fix)
{
    const struct lm_nav_item *last = &n->item[fix->field];
    if (!last->has_value) {
        return false;
    }
    const uint32_t way = fx_abs_u32((int32_t)((uint32_t)fix->value - (uint32_t)last->value));
    const int32_t cosine_q30 = fix->field == LM_CANAS_LATITUDE
                                   ? 1 << 30
                                   : fx_cos_q30((fx_bam_t)n->item[LM_CANAS_LATITUDE].value);
    const int64_t way_mm = times_q30(way, cosine_q30) * 933 / 100;

    const uint64_t period_us = lm_canas_table[fix->field].period_us, day_us = 86400000000ull;
    uint64_t time_us = fix->time_us > last->time_us ? fix->time_us - last->time_us : 0;
    time_us = time_us < period_us ? period_us : time_us > day_us ? day_us : time_us;
    return way_mm > (int64_t)(time_us * LM_NAV_JUMP_M_S / 1000);
}

void lm_nav_take(struct lm_nav *n, const struct lm_can_frame *frame)
{
    struct lm_canas_event event;
    if (lm_canas_take(&n->canas, frame, &event) != LM_CANAS_VALUE) {
        return;
    }
    if (event.field <= LM_CANAS_LONGITUDE && is_jump(n, &event)) {
        n->position_jumps++;
    }
    n->item[event.field] = (struct lm_nav_item){
        .value = event.value,
        .has_value = true,
        .is_coarse = event.is_coarse,
        .time_us = event.time_us,
    };
}
