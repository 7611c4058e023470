#include "handed.h"

#include "sections.h"

/* Written by the host (machine.py finds it by name). */
extern uint8_t scenario[SCENARIO_BYTES_MAX];
ZCU102_BULK uint8_t scenario[SCENARIO_BYTES_MAX];

bool handed_open(struct handed *h, const uint64_t *now_us)
{
    *h = (struct handed){.header = (const struct scenario_header *)(const void *)scenario,
                         .now_us = now_us};
    h->frames = (const struct lm_can_frame *)(const void *)(h->header + 1);
    h->controls = (const struct scenario_control *)(const void *)(h->frames + h->header->frames);
    h->pictures =
        (const struct scenario_picture *)(const void *)(h->controls + h->header->controls);
    return h->header->magic == SCENARIO_MAGIC;
}

int handed_next_control(void *handed, struct lm_control *control)
{
    struct handed *h = handed;
    if (h->next_control == h->header->controls ||
        h->controls[h->next_control].time_us > *h->now_us) {
        return 0;
    }
    *control = h->controls[h->next_control++].control;
    return 1;
}

int handed_receive(void *handed, struct lm_can_frame *frame)
{
    struct handed *h = handed;
    if (h->next_frame == h->header->frames || h->frames[h->next_frame].time_us > *h->now_us) {
        return 0;
    }
    *frame = h->frames[h->next_frame++];
    return 1;
}
