/* The aircraft jumps to where no tile is in memory: those of the whole picture are there before the
 * antenna comes to them, though the flash is slow. */
#include "check.h"
#include "hs/angle.h"
#include "unit_rig.h"

#include <math.h>

enum { READ_POLLS = 2, JUMP_STEPS = 250, SWEEPS_S = 3, RANGE_M = 18520 };

static double waves_m(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 200 + 100 * sin(p->east_m / 1500) * sin(p->north_m / 1100);
}

/* 79 km north to south and 48 km west to east, in cells of 76 m, which a scale of 10 nautical miles
 * takes, and three levels above it. The flight is in the south of it. */
static struct rig *start(void)
{
    struct rig *r = make_rig();
    struct tiny_spec spec = tiny_spec_at(46, 11);
    spec.shift0 = 13;
    spec.rows = 16;
    spec.columns = 14;
    spec.elevation_m = waves_m;
    tiny_image_free(&r->image);
    assert_int_equal(tiny_image_build(&r->image, &spec), 0);
    memory_flash_open(&r->board.flash, r->image.bytes, r->image.size);
    r->bus.jump_degrees = -0.2;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 3);
    r->board.flash.busy_polls = READ_POLLS;
    return r;
}

static void jump(struct rig *r)
{
    r->bus.jump_degrees = 0.05;
    run(r, 0.05); /* until the bus has told it */
    assert_int_equal(r->unit.nav.position_jumps, 1);
}

/* Places of the picture, one for each degree and 200 m, whose tile is not in memory. */
static uint32_t places_missing(const struct rig *r)
{
    const struct lm_tile_cache *c = &r->unit.map.tiles;
    const struct lm_sector *s = &r->unit.picture.sector;
    const uint32_t side_log2 = (uint32_t)c->db->shift0 + s->lod + LM_TILE_CELLS_LOG2;
    uint32_t missing = 0;
    assert_int_equal(s->lod, 0);
    for (int degree = -60; degree <= 60; degree++) {
        for (uint32_t m = 0; m < RANGE_M; m += 200) {
            struct lm_geo_origin origin;
            lm_geo_set_origin(&origin, s->origin.position);
            const struct lm_position at =
                lm_geo_direct(&origin, s->up + hs_bam(degree), LM_M_Q8(m));
            missing += !lm_tile_cache_find(c, s->lod, (at.latitude + FX_BAM_90) >> side_log2,
                                           at.longitude >> (side_log2 + lm_db_zone(at.latitude)));
        }
    }
    return missing;
}

TEST(all_tiles_of_the_picture_are_there_when_the_antenna_is_half_way)
{
    struct rig *r = start();
    const struct lm_tile_cache *c = &r->unit.map.tiles;
    jump(r);
    const uint32_t before = places_missing(r), tiles = c->count.tiles_read;
    uint32_t steps = 0, most_waiting = 0;
    for (; steps < JUMP_STEPS && places_missing(r) > 0; steps++) {
        run(r, STEP_US * 1e-6);
        const uint32_t waiting = lm_tile_cache_waiting(c);
        most_waiting = waiting > most_waiting ? waiting : most_waiting;
    }
    print_message("# %u places without a tile, none after %u steps: %u tiles, at most %u waited\n",
                  before, steps, c->count.tiles_read - tiles, most_waiting);
    assert_true(before > 5000);
    assert_true(steps < JUMP_STEPS);
    assert_true(most_waiting < 32);
    assert_int_equal(c->count.requests_dropped, 0);
    assert_false(r->unit.picture.sector.is_leftward);
    assert_true(r->unit.picture.sector.line < r->unit.picture.sector.lines / 2);
    free_rig(r);
}

TEST(no_look_up_is_late_from_then_on)
{
    struct rig *r = start();
    const struct lm_tile_cache *c = &r->unit.map.tiles;
    jump(r);
    run(r, JUMP_STEPS * STEP_US * 1e-6);
    const uint32_t late = c->count.misses;
    run(r, SWEEPS_S);
    assert_int_equal(c->count.misses - late, 0);
    free_rig(r);
}
