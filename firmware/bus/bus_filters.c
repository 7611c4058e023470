#include "lm/bus_filters.h"

#include "lm/canas_control.h"
#include "lm/canas_service.h"

struct list {
    struct lm_can_filter *filters;
    uint32_t count;
};

static void add(struct list *list, struct lm_can_filter f)
{
    for (uint32_t i = 0; i < list->count; i++) {
        const struct lm_can_filter *known = &list->filters[i];
        if (known->id == f.id && known->mask == f.mask && known->is_extended == f.is_extended) {
            return;
        }
    }
    list->filters[list->count++] = f;
}

/* The bits of a redundancy channel's number that are clear in every channel that is used. */
static uint32_t unused_channel_bits(void)
{
    uint32_t used = 1;
    while (used < LM_BUS_CHANNELS) {
        used *= 2;
    }
    return (LM_CAN_ID_EXTENDED >> 16) & ~(used - 1);
}

uint32_t lm_bus_filters(const struct lm_bus_profile *profile,
                        struct lm_can_filter filters[LM_BUS_FILTERS_MAX])
{
    struct list list = {filters, 0};
    const bool is_canas = profile->framing == LM_BUS_CANAEROSPACE;
    for (uint32_t i = 0; i < profile->row_count; i++) {
        const struct lm_bus_row *row = &profile->rows[i];
        if (is_canas) {
            /* Bits 11..15 must be clear on every channel. */
            const uint32_t mask = 0xffffu | unused_channel_bits() << 16;
            add(&list, (struct lm_can_filter){row->id, LM_CAN_ID_STANDARD, false});
            add(&list, (struct lm_can_filter){row->id, mask, true});
        } else {
            add(&list, (struct lm_can_filter){row->id, row->packing.mask, true});
        }
    }
    if (is_canas) {
        add(&list, (struct lm_can_filter){LM_CANAS_REQUEST_ID, LM_CAN_ID_STANDARD, false});
        for (uint32_t i = LM_CONTROL_ITEM_STEP + 1; i < LM_CONTROL_ITEMS; i++) {
            add(&list, (struct lm_can_filter){LM_CONTROL_ID + i, LM_CAN_ID_STANDARD, false});
        }
    }
    return list.count;
}
