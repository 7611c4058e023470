/* Memory functions: the part of <string.h> that a compiler calls by itself, and unaligned access.
 *
 * The image's linker supplies the functions: from the C library on a hosted board, from the board's
 * start-up files on bare metal. They are those of the C standard. */
#ifndef FX_MEM_H
#define FX_MEM_H

#include <stddef.h>
#include <stdint.h>

void *memcpy(void *restrict to, const void *restrict from, size_t len);
void *memmove(void *to, const void *from, size_t len);
void *memset(void *to, int byte, size_t len);
int memcmp(const void *a, const void *b, size_t len);

/* Load four bytes from any address, in this machine's byte order. Cost: one load where the machine
 * takes unaligned words. In a vectorized loop the loads become one gather. */
static inline uint32_t fx_load_u32(const void *from)
{
    uint32_t word;
    __builtin_memcpy(&word, from, sizeof word);
    return word;
}

/* Load two bytes from any address, in this machine's byte order. */
static inline uint16_t fx_load_u16(const void *from)
{
    uint16_t half;
    __builtin_memcpy(&half, from, sizeof half);
    return half;
}

/* Load eight bytes from any address, in this machine's byte order. */
static inline uint64_t fx_load_u64(const void *from)
{
    uint64_t word;
    __builtin_memcpy(&word, from, sizeof word);
    return word;
}

#endif
