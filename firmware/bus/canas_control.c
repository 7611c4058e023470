#include "lm/canas_control.h"

#include <stddef.h>

#include "fx/mem.h"
#include "lm/canas.h"
#include "lm/units.h"

enum { HEADER_BYTES = 4, FIRST_PATCH = LM_CONTROL_ITEM_PATCH_LATITUDE };

_Static_assert(offsetof(struct lm_sar_command, cell_mm) == 8 &&
                   offsetof(struct lm_sar_command, height_m_q6) ==
                       offsetof(struct lm_sar_command, look_azimuth) + 8,
               "words of a patch are copied together");

/* Items `first` to before `end` are one control. */
struct row {
    uint8_t type, first, end;
};

#define ROW(type_, first_, end_)                                                                   \
    {                                                                                              \
        LM_CANAS_##type_, LM_CONTROL_ITEM_##first_, LM_CONTROL_ITEM_##end_                         \
    }
#define PATCH                                                                                      \
    {                                                                                              \
        LM_CANAS_LONG, FIRST_PATCH, LM_CONTROL_ITEMS                                               \
    }

static const struct row rows[LM_CONTROL_ITEMS] = {
    ROW(ULONG, STEP, KEY),
    ROW(UCHAR, KEY, SWITCH),
    ROW(UCHAR, SWITCH, KNOB),
    ROW(LONG, KNOB, SLEW_X),
    ROW(LONG, SLEW_X, SECTOR),
    ROW(LONG, SLEW_X, SECTOR),
    ROW(UCHAR2, SECTOR, RANGE),
    ROW(LONG, RANGE, WIDTH),
    ROW(UCHAR, WIDTH, GAIN),
    ROW(CHAR, GAIN, CURSOR_LATITUDE),
    ROW(LONG, CURSOR_LATITUDE, STEER_LATITUDE),
    ROW(LONG, CURSOR_LATITUDE, STEER_LATITUDE),
    ROW(LONG, STEER_LATITUDE, PATCH_LATITUDE),
    ROW(LONG, STEER_LATITUDE, PATCH_LATITUDE),
    PATCH,
    PATCH,
    PATCH,
    PATCH,
    PATCH,
    PATCH,
};

/* First item of the controls of a kind, and what tells those of one item apart: the service code of
 * a key, the value of a switch. A kind of zeros is not told. */
enum { KINDS = LM_CONTROL_KINDS };

static const struct kind {
    uint8_t first, act;
} kinds[KINDS] = {
    [LM_CONTROL_DOWN] = {LM_CONTROL_ITEM_KEY, LM_CONTROL_KEY_DOWN},
    [LM_CONTROL_UP] = {LM_CONTROL_ITEM_KEY, 0},
    [LM_CONTROL_DESIGNATE] = {LM_CONTROL_ITEM_SWITCH, LM_CONTROL_SWITCH_DESIGNATE},
    [LM_CONTROL_DROP] = {LM_CONTROL_ITEM_SWITCH, LM_CONTROL_SWITCH_DROP},
    [LM_CONTROL_FREEZE] = {LM_CONTROL_ITEM_SWITCH, LM_CONTROL_SWITCH_FREEZE},
    [LM_CONTROL_TRACK] = {LM_CONTROL_ITEM_SWITCH, LM_CONTROL_SWITCH_TRACK},
    [LM_CONTROL_RANGING] = {LM_CONTROL_ITEM_SWITCH, LM_CONTROL_SWITCH_RANGING},
    [LM_CONTROL_KNOB] = {LM_CONTROL_ITEM_KNOB, 0},
    [LM_CONTROL_SLEW] = {LM_CONTROL_ITEM_SLEW_X, 0},
    [LM_CONTROL_SECTOR] = {LM_CONTROL_ITEM_SECTOR, 0},
    [LM_CONTROL_RANGE] = {LM_CONTROL_ITEM_RANGE, 0},
    [LM_CONTROL_AZIMUTH] = {LM_CONTROL_ITEM_WIDTH, 0},
    [LM_CONTROL_GAIN] = {LM_CONTROL_ITEM_GAIN, 0},
    [LM_CONTROL_CURSOR] = {LM_CONTROL_ITEM_CURSOR_LATITUDE, 0},
    [LM_CONTROL_STEERPOINT] = {LM_CONTROL_ITEM_STEER_LATITUDE, 0},
    [LM_CONTROL_SAR] = {FIRST_PATCH, 0},
};

uint8_t lm_control_type(enum lm_control_item item)
{
    return rows[item].type;
}

void lm_canas_control_init(struct lm_canas_control *c, uint8_t node, bool is_obeying)
{
    memset(c, 0, sizeof *c);
    c->node = node;
    c->is_obeying = is_obeying;
}

static bool put(struct lm_control_ring *r, const struct lm_control_words *words)
{
    const bool has_room = r->head - r->tail < LM_CONTROL_RING;
    if (has_room) {
        r->words[r->head++ % LM_CONTROL_RING] = *words;
    }
    return has_room;
}

/* ---- controls as words ---- */

/* Past the items of a control that begin with `first`. */
static uint8_t end_of(uint8_t first, uint8_t service)
{
    const bool is_short = first == FIRST_PATCH && (service & LM_CONTROL_PATCH_FROM_OWNSHIP) != 0;
    return is_short ? LM_CONTROL_ITEM_PATCH_LOOK : rows[first].end;
}

/* Angles are BAM in a control, and 1e-7 degree on the bus. */
static void convert_angles(struct lm_control_words *w, uint32_t (*convert)(uint32_t))
{
    for (uint32_t i = w->first; i < w->end; i++) {
        const bool is_angle = i >= LM_CONTROL_ITEM_CURSOR_LATITUDE &&
                              i <= LM_CONTROL_ITEM_PATCH_LOOK && i != LM_CONTROL_ITEM_PATCH_CELL;
        if (is_angle) {
            w->word[i - w->first] = convert(w->word[i - w->first]);
        }
    }
}

static uint32_t ten_millionths_of_bam(uint32_t angle)
{
    return lm_ten_millionths_of_bam(angle);
}

static uint32_t bam_of_ten_millionths(uint32_t word)
{
    return lm_bam_of_ten_millionths(word);
}

static void put_patch(struct lm_control_words *w, const struct lm_sar_command *sar)
{
    w->service = (uint8_t)((sar->is_plan ? LM_CONTROL_PATCH_PLAN : 0) |
                           (sar->is_steady ? LM_CONTROL_PATCH_STEADY : 0) |
                           (sar->is_from_ownship ? LM_CONTROL_PATCH_FROM_OWNSHIP : 0));
    memcpy(w->word, &sar->centre, 12);
    memcpy(w->word + 3, &sar->look_azimuth, 12);
}

static void take_patch(struct lm_sar_command *sar, const struct lm_control_words *w)
{
    memcpy(&sar->centre, w->word, 12);
    memcpy(&sar->look_azimuth, w->word + 3, 12);
    sar->is_plan = (w->service & LM_CONTROL_PATCH_PLAN) != 0;
    sar->is_steady = (w->service & LM_CONTROL_PATCH_STEADY) != 0;
    sar->is_from_ownship = (w->service & LM_CONTROL_PATCH_FROM_OWNSHIP) != 0;
}

/* `kind` is one that is told. Most have one or two words at the start of the union. */
static void put_words(struct lm_control_words *w, const struct lm_control *control)
{
    const struct kind *kind = &kinds[control->kind];
    w->first = kind->first;
    memcpy(w->word, &control->slew, sizeof control->slew);
    if (kind->first == LM_CONTROL_ITEM_KEY) {
        w->service = kind->act;
    } else if (kind->first == LM_CONTROL_ITEM_SWITCH) {
        w->word[0] =
            (uint32_t)kind->act + (control->kind == LM_CONTROL_FREEZE && !control->is_frozen);
    } else if (kind->first == LM_CONTROL_ITEM_SECTOR) {
        w->word[0] = w->word[0] << 8 | w->word[1];
    } else if (kind->first == LM_CONTROL_ITEM_STEER_LATITUDE) {
        w->service = control->steerpoint.is_set ? 0 : LM_CONTROL_STEER_TO_BUS;
        memcpy(w->word, &control->steerpoint.position, sizeof control->steerpoint.position);
    } else if (kind->first == FIRST_PATCH) {
        put_patch(w, &control->sar);
    }
    w->end = end_of(w->first, w->service);
    convert_angles(w, ten_millionths_of_bam);
}

/* The kind of a set: the first that has its item, and its act where there are several. */
static enum lm_control_kind kind_of(const struct lm_control_words *w)
{
    const uint32_t act = w->first == LM_CONTROL_ITEM_KEY      ? w->service != 0
                         : w->first == LM_CONTROL_ITEM_SWITCH ? w->word[0]
                                                              : 0;
    const uint32_t named = act == LM_CONTROL_SWITCH_RELEASE ? LM_CONTROL_SWITCH_FREEZE : act;
    uint32_t kind = 0;
    while (kind < KINDS - 1 && (kinds[kind].first != w->first || kinds[kind].act != named)) {
        kind++;
    }
    return (enum lm_control_kind)kind;
}

/* The control of a complete set. */
static void take_words(struct lm_control *control, struct lm_control_words *w)
{
    convert_angles(w, bam_of_ten_millionths);
    memset(control, 0, sizeof *control);
    control->kind = kind_of(w);
    const uint32_t first = w->word[0];
    if (w->first == LM_CONTROL_ITEM_SWITCH) {
        control->is_frozen = first == LM_CONTROL_SWITCH_FREEZE;
    } else if (w->first == LM_CONTROL_ITEM_STEER_LATITUDE) {
        control->steerpoint.is_set = w->service != LM_CONTROL_STEER_TO_BUS;
        memcpy(&control->steerpoint.position, w->word, sizeof control->steerpoint.position);
    } else if (w->first == FIRST_PATCH) {
        take_patch(&control->sar, w);
    } else {
        const uint32_t last = w->first == LM_CONTROL_ITEM_SECTOR ? first & 0xff : w->word[1];
        control->slew.x = w->first == LM_CONTROL_ITEM_SECTOR ? (int32_t)(first >> 8)
                          : w->first == LM_CONTROL_ITEM_GAIN ? (int8_t)first
                                                             : (int32_t)first;
        control->slew.y = (int32_t)last;
    }
}

/* ---- from the bus ---- */

static uint32_t bytes_of(uint32_t item)
{
    const struct lm_canas_type *type = &lm_canas_types[rows[item].type];
    return (uint32_t)type->element_bytes * type->elements;
}

/* True if the frame continues the set that waits. */
static bool continues(const struct lm_canas_control *c, const struct lm_can_frame *frame,
                      uint32_t item)
{
    const struct lm_control_words *w = &c->set.words;
    return c->set.missing != 0 && w->first == rows[item].first && c->set.node == frame->data[0] &&
           w->service == frame->data[2] && w->code == frame->data[3] &&
           (c->set.missing >> (item - w->first) & 1) != 0 &&
           frame->time_us - c->set.time_us <= LM_CONTROL_SET_US;
}

static void begin_set(struct lm_canas_control *c, const struct lm_can_frame *frame, uint32_t item)
{
    const uint8_t first = rows[item].first, end = end_of(first, frame->data[2]);
    c->count.torn += c->set.missing != 0;
    c->set.words = (struct lm_control_words){
        .first = first, .end = end, .service = frame->data[2], .code = frame->data[3]};
    c->set.missing = (1u << (end - first)) - 1;
    c->set.node = frame->data[0];
    c->set.time_us = frame->time_us;
}

static void take_value(struct lm_canas_control *c, const struct lm_can_frame *frame, uint32_t item)
{
    if (!continues(c, frame, item)) {
        begin_set(c, frame, item);
    }
    struct lm_control_words *w = &c->set.words;
    if (item < w->first || item >= w->end) {
        c->count.bad++; /* a value that this control does not have */
        c->set.missing = 0;
        return;
    }
    uint32_t word = 0;
    for (uint32_t i = 0; i < bytes_of(item); i++) {
        word = word << 8 | frame->data[HEADER_BYTES + i];
    }
    w->word[item - w->first] = word;
    c->set.missing &= ~(1u << (item - w->first));
    if (c->set.missing == 0) {
        c->count.bad += !put(&c->heard, w);
    }
}

static bool is_well_formed(const struct lm_can_frame *frame, uint32_t item)
{
    const bool is_sound = frame->length == HEADER_BYTES + bytes_of(item) && frame->data[0] != 0 &&
                          frame->data[1] == rows[item].type;
    return is_sound && (item != LM_CONTROL_ITEM_SWITCH ||
                        (frame->data[HEADER_BYTES] >= LM_CONTROL_SWITCH_DESIGNATE &&
                         frame->data[HEADER_BYTES] <= LM_CONTROL_SWITCH_RANGING));
}

void lm_canas_control_take(struct lm_canas_control *c, const struct lm_can_frame *frame)
{
    const uint32_t item = frame->id - LM_CONTROL_ID; /* below the first, a large number */
    const bool is_own = c->node != 0 && frame->length != 0 && frame->data[0] == c->node;
    if (frame->is_extended || frame->is_remote || frame->is_error || is_own ||
        item == LM_CONTROL_ITEM_STEP || item >= LM_CONTROL_ITEMS) {
        return;
    }
    if (!c->is_obeying) {
        c->count.refused++;
    } else if (!is_well_formed(frame, item)) {
        c->count.bad++;
    } else {
        take_value(c, frame, item);
    }
}

bool lm_canas_control_next(struct lm_canas_control *c, struct lm_control *control)
{
    struct lm_control_ring *r = &c->heard;
    if (r->head == r->tail) {
        return false;
    }
    take_words(control, &r->words[r->tail++ % LM_CONTROL_RING]);
    c->count.heard++;
    return true;
}

/* ---- to the bus ---- */

void lm_canas_control_tell(struct lm_canas_control *c, const struct lm_control *control,
                           uint64_t now_us)
{
    struct lm_control_words w = {0};
    if (c->node == 0 || kinds[control->kind].first == 0) {
        return;
    }
    put_words(&w, control);
    w.code = ++c->code; /* a gap in the codes says that one was lost */
    w.step_us = (uint32_t)now_us;
    const bool is_put = put(&c->told, &w);
    c->count.told += is_put;
    c->count.lost += !is_put;
}

static struct lm_can_frame frame_of(const struct lm_canas_control *c,
                                    const struct lm_control_words *w, uint32_t item)
{
    const uint32_t word = item == LM_CONTROL_ITEM_STEP ? w->step_us : w->word[item - w->first];
    const uint32_t bytes = bytes_of(item);
    struct lm_can_frame frame = {
        .id = LM_CONTROL_ID + item,
        .length = (uint8_t)(HEADER_BYTES + bytes),
        .data = {c->node, rows[item].type, w->service, w->code},
    };
    for (uint32_t i = 0; i < bytes; i++) {
        frame.data[HEADER_BYTES + i] = (uint8_t)(word >> 8 * (bytes - 1 - i));
    }
    return frame;
}

/* The step first, then the values in their order. */
static uint8_t item_after(const struct lm_control_words *w, uint8_t item)
{
    return item == LM_CONTROL_ITEM_STEP ? w->first : (uint8_t)(item + 1);
}

void lm_canas_control_send(struct lm_canas_control *c, const struct lm_can *can)
{
    struct lm_control_ring *r = &c->told;
    for (uint32_t n = 0; n < LM_CONTROL_FRAMES_A_STEP && r->head != r->tail && can->send != NULL;
         n++) {
        const struct lm_control_words *w = &r->words[r->tail % LM_CONTROL_RING];
        const struct lm_can_frame frame = frame_of(c, w, c->item);
        const int status = can->send(can->ctx, &frame);
        if (status == LM_BUSY) {
            return;
        }
        c->count.lost += status != LM_OK;
        c->item = item_after(w, c->item);
        if (c->item == w->end) {
            c->item = LM_CONTROL_ITEM_STEP;
            r->tail++;
        }
    }
}
