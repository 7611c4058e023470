/* One country and one flight along 90 E, where longitudes do not wrap, and along the antimeridian,
 * where they do in the middle of every picture: the glass shows the same. */
#include "hs/angle.h"
#include "unit_rig.h"

#include "check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct twins {
    struct rig *plain, *wrapped;
};

/* Targets to both sides: one stands, one fluctuates, two move across the meridian. */
static void add_targets(struct rig *r, double longitude_deg)
{
    static const double beside[][2] = {{46.02, 0.01}, {46.01, -0.01}, {46.02, -0.002}, {46, 0.002}};
    for (uint32_t i = 0; i < 4; i++) {
        r->unit.map.targets[i] = (struct lm_target){
            .id = 40 + i,
            .latitude = hs_bam(beside[i][0]),
            .longitude = hs_bam(longitude_deg) + hs_bam(beside[i][1]),
            .elevation_m_q6 = 100 * 64,
            .heading = FX_BAM_DEG(i == 2 ? 90 : 270),
            .swerling = i == 1,
            .mean_rcs_dbsm_q8 = 40 * 256,
            .speed_mm_s = i < 2 ? 0 : 60000,
            .leg_m = i < 2 ? 0 : 4000,
        };
    }
    r->unit.map.target_set.items = r->unit.map.targets;
    r->unit.map.target_set.count = 4;
}

static struct rig *start_at(double longitude_deg)
{
    struct rig *r = make_rig_at(46, longitude_deg);
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    add_targets(r, longitude_deg);
    command(r, range_10);
    run(r, 3);
    return r;
}

static struct twins start(double wrapped_deg)
{
    return (struct twins){start_at(90), start_at(wrapped_deg)};
}

static void end(struct twins *t)
{
    free_rig(t->plain);
    free_rig(t->wrapped);
}

static void both(const struct twins *t, struct lm_control control, double seconds)
{
    command(t->plain, control);
    command(t->wrapped, control);
    run(t->plain, seconds);
    run(t->wrapped, seconds);
}

/* A country of waves and steps has values on the edge between two codes. Of a place given in
 * doubles of another size a handful fall the other way. */
static void compare(const struct twins *t, const char *what)
{
    const struct lm_cursor *a = &t->plain->unit.cursor, *b = &t->wrapped->unit.cursor;
    uint32_t other = 0;
    for (size_t i = 0; i < sizeof t->plain->plane; i++) {
        other += t->plain->plane[i] != t->wrapped->plane[i];
    }
    print_message("# %s: %u lit, %u other pixels\n", what, lit_pixels(t->plain), other);
    assert_true(lit_pixels(t->plain) > 300);
    assert_int_equal(other, 0);
    assert_int_equal(a->is_placed, b->is_placed);
    assert_int_equal(a->position.latitude, b->position.latitude);
    assert_int_equal(a->position.longitude - hs_bam(90), b->position.longitude - hs_bam(180));
    assert_int_equal(a->range_m, b->range_m);
    assert_int_equal(a->bearing, b->bearing);
    assert_int_equal(t->plain->unit.cursor_elevation_m_q10,
                     t->wrapped->unit.cursor_elevation_m_q10);
    assert_int_equal(t->plain->unit.ground_m_q10, t->wrapped->unit.ground_m_q10);
    assert_int_equal(t->plain->unit.flags, t->wrapped->unit.flags);
    assert_int_equal(t->wrapped->unit.flags & LM_FLAG_OFF_MAP, 0);
}

static struct lm_control sector(int32_t mode, int32_t fov)
{
    return (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {.mode = mode, .fov = fov}};
}

/* Put the cursor so far beside the meridian, which is `at_deg` on one of the rigs. */
static void put_cursor(struct rig *r, double at_deg, double beside_deg)
{
    command(r, (struct lm_control){
                   .kind = LM_CONTROL_CURSOR,
                   .cursor = {hs_bam(46.045), hs_bam(at_deg) + (uint32_t)hs_bam(beside_deg)}});
}

TEST(sectors_windows_cursor_and_targets_are_the_same_across_the_antimeridian)
{
    static const int32_t modes[] = {LM_SECTOR_GM, LM_SECTOR_GMT, LM_SECTOR_SEA};
    for (int sign = -1; sign <= 1; sign += 2) {
        struct twins t = start(180 * sign);
        for (int m = 0; m < 3; m++) {
            both(&t, sector(modes[m], LM_FOV_NORM), 3);
            compare(&t, m == 0 ? "GM" : m == 1 ? "GMT" : "SEA");
        }
        /* The cursor is slewed from one side to the other. */
        both(&t, sector(LM_SECTOR_GM, LM_FOV_NORM), 1);
        both(&t, lm_control_slew(-LM_FULL_DEFLECTION, 0), 0.5);
        compare(&t, "cursor to the left");
        both(&t, lm_control_slew(LM_FULL_DEFLECTION, 0), 1);
        both(&t, lm_control_slew(0, 0), 2);
        compare(&t, "cursor to the right");
        for (int beside = -1; beside <= 1; beside++) {
            put_cursor(t.plain, 90, 0.002 * beside);
            put_cursor(t.wrapped, 180 * sign, 0.002 * beside);
            for (int32_t fov = LM_FOV_EXP; fov <= LM_FOV_DBS2; fov++) {
                both(&t, sector(LM_SECTOR_GM, fov), 3);
                compare(&t, "window");
            }
        }
        end(&t);
    }
}

/* Speckle of a patch is drawn by its place: its pixels differ, its ground does not. */
TEST(a_patch_across_the_antimeridian_is_drawn_and_reported_like_any_other)
{
    struct twins t = start(180);
    struct rig *const rigs[] = {t.plain, t.wrapped};
    double sum[2] = {0, 0};
    for (int i = 0; i < 2; i++) {
        struct rig *r = rigs[i];
        command(r, (struct lm_control){
                       .kind = LM_CONTROL_SAR,
                       .sar = {.centre = {hs_bam(46), hs_bam(i == 0 ? 90 : 180) + hs_bam(0.05)},
                               .cell_mm = 10000,
                               .is_from_ownship = true}});
        run(r, 20);
        for (size_t k = 0; k < sizeof r->plane; k++) {
            sum[i] += r->plane[k];
        }
        assert_int_equal(r->unit.picture.sar.line, r->unit.picture.sar.lines);
        assert_int_equal(r->unit.flags & LM_FLAG_OFF_MAP, 0);
    }
    print_message("# grey of the two patches: %.0f, %.0f\n", sum[0], sum[1]);
    assert_true(sum[0] > 1e6 && fabs(sum[0] - sum[1]) < 0.01 * sum[0]);
    end(&t);
}
