/* Byte ring: bytes from one thread to another, such as from the loop to a thread that writes them.
 * One writer, one reader, no lock; neither ever waits. All zero is a ring without room. */
#ifndef PANEL_BYTE_RING_H
#define PANEL_BYTE_RING_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

struct byte_ring {
    uint8_t *bytes;           /* borrowed */
    size_t size;              /* a power of two */
    atomic_size_t head, tail; /* bytes put in, and taken out, since the start */
};

static inline size_t byte_ring_room(struct byte_ring *r)
{
    return r->size - (atomic_load_explicit(&r->head, memory_order_relaxed) -
                      atomic_load_explicit(&r->tail, memory_order_acquire));
}

/* Put in all of them. False, and the ring is unchanged, if there is no room. */
static inline bool byte_ring_put(struct byte_ring *r, const void *bytes, size_t count)
{
    const size_t head = atomic_load_explicit(&r->head, memory_order_relaxed);
    if (count > byte_ring_room(r)) {
        return false;
    }
    const size_t at = head & (r->size - 1);
    const size_t first = count < r->size - at ? count : r->size - at;
    memcpy(r->bytes + at, bytes, first);
    memcpy(r->bytes, (const uint8_t *)bytes + first, count - first);
    atomic_store_explicit(&r->head, head + count, memory_order_release);
    return true;
}

/* The oldest bytes, as many as lie side by side. Returns how many; 0: the ring is empty. */
static inline size_t byte_ring_peek(struct byte_ring *r, const uint8_t **bytes)
{
    const size_t tail = atomic_load_explicit(&r->tail, memory_order_relaxed);
    const size_t count = atomic_load_explicit(&r->head, memory_order_acquire) - tail;
    const size_t at = tail & (r->size - 1);
    *bytes = r->bytes + at;
    return count < r->size - at ? count : r->size - at;
}

/* Take out so many of those that byte_ring_peek gave. */
static inline void byte_ring_drop(struct byte_ring *r, size_t count)
{
    const size_t tail = atomic_load_explicit(&r->tail, memory_order_relaxed);
    atomic_store_explicit(&r->tail, tail + count, memory_order_release);
}

#endif
