#include "lm/bus_filters.h"

#include <stddef.h>

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

static void add_rows(struct list *list, const struct lm_bus_profile *profile)
{
    const bool is_canas = profile->framing == LM_BUS_CANAEROSPACE;
    for (uint32_t i = 0; i < profile->row_count; i++) {
        const struct lm_bus_row *row = &profile->rows[i];
        if (is_canas) {
            /* Bits 11..15 must be clear on every channel. */
            const uint32_t mask = 0xffffu | unused_channel_bits() << 16;
            add(list, (struct lm_can_filter){row->id, LM_CAN_ID_STANDARD, false});
            add(list, (struct lm_can_filter){row->id, mask, true});
        } else {
            add(list, (struct lm_can_filter){row->id, row->packing.mask, true});
        }
    }
}

uint32_t lm_bus_filters(const struct lm_bus_profile *profile,
                        struct lm_can_filter filters[LM_BUS_FILTERS_MAX])
{
    struct list list = {filters, 0};
    add_rows(&list, profile);
    if (profile->framing == LM_BUS_CANAEROSPACE) {
        add(&list, (struct lm_can_filter){LM_CANAS_REQUEST_ID, LM_CAN_ID_STANDARD, false});
        for (uint32_t i = LM_CONTROL_ITEM_STEP + 1; i < LM_CONTROL_ITEMS; i++) {
            add(&list, (struct lm_can_filter){LM_CONTROL_ID + i, LM_CAN_ID_STANDARD, false});
        }
        add(&list, (struct lm_can_filter){LM_BUS_SWAP_ID, LM_CAN_ID_STANDARD, false});
    }
    return list.count;
}

bool lm_bus_profiles_clash(const struct lm_bus_profile *a, const struct lm_bus_profile *b,
                           uint32_t *id)
{
    struct lm_can_filter of_a[LM_BUS_FILTERS_MAX], of_b[LM_BUS_FILTERS_MAX];
    struct list one = {of_a, 0}, other = {of_b, 0};
    add_rows(&one, a);
    add_rows(&other, b);
    for (uint32_t i = 0; i < one.count; i++) {
        const struct lm_can_filter *f = &of_a[i];
        for (uint32_t k = 0; k < other.count; k++) {
            const struct lm_can_filter *g = &of_b[k];
            if (f->is_extended == g->is_extended && ((f->id ^ g->id) & f->mask & g->mask) == 0) {
                if (id != NULL) {
                    *id = f->id | g->id;
                }
                return true;
            }
        }
    }
    return false;
}
