/* One pattern of reads, for the model of the caches and for cachegrind, which judges it: rows, a
 * column of 264 bytes a step, places at random, and places used again between others, over 2 MiB.
 *
 *   strides touch ROUNDS     reads memory
 *   strides model ROUNDS     prints the model's misses of the first cache and of both */
#include "cache_model.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BYTES = 2 << 20, STEPS = 20000, ROW_BYTES = 264, USED_AGAIN_BYTES = 24 << 10 };

static _Alignas(1 << 16) volatile uint8_t memory[BYTES];

/* The offset that the pattern's step i reads. */
static uint32_t place(uint32_t i, uint32_t *random)
{
    *random = *random * 1664525u + 1013904223u;
    switch (i / 2500 % 4) {
    case 0:
        return i * 4 % BYTES;
    case 1:
        return i * ROW_BYTES % BYTES;
    case 2:
        return (*random >> 8) % BYTES;
    default: /* what is used again, between what is not */
        return i % 2 ? (*random >> 8) % USED_AGAIN_BYTES : i * 32 % BYTES;
    }
}

int main(int argc, char **argv)
{
    static struct cache_levels levels;
    struct cache_counts counts = {0};
    const uint32_t rounds = argc == 3 ? (uint32_t)strtoul(argv[2], NULL, 10) : 0;
    const bool is_model = argc == 3 && strcmp(argv[1], "model") == 0;
    uint32_t random = 1;
    cache_model_levels(&levels);
    for (uint32_t i = 0; i < rounds * STEPS; i++) {
        const uint32_t at = place(i, &random);
        if (is_model) {
            cache_model_data(&levels, at, 1, &counts);
        } else {
            (void)memory[at];
        }
    }
    printf("%" PRIu64 " %" PRIu64 "\n", counts.misses, counts.far_misses);
    return rounds == 0;
}
