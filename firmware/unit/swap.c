#include "swap.h"

#include "commands.h"
#include "fx/mem.h"
#include "lm/canas.h"
#include "settings.h"

enum { HEADER_BYTES = 4, PART_BYTES = 4, OF_ANSWER = 256, ALL_MISSING = 0xffff };

void lm_swap_init(struct lm_unit *u, uint8_t node)
{
    const uint8_t partner = u->board->bus_partner;
    u->swap.node = node;
    u->swap.partner = node != 0 && node != partner ? partner : 0;
    u->swap.item = LM_SWAP_SILENT;
    u->swap.missing = ALL_MISSING;
}

static void enter(struct lm_swap *s, enum lm_swap_state state, uint64_t until_us)
{
    s->state = (uint8_t)state;
    s->until_us = until_us;
}

/* `item`: an act, or the first part of settings. */
static void tell(struct lm_swap *s, uint32_t item, uint8_t code)
{
    s->item = (uint8_t)item;
    s->code = code;
}

void lm_swap_ask(struct lm_unit *u, uint64_t now_us)
{
    struct lm_swap *s = &u->swap;
    if (s->partner == 0) {
        lm_refuse(u, LM_REFUSED_SWAP, now_us);
    } else if (s->state == LM_SWAP_IDLE) {
        s->exchange = ++s->begun;
        lm_settings_give(u, &s->told);
        tell(s, 0, s->exchange);
        enter(s, LM_SWAP_ASKING, now_us + LM_SWAP_ASK_US);
    }
}

/* ---- from the bus ---- */

/* While the partner takes this display's page, its own must stay as it was judged. */
static bool take_part(struct lm_swap *s, const uint8_t *data, uint16_t key)
{
    const uint32_t part = data[2] % LM_SWAP_PARTS;
    if (s->state == LM_SWAP_TAKING) {
        return false;
    }
    if (key != s->key) {
        s->key = key;
        s->missing = ALL_MISSING;
    }
    memcpy((uint8_t *)&s->heard + part * PART_BYTES, data + HEADER_BYTES, PART_BYTES);
    s->missing &= (uint16_t) ~(1u << part);
    return true;
}

static void exchange(struct lm_unit *u)
{
    u->swap.state = LM_SWAP_IDLE;
    u->count.swaps++;
    lm_settings_take(u, &u->swap.heard, LM_PAGE_SHARED_BYTES, u->now_us);
}

/* TAKE may come again, because TAKEN was lost. True if the act had its turn. */
static bool take_take(struct lm_unit *u, uint8_t code, bool is_ready)
{
    struct lm_swap *s = &u->swap;
    if (is_ready && s->state == LM_SWAP_ANSWERED) {
        s->done = code + OF_ANSWER;
        exchange(u);
    }
    const bool is_done = s->done == code + OF_ANSWER;
    if (is_done && s->item == LM_SWAP_SILENT) {
        tell(s, LM_SWAP_TAKEN, code);
    }
    return is_done;
}

/* Not called while the partner takes this display's page: then what was heard is an answer, and
 * stays one. */
static bool take_ask(struct lm_unit *u, uint8_t code)
{
    struct lm_swap *s = &u->swap;
    if (s->state == LM_SWAP_ASKING && s->partner > s->node) {
        return false;
    }
    s->exchange = code;
    s->done = 0;
    lm_settings_give(u, &s->told);
    tell(s, LM_SWAP_OF_ANSWER, code);
    enter(s, LM_SWAP_ANSWERED, u->now_us + LM_SWAP_HOLD_US);
    return true;
}

static bool take_act(struct lm_unit *u, uint8_t act, uint8_t code)
{
    struct lm_swap *s = &u->swap;
    const bool is_running = code == s->exchange;
    const bool is_whole = s->missing == 0 &&
                          s->key == code + (act == LM_SWAP_ANSWER ? OF_ANSWER : 0) &&
                          lm_settings_are_sound(u, &s->heard);
    if (act == LM_SWAP_ASK) {
        return is_whole && take_ask(u, code);
    }
    if (act == LM_SWAP_TAKE) {
        return take_take(u, code, is_whole && is_running);
    }
    if (act == LM_SWAP_ANSWER && is_whole && is_running && s->state == LM_SWAP_ASKING) {
        s->again_us = u->now_us;
        enter(s, LM_SWAP_TAKING, u->now_us + LM_SWAP_TAKE_US);
        return true;
    }
    if (act == LM_SWAP_TAKEN && is_running && s->state == LM_SWAP_TAKING) {
        exchange(u);
        return true;
    }
    return false;
}

void lm_swap_take(struct lm_unit *u, const struct lm_can_frame *frame)
{
    struct lm_swap *s = &u->swap;
    const uint8_t *data = frame->data;
    if (frame->id != LM_SWAP_ID || frame->is_extended || frame->is_remote || frame->is_error ||
        s->partner == 0) {
        return;
    }
    const uint8_t service = data[2], code = data[3];
    bool is_sound = frame->length == HEADER_BYTES + PART_BYTES && data[0] == s->partner &&
                    data[1] == LM_CANAS_UCHAR4;
    if (is_sound && service < LM_SWAP_ASK) {
        is_sound = take_part(s, data, (uint16_t)(code + service / LM_SWAP_OF_ANSWER * OF_ANSWER));
    } else if (is_sound) {
        is_sound = data[HEADER_BYTES] == s->node && take_act(u, service, code);
    }
    s->refused += !is_sound;
}

/* ---- to the bus ---- */

static void end_wait(struct lm_unit *u, uint64_t now_us)
{
    struct lm_swap *s = &u->swap;
    if (s->state != LM_SWAP_IDLE && now_us >= s->until_us) {
        if (s->state != LM_SWAP_ANSWERED) {
            lm_refuse(u, LM_REFUSED_SWAP, now_us);
        }
        s->state = LM_SWAP_IDLE;
        s->item = LM_SWAP_SILENT;
    }
    if (s->state == LM_SWAP_TAKING && now_us >= s->again_us) {
        s->again_us = now_us + LM_SWAP_AGAIN_US;
        tell(s, LM_SWAP_TAKE, s->exchange);
    }
}

/* ASK follows the parts of settings offered, ANSWER those of an answer. */
static uint8_t item_after(uint8_t item)
{
    return item >= LM_SWAP_ASK ? LM_SWAP_SILENT
           : item % LM_SWAP_PARTS < LM_SWAP_PARTS - 1
               ? (uint8_t)(item + 1)
               : (uint8_t)(LM_SWAP_ASK + item / LM_SWAP_PARTS);
}

void lm_swap_send(struct lm_unit *u, uint64_t now_us)
{
    struct lm_swap *s = &u->swap;
    const struct lm_can *can = u->board->can;
    end_wait(u, now_us);
    for (uint32_t n = 0; n < LM_SWAP_FRAMES_A_STEP && s->item != LM_SWAP_SILENT && can->send; n++) {
        struct lm_can_frame frame = {
            .id = LM_SWAP_ID,
            .length = HEADER_BYTES + PART_BYTES,
            .data = {s->node, LM_CANAS_UCHAR4, s->item, s->code, s->partner},
        };
        if (s->item < LM_SWAP_ASK) {
            memcpy(frame.data + HEADER_BYTES,
                   (const uint8_t *)&s->told + s->item % LM_SWAP_PARTS * PART_BYTES, PART_BYTES);
        }
        if (can->send(can->ctx, &frame) == LM_BUSY) {
            return;
        }
        s->item = item_after(s->item);
    }
}
