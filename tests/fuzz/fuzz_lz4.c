/* Any bytes as a block of LZ4. The first four bytes of the input are the length of the output and
 * how far the block lies from its start; the rest is the block. Buffers are as long as needed, so
 * that the sanitizer sees every byte outside. */
#include "fuzz.h"
#include "lm/lz4.h"

const uint32_t fuzz_mutations = 100000;

/* Decode in steps of so many sequences. Returns the status. */
static int decode(uint8_t *buffer, uint32_t out_bytes, uint32_t at, uint32_t bytes, uint32_t step)
{
    struct lm_lz4 d;
    int status = LM_BUSY;
    lm_lz4_begin(&d, buffer, out_bytes, at, bytes);
    for (uint32_t done = 0; status == LM_BUSY; done += step) {
        FUZZ_ASSERT(done <= out_bytes / 4 + 1);
        status = lm_lz4_run(&d, step);
        FUZZ_ASSERT(d.out <= d.out_end && d.in <= d.in_end);
        FUZZ_ASSERT(d.out <= d.in || d.in == d.in_end);
    }
    FUZZ_ASSERT(status == LM_OK || status == LM_ERR_CORRUPT);
    FUZZ_ASSERT(status != LM_OK || d.out == out_bytes);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    const uint32_t out_bytes = fuzz_u16(&supply) % 20000, at = fuzz_u16(&supply);
    const uint32_t bytes = (uint32_t)(supply.left < 100000 ? supply.left : 100000);
    const uint32_t end = at + bytes > out_bytes ? at + bytes : out_bytes;
    uint8_t *once = malloc(end + 1), *again = malloc(end + 1);
    FUZZ_ASSERT(once && again);
    memset(once, 0, end + 1);
    memcpy(once + at, supply.at, bytes);
    memcpy(again, once, end + 1);
    const int status = decode(once, out_bytes, at, bytes, 1000000);
    FUZZ_ASSERT(decode(again, out_bytes, at, bytes, 1) == status);
    FUZZ_ASSERT(memcmp(once, again, end) == 0);
    free(once);
    free(again);
    return 0;
}
