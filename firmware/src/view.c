#include "lm/view.h"

#include "fx/root.h"
#include "fx/sat.h"
#include "fx/trig.h"

enum { FARTHEST_Q8 = 250000 * 256 };

struct lm_view lm_view_of_sector(const struct lm_frame *frame, struct lm_place place,
                                 fx_bam_t heading, uint32_t range_m)
{
    const uint16_t radius_px = lm_ppi_radius_px(frame);
    return (struct lm_view){
        .origin = place,
        .up = heading,
        .at = {frame->left_px + frame->width_px / 2, frame->top_px + frame->height_px - 1},
        .mm_q8_per_px = (uint32_t)((uint64_t)range_m * 256000u / radius_px),
        .radius_px = radius_px,
    };
}

struct lm_view lm_view_of_patch(const struct lm_frame *frame, struct lm_place centre, fx_bam_t look,
                                uint32_t cells, uint32_t cell_mm)
{
    const uint16_t cell_px = lm_patch_cell_px(frame, cells);
    return (struct lm_view){
        .origin = centre,
        .up = look,
        .at = {frame->left_px + frame->width_px / 2, frame->top_px + frame->height_px / 2},
        .mm_q8_per_px = cell_mm * 256u / cell_px,
        .radius_px = cell_px * (int32_t)cells / 2,
    };
}

bool lm_view_find(const struct lm_view *v, struct lm_place place, struct lm_offset *offset)
{
    uint32_t distance_q8;
    fx_bam_t azimuth;
    lm_geo_inverse(v->origin, place, &distance_q8, &azimuth);
    /* metres * 256 -> pixels * 256: times 256,000 / mm_q8_per_px. */
    const uint64_t length_q8 = (uint64_t)distance_q8 * 256000u / v->mm_q8_per_px;
    if (distance_q8 > FARTHEST_Q8 || length_q8 > (uint64_t)LM_DRAW_FAR * 256u) {
        return false;
    }
    const fx_bam_t turn = azimuth - v->up;
    *offset = (struct lm_offset){(int32_t)((int64_t)length_q8 * fx_sin_q30(turn) >> 30),
                                 (int32_t)((int64_t)length_q8 * fx_cos_q30(turn) >> 30)};
    return true;
}

struct lm_place lm_view_place(const struct lm_view *v, struct lm_offset offset)
{
    struct lm_geo_origin origin;
    const uint64_t length_q8 = fx_hypot_u32(offset.x_q8, offset.y_q8);
    const uint64_t distance_q8 = (length_q8 * v->mm_q8_per_px + 128000u) / 256000u;
    lm_geo_set_origin(&origin, v->origin);
    return lm_geo_direct(&origin, v->up + fx_atan2(offset.x_q8, offset.y_q8),
                         distance_q8 < FARTHEST_Q8 ? (uint32_t)distance_q8 : FARTHEST_Q8);
}

struct lm_point lm_view_point(const struct lm_view *v, struct lm_offset offset)
{
    return (struct lm_point){v->at.x + ((offset.x_q8 + 128) >> 8),
                             v->at.y - ((offset.y_q8 + 128) >> 8)};
}
