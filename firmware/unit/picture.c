#include "lm/picture.h"

#include "fx/mem.h"
#include "fx/sat.h"
#include "ownship.h"
#include "picture_kind.h"

static const struct lm_picture_methods *const methods_of[LM_PICTURES] = {
    [LM_PICTURE_SECTOR] = &lm_picture_sector,
    [LM_PICTURE_PATCH] = &lm_picture_patch,
};

/* The methods of the picture that is shown. */
static const struct lm_picture_methods *methods(const struct lm_picture *p)
{
    return methods_of[p->lent.page->picture];
}

void lm_picture_init(struct lm_picture *p, const struct lm_picture_lent *lent,
                     const struct lm_plane *plane)
{
    memset(p, 0, sizeof *p);
    p->lent = *lent;
    p->plane = *plane;
    p->frame = lm_frame_of_display(plane->width_px, plane->height_px);
    memset(plane->pixels, 0, (size_t)plane->width_px * plane->height_px);
}

enum lm_refusal lm_picture_start(struct lm_picture *p, enum lm_picture_kind kind,
                                 const struct lm_sar_command *patch, uint64_t now_us)
{
    const int32_t loss_db_q8 = p->patch_loss_db_q8;
    const enum lm_refusal reason = methods_of[kind]->start(p, patch, now_us);
    if (reason != LM_REFUSED_NOT) {
        return reason;
    }
    if (loss_db_q8 != p->patch_loss_db_q8) {
        lm_picture_set_tone(p);
    }
    lm_page_show_picture(p->lent.page, kind);
    p->next_line_us = now_us;
    p->coverage = (struct lm_coverage){0};
    p->is_view_held = false;
    p->is_step_spent = true;
    lm_plane_clear(&p->plane, &p->frame);
    return LM_REFUSED_NOT;
}

void lm_picture_remove(struct lm_picture *p)
{
    lm_plane_clear(&p->plane, &p->frame);
    methods(p)->restart(p);
}

void lm_picture_set_tone(struct lm_picture *p)
{
    for (uint32_t kind = 0; kind < LM_PICTURES; kind++) {
        struct lm_tone_config config = lm_page_tone(p->lent.page, methods_of[kind]->tone(p));
        if (kind == LM_PICTURE_PATCH) { /* its noise was raised by the loss: all is darker by it */
            config.black_db_q8 = (int16_t)(config.black_db_q8 + p->patch_loss_db_q8);
            config.white_db_q8 = (int16_t)(config.white_db_q8 + p->patch_loss_db_q8);
        }
        lm_tone_set(&p->tone[kind], &config);
    }
}

void lm_picture_set_beam(struct lm_picture *p)
{
    methods(p)->set_beam(p);
}

void lm_picture_prefetch(struct lm_picture *p)
{
    methods(p)->prefetch(p);
}

bool lm_picture_is_ready(struct lm_picture *p, uint64_t now_us)
{
    return methods(p)->is_ready(p, now_us);
}

struct lm_cursor_scene lm_picture_cursor_scene(const struct lm_picture *p)
{
    const struct lm_ownship *own = p->lent.ownship;
    return (struct lm_cursor_scene){
        .view = &p->view,
        .ownship = lm_ownship_position(own),
        .heading = own->heading,
        .scale_m = p->lent.radar->range[p->lent.page->range_index].range_m,
        .half_px = (int32_t)fx_min_u32(p->plane.width_px, p->plane.height_px) / 2,
        .slew_percent = (int32_t)methods(p)->slew_percent(p),
    };
}

void lm_picture_follow_view(struct lm_picture *p, bool is_standing)
{
    const bool is_held = is_standing && methods(p)->moves;
    if (!is_held && p->is_view_held) {
        lm_picture_remove(p); /* lines of long ago and of now would stand side by side */
    }
    if (!is_held || !p->is_view_held) {
        p->view = methods(p)->view(p);
    }
    p->is_view_held = is_held;
    if (lm_ownship_is_known(p->lent.ownship)) {
        const struct lm_cursor_scene scene = lm_picture_cursor_scene(p);
        lm_cursor_locate(p->lent.cursor, &scene);
    }
}

bool lm_picture_draw_line(struct lm_picture *p, uint64_t now_us, uint32_t *azimuths)
{
    const struct lm_picture_methods *m = methods(p);
    const enum lm_sweep sweep = m->begin(p, now_us);
    if (sweep != LM_SWEEP_GOES_ON) {
        lm_picture_follow_view(p, false);
    }
    p->is_step_spent |= sweep == LM_SWEEP_BEGUN_AT_COST;
    if (sweep == LM_SWEEP_BEGUN_AT_COST || !m->sample_ahead(p, now_us, azimuths)) {
        return false;
    }
    const uint32_t number = m->draw_line(p, now_us);
    if (!lm_malfunction_is(p->lent.malfunctions, LM_MALFUNCTION_FROZEN)) {
        m->paint(p, number);
    }
    p->next_line_us += m->line_us(p);
    return true;
}

/* LOD of cells of one size in the new map, or the nearest that it has. */
static uint8_t lod_now(const struct lm_picture *p, uint32_t shift_was, uint8_t lod)
{
    const struct lm_db *db = &p->lent.map->db;
    return (uint8_t)fx_clamp_i32((int32_t)shift_was + lod - db->shift0, 0, db->lod_count - 1);
}

bool lm_picture_change_map(struct lm_picture *p, uint32_t shift_was)
{
    const struct lm_sar *sar = &p->sar;
    p->sar.lod = lod_now(p, shift_was, p->sar.lod);
    p->sar.foreground.lod = lod_now(p, shift_was, p->sar.foreground.lod);
    p->coverage.coarsest_lod = lod_now(p, shift_was, p->coverage.coarsest_lod);
    lm_sector_begin_again(&p->sector);
    p->sector.candidates.is_chosen = false; /* targets have other numbers */
    p->turn.period_us = 0; /* an exercise's antenna does not rest until its next sweep either */
    return !methods(p)->moves && sar->line < sar->lines;
}

bool lm_picture_moves(const struct lm_picture *p)
{
    return methods(p)->moves;
}

bool lm_picture_needs_ownship(const struct lm_picture *p)
{
    return methods(p)->needs_ownship(p);
}

void lm_picture_describe(const struct lm_picture *p, struct lm_symbols *symbols)
{
    methods(p)->describe(p, symbols);
}
