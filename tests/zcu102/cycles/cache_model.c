#include "cache_model.h"

#include <string.h>

enum { KIB = 1024 };

bool cache_model_init(struct cache *cache, uint32_t bytes, uint32_t ways)
{
    const uint32_t sets = ways ? bytes / CACHE_LINE_BYTES / ways : 0;
    if (ways == 0 || ways > CACHE_WAYS_MAX || sets == 0 || sets > CACHE_SETS_MAX ||
        (sets & (sets - 1)) != 0 || sets * ways * CACHE_LINE_BYTES != bytes) {
        return false;
    }
    memset(cache, 0, sizeof *cache);
    cache->sets = sets;
    cache->ways = ways;
    return true;
}

bool cache_model_has(struct cache *cache, uint64_t line)
{
    const uint32_t set = (uint32_t)line & (cache->sets - 1);
    uint64_t *lines = cache->line[set], *used = cache->used[set];
    uint32_t oldest = 0;
    cache->now++;
    for (uint32_t way = 0; way < cache->ways; way++) {
        if (lines[way] == line + 1) {
            used[way] = cache->now;
            return true;
        }
        oldest = used[way] < used[oldest] ? way : oldest;
    }
    lines[oldest] = line + 1;
    used[oldest] = cache->now;
    return false;
}

void cache_model_levels(struct cache_levels *levels)
{
    memset(levels, 0, sizeof *levels);
    (void)cache_model_init(&levels->data, 32 * KIB, 4);
    (void)cache_model_init(&levels->code, 32 * KIB, 2);
    (void)cache_model_init(&levels->second, KIB * KIB, 16);
}

static bool is_next(struct cache_levels *levels, uint64_t line)
{
    bool found = false;
    for (uint32_t i = 0; i < CACHE_STREAMS; i++) {
        found |= levels->streams[i] == line - 1 || levels->streams[i] == line + 1;
    }
    levels->streams[levels->stream++ % CACHE_STREAMS] = line;
    return found;
}

static void access_lines(struct cache_levels *levels, struct cache *first, uint64_t address,
                         uint32_t bytes, struct cache_counts *counts)
{
    const uint64_t last = (address + bytes - 1) / CACHE_LINE_BYTES;
    for (uint64_t line = address / CACHE_LINE_BYTES; line <= last; line++) {
        counts->accesses++;
        if (cache_model_has(first, line)) {
            continue;
        }
        const bool next = is_next(levels, line), near = cache_model_has(&levels->second, line);
        counts->misses++;
        counts->next += next;
        counts->far_misses += !near;
        counts->far_next += !near && next;
    }
}

void cache_model_data(struct cache_levels *levels, uint64_t address, uint32_t bytes,
                      struct cache_counts *counts)
{
    access_lines(levels, &levels->data, address, bytes, counts);
}

void cache_model_code(struct cache_levels *levels, uint64_t address, uint32_t bytes,
                      struct cache_counts *counts)
{
    access_lines(levels, &levels->code, address, bytes, counts);
}
