/* Cache model: a set-associative cache of lines of 64 bytes that replaces what was used longest ago
 * (LRU), and the two levels of the Cortex-A53 of the ZCU102: 32 KiB of 4 ways for data, 32 KiB of 2
 * ways for code, and 1 MiB of 16 ways behind both (UG1085, 3; DDI 0500, 6 and 7). The core itself
 * replaces at random in the first level, and fetches ahead what a stride foretells. */
#ifndef CACHE_MODEL_H
#define CACHE_MODEL_H

#include <stdbool.h>
#include <stdint.h>

enum {
    CACHE_LINE_BYTES = 64,
    CACHE_WAYS_MAX = 16,
    CACHE_SETS_MAX = 1024,
    CACHE_STREAMS = 8, /* misses remembered, next to which a miss is one in sequence */
};

struct cache {
    uint32_t sets, ways;
    uint64_t now;
    uint64_t line[CACHE_SETS_MAX][CACHE_WAYS_MAX]; /* line number + 1; 0: empty */
    uint64_t used[CACHE_SETS_MAX][CACHE_WAYS_MAX];
};

/* Counts of accesses. `next` of the misses are those whose line lies beside that of one of the last
 * eight misses: what fetching ahead may hide. */
struct cache_counts {
    uint64_t accesses, misses, next, far_misses, far_next; /* far: of the second level, too */
};

struct cache_levels {
    struct cache data, code, second;
    uint64_t streams[CACHE_STREAMS];
    uint32_t stream;
};

/* An empty cache. `bytes` and `ways` must make a power of two of sets, CACHE_SETS_MAX at most.
 * False, and nothing is set, if they do not. */
bool cache_model_init(struct cache *cache, uint32_t bytes, uint32_t ways);

/* True if the line of this number was there; it is there from now on. */
bool cache_model_has(struct cache *cache, uint64_t line);

/* Those of the board. */
void cache_model_levels(struct cache_levels *levels);

/* An access to `bytes` bytes at `address`, counted once for each line that it touches. */
void cache_model_data(struct cache_levels *levels, uint64_t address, uint32_t bytes,
                      struct cache_counts *counts);
void cache_model_code(struct cache_levels *levels, uint64_t address, uint32_t bytes,
                      struct cache_counts *counts);

#endif
