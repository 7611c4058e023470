#include "entities.h"

#include <string.h>

bool dis_id_is(const struct dis_id *a, const struct dis_id *b)
{
    return a->site == b->site && a->application == b->application && a->entity == b->entity;
}

static int *bucket_of(struct entities *e, const struct dis_id *id)
{
    const uint64_t key = (uint64_t)id->site << 32 | (uint64_t)id->application << 16 | id->entity;
    /* The golden ratio's multiplier spreads numbers that follow one another. */
    return &e->bucket[key * UINT64_C(0x9e3779b97f4a7c15) >> 51];
}

void entities_clear(struct entities *e)
{
    e->count = 0;
    for (int i = 0; i < BUCKETS; i++) {
        e->bucket[i] = -1;
    }
}

int entities_find(const struct entities *e, const struct dis_id *id)
{
    int at = *bucket_of((struct entities *)e, id);
    while (at >= 0 && !dis_id_is(&e->one[at].id, id)) {
        at = e->one[at].next;
    }
    return at;
}

int entities_add(struct entities *e, const struct dis_id *id)
{
    if (e->count == DIS_ENTITIES_MAX) {
        return -1;
    }
    const int at = e->count++;
    int *bucket = bucket_of(e, id);
    e->one[at] = (struct entity){.id = *id, .number = NO_NUMBER, .next = *bucket};
    *bucket = at;
    return at;
}

/* The link that leads to `at`. */
static int *link_to(struct entities *e, int at)
{
    int *link = bucket_of(e, &e->one[at].id);
    while (*link != at) {
        link = &e->one[*link].next;
    }
    return link;
}

void entities_drop(struct entities *e, int at)
{
    *link_to(e, at) = e->one[at].next;
    const int last = --e->count;
    if (at != last) {
        *link_to(e, last) = at;
        e->one[at] = e->one[last];
    }
}
