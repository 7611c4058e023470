#include "lm/cursor.h"

#include "fx/root.h"
#include "fx/sat.h"
#include "lm/units.h"

void lm_cursor_zero(struct lm_cursor *c, const struct lm_cursor_scene *scene)
{
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, scene->ownship);
    c->position = lm_geo_direct(&origin, scene->heading, lm_m_q8_of_m(scene->scale_m / 2));
    c->is_placed = c->is_home = true;
}

void lm_cursor_stabilise(struct lm_cursor *c)
{
    c->is_snowplow = c->is_home = false;
}

void lm_cursor_put(struct lm_cursor *c, struct lm_position position)
{
    c->position = position;
    c->is_placed = true;
    lm_cursor_stabilise(c);
}

/* Part of a sector that a cursor may stand in, pixels * 256 from the apex. */
struct part {
    int32_t aside_px_q8, low_px_q8, high_px_q8;
};

/* What the frame shows of the sector. */
static struct part shown_part(const struct lm_view *v)
{
    return (struct part){lm_px_q8_of_px(v->aside_px), 0, lm_px_q8_of_px(v->above_px)};
}

/* What slewing reaches: 0.95 of half the frame's height to each side of its middle, and as much
 * from the line straight ahead. [FreeFalcon] caps its cursor so, gmscope.cpp 1320. */
static struct part slewed_part(const struct lm_view *v)
{
    const struct part shown = shown_part(v);
    const int32_t high_px_q8 = shown.high_px_q8;
    return (struct part){fx_min_i32(shown.aside_px_q8 - 256, high_px_q8 * 475 / 1000),
                         high_px_q8 * 25 / 1000, high_px_q8 * 975 / 1000};
}

/* The nearest offset within a part of the sector and its circle. */
static struct lm_offset within_sector(struct lm_offset o, int32_t radius_px,
                                      const struct part *part)
{
    const int64_t radius_px_q8 = lm_px_q8_of_px(radius_px);
    o.x_px_q8 = fx_clamp_i32(o.x_px_q8, -part->aside_px_q8, part->aside_px_q8);
    o.y_px_q8 = fx_clamp_i32(o.y_px_q8, part->low_px_q8, part->high_px_q8);
    const int64_t length_px_q8 = fx_hypot_u32(o.x_px_q8, o.y_px_q8);
    if (length_px_q8 > radius_px_q8) {
        o.x_px_q8 = (int32_t)(o.x_px_q8 * radius_px_q8 / length_px_q8);
        o.y_px_q8 = (int32_t)(o.y_px_q8 * radius_px_q8 / length_px_q8);
    }
    return o;
}

/* The nearest offset within the window or patch. */
static struct lm_offset within_square(struct lm_offset o, const struct lm_view *view)
{
    const int32_t edge_px_q8 = lm_px_q8_of_px(view->radius_px - 1);
    const struct lm_offset middle = lm_view_middle(view);
    return (struct lm_offset){
        middle.x_px_q8 + fx_clamp_i32(o.x_px_q8 - middle.x_px_q8, -edge_px_q8, edge_px_q8),
        middle.y_px_q8 + fx_clamp_i32(o.y_px_q8 - middle.y_px_q8, -edge_px_q8, edge_px_q8)};
}

static struct lm_offset within(struct lm_offset o, const struct lm_view *view,
                               const struct part *part)
{
    return view->shape == LM_VIEW_SECTOR ? within_sector(o, view->radius_px, part)
                                         : within_square(o, view);
}

/* Distance that a deflection moves the cursor in one step: at most 512 * 256 / 50. */
static int32_t step_px_q8(int32_t deflection, int32_t half_px)
{
    const int32_t full_px_q8 =
        lm_px_q8_of_px(half_px) * LM_CURSOR_HALVES_PER_S / (1000000 / LM_CURSOR_STEP_US);
    return full_px_q8 * deflection / 1000;
}

static void slew(struct lm_cursor *c, const struct lm_cursor_scene *scene)
{
    struct lm_offset o;
    if (!lm_view_find(scene->view, c->position, &o)) {
        lm_cursor_zero(c, scene);
        return;
    }
    o.x_px_q8 += step_px_q8(c->slew_x, scene->half_px) * scene->slew_percent / 100;
    o.y_px_q8 += step_px_q8(c->slew_y, scene->half_px) * scene->slew_percent / 100;
    const struct part part = slewed_part(scene->view);
    c->position = lm_view_position(scene->view, within(o, scene->view, &part));
    c->is_home = false;
}

bool lm_cursor_step(struct lm_cursor *c, const struct lm_cursor_scene *scene, uint64_t now_us)
{
    if (now_us - c->stepped_us < LM_CURSOR_STEP_US) {
        return false;
    }
    c->stepped_us =
        now_us - c->stepped_us < 2 * LM_CURSOR_STEP_US ? c->stepped_us + LM_CURSOR_STEP_US : now_us;
    if (!c->is_placed || c->is_snowplow) {
        lm_cursor_zero(c, scene);
    } else if (c->slew_x != 0 || c->slew_y != 0) {
        slew(c, scene);
    }
    return true;
}

void lm_cursor_locate(struct lm_cursor *c, const struct lm_cursor_scene *scene)
{
    uint32_t distance_m_q8;
    lm_geo_inverse(scene->ownship, c->position, &distance_m_q8, &c->bearing);
    c->range_m = lm_m_of_m_q8(distance_m_q8);
    c->offset = (struct lm_offset){0, 0};
    c->is_on_glass = lm_view_find(scene->view, c->position, &c->offset);
    if (c->is_on_glass) {
        /* A tolerance of one pixel: a position changes a little on its way from the glass to the
         * ground and back. */
        const struct part part = shown_part(scene->view);
        const struct lm_offset o = within(c->offset, scene->view, &part);
        c->is_on_glass =
            fx_hypot_u32(o.x_px_q8 - c->offset.x_px_q8, o.y_px_q8 - c->offset.y_px_q8) <= 256;
    }
}

int32_t lm_cursor_wants_range(const struct lm_cursor *c, uint32_t scale_m)
{
    if (c->offset.y_px_q8 <= 0) {
        return 0;
    }
    /* Ranges are below 1,300 km: products below 2^31. */
    if (c->range_m * 100 >= scale_m * 95) {
        return 1;
    }
    return c->range_m * 1000 < scale_m * 425 ? -1 : 0;
}
