/* Controls as bytes: numbers of 32 bits, the lowest byte first. */
#include "record.h"

#include "fx/mem.h"

struct bytes {
    uint8_t *to;         /* writing */
    const uint8_t *from; /* reading; NULL: writing */
    uint32_t at, end;
    bool is_short;
};

/* Write a number, or read it. */
static void number(struct bytes *b, uint32_t *value)
{
    if (b->end - b->at < 4) {
        b->is_short = true;
        return;
    }
    if (b->from) {
        const uint8_t *p = b->from + b->at;
        *value = p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
    } else {
        for (uint32_t i = 0; i < 4; i++) {
            b->to[b->at + i] = (uint8_t)(*value >> 8 * i);
        }
    }
    b->at += 4;
}

/* The same of narrower members. What does not fit is cut; the unit judges the rest. */
#define NUMBER(bytes_, member_)                                                                    \
    do {                                                                                           \
        uint32_t word_ = (uint32_t)(member_);                                                      \
        number((bytes_), &word_);                                                                  \
        (member_) = (__typeof__(member_))word_;                                                    \
    } while (0)

static void position(struct bytes *b, struct lm_position *p)
{
    number(b, &p->latitude);
    number(b, &p->longitude);
}

static void environment(struct bytes *b, struct lm_environment *e)
{
    NUMBER(b, e->rain_count);
    NUMBER(b, e->jammer_count);
    NUMBER(b, e->sea_state);
    NUMBER(b, e->is_sea_commanded);
    NUMBER(b, e->has_wind);
    number(b, &e->wind_from);
    for (uint32_t i = 0; i < LM_RAINS_MAX; i++) {
        position(b, &e->rain[i].centre);
        number(b, &e->rain[i].radius_m);
        NUMBER(b, e->rain[i].mm_per_h);
    }
    for (uint32_t i = 0; i < LM_JAMMERS_MAX; i++) {
        position(b, &e->jammer[i].position);
        NUMBER(b, e->jammer[i].noise_ratio_db_q8);
    }
}

static void patch(struct bytes *b, struct lm_sar_command *s)
{
    position(b, &s->centre);
    number(b, &s->cell_mm);
    NUMBER(b, s->is_plan);
    NUMBER(b, s->is_steady);
    NUMBER(b, s->is_from_ownship);
    number(b, &s->look_azimuth);
    number(b, &s->range_m);
    NUMBER(b, s->height_m_q6);
}

static void image(struct bytes *b, struct lm_image_change *i)
{
    uint32_t low = (uint32_t)i->bytes, high = (uint32_t)(i->bytes >> 32);
    NUMBER(b, i->place);
    number(b, &i->crc);
    number(b, &low);
    number(b, &high);
    NUMBER(b, i->is_unsigned);
    i->bytes = (uint64_t)high << 32 | low;
}

static void member_of(struct bytes *b, struct lm_control *c)
{
    switch (c->kind) {
    case LM_CONTROL_SECTOR:
        NUMBER(b, c->sector.mode);
        NUMBER(b, c->sector.fov);
        break;
    case LM_CONTROL_SAR:
        patch(b, &c->sar);
        break;
    case LM_CONTROL_ENVIRONMENT:
        environment(b, &c->environment);
        break;
    case LM_CONTROL_STEERPOINT:
        NUMBER(b, c->steerpoint.is_set);
        position(b, &c->steerpoint.position);
        break;
    case LM_CONTROL_CURSOR:
        position(b, &c->cursor);
        break;
    case LM_CONTROL_RANGE:
        NUMBER(b, c->range_nm);
        break;
    case LM_CONTROL_AZIMUTH:
        NUMBER(b, c->azimuth_index);
        break;
    case LM_CONTROL_GAIN:
        NUMBER(b, c->gain_db);
        break;
    case LM_CONTROL_FREEZE:
        NUMBER(b, c->is_frozen);
        break;
    case LM_CONTROL_DOWN:
    case LM_CONTROL_UP:
        NUMBER(b, c->button);
        break;
    case LM_CONTROL_KNOB:
        NUMBER(b, c->knob);
        break;
    case LM_CONTROL_SLEW:
        NUMBER(b, c->slew.x);
        NUMBER(b, c->slew.y);
        break;
    case LM_CONTROL_SLOTS:
        NUMBER(b, c->slots.flown);
        NUMBER(b, c->slots.damaged);
        NUMBER(b, c->slots.cut_off);
        NUMBER(b, c->slots.load);
        NUMBER(b, c->slots.percent);
        break;
    case LM_CONTROL_IMAGE:
        image(b, &c->image);
        break;
    case LM_CONTROL_DESIGNATE:
    case LM_CONTROL_DROP:
    case LM_CONTROL_TRACK:
    case LM_CONTROL_RANGING:
        break;
    }
}

uint32_t record_control_bytes(const struct lm_control *control, uint8_t bytes[RECORD_BLOB_MAX])
{
    struct lm_control copy = *control;
    struct bytes b = {.to = bytes, .at = 1, .end = RECORD_BLOB_MAX};
    bytes[0] = (uint8_t)copy.kind;
    member_of(&b, &copy);
    return b.at;
}

bool record_control_read(struct lm_control *control, const uint8_t *bytes, uint32_t count)
{
    memset(control, 0, sizeof *control);
    if (count == 0 || bytes[0] >= LM_CONTROL_KINDS) {
        return false;
    }
    struct bytes b = {.from = bytes, .at = 1, .end = count};
    control->kind = (enum lm_control_kind)bytes[0];
    member_of(&b, control);
    return !b.is_short && b.at == count;
}
