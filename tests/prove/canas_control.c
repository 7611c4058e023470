/* Control frames (lm/canas_control.h): what an instructor commands, and what the display tells.
 *
 * Invariant: a ring holds at most LM_CONTROL_RING controls; each of them and the set that is being
 * received is one that the table has (is_set_sound); `missing` has only bits of the set's words;
 * the item that is sent next is the step or one of the oldest control told.
 *
 * Proved, for any state that keeps it: any frame, any control told and any answer of the driver
 * keep it; no access outside an object, no shift too wide. prove_kind: a set that was heard has the
 * kind that its items say, never an LM_CONTROL_ENVIRONMENT. How it is handed out is not proved.
 *
 * An angle is converted to any angle here; prove_angles is about the conversions.
 *
 * Assumed: a control that the unit tells has one of the kinds. */
#include "lm/units.h"
#include "prove.h"

void prove_angles(void)
{
    (void)lm_bam_of_ten_millionths(nondet_u32());
    (void)lm_ten_millionths_of_bam(nondet_u32());
}

#define lm_bam_of_ten_millionths(word)  ((void)(word), nondet_u32())
#define lm_ten_millionths_of_bam(angle) ((void)(angle), nondet_u32())
#include "firmware/bus/canas_control.c"

struct lm_canas_control nondet_canas_control(void);
struct lm_can_frame nondet_frame(void);
struct lm_control nondet_control(void);

/* The items that begin a control. */
static bool is_set_sound(const struct lm_control_words *w)
{
    return w->first >= LM_CONTROL_ITEM_KEY && w->first < LM_CONTROL_ITEMS &&
           rows[w->first].first == w->first && w->end == end_of(w->first, w->service);
}

static bool is_heard_sound(const struct lm_control_words *w)
{
    return is_set_sound(w) &&
           (w->first != LM_CONTROL_ITEM_SWITCH ||
            (w->word[0] >= LM_CONTROL_SWITCH_DESIGNATE && w->word[0] <= LM_CONTROL_SWITCH_RANGING));
}

static bool is_ring_kept(const struct lm_control_ring *r)
{
    return r->head - r->tail <= LM_CONTROL_RING;
}

static bool is_receiving_kept(const struct lm_canas_control *c)
{
    const struct lm_control_words *w = &c->set.words;
    return c->set.missing == 0 || (is_set_sound(w) && c->set.missing >> (w->end - w->first) == 0);
}

void prove_init(void)
{
    struct lm_canas_control c;
    lm_canas_control_init(&c, nondet_u8(), nondet_bool());
    PROVE(is_ring_kept(&c.told) && is_ring_kept(&c.heard) && is_receiving_kept(&c));
    PROVE(c.item == LM_CONTROL_ITEM_STEP);
}

void prove_take(void)
{
    struct lm_canas_control c = nondet_canas_control();
    const struct lm_can_frame frame = nondet_frame();
    ASSUME(is_ring_kept(&c.heard) && is_receiving_kept(&c));
    const uint32_t head = c.heard.head;
    lm_canas_control_take(&c, &frame);
    PROVE(is_ring_kept(&c.heard) && is_receiving_kept(&c));
    PROVE(c.heard.head == head || c.heard.head == head + 1);
    if (c.heard.head != head) {
        PROVE(is_heard_sound(&c.heard.words[head % LM_CONTROL_RING]));
        PROVE(c.is_obeying && frame.data[0] != 0);
    }
}

struct lm_control_words nondet_words(void);

void prove_kind(void)
{
    const struct lm_control_words heard = nondet_words();
    ASSUME(is_heard_sound(&heard));
    const enum lm_control_kind kind = kind_of(&heard);
    PROVE((uint32_t)kind < LM_CONTROL_KINDS && kind != LM_CONTROL_ENVIRONMENT &&
          kind != LM_CONTROL_SLOTS && kind != LM_CONTROL_IMAGE);
    PROVE(kinds[kind].first == heard.first);
    PROVE(heard.first != LM_CONTROL_ITEM_SWITCH || kinds[kind].act == heard.word[0] ||
          (kind == LM_CONTROL_FREEZE && heard.word[0] == LM_CONTROL_SWITCH_RELEASE));
}

void prove_tell(void)
{
    struct lm_canas_control c = nondet_canas_control();
    const struct lm_control control = nondet_control();
    ASSUME((uint32_t)control.kind < LM_CONTROL_KINDS && is_ring_kept(&c.told));
    const uint32_t head = c.told.head;
    lm_canas_control_tell(&c, &control, nondet_u64());
    PROVE(is_ring_kept(&c.told));
    PROVE(c.told.head == head || is_set_sound(&c.told.words[head % LM_CONTROL_RING]));
}

static uint32_t sent;

static int send(void *ctx, const struct lm_can_frame *frame)
{
    PROVE(ctx == NULL && frame->id >= LM_CONTROL_ID &&
          frame->id < LM_CONTROL_ID + LM_CONTROL_ITEMS);
    PROVE(frame->length >= HEADER_BYTES && frame->length <= 8);
    sent++;
    return nondet_i32();
}

/* Each control that waits is sound; which two of them a call reaches does not matter. */
void prove_send(void)
{
    struct lm_canas_control c = nondet_canas_control();
    const struct lm_can can = {.send = send};
    ASSUME(is_ring_kept(&c.told));
    for (uint32_t i = 0; i < LM_CONTROL_RING; i++) {
        ASSUME(is_set_sound(&c.told.words[i]));
    }
    const struct lm_control_words *oldest = &c.told.words[c.told.tail % LM_CONTROL_RING];
    ASSUME(c.item == LM_CONTROL_ITEM_STEP ||
           (c.told.head != c.told.tail && c.item >= oldest->first && c.item < oldest->end));
    sent = 0;
    lm_canas_control_send(&c, &can);
    oldest = &c.told.words[c.told.tail % LM_CONTROL_RING];
    PROVE(is_ring_kept(&c.told) && sent <= LM_CONTROL_FRAMES_A_STEP);
    PROVE(c.item == LM_CONTROL_ITEM_STEP ||
          (c.told.head != c.told.tail && c.item >= oldest->first && c.item < oldest->end));
}
