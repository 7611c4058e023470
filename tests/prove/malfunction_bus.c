/* Malfunctions that come over the bus (lm/malfunction_bus.h).
 *
 * Invariant: bits of `set` are those of kinds, and the amount of each kind that is set is within
 * its limits (lm/malfunction.h).
 *
 * Proved, for any state that keeps it, any event and any time: it is kept; no access outside an
 * object, no shift too wide, no overflow. The amounts of every kind that lm/malfunction.h converts
 * stay in 32 bits.
 *
 * Assumed: nothing. */
#include "firmware/nav/malfunction_bus.c"

#include "prove.h"

struct lm_malfunction_bus nondet_malfunction_bus(void);
struct lm_bus_event nondet_event(void);

static bool is_kept(const struct lm_malfunction_bus *b)
{
    bool is_sound = b->now.set >> LM_MALFUNCTIONS == 0;
    for (uint32_t kind = 0; kind < LM_MALFUNCTIONS; kind++) {
        const int32_t amount_q8 = b->now.amount_q8[kind];
        is_sound =
            is_sound && ((b->now.set >> kind & 1) == 0 ||
                         (amount_q8 >= limit[kind][0] * 256 && amount_q8 <= limit[kind][1] * 256));
    }
    return is_sound;
}

void prove_take(void)
{
    struct lm_malfunction_bus b = nondet_malfunction_bus();
    const struct lm_bus_event event = nondet_event();
    ASSUME(is_kept(&b));
    lm_malfunction_bus_take(&b, &event);
    PROVE(is_kept(&b));
}

void prove_at(void)
{
    struct lm_malfunction_bus b = nondet_malfunction_bus();
    const uint32_t kind = nondet_u32();
    ASSUME(is_kept(&b) && kind < LM_MALFUNCTIONS);
    const uint32_t before = b.now.set;
    lm_malfunction_bus_at(&b, nondet_u64());
    PROVE(is_kept(&b) && (b.now.set & ~before) == 0);
    const int32_t bam = lm_malfunction_bam(&b.now, (enum lm_malfunction)kind);
    PROVE(kind == LM_MALFUNCTION_KEY || fx_abs_u32(bam) <= 1u << 31);
}
