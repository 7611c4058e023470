/* How long a new entity of DIS is on its way to the glass of a display that sweeps the ground map,
 * by the times of the parts: gateway, bus, steps of the unit, antenna, frames. Time is made up, so
 * that the figures are the same on every machine; what processors add is not in them (dis_delay.py
 * measures it for the gateway).
 *
 * The aircraft stands 5.5 km before a round lake. Each entity appears on it at a moment of its own,
 * and is removed when it was seen. Usage: dis_glass [ENTITIES] */
#include "dis/gateway.h"
#include "hs/angle.h"
#include "lm/unit.h"

#include "feed.h"
#include "scales.h"
#include "unit_rig.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    S = 1000000,
    PANEL_STEP_US = 4000, /* of bsp/panel-linux */
    FRAME_US = 135,       /* of a frame at 1 Mbit/s, every stuff bit */
    QUEUE = 64,
    ENTITIES_MOST = 1000,
    BRIGHT = 100,
    SEEN_WITHIN_S = 20
};

/* Frames on their way. */
static struct {
    struct lm_can_frame frame[QUEUE];
    uint64_t at_us[QUEUE];
    int first, count;
    const struct lm_can *flight;
    uint64_t now_us;
} bus;

static bool send_frame(void *context, const struct lm_can_frame *frame, int64_t time_us)
{
    (void)context;
    const int at = (bus.first + bus.count) % QUEUE;
    if (bus.count == QUEUE) {
        return false;
    }
    bus.frame[at] = *frame;
    bus.at_us[at] = (uint64_t)time_us + FRAME_US;
    bus.count++;
    return true;
}

static int receive(void *context, struct lm_can_frame *frame)
{
    (void)context;
    if (bus.count > 0 && bus.at_us[bus.first] <= bus.now_us) {
        *frame = bus.frame[bus.first];
        frame->time_us = bus.at_us[bus.first];
        bus.first = (bus.first + 1) % QUEUE;
        bus.count--;
        return 1;
    }
    return bus.flight->receive(bus.flight->ctx, frame);
}

static struct dis_entity_state ship_at(uint16_t entity, double latitude_deg, double longitude_deg)
{
    struct dis_entity_state s = {.id = {1, 2, entity},
                                 .type = {.kind = 1, .domain = 3, .country = 225, .category = 1},
                                 .motion.algorithm = DIS_FPW};
    const struct dis_place place = {latitude_deg, longitude_deg, 0};
    dis_place_back(&place, s.motion.place_m);
    return s;
}

/* The brightest of the pixels around a place, in the radar's plane or on the glass. */
static int brightest(const struct rig *r, struct lm_position position, bool is_glass)
{
    struct lm_offset offset;
    int most = 0;
    if (!lm_view_find(&r->unit.picture.view, position, &offset)) {
        return 0;
    }
    const struct lm_point at = lm_view_point(&r->unit.picture.view, offset);
    for (int32_t y = at.y - 2; y <= at.y + 2; y++) {
        for (int32_t x = at.x - 2; x <= at.x + 2; x++) {
            const int value =
                is_glass ? (int)(r->glass[y * WIDTH + x] & 255) : r->plane[y * WIDTH + x];
            most = value > most ? value : most;
        }
    }
    return most;
}

static void step(struct rig *r, struct dis_gateway *g)
{
    r->now_us += PANEL_STEP_US;
    r->bus.now_us = bus.now_us = r->now_us;
    /* The program's steps and the unit's are not in step. */
    dis_gateway_step(g, (int64_t)r->now_us - 1234);
    lm_unit_step(&r->unit, r->now_us);
}

/* When the entity was accepted, painted and shown, microseconds after its state; 0: never. */
struct seen {
    uint64_t accepted_us, painted_us, shown_us;
};

static struct seen watch(struct rig *r, struct dis_gateway *g, struct lm_position position,
                         uint64_t told_us)
{
    struct seen seen = {0, 0, 0};
    while (seen.shown_us == 0 && r->now_us < told_us + (uint64_t)SEEN_WITHIN_S * S) {
        step(r, g);
        const uint64_t since_us = r->now_us - told_us;
        if (seen.accepted_us == 0 && r->unit.live.live.count > 0) {
            seen.accepted_us = since_us;
        }
        if (seen.painted_us == 0 && brightest(r, position, false) >= BRIGHT) {
            seen.painted_us = since_us;
        }
        if (seen.painted_us != 0 && brightest(r, position, true) >= BRIGHT) {
            seen.shown_us = since_us;
        }
    }
    return seen;
}

/* One entity: it appears, is watched, and goes; until the lake is dark again. */
static struct seen measure(struct rig *r, struct dis_gateway *g, uint16_t number)
{
    const double north = 46 + 0.004 * (rand() / (double)RAND_MAX - 0.5);
    const double east = 11 + 0.004 * (rand() / (double)RAND_MAX - 0.5);
    const struct lm_position position = {hs_bam(north), hs_bam(east)};
    const uint64_t pause_us = (uint64_t)(rand() / (double)RAND_MAX * 4 * S);
    for (const uint64_t until_us = r->now_us + pause_us; r->now_us < until_us;) {
        step(r, g);
    }
    const uint64_t told_us = r->now_us + (uint64_t)rand() % PANEL_STEP_US;
    struct dis_entity_state s = ship_at(number, north, east);
    dis_gateway_take_entity(g, &s, (int64_t)told_us);
    dis_gateway_step(g, (int64_t)told_us);
    const struct seen seen = watch(r, g, position, told_us);
    s.is_deactivated = true;
    dis_gateway_take_entity(g, &s, (int64_t)r->now_us);
    const uint64_t end_us = r->now_us + (uint64_t)SEEN_WITHIN_S * S;
    while (r->now_us < end_us && brightest(r, position, false) >= BRIGHT / 2) {
        step(r, g);
    }
    return seen;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

static void print(const char *what, double *ms, int count)
{
    qsort(ms, (size_t)count, sizeof *ms, compare);
    printf("  %-34s median %7.1f   99 %% %7.1f\n", what, ms[count / 2], ms[(count - 1) * 99 / 100]);
}

/* A display in flight, hung at a bus of its own. */
static struct rig *hang_rig(struct lm_board *board, struct lm_can *can)
{
    struct rig *r = fly_rig();
    *board = *r->unit.board;
    *can = *board->can;
    bus.flight = board->can;
    can->receive = receive;
    can->ctx = NULL;
    board->can = can;
    r->unit.board = board;
    r->bus.speed_m_s = 0;
    run(r, 8);
    return r;
}

static int measure_all(struct rig *r, struct dis_gateway *g, int entities)
{
    static double accepted_ms[ENTITIES_MOST], painted_ms[ENTITIES_MOST], shown_ms[ENTITIES_MOST];
    int count = 0;
    for (int i = 0; i < entities; i++) {
        const struct seen seen = measure(r, g, (uint16_t)(i + 1));
        if (seen.shown_us != 0) {
            accepted_ms[count] = (double)seen.accepted_us / 1e3;
            painted_ms[count] = (double)seen.painted_us / 1e3;
            shown_ms[count++] = (double)seen.shown_us / 1e3;
        }
    }
    const struct lm_sector *s = &r->unit.picture.sector;
    printf(
        "A new entity of DIS, from its state to the display (ground map, a sweep of %.2f s; "
        "made-up time): ms\n",
        s->lines * lm_sector_line_us(s) / 1e6);
    if (count == 0) {
        printf("  none of %d was seen\n", entities);
        return 1;
    }
    print("accepted by the unit", accepted_ms, count);
    print("in the first line that draws it", painted_ms, count);
    print("on the glass", shown_ms, count);
    printf("  (%d of %d entities)\n", count, entities);
    return 0;
}

int main(int argc, char **argv)
{
    static struct dis_kinds kinds;
    struct lm_board board;
    struct lm_can can;
    const int wanted = argc > 1 ? atoi(argv[1]) : 100;
    const int entities = wanted > 0 && wanted <= ENTITIES_MOST ? wanted : ENTITIES_MOST;
    const struct dis_settings settings = dis_settings_usual();
    const struct dis_sink sink = {send_frame, NULL};
    struct dis_gateway *g =
        dis_kinds_read_builtin(&kinds) == 0 ? dis_gateway_new(&settings, &kinds, &sink) : NULL;
    if (g == NULL) {
        return 1;
    }
    srand(1);
    struct rig *r = hang_rig(&board, &can);
    const int status = measure_all(r, g, entities);
    dis_gateway_free(g);
    free_rig(r);
    return status;
}
