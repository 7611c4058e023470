#include "slots.h"

#include "console.h"

static void print_slot(struct zcu102 *z, uint32_t slot)
{
    static const char *const words[LM_SLOT_VERDICTS] = {
        [LM_SLOT_EMPTY] = "empty\n",
        [LM_SLOT_CUT_OFF] = "not flown, a load has not come to its end\n",
        [LM_SLOT_DAMAGED] = ", not flown: damaged\n",
        [LM_SLOT_STANDS_BY] = " stands by\n",
        [LM_SLOT_FLOWN] = ", flown\n"};
    struct drv_uart *u = &z->console;
    const uint64_t load = z->slots.slot[slot].sequence;
    zcu102_print(u, slot == 0 ? "slot A: " : "slot B: ");
    if (load != 0) {
        zcu102_print(u, "load ");
        zcu102_print_number(u, load);
    }
    zcu102_print(u, words[z->slots.slot[slot].verdict]);
}

static bool has_slots(const struct zcu102 *z)
{
    return (z->slots.slot[0].verdict | z->slots.slot[1].verdict) != LM_SLOT_EMPTY;
}

void zcu102_choose_slot(struct zcu102 *z, void *scratch, uint32_t scratch_bytes)
{
    lm_slot_flash_open(&z->slots, &z->flash.port, &z->unit.map.db, scratch, scratch_bytes,
                       ZCU102_FLASH_POLLS);
    for (uint32_t i = 0; i < LM_SLOTS && has_slots(z); i++) {
        print_slot(z, i);
    }
}

static struct lm_slots_state state_of(const struct lm_slot_flash *slots)
{
    struct lm_slots_state state = {.flown = 0};
    for (int32_t i = 0; i < LM_SLOTS; i++) {
        const enum lm_slot_verdict verdict = slots->slot[i].verdict;
        if (verdict == LM_SLOT_FLOWN) {
            state.flown = i + 1;
        }
        state.damaged |= (verdict == LM_SLOT_DAMAGED) << i;
        state.cut_off |= (verdict == LM_SLOT_CUT_OFF) << i;
    }
    return state;
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct zcu102 *z = ctx;
    if (z->are_slots_told) {
        return z->bezel.port.next(z->bezel.port.ctx, control);
    }
    z->are_slots_told = true;
    *control = (struct lm_control){.kind = LM_CONTROL_SLOTS, .slots = state_of(&z->slots)};
    return 1;
}

void zcu102_tell_slots(struct zcu102 *z)
{
    z->controls = (struct lm_controls){.ctx = z, .next = next_control};
    z->are_slots_told = !has_slots(z);
}
