/* What a window shows is what the antenna reaches: ground that it cannot draw again is not kept. */
#include "check.h"
#include "unit_rig.h"

#include <math.h>

static const double degree = 3.14159265358979323846 / 180;

/* Pixels of the window that are not black, and those of them that no line of this sweep paints. */
struct shown {
    int lit, unreached;
};

static struct shown look(const struct rig *r)
{
    const struct lm_picture *p = &r->unit.picture;
    const struct lm_frame square = lm_frame_square(&p->frame);
    const double left = lm_sector_edge_bam(&p->sector, 0) / 2147483648.0 * 180;
    const double right = lm_sector_edge_bam(&p->sector, p->sector.lines) / 2147483648.0 * 180;
    struct shown shown = {0};
    for (int32_t y = square.top_px; y < square.top_px + square.height_px; y++) {
        for (int32_t x = square.left_px; x < square.left_px + square.width_px; x++) {
            const double right_px = x + 0.5 - p->view.at.x, up_px = p->view.at.y - y - 0.5;
            const double azimuth = atan2(right_px, up_px) / degree;
            const double slack = 0.01 / hypot(right_px, up_px) / degree;
            if (r->plane[y * WIDTH + x] != 0) {
                shown.lit++;
                shown.unreached += azimuth < left - slack || azimuth > right + slack;
            }
        }
    }
    return shown;
}

/* Fly past a cursor to the right of the nose, until it is beyond the antenna's limit. */
static void fly_past(int32_t fov, double turn_deg_s, int seconds)
{
    struct rig *r = make_rig();
    r->bus.speed_m_s = 300;
    r->bus.turn_deg_s = turn_deg_s;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    command(r, range_10);
    run(r, 1);
    command(r, lm_control_slew(1000, -500));
    run(r, 0.4);
    command(r, lm_control_slew(0, 0));
    command(r, (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GM, fov}});
    run(r, 8);
    assert_true(look(r).lit > 20000);
    for (int n = 0; n < 10 * seconds; n++) {
        run(r, 0.1);
        r->bus.nose_deg += 0.1 * turn_deg_s;
        const struct shown shown = look(r);
        if (shown.unreached != 0) {
            fail_msg(
                "field of view %d, %g degrees a second: after %.1f s %d pixels of %d are out "
                "of the antenna's reach",
                (int)fov, turn_deg_s, n / 10.0, shown.unreached, shown.lit);
        }
    }
    assert_int_equal(look(r).lit, 0);
    free_rig(r);
}

TEST(ground_that_has_left_the_antennas_limits_leaves_the_window)
{
    fly_past(LM_FOV_EXP, 0, 60);
    fly_past(LM_FOV_DBS1, 0, 60);
    fly_past(LM_FOV_DBS2, 0, 60);
}

TEST(ground_leaves_the_window_in_a_turn_too)
{
    fly_past(LM_FOV_EXP, -3, 30);
    fly_past(LM_FOV_DBS1, -3, 30);
}

/* Stand still for ten seconds by a key, pressed twice, and return the lit pixels right after. */
static uint32_t lit_after_standing(struct rig *r, int key)
{
    press(r, key);
    run(r, 10);
    press(r, key);
    return lit_pixels(r);
}

/* The aircraft flies 1.5 km meanwhile: lines of before and of now would not fit together. */
TEST(ground_from_before_a_freeze_is_not_shown_beside_that_of_now)
{
    static const int freeze = 7, override = 4;
    struct rig *r = fly_rig();
    run(r, 5);
    for (int n = 0; n < 2; n++) {
        const uint32_t before = lit_pixels(r);
        const uint32_t after = lit_after_standing(r, n == 0 ? freeze : override);
        assert_true(before > 20000);
        assert_in_range(after, 1, before / 4); /* what a tenth of a second sweeps */
        run(r, 6);
        assert_true(lit_pixels(r) > 2 * after); /* swept again; the small country ends ahead */
    }
    free_rig(r);
}

TEST(a_patch_stays_behind_a_freeze)
{
    struct rig *r = fly_rig();
    command(r, patch_here);
    run(r, 8);
    const uint32_t before = plane_sum(r);
    press(r, 7);
    run(r, 2);
    press(r, 7);
    assert_true(before != 0);
    assert_int_equal(plane_sum(r), before);
    free_rig(r);
}
