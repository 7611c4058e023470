/* The table of kinds of landmass-dis: what it accepts is within what the bus carries, and each rule
 * can decide about some entity. */
#include "dis/kinds.h"
#include "fuzz.h"

const uint32_t fuzz_mutations = 40000;

static struct dis_kinds kinds;

static void check_rule(int n)
{
    const struct dis_rule *r = &kinds.rule[n];
    const struct dis_type type = {(uint8_t)r->low[0], (uint8_t)r->low[1], r->low[2],
                                  (uint8_t)r->low[3], (uint8_t)r->low[4], (uint8_t)r->low[5],
                                  (uint8_t)r->low[6]};
    struct dis_kind found;
    FUZZ_ASSERT(r->kind.kind < DIS_TARGET_KINDS && dis_kind_name(r->kind.kind) != NULL);
    FUZZ_ASSERT(isnan(r->kind.rcs_dbsm) || (r->kind.rcs_dbsm >= -40 && r->kind.rcs_dbsm <= 60));
    const struct dis_rule *decides = dis_kinds_find(&kinds, &type, &found);
    FUZZ_ASSERT(decides != NULL && decides <= r);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    FILE *in = size > 0 ? fmemopen((void *)(uintptr_t)data, size, "r") : NULL;
    if (in == NULL) {
        return 0;
    }
    if (dis_kinds_read_stream(&kinds, in, "input") == 0) {
        FUZZ_ASSERT(kinds.count > 0 && kinds.count <= DIS_RULES_MAX);
        for (int n = 0; n < kinds.count; n++) {
            check_rule(n);
        }
    }
    fclose(in);
    return 0;
}
