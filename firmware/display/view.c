#include "lm/view.h"

#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"
#include "lm/units.h"

enum { FARTHEST_Q8 = LM_M_Q8(250000) };

struct lm_view lm_view_of_sector(const struct lm_frame *frame, const struct lm_view_from *from,
                                 uint32_t range_m, bool is_whole)
{
    const uint16_t radius_px = lm_ppi_radius_px(frame, is_whole);
    const struct lm_point apex = {frame->left_px + frame->width_px / 2,
                                  frame->top_px + frame->height_px};
    return (struct lm_view){
        .shape = LM_VIEW_SECTOR,
        .origin = from->position,
        .up = from->up,
        .height_m_q10 = from->height_m_q10,
        .at = apex,
        .middle = apex,
        .scale_mm_per_px_q8 = (uint32_t)((uint64_t)range_m * 256000u / radius_px),
        .radius_px = radius_px,
        .aside_px = frame->width_px / 2,
        .above_px = frame->height_px,
    };
}

static struct lm_point middle_of(const struct lm_frame *frame)
{
    return (struct lm_point){frame->left_px + frame->width_px / 2,
                             frame->top_px + frame->height_px / 2};
}

struct lm_view lm_view_of_patch(const struct lm_frame *frame, struct lm_position centre,
                                fx_bam_t look, uint32_t cells, uint32_t cell_mm)
{
    const struct lm_frame square = lm_patch_square(frame);
    return (struct lm_view){
        .shape = LM_VIEW_PATCH,
        .origin = centre,
        .up = look,
        .at = middle_of(&square),
        .middle = middle_of(&square),
        .scale_mm_per_px_q8 = (uint32_t)(lm_mm_q8_of_mm(cell_mm) * cells / square.width_px),
        .radius_px = square.width_px / 2,
    };
}

/* Length on the glass of a ground range from the origin. A view from a height shows slant range. */
static uint64_t length_px_q8_of(const struct lm_view *v, uint32_t ground_m_q8)
{
    const uint32_t length_px_q8 =
        v->height_m_q10 ? lm_slant_of_ground_m_q8(ground_m_q8, v->height_m_q10) : ground_m_q8;
    /* m q8 to px q8: 1000 mm a metre, and 256 for the scale's own format. */
    return (uint64_t)length_px_q8 * 256000u / v->scale_mm_per_px_q8;
}

/* Offset of a position. False, and *offset unchanged, beyond FARTHEST_Q8. */
static bool offset_of(const struct lm_view *v, struct lm_position position,
                      struct lm_offset *offset)
{
    uint32_t distance_m_q8;
    fx_bam_t azimuth;
    lm_geo_inverse(v->origin, position, &distance_m_q8, &azimuth);
    const uint64_t length_px_q8 = length_px_q8_of(v, distance_m_q8);
    if (distance_m_q8 > FARTHEST_Q8 || length_px_q8 > INT32_MAX / 2) {
        return false;
    }
    const fx_bam_t turn = azimuth - v->up;
    *offset = (struct lm_offset){(int32_t)((int64_t)length_px_q8 * fx_sin_q30(turn) >> 30),
                                 (int32_t)((int64_t)length_px_q8 * fx_cos_q30(turn) >> 30)};
    return true;
}

struct lm_view lm_view_of_window(const struct lm_frame *frame, const struct lm_view_from *from,
                                 struct lm_position centre, uint32_t half_m)
{
    const struct lm_frame square = lm_frame_square(frame);
    struct lm_view v = {
        .shape = LM_VIEW_WINDOW,
        .origin = from->position,
        .up = from->up,
        .height_m_q10 = from->height_m_q10,
        .middle = middle_of(&square),
        .scale_mm_per_px_q8 = (uint32_t)((uint64_t)half_m * 512000u / square.width_px),
        .radius_px = square.width_px / 2,
    };
    const int32_t far_px_q8 = lm_px_q8_of_px(LM_VIEW_APEX_FAR_PX);
    struct lm_offset offset = {0, 0};
    if (!offset_of(&v, centre, &offset) || fx_abs_u32(offset.x_px_q8) > (uint32_t)far_px_q8 ||
        fx_abs_u32(offset.y_px_q8) > (uint32_t)far_px_q8) {
        offset = (struct lm_offset){0, far_px_q8}; /* nothing of the window is in sight */
    }
    v.at = (struct lm_point){v.middle.x - lm_px_of_px_q8(offset.x_px_q8),
                             v.middle.y + lm_px_of_px_q8(offset.y_px_q8)};
    return v;
}

struct lm_offset lm_view_middle(const struct lm_view *v)
{
    return (struct lm_offset){lm_px_q8_of_px(v->middle.x - v->at.x),
                              lm_px_q8_of_px(v->at.y - v->middle.y)};
}

bool lm_view_find(const struct lm_view *v, struct lm_position position, struct lm_offset *offset)
{
    struct lm_offset found;
    if (!offset_of(v, position, &found)) {
        return false;
    }
    const struct lm_offset middle = lm_view_middle(v);
    const uint32_t far_px_q8 = (uint32_t)lm_px_q8_of_px(LM_DRAW_FAR);
    if (fx_abs_u32(found.x_px_q8 - middle.x_px_q8) > far_px_q8 ||
        fx_abs_u32(found.y_px_q8 - middle.y_px_q8) > far_px_q8) {
        return false;
    }
    *offset = found;
    return true;
}

struct lm_position lm_view_position(const struct lm_view *v, struct lm_offset offset)
{
    struct lm_geo_origin origin;
    const uint64_t length_px_q8 = fx_hypot_u32(offset.x_px_q8, offset.y_px_q8);
    const uint64_t along_px_q8 = (length_px_q8 * v->scale_mm_per_px_q8 + 128000u) / 256000u;
    const uint32_t range_m_q8 = along_px_q8 < FARTHEST_Q8 ? (uint32_t)along_px_q8 : FARTHEST_Q8;
    const uint32_t ground_m_q8 =
        v->height_m_q10 ? lm_ground_of_slant_m_q8(range_m_q8, v->height_m_q10) : range_m_q8;
    lm_geo_set_origin(&origin, v->origin);
    return lm_geo_direct(&origin, v->up + fx_atan2(offset.x_px_q8, offset.y_px_q8), ground_m_q8);
}

struct lm_ppi lm_view_ppi(const struct lm_view *v, const struct lm_frame *frame, uint32_t cell_m_q8,
                          uint32_t edge_m_q8)
{
    return (struct lm_ppi){
        .clip = v->shape == LM_VIEW_WINDOW ? lm_frame_square(frame) : *frame,
        .apex_x_px = v->at.x,
        .apex_y_px = v->at.y,
        .cells_per_px_q16 =
            (uint32_t)(((uint64_t)v->scale_mm_per_px_q8 << 16) / lm_mm_q8_of_m_q8(cell_m_q8)),
        .near_cells_q8 = (int32_t)lm_cells_q8_of_m_q8(edge_m_q8, cell_m_q8),
    };
}

struct lm_point lm_view_point(const struct lm_view *v, struct lm_offset offset)
{
    return (struct lm_point){v->at.x + (offset.x_px_q8 >> 8), v->at.y - 1 - (offset.y_px_q8 >> 8)};
}
