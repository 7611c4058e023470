/* From the levels of up to 64 lines to keys that are up or down. Pure: time is an argument.
 *
 * A key is believed when its line has been different from what is believed, and still, for the
 * whole period; an edge between two looks counts as movement even when both looks agree. */
#ifndef DRV_DEBOUNCE_H
#define DRV_DEBOUNCE_H

#include <stdbool.h>
#include <stdint.h>

enum { DRV_DEBOUNCE_KEYS = 64 };

struct drv_debounce {
    uint32_t period_us;
    uint64_t down;     /* bit n: key n is believed to be down */
    uint64_t differs;  /* the line says otherwise, since `still_us` at least */
    uint64_t at_start; /* down when we began and not let go since: a key that is stuck. It counts as
                          up, because nobody pressed it */
    uint64_t still_us[DRV_DEBOUNCE_KEYS];
    uint64_t down_us[DRV_DEBOUNCE_KEYS]; /* since when it is down */
};

/* Begin with the lines as they are now. */
void drv_debounce_init(struct drv_debounce *d, uint32_t period_us, uint64_t levels);

/* Look at the lines. Bit n of `levels`: line n is active; of `edges`: it has moved since the last
 * look. `now_us` never goes back. Returns the keys whose belief has changed: see d->down. */
uint64_t drv_debounce_look(struct drv_debounce *d, uint64_t levels, uint64_t edges,
                           uint64_t now_us);

/* Whether there is a belief that may change without an edge: look again soon. */
bool drv_debounce_is_waiting(const struct drv_debounce *d);

/* Keys that are down since before `now_us` - `held_us`, or since the start. */
uint64_t drv_debounce_stuck(const struct drv_debounce *d, uint64_t now_us, uint64_t held_us);

#endif
