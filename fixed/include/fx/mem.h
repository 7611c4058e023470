/* The functions of <string.h> that a compiler may call by itself. Whoever links an image supplies
 * them: the C library on a hosted board, the board's own start-up files on bare metal. */
#ifndef FX_MEM_H
#define FX_MEM_H

#include <stddef.h>
#include <stdint.h>

void *memcpy(void *restrict to, const void *restrict from, size_t len);
void *memset(void *to, int byte, size_t len);
int memcmp(const void *a, const void *b, size_t len);

/* Four bytes from any address, as a number of this machine's order of bytes. One load where words
 * need not be aligned, and one gather of many where a loop is made of vectors. */
static inline uint32_t fx_load_u32(const void *from)
{
    uint32_t word;
    __builtin_memcpy(&word, from, sizeof word);
    return word;
}

/* The lower two bytes of a number to any address. */
static inline void fx_store_u16(void *to, uint32_t number)
{
    const uint16_t half = (uint16_t)number;
    __builtin_memcpy(to, &half, sizeof half);
}

/* Eight bytes likewise. */
static inline uint64_t fx_load_u64(const void *from)
{
    uint64_t word;
    __builtin_memcpy(&word, from, sizeof word);
    return word;
}

#endif
