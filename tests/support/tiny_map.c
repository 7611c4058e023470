#include "tiny_map.h"
#include "check.h"

#include <stdlib.h>

enum { POLLS = 16, CALLS_MAX = 100000 };

void tiny_map_open(struct tiny_map *m, const struct tiny_spec *spec, uint32_t tiles)
{
    const size_t pool_bytes = tiles * sizeof(struct lm_tile);
    assert_int_equal(tiny_image_build(&m->image, spec), 0);
    memory_flash_open(&m->flash, m->image.bytes, m->image.size);
    m->pool = malloc(pool_bytes);
    assert_non_null(m->pool);
    assert_int_equal(lm_db_open(&m->db, &m->flash.port, POLLS), LM_OK);
    assert_int_equal(lm_tile_cache_init(&m->tiles, &m->db, m->pool, pool_bytes, POLLS), LM_OK);
}

void tiny_map_open_soil(struct tiny_map *m, uint32_t tiles, struct lm_tone *tone)
{
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 12;
    spec.rows = spec.columns = 4;
    tiny_map_open(m, &spec, tiles);
    assert_int_equal(lm_tone_set(tone, &lm_radar_default.sar.tone), LM_OK);
}

void tiny_map_close(struct tiny_map *m)
{
    tiny_image_free(&m->image);
    free(m->pool);
}

void tiny_map_read_tiles(struct tiny_map *m)
{
    uint32_t calls = 0;
    do {
        lm_tile_cache_service(&m->tiles, 0, 1);
    } while (!lm_tile_cache_is_idle(&m->tiles) && ++calls < CALLS_MAX);
    assert_true(lm_tile_cache_is_idle(&m->tiles));
}
