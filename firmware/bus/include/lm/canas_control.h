/* Control frames: what the operator does, told to the other avionics over CANaerospace, and what an
 * instructor does from there.
 *
 * A control is told once, when the unit has acted on it: a frame with the time of the step, then a
 * frame for each of its values. All have one message code, which counts up from control to control.
 * The same frames obey an instructor, when the board allows it. Controls that came from the bus are
 * not told again. Tables for people: docs/bus.md, "Controls".
 *
 * In each step of the unit:
 *
 *     lm_canas_control_take(&c, &frame);                    each frame of the bus
 *     while (lm_canas_control_next(&c, &control)) { act; }
 *     if (the unit acted on a control of the board) { lm_canas_control_tell(&c, &control, now_us);
 * } lm_canas_control_send(&c, can); */
#ifndef LM_CANAS_CONTROL_H
#define LM_CANAS_CONTROL_H

#include "lm/controls.h"
#include "lm/port.h"

/* Items; the identifier of one is LM_CONTROL_ID + its number. Those of a control stand together. */
enum lm_control_item {
    LM_CONTROL_ITEM_STEP,   /* time of the step, microseconds, modulo 2^32; told, never obeyed */
    LM_CONTROL_ITEM_KEY,    /* number of the button; service code: LM_CONTROL_KEY_DOWN, or 0: up */
    LM_CONTROL_ITEM_SWITCH, /* enum lm_control_switch */
    LM_CONTROL_ITEM_KNOB,   /* range knob, thousandths of its deflection */
    LM_CONTROL_ITEM_SLEW_X, /* cursor control, thousandths of its deflection */
    LM_CONTROL_ITEM_SLEW_Y,
    LM_CONTROL_ITEM_SECTOR,          /* two bytes: enum lm_sector_mode, enum lm_fov */
    LM_CONTROL_ITEM_RANGE,           /* nautical miles */
    LM_CONTROL_ITEM_WIDTH,           /* number of the sector's width */
    LM_CONTROL_ITEM_GAIN,            /* dB */
    LM_CONTROL_ITEM_CURSOR_LATITUDE, /* 1e-7 degree */
    LM_CONTROL_ITEM_CURSOR_LONGITUDE,
    LM_CONTROL_ITEM_STEER_LATITUDE, /* service code LM_CONTROL_STEER_TO_BUS: to the bus's again */
    LM_CONTROL_ITEM_STEER_LONGITUDE,
    LM_CONTROL_ITEM_PATCH_LATITUDE, /* service code: enum lm_control_patch */
    LM_CONTROL_ITEM_PATCH_LONGITUDE,
    LM_CONTROL_ITEM_PATCH_CELL,   /* mm */
    LM_CONTROL_ITEM_PATCH_LOOK,   /* from the antenna to the patch, 1e-7 degree */
    LM_CONTROL_ITEM_PATCH_RANGE,  /* m along the ground */
    LM_CONTROL_ITEM_PATCH_HEIGHT, /* of the antenna above mean sea level, m / 64 */
    LM_CONTROL_ITEMS
};

enum { LM_CONTROL_ID = 1530, LM_CONTROL_WORDS = 6 };

/* Service codes. */
enum { LM_CONTROL_KEY_DOWN = 1, LM_CONTROL_STEER_TO_BUS = 1 };

enum lm_control_switch {
    LM_CONTROL_SWITCH_DESIGNATE = 1,
    LM_CONTROL_SWITCH_DROP,
    LM_CONTROL_SWITCH_FREEZE,
    LM_CONTROL_SWITCH_RELEASE,
    LM_CONTROL_SWITCH_TRACK,
    LM_CONTROL_SWITCH_RANGING
};

/* Service code of a patch's frames, bits. */
enum lm_control_patch {
    LM_CONTROL_PATCH_PLAN = 1 << 0,
    LM_CONTROL_PATCH_STEADY = 1 << 1,
    LM_CONTROL_PATCH_FROM_OWNSHIP = 1 << 2 /* look, range and height say nothing */
};

/* Data type of an item, LM_CANAS_... */
uint8_t lm_control_type(enum lm_control_item item);

/* A control as words, one for each item from `first` to before `end`. */
struct lm_control_words {
    uint8_t first, end; /* enum lm_control_item; first == end: not told */
    uint8_t service, code;
    uint32_t step_us;
    uint32_t word[LM_CONTROL_WORDS];
};

/* Controls that wait: more than the most that a step takes from the board. */
enum { LM_CONTROL_RING = 16 };

/* Most frames of one call of lm_canas_control_send, and age at which a set is given up. */
enum { LM_CONTROL_FRAMES_A_STEP = 4, LM_CONTROL_SET_US = 1000000 };

struct lm_control_ring {
    struct lm_control_words words[LM_CONTROL_RING];
    uint32_t head, tail; /* put in and taken out so far */
};

/* State; the caller owns it. Counters only ever grow. */
struct lm_canas_control {
    uint8_t node; /* the display's own, 1..255; 0: it tells nothing */
    bool is_obeying;
    uint8_t code; /* message code of the control told last */
    uint8_t item; /* of the oldest control that waits in `told`: the next to send */
    struct lm_control_ring told, heard;
    struct {
        struct lm_control_words words;
        uint32_t missing; /* bit n: word n has not come; 0: nothing waits */
        uint8_t node;
        uint64_t time_us; /* arrival of its first frame */
    } set;
    struct {
        uint32_t told;    /* controls */
        uint32_t lost;    /* controls that found the ring full, and frames that the driver lost */
        uint32_t heard;   /* controls of the bus that were handed out */
        uint32_t refused; /* control frames while the unit does not obey */
        uint32_t torn;    /* sets given up for another one, or too old */
        uint32_t bad;     /* frames of a wrong type or length, or without a sender; controls heard
                             that found the ring full */
    } count;
};

/* Begin. `node`: tell as this node, 0: tell nothing; and obey the bus, or not. */
void lm_canas_control_init(struct lm_canas_control *c, uint8_t node, bool is_obeying);

/* Take any frame; only control frames of other nodes have an effect. Any contents are safe: the
 * values are judged where they are applied. */
void lm_canas_control_take(struct lm_canas_control *c, const struct lm_can_frame *frame);

/* Hand out the oldest control that the bus has commanded. False if there is none. */
bool lm_canas_control_next(struct lm_canas_control *c, struct lm_control *control);

/* Tell a control that the unit acted on at `now_us`. An LM_CONTROL_ENVIRONMENT is not told: rain,
 * jammers and sea have frames of their own. */
void lm_canas_control_tell(struct lm_canas_control *c, const struct lm_control *control,
                           uint64_t now_us);

/* Offer up to LM_CONTROL_FRAMES_A_STEP frames. Never waits: what the bus does not take now is
 * offered by the next call. No effect if the board can only listen. */
void lm_canas_control_send(struct lm_canas_control *c, const struct lm_can *can);

#endif
