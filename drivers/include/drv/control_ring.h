/* Control ring: controls from a driver's thread to the loop. One writer, one reader, no lock. All
 * zero is an empty ring. */
#ifndef DRV_CONTROL_RING_H
#define DRV_CONTROL_RING_H

#include <stdatomic.h>
#include <stdbool.h>

#include "lm/controls.h"

enum { DRV_CONTROL_RING = 64 };

struct drv_control_ring {
    struct lm_control control[DRV_CONTROL_RING];
    atomic_uint head, tail; /* controls put in, and taken out, since the start */
};

/* Put in a control, which is copied. False, and the ring is unchanged, if it is full. */
static inline bool drv_control_ring_put(struct drv_control_ring *r, struct lm_control control)
{
    const unsigned head = atomic_load_explicit(&r->head, memory_order_relaxed);
    if (head - atomic_load_explicit(&r->tail, memory_order_acquire) == DRV_CONTROL_RING) {
        return false;
    }
    r->control[head % DRV_CONTROL_RING] = control;
    atomic_store_explicit(&r->head, head + 1, memory_order_release);
    return true;
}

/* Take out the oldest control. False, and *control is unchanged, if the ring is empty. */
static inline bool drv_control_ring_take(struct drv_control_ring *r, struct lm_control *control)
{
    const unsigned tail = atomic_load_explicit(&r->tail, memory_order_relaxed);
    if (tail == atomic_load_explicit(&r->head, memory_order_acquire)) {
        return false;
    }
    *control = r->control[tail % DRV_CONTROL_RING];
    atomic_store_explicit(&r->tail, tail + 1, memory_order_release);
    return true;
}

#endif
