/* The display, as it hears the gateway: what the firmware makes of the frames is where the entities
 * are, and it refuses none of them. */
#include "check.h"
#include "dis/gateway.h"
#include "hs/rng.h"
#include "lm/bus.h"
#include "lm/live_bus.h"
#include "make_pdu.h"
#include "wgs84.h"

#include <math.h>
#include <stdlib.h>

enum { STEP_US = 5000, SECOND_US = 1000000, VEHICLES = 36 };

static struct lm_bus bus;
static struct lm_live_bus live;

static bool hear(void *context, const struct lm_can_frame *sent, int64_t time_us)
{
    struct lm_bus_event events[LM_BUS_EVENTS];
    struct lm_can_frame frame = *sent;
    (void)context;
    frame.time_us = (uint64_t)time_us;
    const uint32_t count = lm_bus_take(&bus, &frame, events);
    assert_true(count >= 1);
    for (uint32_t i = 0; i < count; i++) {
        lm_live_bus_take(&live, &events[i], events[i].time_us);
    }
    return true;
}

static struct dis_kinds kinds;

static struct dis_gateway *connect(void)
{
    const struct dis_settings settings = dis_settings_usual();
    const struct dis_sink sink = {hear, NULL};
    live = (struct lm_live_bus){.next = 0};
    lm_bus_init(&bus, &lm_bus_canas17);
    assert_int_equal(dis_kinds_read_builtin(&kinds), 0);
    struct dis_gateway *g = dis_gateway_new(&settings, &kinds, &sink);
    assert_non_null(g);
    return g;
}

/* A vehicle of any model somewhere, as fast as such things are. */
static struct made_entity any_entity(struct hs_rng *rng, uint16_t number)
{
    struct made_entity e = made_vehicle(number);
    const struct dis_place at = {120 * hs_rng_uniform(rng) - 60, 360 * hs_rng_uniform(rng) - 180,
                                 3000 * hs_rng_uniform(rng)};
    const struct dis_axes axes = dis_axes_at(&at);
    const double heading = 6.28 * hs_rng_uniform(rng), speed = 60 * hs_rng_uniform(rng);
    const bool is_body = number % 9 + 1 >= 6;
    double ahead[3];
    dis_place_back(&at, e.place);
    for (int i = 0; i < 3; i++) {
        ahead[i] = sin(heading) * axes.east[i] + cos(heading) * axes.north[i];
        e.velocity[i] = (float)(is_body ? (i == 0 ? speed : 0) : speed * ahead[i]);
        e.acceleration[i] = (float)(is_body ? (i == 0 ? 1.5 : 0) : 1.5 * axes.east[i]);
    }
    const double right_z = -sin(heading) * axes.north[2];
    e.orientation[0] = (float)atan2(ahead[1], ahead[0]);
    e.orientation[1] = (float)asin(-ahead[2]);
    e.orientation[2] = (float)atan2(right_z, -axes.up[2]);
    e.turn[2] = (float)(0.2 * hs_rng_normal(rng));
    e.algorithm = (uint8_t)(number % 9 + 1);
    return e;
}

static double off_m(const struct dis_gateway *g, int index, int64_t now_us)
{
    const struct dis_listed e = dis_gateway_entity(g, index, now_us);
    assert_true(e.number >= 0 && live.live.target[e.number].is_there);
    const struct lm_live_state s = lm_live_at(&live.live.target[e.number], (uint64_t)now_us);
    const double bam = 360 / 4294967296.0;
    return wgs84_metres((int32_t)s.position.latitude * bam, (int32_t)s.position.longitude * bam,
                        e.place.latitude_deg, e.place.longitude_deg);
}

TEST(the_display_has_every_entity_within_the_threshold_for_every_model)
{
    struct dis_gateway *g = connect();
    struct hs_rng rng;
    int64_t now_us = 100 * (int64_t)SECOND_US;
    double worst_m = 0;
    hs_rng_seed(&rng, 8);
    for (uint16_t i = 1; i <= VEHICLES; i++) {
        const struct made_entity e = any_entity(&rng, i);
        struct made m = {.length = 0};
        made_entity_state(&m, &e);
        dis_gateway_take(g, m.bytes, m.length, now_us);
    }
    for (int step = 0; step < 10 * SECOND_US / STEP_US; step++) {
        now_us += STEP_US;
        dis_gateway_step(g, now_us);
        for (int i = 0; i < dis_gateway_entities(g) && step > 100; i++) {
            worst_m = fmax(worst_m, off_m(g, i, now_us + DIS_SET_MAX * 135));
        }
    }
    print_message("# worst: %.2f m\n", worst_m);
    assert_true(worst_m < 0.5);
    assert_int_equal(live.live.count, VEHICLES);
    assert_true(live.count.torn == 0 && live.count.refused == 0 && live.count.rivals == 0);
    assert_int_equal(live.count.sets, dis_gateway_counts(g)->sets);
    dis_gateway_end(g, now_us);
    assert_int_equal(live.live.count, 0);
    dis_gateway_free(g);
}

/* Whatever passes the reader of PDUs, the display takes what is made of it. */
TEST(the_display_refuses_no_set_however_odd_the_entity)
{
    struct dis_gateway *g = connect();
    struct hs_rng rng;
    int64_t now_us = 100 * (int64_t)SECOND_US;
    hs_rng_seed(&rng, 9);
    for (int n = 0; n < 20000; n++) {
        struct made_entity e = any_entity(&rng, (uint16_t)(hs_rng_below(&rng, 200) + 1));
        struct made m = {.length = 0};
        const double scale = pow(10, 4 * hs_rng_uniform(&rng) - 1);
        for (int i = 0; i < 3; i++) {
            e.velocity[i] = (float)(scale * hs_rng_normal(&rng));
            e.acceleration[i] = (float)(0.1 * scale * hs_rng_normal(&rng));
            e.turn[i] = (float)(0.01 * scale * hs_rng_normal(&rng));
            e.orientation[i] = (float)(10 * hs_rng_normal(&rng));
        }
        e.domain = (uint8_t)(1 + hs_rng_below(&rng, 3));
        e.algorithm = (uint8_t)hs_rng_below(&rng, 12);
        made_entity_state(&m, &e);
        dis_gateway_take(g, m.bytes, m.length, now_us);
        now_us += STEP_US;
        dis_gateway_step(g, now_us);
    }
    assert_true(live.count.refused == 0 && live.count.torn == 0);
    assert_true(live.count.sets == dis_gateway_counts(g)->sets && live.count.sets > 5000);
    dis_gateway_free(g);
}
