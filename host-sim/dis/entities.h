/* Entities: those that were heard, found by their numbers. */
#ifndef DIS_ENTITIES_H
#define DIS_ENTITIES_H

#include "dis/gateway.h"

enum { BUCKETS = 8192, NO_NUMBER = -1 };

struct entity {
    struct dis_id id;
    struct dis_type type;
    char marking[12];
    struct dis_motion motion;
    int64_t motion_us; /* the instant that the motion is of */
    int64_t heard_us, first_us;
    struct dis_kind kind;
    bool is_wanted; /* a rule makes a target of it */
    bool is_fit;    /* and the bus can carry it */
    bool was_told;  /* `told` is what the display has */
    int number;     /* NO_NUMBER, or of the bus */
    struct dis_target told;
    int64_t told_us;
    int next; /* in its bucket; -1: the last */
};

struct entities {
    struct entity one[DIS_ENTITIES_MAX]; /* the first `count` are in use */
    int bucket[BUCKETS];
    int count;
};

void entities_clear(struct entities *e);

/* The place of an entity, or -1. */
int entities_find(const struct entities *e, const struct dis_id *id);

/* Make room for one that is not there yet, all zeros but id and number. Returns -1 when full. */
int entities_add(struct entities *e, const struct dis_id *id);

/* Take one out. The last one moves to its place. */
void entities_drop(struct entities *e, int at);

bool dis_id_is(const struct dis_id *a, const struct dis_id *b);

#endif
