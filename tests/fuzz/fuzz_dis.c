/* Any bytes as datagrams of DIS, and as packets of a capture: nothing is read beyond them, and what
 * passes is near the Earth and finite, however long it is reckoned on. The input is datagrams, each
 * behind its length. */
#include "dis/capture.h"
#include "dis/earth.h"
#include "dis/gateway.h"
#include "dis/reckon.h"
#include "fuzz.h"

#include <math.h>

const uint32_t fuzz_mutations = 20000;

static void check_state(const struct dis_entity_state *s)
{
    FUZZ_ASSERT(s->marking[sizeof s->marking - 1] == 0);
    FUZZ_ASSERT(dis_is_near_earth(s->motion.place_m));
    const struct dis_place place = dis_place_of(s->motion.place_m);
    FUZZ_ASSERT(fabs(place.latitude_deg) <= 90 && fabs(place.longitude_deg) <= 180);
    for (double after_s = 0; after_s < 100; after_s = after_s * 3 + 0.01) {
        const struct dis_state now = dis_reckon(&s->motion, after_s);
        for (int i = 0; i < 3; i++) {
            FUZZ_ASSERT(isfinite(now.place_m[i]) && isfinite(now.velocity_m_s[i]));
            FUZZ_ASSERT(fabs(now.forward[i]) < 1.001);
        }
    }
}

static void take(const struct dis_pdu *pdu)
{
    struct dis_entity_state state;
    struct dis_command command;
    if ((pdu->type == DIS_ENTITY_STATE || pdu->type == DIS_ENTITY_STATE_UPDATE) &&
        dis_entity_state_read(pdu, &state) == DIS_FAULT_NONE) {
        check_state(&state);
    }
    if ((pdu->type == DIS_START_RESUME || pdu->type == DIS_STOP_FREEZE) &&
        dis_command_read(pdu, &command) == DIS_FAULT_NONE) {
        FUZZ_ASSERT(isfinite(command.real_s) && isfinite(command.exercise_s));
    }
}

static void walk(const uint8_t *bytes, size_t length)
{
    struct dis_datagram d;
    struct dis_pdu pdu;
    enum dis_fault fault = DIS_FAULT_NONE;
    enum dis_step step;
    size_t stepped = 0;
    dis_datagram_begin(&d, bytes, length);
    while ((step = dis_datagram_next(&d, &pdu, &fault)) == DIS_STEP_PDU ||
           step == DIS_STEP_VERSION) {
        stepped += pdu.length;
        FUZZ_ASSERT(pdu.length >= DIS_HEADER_BYTES && stepped <= length);
        take(&pdu);
    }
    FUZZ_ASSERT(step == DIS_STEP_END || (fault > DIS_FAULT_NONE && fault < DIS_FAULT_COUNT));
}

/* The same bytes as a packet of every link that captures have. */
static void find(const uint8_t *bytes, size_t length)
{
    for (int link = 0; link < 300; link++) {
        struct dis_packet packet;
        if (dis_find_udp(link, bytes, length, &packet) == DIS_TRAFFIC_UDP) {
            FUZZ_ASSERT(packet.bytes >= bytes && packet.bytes + packet.length <= bytes + length);
        }
    }
}

/* What goes to the bus is what docs/bus.md lets through. */
static bool check_frame(void *context, const struct lm_can_frame *f, int64_t time_us)
{
    int64_t *last_us = context;
    FUZZ_ASSERT(time_us > *last_us && f->id >= DIS_ID_LATITUDE && f->id <= 1821);
    FUZZ_ASSERT(f->length == (f->id == DIS_ID_REMOVED ? 5 : 8) && f->data[0] == 60);
    FUZZ_ASSERT(f->data[2] <= 3);
    *last_us = time_us;
    return true;
}

/* The built-in table is read once, since a text takes longer to read than an input. The gateway
 * notes in it what it used, so that each input gets a fresh one. */
static struct dis_gateway *make_gateway(int64_t *last_us)
{
    static struct dis_kinds read, kinds;
    struct dis_settings settings = dis_settings_usual();
    settings.tells_clock = true;
    settings.last_number = 3;
    const struct dis_sink sink = {check_frame, last_us};
    if (read.count == 0) {
        FUZZ_ASSERT(dis_kinds_read_builtin(&read) == 0);
    }
    kinds = read;
    struct dis_gateway *g = dis_gateway_new(&settings, &kinds, &sink);
    FUZZ_ASSERT(g != NULL);
    return g;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    int64_t last_us = -1, now_us = 0;
    struct dis_gateway *g = make_gateway(&last_us);
    while (supply.left > 0) {
        const size_t wanted = fuzz_u16(&supply);
        const size_t length = wanted < supply.left ? wanted : supply.left;
        uint8_t *alone = malloc(length + 1); /* by itself, so that reading beyond it is seen */
        memcpy(alone, supply.at, length);
        walk(alone, length);
        find(alone, length);
        dis_gateway_take(g, alone, length, now_us);
        dis_gateway_step(g, now_us);
        now_us += 700000;
        dis_gateway_step(g, now_us);
        free(alone);
        supply.at += length;
        supply.left -= length;
    }
    dis_gateway_end(g, now_us);
    dis_gateway_free(g);
    return 0;
}
