#include "fx/sat.h"
#include "unit_internal.h"

enum {
    NONE_SAMPLE_CELLS = 16,
    /* A line that needs more waits for the next step: azimuths of a sector, lines of a patch. */
    AZIMUTHS_A_STEP = 4,
    SAMPLES_A_STEP = 3,
    /* Tiles of a patch are asked for by every fourth line, some in a step. */
    LINES_APART = 4,
    PREFETCHES_A_STEP = 8,
    LATE_MOST_US = 50000
};

/* Count how much of the line lies outside the map, a cell in sixteen. */
static void sample_coverage(struct lm_unit *u, uint32_t cells)
{
    for (uint32_t i = 0; i < cells; i += NONE_SAMPLE_CELLS) {
        u->cells_seen++;
        u->cells_none += u->line.ground.cell[i] == LM_CELL_NONE;
    }
}

static struct lm_platform platform_of(const struct lm_unit *u, uint64_t now_us)
{
    const struct lm_ownship *own = &u->ownship;
    const bool is_moving = own->velocity_quality != LM_NAV_DEAD;
    return (struct lm_platform){
        .place = lm_ownship_place(u),
        .height_q10 = lm_antenna_height_q6(u) * 16,
        .heading = own->heading,
        .track = own->track,
        .speed_mm_s = is_moving ? (uint32_t)own->ground_speed_mm_s : 0,
        .time_us = now_us,
    };
}

/* A window is put around the cursor anew before each sweep: what is drawn moves with it. */
static void recentre(struct lm_unit *u)
{
    struct lm_offset at;
    const struct lm_frame square = lm_frame_square(&u->frame);
    const struct lm_offset middle = lm_view_middle(&u->view);
    if (!u->cursor.is_placed || u->view.shape != LM_VIEW_WINDOW) {
        return;
    }
    if (lm_view_find(&u->view, u->cursor.place, &at)) {
        lm_plane_shift(&u->plane, &square, -((at.x_q8 - middle.x_q8 + 128) >> 8),
                       (at.y_q8 - middle.y_q8 + 128) >> 8);
    } else {
        lm_plane_clear(&u->plane, &u->frame);
    }
    u->sector.command.centre = u->cursor.place;
}

static void begin_sweep(struct lm_unit *u, const struct lm_platform *platform)
{
    recentre(u);
    lm_sector_begin(&u->sector, &u->map.tiles, platform);
    lm_follow_view(u);
    lm_page_note_tilt(&u->page, u->sector.tilt);
    u->is_off_map = 2 * u->cells_none > u->cells_seen;
    u->cells_none = u->cells_seen = 0;
}

/* Draw the next line, or take a part of the samples that it needs. Whether it was drawn. */
static bool draw_sector_line(struct lm_unit *u, uint64_t now_us, uint32_t *azimuths)
{
    struct lm_sector *s = &u->sector;
    const struct lm_platform platform = platform_of(u, now_us);
    if (lm_sector_is_at_edge(s)) {
        begin_sweep(u, &platform);
        if (s->half_m != 0) {
            return false; /* a window's geometry is work enough for a step */
        }
    }
    const uint32_t samples = s->samples;
    const bool is_ready = lm_sector_sample_ahead(s, &u->map.tiles, &platform, azimuths, &u->line);
    if (s->samples != samples) {
        sample_coverage(u, s->grid.cells);
    }
    if (!is_ready) {
        return false;
    }
    const uint32_t drawn =
        lm_sector_draw_line(s, &u->map.tiles, &platform, &u->sector_tone, &u->line);
    const struct lm_ppi ppi = lm_view_ppi(&u->view, &u->frame, s->slant.cell_q8, s->edge_q8);
    lm_ppi_paint(&u->plane, &ppi, (fx_bam_t)lm_sector_edge_bam(s, drawn),
                 (fx_bam_t)lm_sector_edge_bam(s, drawn + 1), u->line.grey, s->slant.cells);
    u->next_line_us += lm_sector_line_us(s);
    return true;
}

static bool draw_patch_line(struct lm_unit *u, uint64_t now_us)
{
    const uint32_t cells = u->sar.radar->sar.cells, drawn = u->sar.line;
    if (!lm_sar_sample_ahead(&u->sar, &u->map.tiles, SAMPLES_A_STEP, &u->line)) {
        u->next_line_us = drawn == 0 ? now_us : u->next_line_us; /* nothing is owed yet */
        return false;
    }
    lm_sar_draw_line(&u->sar, &u->map.tiles, &u->sar_tone, &u->line);
    lm_patch_paint(&u->plane, &u->frame, drawn, u->line.grey + LM_SAR_GUARD, cells);
    sample_coverage(u, cells);
    u->is_off_map = 2 * u->cells_none > u->cells_seen;
    u->next_line_us += u->sar.line_us;
    return true;
}

/* What was known of the patch's elevation when it was asked for may have come from a coarse tile:
 * look again when all have been read. Whether it is another one, which targets wait for. */
static bool refer_anew(struct lm_unit *u)
{
    const int32_t reference_q10 = lm_patch_elevation_q10(u, &u->sar.command);
    if (reference_q10 == u->sar.grid.reference_q10) {
        return false;
    }
    lm_sar_set_reference(&u->sar, &u->map.db, reference_q10);
    lm_sar_prefetch_targets(&u->sar, &u->map.tiles);
    return true;
}

/* Ask for the tiles of some more lines of the patch: of every fourth one, and of the last. */
static void ask_for_patch(struct lm_unit *u)
{
    const uint32_t lines = u->sar.radar->sar.cells;
    for (uint32_t n = 0; n < PREFETCHES_A_STEP && u->lines_asked_for < lines; n++) {
        lm_sar_prefetch(&u->sar, &u->map.tiles, u->lines_asked_for);
        const uint32_t next = u->lines_asked_for + LINES_APART;
        u->lines_asked_for = u->lines_asked_for == lines - 1 ? lines : fx_min_u32(next, lines - 1);
    }
}

/* Whether lines may be drawn now; while they may not, time does not owe any. */
static bool is_drawing(struct lm_unit *u, uint64_t now_us)
{
    if (u->flags & LM_FLAGS_NO_LINES) {
        return false;
    }
    if (u->page.picture != LM_PICTURE_PATCH) {
        return true;
    }
    if (u->is_acquiring) {
        const bool has_all = u->lines_asked_for == u->sar.radar->sar.cells &&
                             lm_tile_cache_is_idle(&u->map.tiles) &&
                             lm_chips_are_settled(&u->map.chips);
        const bool is_over = has_all || now_us >= u->acquire_until_us;
        u->is_acquiring = !is_over || refer_anew(u);
        u->next_line_us = now_us + u->sar.line_us; /* the dwell begins */
    }
    return !u->is_acquiring && u->sar.line < u->sar.radar->sar.cells;
}

/* Draw a line of what is shown. False when it needs more than one step. */
static bool draw_line(struct lm_unit *u, uint64_t now_us, uint32_t *azimuths)
{
    return u->page.picture == LM_PICTURE_PATCH ? draw_patch_line(u, now_us)
                                               : draw_sector_line(u, now_us, azimuths);
}

/* Lines that are due and not drawn stay so, but not for long: the sweep then goes on from now. */
static void forgive_lines(struct lm_unit *u, uint64_t now_us)
{
    const bool is_late = is_drawing(u, now_us);
    if (!is_late || u->next_line_us + LATE_MOST_US <= now_us) {
        u->count.lines_dropped += is_late;
        u->next_line_us = now_us;
    }
}

void lm_draw_due_lines(struct lm_unit *u, uint64_t now_us)
{
    /* To trace an azimuth is as much work as to draw a line. */
    uint32_t azimuths = AZIMUTHS_A_STEP, lines = 0;
    if (u->page.picture == LM_PICTURE_PATCH && u->is_acquiring) {
        ask_for_patch(u);
    }
    while (lines + AZIMUTHS_A_STEP - azimuths < LM_STEP_LINES && is_drawing(u, now_us) &&
           u->next_line_us <= now_us && draw_line(u, now_us, &azimuths)) {
        lines++;
    }
    u->count.lines += lines;
    if (u->next_line_us <= now_us) {
        forgive_lines(u, now_us);
    }
}
