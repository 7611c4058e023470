/* Eight numbers that are worked on together, for loops that a compiler does not make vectors of by
 * itself. These are GNU C's vectors: one register where the machine has one so wide, two of four,
 * or eight numbers one by one, the bits being the same. Use them inside a function only: how one is
 * passed to another depends on the machine. */
#ifndef FX_LANES_H
#define FX_LANES_H

#include <stdint.h>

enum { FX_LANES = 8 };

typedef uint32_t fx_lanes_u32 __attribute__((vector_size(4 * FX_LANES)));
typedef int32_t fx_lanes_i32 __attribute__((vector_size(4 * FX_LANES)));

/* Eight numbers in an array, aligned as any number is. */
typedef uint32_t fx_lanes_in_memory
    __attribute__((vector_size(4 * FX_LANES), aligned(4), may_alias));

#endif
