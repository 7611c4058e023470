/* Datagrams of CIGI, for landmass-dis: each begins with two bytes of its length. What is accepted
 * is within the ranges of the frames that it becomes. */
#include "dis/cigi.h"
#include "fuzz.h"

#include <math.h>
#include <stdlib.h>

const uint32_t fuzz_mutations = 4000;

static bool check_frame(void *context, const struct lm_can_frame *f, int64_t time_us)
{
    int64_t *last_us = context;
    FUZZ_ASSERT(time_us > *last_us && f->id >= DIS_ID_LATITUDE && f->id <= DIS_ID_ACCELERATION);
    FUZZ_ASSERT(f->data[0] == 60);
    *last_us = time_us;
    return true;
}

static void check_packets(const uint8_t *bytes, size_t length)
{
    struct dis_cigi_message m;
    struct dis_cigi_packet p;
    struct dis_cigi_entity e;
    enum dis_fault fault;
    if (dis_cigi_begin(&m, bytes, length) != DIS_FAULT_NONE) {
        return;
    }
    while (dis_cigi_next(&m, &p, &fault) == DIS_STEP_PDU) {
        FUZZ_ASSERT(p.bytes >= bytes && p.bytes + p.length <= bytes + length);
        if (dis_cigi_entity_read(&p, &e) == DIS_FAULT_NONE && e.is_active && !e.is_child) {
            FUZZ_ASSERT(fabs(e.latitude_deg) <= 90 && fabs(e.longitude_deg) <= 180);
            FUZZ_ASSERT(isfinite(e.height_m) && fabs(e.yaw_deg) <= 360);
        }
    }
}

/* The built-in table, read once, since a text takes longer to read than an input; but every entity
 * has a kind. The gateway notes in its table what it used, so that each input gets a fresh one. */
static struct dis_kinds *every_kind(void)
{
    static struct dis_kinds read, kinds;
    if (read.count == 0) {
        FUZZ_ASSERT(dis_kinds_read_builtin(&read) == 0);
        read.rule[0] = (struct dis_rule){.kind.rcs_dbsm = (double)NAN};
        for (int i = 0; i < DIS_RULE_FIELDS; i++) {
            read.rule[0].high[i] = UINT16_MAX;
        }
    }
    kinds = read;
    return &kinds;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const struct dis_settings settings = dis_settings_usual();
    int64_t last_us = -1, now_us = 0;
    const struct dis_sink sink = {check_frame, &last_us};
    struct dis_gateway *g = dis_gateway_new(&settings, every_kind(), &sink);
    struct dis_cigi *c = g ? dis_cigi_new(g, &settings.sea) : NULL;
    FUZZ_ASSERT(g != NULL && c != NULL);
    while (supply.left >= 2) {
        const size_t named = fuzz_u16(&supply);
        const size_t length = named < supply.left ? named : supply.left;
        uint8_t *alone = malloc(length + 1); /* by itself, so that reading beyond it is seen */
        memcpy(alone, supply.at, length);
        check_packets(alone, length);
        now_us += 50000;
        dis_cigi_take(c, alone, length, now_us);
        dis_gateway_step(g, now_us);
        free(alone);
        supply.at += length;
        supply.left -= length;
    }
    dis_gateway_end(g, now_us + 1000000);
    dis_cigi_free(c);
    dis_gateway_free(g);
    return 0;
}
