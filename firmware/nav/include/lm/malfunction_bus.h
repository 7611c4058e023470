/* Malfunctions that come over the bus (docs/bus.md, "Malfunctions"): each by itself, repeated while
 * it lasts. */
#ifndef LM_MALFUNCTION_BUS_H
#define LM_MALFUNCTION_BUS_H

#include "lm/bus_event.h"
#include "lm/malfunction.h"

/* State; the caller owns it. It starts as zeros. Counters only ever grow. */
struct lm_malfunction_bus {
    struct lm_malfunctions now; /* those in force */
    uint64_t heard_us[LM_MALFUNCTIONS];
    uint64_t last_us; /* arrival of the last frame of `node` */
    uint32_t stale_us, dead_us;
    bool is_stale; /* one in force was not repeated, and will end */
    uint8_t node;  /* the sender */
    struct {
        uint32_t refused; /* of a kind that does not exist, or an amount out of range */
        uint32_t rivals;  /* frames of a second node while the first one is received */
    } count;
};

/* Take an event of the bus. Events of other fields change nothing. */
void lm_malfunction_bus_take(struct lm_malfunction_bus *b, const struct lm_bus_event *event);

/* End what is dead, by the ages of lm/nav.h, and update is_stale. Call in every step. */
void lm_malfunction_bus_at(struct lm_malfunction_bus *b, uint64_t now_us);

#endif
