/* fx_crc32c for the libFuzzer programs (linked by --wrap; fuzz.mk): the sums of images, records and
 * pieces took up to three quarters of an input. What it is given is looked at first, so that a
 * reader that sums too much is still found. */
#include "fuzz.h"
#include "fx/crc32c.h"

#include <sanitizer/asan_interface.h>

uint32_t __real_fx_crc32c(uint32_t crc, const void *data, size_t len);
uint32_t __wrap_fx_crc32c(uint32_t crc, const void *data, size_t len);

#ifdef __x86_64__
__attribute__((target("sse4.2"), no_sanitize("address"))) static uint32_t
sum(uint32_t crc, const uint8_t *at, size_t left)
{
    uint64_t c = ~crc;
    for (; left >= 8; left -= 8, at += 8) {
        uint64_t eight;
        __builtin_memcpy(&eight, at, sizeof eight);
        c = __builtin_ia32_crc32di(c, eight);
    }
    for (; left > 0; left--, at++) {
        c = __builtin_ia32_crc32qi((uint32_t)c, *at);
    }
    return ~(uint32_t)c;
}

/* What may not be read goes to the true one, and the sanitizer sees it there; so does now and then
 * what may, to compare the two. */
uint32_t __wrap_fx_crc32c(uint32_t crc, const void *data, size_t len)
{
    static uint32_t calls;
    if (len == 0 || __asan_region_is_poisoned((void *)(uintptr_t)data, len)) {
        return __real_fx_crc32c(crc, data, len);
    }
    const uint32_t found = sum(crc, data, len);
    FUZZ_ASSERT(++calls % 256 != 0 || found == __real_fx_crc32c(crc, data, len));
    return found;
}
#else
uint32_t __wrap_fx_crc32c(uint32_t crc, const void *data, size_t len)
{
    return __real_fx_crc32c(crc, data, len);
}
#endif
