/* memcpy and its kin (fx/mem.h), by the instructions that WebAssembly has for copying and filling
 * memory: memory.copy allows its two ranges to overlap. The compiler makes the instruction of each
 * builtin, and no call of the function in which it stands (-mbulk-memory). */
#include "fx/mem.h"

void *memcpy(void *restrict to, const void *restrict from, size_t len)
{
    return __builtin_memcpy(to, from, len);
}

void *memmove(void *to, const void *from, size_t len)
{
    return __builtin_memmove(to, from, len);
}

void *memset(void *to, int byte, size_t len)
{
    return __builtin_memset(to, byte, len);
}

int memcmp(const void *a, const void *b, size_t len)
{
    const uint8_t *x = a, *y = b;
    for (size_t i = 0; i < len; i++) {
        if (x[i] != y[i]) {
            return x[i] - y[i];
        }
    }
    return 0;
}
