#include "hs/crc32c.h"

#include "fx/crc32c.h"

#ifdef __x86_64__
#include <nmmintrin.h>
#include <string.h>

/* Intel SDM, volume 2, CRC32: the polynomial is Castagnoli's, without the inversions. */
__attribute__((target("sse4.2"))) static uint32_t by_instruction(uint32_t crc, const uint8_t *p,
                                                                 size_t len)
{
    uint64_t c = (uint32_t)~crc;
    for (; len >= 8; len -= 8, p += 8) {
        uint64_t word;
        memcpy(&word, p, sizeof word);
        c = _mm_crc32_u64(c, word);
    }
    for (; len > 0; len--, p++) {
        c = _mm_crc32_u8((uint32_t)c, *p);
    }
    return ~(uint32_t)c;
}
#endif

uint32_t hs_crc32c(uint32_t crc, const void *data, size_t len)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("sse4.2")) {
        return by_instruction(crc, data, len);
    }
#endif
    return fx_crc32c(crc, data, len);
}
