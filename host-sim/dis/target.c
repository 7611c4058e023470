#include "dis/target.h"

#include "feed.h"

#include <math.h>
#include <string.h>

#define DEG                   (180 / 3.14159265358979323846)
#define SPEED_MAX_M_S         999.9 /* the display refuses 1,000, and both components are rounded */
#define ACCELERATION_MAX_M_S2 300.0
#define TURN_MAX_DEG_S        60.0
#define METRES_A_DEGREE       111320.0

enum { HEIGHT_LOWEST_M = -1000, HEIGHT_HIGHEST_M = 16000 };
enum { TYPE_FLOAT = 2, TYPE_LONG = 3, TYPE_UCHAR = 10, TYPE_SHORT2 = 12, TYPE_UCHAR4 = 16 };

/* ---- from an entity ---- */

double dis_sea_level_m(const struct dis_sea_level *sea, const struct dis_place *place)
{
    if (sea->grid == NULL) {
        return sea->height_m;
    }
    const struct lm_position at = {
        .latitude = (fx_bam_t)(int32_t)lround(place->latitude_deg / 360 * 4294967296.0),
        .longitude = (fx_bam_t)(int64_t)llround(place->longitude_deg / 360 * 4294967296.0)};
    return lm_geoid_height_m_q6(sea->grid, at) / 64.0;
}

static int16_t steps(double value, double step, double most)
{
    return (int16_t)lround(fmax(-most, fmin(most, value)) / step);
}

static bool is_turning(uint8_t algorithm)
{
    return algorithm == DIS_RPW || algorithm == DIS_RVW || algorithm == DIS_RPB ||
           algorithm == DIS_RVB;
}

static bool is_accelerating(uint8_t algorithm)
{
    return algorithm == DIS_RVW || algorithm == DIS_FVW || algorithm == DIS_RVB ||
           algorithm == DIS_FVB;
}

static void set_motion(const struct dis_state *s, const struct dis_axes *axes, struct dis_target *t)
{
    const double east_m_s = dis_dot(s->velocity_m_s, axes->east);
    const double north_m_s = dis_dot(s->velocity_m_s, axes->north);
    const double heading_deg =
        atan2(dis_dot(s->forward, axes->east), dis_dot(s->forward, axes->north)) * DEG;
    t->east_0m05_s = steps(east_m_s, 0.05, SPEED_MAX_M_S);
    t->north_0m05_s = steps(north_m_s, 0.05, SPEED_MAX_M_S);
    t->heading_bam16 = (int16_t)(lround(heading_deg / 180 * 32768) & 0xffff);
    /* Right is positive on the bus, and positive about the axis that points down. */
    t->turn_0d01_s = steps(-dis_dot(s->turn_rad_s, axes->up) * DEG, 0.01, TURN_MAX_DEG_S);
    t->east_0m01_s2 = steps(dis_dot(s->acceleration_m_s2, axes->east), 0.01, ACCELERATION_MAX_M_S2);
    t->north_0m01_s2 =
        steps(dis_dot(s->acceleration_m_s2, axes->north), 0.01, ACCELERATION_MAX_M_S2);
}

/* One that points up or down, such as a missile at its start, has no heading. */
#define LEVEL_LEAST 0.05

static bool has_heading(const struct dis_state *s, const struct dis_axes *axes)
{
    return hypot(dis_dot(s->forward, axes->east), dis_dot(s->forward, axes->north)) > LEVEL_LEAST;
}

static uint8_t parts_of(const struct dis_target *t, const struct dis_kind *kind, bool is_level)
{
    const bool moves = t->east_0m05_s != 0 || t->north_0m05_s != 0;
    const bool gains = t->east_0m01_s2 != 0 || t->north_0m01_s2 != 0;
    return (uint8_t)((is_level ? DIS_PART_HEADING : 0) |
                     (kind->is_on_ground ? 0 : DIS_PART_HEIGHT) | (moves ? DIS_PART_VELOCITY : 0) |
                     (gains && is_accelerating(t->algorithm) ? DIS_PART_ACCELERATION : 0) |
                     (isnan(kind->rcs_dbsm) ? 0 : DIS_PART_RCS));
}

static uint8_t algorithm_of(const struct dis_motion *m)
{
    return m->is_frozen || m->algorithm < DIS_STATIC || m->algorithm > DIS_FVB ? DIS_STATIC
                                                                               : m->algorithm;
}

enum dis_unfit dis_target_of(const struct dis_motion *motion, const struct dis_kind *kind,
                             const struct dis_sea_level *sea, double after_s, struct dis_target *t)
{
    const struct dis_state s = dis_reckon(motion, after_s);
    if (!dis_is_near_earth(s.place_m)) {
        return DIS_TOO_HIGH;
    }
    const struct dis_place place = dis_place_of(s.place_m);
    const struct dis_axes axes = dis_axes_at(&place);
    memset(t, 0, sizeof *t);
    t->latitude_1e7 = (int32_t)lround(place.latitude_deg * 1e7);
    t->longitude_1e7 = (int32_t)lround(place.longitude_deg * 1e7);
    t->height_m = kind->is_on_ground ? 0 : (float)(place.height_m - dis_sea_level_m(sea, &place));
    t->kind = kind->kind;
    t->signature = kind->signature;
    t->rcs_dbsm = isnan(kind->rcs_dbsm) ? 0 : (float)kind->rcs_dbsm;
    t->algorithm = algorithm_of(motion);
    set_motion(&s, &axes, t);
    const bool is_level = has_heading(&s, &axes);
    if (!is_level) {
        t->heading_bam16 = 0;
    }
    t->parts = parts_of(t, kind, is_level);
    if (hypot(dis_dot(s.velocity_m_s, axes.east), dis_dot(s.velocity_m_s, axes.north)) >
        SPEED_MAX_M_S) {
        return DIS_TOO_FAST;
    }
    return t->height_m < (float)HEIGHT_LOWEST_M || t->height_m > (float)HEIGHT_HIGHEST_M
               ? DIS_TOO_HIGH
               : DIS_FIT;
}

/* ---- what the display makes of it ---- */

/* Metres east and north that the display moves a target by, and degrees that it turns it. */
struct moved {
    double east_m, north_m, degrees;
};

static struct moved display_moves(const struct dis_target *t, double after_s)
{
    const double turn_deg_s = is_turning(t->algorithm) ? 0.01 * t->turn_0d01_s : 0;
    const bool gains = is_accelerating(t->algorithm) && (t->parts & DIS_PART_ACCELERATION) != 0;
    const double gain = gains ? 0.01 : 0, still = t->algorithm == DIS_STATIC ? 0 : 0.05;
    /* The axes of the body turn to the right: a turn about down in axes north, east, down. */
    const struct dis_motion m = {
        .velocity_m_s = {still * t->north_0m05_s, still * t->east_0m05_s, 0},
        .acceleration_m_s2 = {gain * t->north_0m01_s2, gain * t->east_0m01_s2, 0},
        .turn_rad_s = {0, 0, turn_deg_s / DEG},
        .algorithm = t->algorithm >= DIS_FPB ? DIS_RVB : DIS_FVW};
    const struct dis_state s = dis_reckon(&m, after_s);
    return (struct moved){s.place_m[1], s.place_m[0], turn_deg_s * after_s};
}

struct dis_error dis_target_error(const struct dis_target *old, double after_s,
                                  const struct dis_target *now)
{
    const struct moved moved = display_moves(old, after_s);
    const double cosine = cos(now->latitude_1e7 * 1e-7 / DEG);
    const double turned = remainder((now->longitude_1e7 - (double)old->longitude_1e7) * 1e-7, 360);
    const double north_m =
        (now->latitude_1e7 - (double)old->latitude_1e7) * 1e-7 * METRES_A_DEGREE - moved.north_m;
    const double east_m = turned * METRES_A_DEGREE * cosine - moved.east_m;
    const double up_m = (double)(now->height_m - old->height_m);
    const double off_deg = (now->heading_bam16 - old->heading_bam16) * (180.0 / 32768);
    return (struct dis_error){
        .metres = hypot(hypot(north_m, east_m), up_m),
        .degrees = fabs(remainder(off_deg - moved.degrees, 360)),
        .is_other = now->kind != old->kind || now->signature != old->signature ||
                    now->rcs_dbsm != old->rcs_dbsm || now->algorithm != old->algorithm ||
                    ((now->parts ^ old->parts) & (DIS_PART_HEIGHT | DIS_PART_HEADING)) != 0};
}

/* ---- frames ---- */

static struct lm_can_frame frame(uint16_t id, uint8_t node, uint8_t type, uint8_t number,
                                 uint8_t code, uint32_t word)
{
    return (struct lm_can_frame){.id = id,
                                 .length = 8,
                                 .data = {node, type, number, code, (uint8_t)(word >> 24),
                                          (uint8_t)(word >> 16), (uint8_t)(word >> 8),
                                          (uint8_t)word}};
}

static uint32_t float_word(float value)
{
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    return word;
}

static uint32_t pair_word(int16_t first, int16_t second)
{
    return (uint32_t)(uint16_t)first << 16 | (uint16_t)second;
}

int dis_target_frames(const struct dis_target *t, uint8_t node, uint8_t number, uint8_t code,
                      struct lm_can_frame frames[DIS_SET_MAX])
{
    const struct {
        uint8_t part;
        uint16_t id;
        uint8_t type;
        uint32_t word;
    } all[DIS_SET_MAX] = {
        {0, DIS_ID_KIND, TYPE_UCHAR4,
         (uint32_t)t->kind << 24 | (uint32_t)t->algorithm << 16 | (uint32_t)t->signature << 8 |
             t->parts},
        {0, DIS_ID_LATITUDE, TYPE_LONG, (uint32_t)t->latitude_1e7},
        {0, DIS_ID_LONGITUDE, TYPE_LONG, (uint32_t)t->longitude_1e7},
        {DIS_PART_HEIGHT, DIS_ID_HEIGHT, TYPE_FLOAT, float_word(t->height_m)},
        {DIS_PART_VELOCITY, DIS_ID_VELOCITY, TYPE_SHORT2,
         pair_word(t->east_0m05_s, t->north_0m05_s)},
        {DIS_PART_HEADING, DIS_ID_HEADING, TYPE_SHORT2,
         pair_word(t->heading_bam16, t->turn_0d01_s)},
        {DIS_PART_RCS, DIS_ID_RCS, TYPE_FLOAT, float_word(t->rcs_dbsm)},
        {DIS_PART_ACCELERATION, DIS_ID_ACCELERATION, TYPE_SHORT2,
         pair_word(t->east_0m01_s2, t->north_0m01_s2)},
    };
    int count = 0;
    for (int i = 0; i < DIS_SET_MAX; i++) {
        if (all[i].part == 0 || (t->parts & all[i].part) != 0) {
            frames[count++] = frame(all[i].id, node, all[i].type, number, code, all[i].word);
        }
    }
    return count;
}

struct lm_can_frame dis_removal(uint8_t node, uint8_t number, uint8_t code)
{
    struct lm_can_frame f = frame(DIS_ID_REMOVED, node, TYPE_UCHAR, number, code, 0);
    f.length = 5;
    return f;
}
