/* Control ring: a lock-free queue of controls from a driver's thread to the loop, with one writer
 * and one reader. All zero is an empty ring. */
#ifndef DRV_CONTROL_RING_H
#define DRV_CONTROL_RING_H

#include <stdatomic.h>
#include <stdbool.h>

#include "lm/controls.h"

enum { DRV_CONTROL_RING = 64 }; /* controls that may wait; a power of two */

struct drv_control_ring {
    struct lm_control control[DRV_CONTROL_RING];
    atomic_uint head, tail; /* how many were ever put in, and taken out */
};

/* Append a control; the writer's side. False when the ring is full: nothing was put in. */
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

/* Take the oldest control; the reader's side. False when the ring is empty: *control is left alone.
 */
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
