/* Debouncing: levels of up to 64 lines become keys that are up or down. Pure: time is an argument.
 *
 * A key changes its state when its line has differed from that state, without an edge, for the
 * whole period. An edge between two calls counts even if both calls see the same level. */
#ifndef DRV_DEBOUNCE_H
#define DRV_DEBOUNCE_H

#include <stdbool.h>
#include <stdint.h>

enum { DRV_DEBOUNCE_KEYS = 64 };

struct drv_debounce {
    uint32_t period_us;
    uint64_t down;     /* bit n: key n is down */
    uint64_t differs;  /* bit n: line n differs from its key, since still_us[n] */
    uint64_t at_start; /* bit n: line n has been active since the start. The key is stuck and counts
                          as up, because nobody pressed it */
    uint64_t still_us[DRV_DEBOUNCE_KEYS];
    uint64_t down_us[DRV_DEBOUNCE_KEYS]; /* time since when it is down */
};

/* Begin with the lines as they are now. */
void drv_debounce_init(struct drv_debounce *d, uint32_t period_us, uint64_t levels);

/* Take the lines' levels. Bit n of `levels`: line n is active; bit n of `edges`: line n had an edge
 * since the last call. `now_us` never goes back. Returns the keys that changed; d->down has their
 * state. */
uint64_t drv_debounce_look(struct drv_debounce *d, uint64_t levels, uint64_t edges,
                           uint64_t now_us);

/* True if a key may change without another edge: call drv_debounce_look again soon. */
bool drv_debounce_is_waiting(const struct drv_debounce *d);

/* The keys that have been down for longer than `held_us`, or since the start. */
uint64_t drv_debounce_stuck(const struct drv_debounce *d, uint64_t now_us, uint64_t held_us);

#endif
