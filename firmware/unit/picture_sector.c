/* Sector: the kind of picture that is swept over and over, whole or in a window. */
#include "fx/mem.h"
#include "lm/units.h"
#include "ownship.h"
#include "picture_kind.h"

enum {
    WINDOW_GRID_US = 250000,
    LATE_MOST_US = 40000 /* a sweep that begins later than this is joined at a later line */
};

static struct lm_beam_setting beam_of(const struct lm_page *page)
{
    return (struct lm_beam_setting){
        .is_tilt_manual = page->is_tilt_manual,
        .is_pencil = page->is_pencil,
        .tilt = (int32_t)(page->tilt_tenths * (1LL << 32) / 3600),
    };
}

/* Start a sweep. A window is centred on the cursor; until that is placed, the whole sector is
 * swept. */
static enum lm_refusal start(struct lm_picture *p, const struct lm_sar_command *patch,
                             uint64_t now_us)
{
    (void)patch;
    (void)now_us;
    p->turn.period_us = 0;
    const struct lm_page *page = p->lent.page;
    p->is_recentred = false;
    p->is_cursor_awaited = page->fov != LM_FOV_NORM && !p->lent.cursor->is_placed;
    const struct lm_sector_command command = {
        .mode = page->mode,
        .fov = p->is_cursor_awaited ? (uint8_t)LM_FOV_NORM : page->fov,
        .range_index = page->range_index,
        .azimuth_index = page->azimuth_index,
        .centre = p->lent.cursor->position,
        .beam = beam_of(page),
    };
    lm_sector_start(&p->sector, p->lent.radar, &command, p->lent.exercise->seed);
    p->sector.targets = &p->lent.map->target_set;
    p->sector.chips = &p->lent.map->chips;
    p->sector.environment = p->lent.environment;
    p->sector.malfunctions = p->lent.malfunctions;
    return LM_REFUSED_NOT;
}

static void sweep_on(struct lm_picture *p)
{
    (void)p;
}

/* The tiles of the first sweep; after that, lines request them before they are swept. */
static void prefetch(struct lm_picture *p)
{
    lm_sector_prefetch(&p->sector, &p->lent.map->tiles);
}

/* Between two sweeps of an exercise the antenna rests until the next one's time has come. */
static bool is_ready(struct lm_picture *p, uint64_t now_us)
{
    (void)now_us;
    const struct lm_exercise *x = p->lent.exercise;
    const bool is_resting = x->rate_q8 != 0 && x->time_us >= p->turn.begun_us &&
                            x->time_us - p->turn.begun_us < p->turn.period_us;
    return !is_resting || !lm_sector_is_at_edge(&p->sector);
}

static struct lm_platform platform_of(const struct lm_picture *p)
{
    return lm_ownship_platform(p->lent.ownship, p->lent.map, p->lent.exercise->time_us);
}

/* Centre the window on the cursor before each sweep, and shift what is drawn accordingly. That
 * takes as long as the geometry of the sweep; so they are done in two steps. The view between them
 * has the new centre and the old place of the antenna, which is what the shifted picture shows. */
static void recentre(struct lm_picture *p)
{
    struct lm_offset at;
    const struct lm_cursor *cursor = p->lent.cursor;
    const struct lm_frame square = lm_frame_square(&p->frame);
    const struct lm_offset middle = lm_view_middle(&p->view);
    if (lm_view_find(&p->view, cursor->position, &at)) {
        lm_plane_shift(&p->plane, &square, -lm_px_of_px_q8(at.x_px_q8 - middle.x_px_q8),
                       lm_px_of_px_q8(at.y_px_q8 - middle.y_px_q8));
    } else {
        lm_plane_clear(&p->plane, &p->frame);
    }
    p->sector.command.centre = cursor->position;
}

static bool needs_centre(const struct lm_picture *p)
{
    return !p->is_recentred && p->lent.cursor->is_placed && p->view.shape == LM_VIEW_WINDOW;
}

static struct lm_view view(const struct lm_picture *p);

/* Remove the part of a window that the antenna does not reach in this sweep. Nothing would draw it
 * again, and each sweep would move it along. */
static void remove_unreached(struct lm_picture *p)
{
    const struct lm_sector *s = &p->sector;
    const struct lm_view now = view(p);
    const struct lm_ppi ppi = lm_view_ppi(&now, &p->frame, s->slant.cell_m_q8, s->edge_m_q8);
    lm_plane_keep_wedge(&p->plane, &ppi, (fx_bam_t)lm_sector_edge_bam(s, 0),
                        (fx_bam_t)lm_sector_edge_bam(s, s->lines));
}

/* Time from one sweep to the next by the exercise clock. Those over a window take different times;
 * the antenna rests behind them, and the sweeps still begin on a common grid. A sweep takes less
 * than 2^26 us, times a rate of at most 2^12. */
static uint64_t period_us(const struct lm_picture *p)
{
    const struct lm_sector *s = &p->sector;
    const uint64_t sweep_us = (uint64_t)s->lines * lm_sector_line_us(s);
    const uint64_t grid_us = lm_sector_is_window(s) ? WINDOW_GRID_US : 1;
    const uint32_t rate_q8 = p->lent.exercise->rate_q8;
    const uint64_t turn_us = (sweep_us + grid_us - 1) / grid_us * grid_us;
    return rate_q8 != 0 ? turn_us * rate_q8 / LM_EXERCISE_RATE_ONE + 1 : turn_us + 1;
}

/* Join the sweep that the exercise is in, at the line where its antenna is. While the exercise
 * stands, its sweep is drawn over and over. */
static void join_exercise(struct lm_picture *p, uint64_t now_us)
{
    struct lm_sector *s = &p->sector;
    const struct lm_exercise *x = p->lent.exercise;
    p->turn.period_us = period_us(p);
    const uint64_t number = x->time_us / p->turn.period_us;
    p->turn.begun_us = number * p->turn.period_us;
    const uint64_t into_us = x->time_us - p->turn.begun_us;
    const uint64_t late_us = x->rate_q8 != 0 ? into_us * LM_EXERCISE_RATE_ONE / x->rate_q8 : 0;
    const uint32_t line_us = lm_sector_line_us(s);
    const uint64_t over = late_us > LATE_MOST_US ? late_us / line_us : 0;
    const uint32_t skipped = over < s->lines ? (uint32_t)over : s->lines - 1;
    const uint64_t behind_us = late_us - (uint64_t)skipped * line_us;
    const struct lm_sector_turn turn = {
        .sweep = x->seed + (uint32_t)number,
        .skipped = skipped,
        .time_us = p->turn.begun_us,
    };
    lm_sector_join(s, &turn);
    p->next_line_us = now_us > behind_us ? now_us - behind_us : 0;
}

/* Turn the map to what the sweep will show. 3/2 is more than half the diagonal of a window. */
static void look(struct lm_picture *p)
{
    const struct lm_sector *s = &p->sector;
    const uint32_t range_m = p->lent.radar->range[s->command.range_index].range_m;
    const uint32_t half_m = range_m * p->lent.radar->fov[s->command.fov].window_permille / 1000;
    const bool is_window = lm_sector_is_window(s);
    lm_unit_map_look(p->lent.map,
                     is_window ? s->command.centre : lm_ownship_position(p->lent.ownship),
                     is_window ? half_m * 3 / 2 : range_m);
}

static enum lm_sweep begin(struct lm_picture *p, uint64_t now_us)
{
    if (!lm_sector_is_at_edge(&p->sector)) {
        return LM_SWEEP_GOES_ON;
    }
    if (needs_centre(p)) {
        recentre(p);
        p->is_recentred = true;
        return LM_SWEEP_BEGUN_AT_COST;
    }
    p->is_recentred = false;
    const struct lm_platform platform = platform_of(p);
    p->sector.is_shared = p->lent.exercise->is_told;
    look(p);
    lm_sector_begin(&p->sector, &p->lent.map->tiles, &platform);
    if (p->sector.is_shared) {
        join_exercise(p, now_us);
    }
    lm_page_note_tilt(p->lent.page, p->sector.tilt);
    lm_coverage_judge(&p->coverage);
    lm_coverage_restart(&p->coverage);
    if (!lm_sector_is_window(&p->sector)) {
        return LM_SWEEP_BEGUN;
    }
    remove_unreached(p);
    return LM_SWEEP_BEGUN_AT_COST;
}

static bool sample_ahead(struct lm_picture *p, uint64_t now_us, uint32_t *azimuths)
{
    (void)now_us;
    struct lm_sector *s = &p->sector;
    const struct lm_platform platform = platform_of(p);
    const uint32_t samples = s->samples;
    const bool has_all =
        lm_sector_sample_ahead(s, &p->lent.map->tiles, &platform, azimuths, &p->line);
    if (s->samples != samples) {
        lm_coverage_add(&p->coverage, &p->line.ground, s->grid.cells);
        /* Looking through the live targets and drawing them takes the time of composing. */
        p->is_step_spent |= lm_target_set_is_live(s->targets);
        p->targets_left_out += s->live.left_out + s->candidates.left_out;
    }
    return has_all;
}

static uint32_t draw_line(struct lm_picture *p, uint64_t now_us)
{
    (void)now_us;
    const struct lm_platform platform = platform_of(p);
    return lm_sector_draw_line(&p->sector, &p->lent.map->tiles, &platform,
                               &p->tone[LM_PICTURE_SECTOR], &p->line);
}

/* The azimuth that a stuck antenna tells, or that of the next line. */
static int32_t told_azimuth(const struct lm_picture *p)
{
    const struct lm_malfunctions *m = p->lent.malfunctions;
    return lm_malfunction_is(m, LM_MALFUNCTION_STUCK)
               ? lm_malfunction_bam(m, LM_MALFUNCTION_STUCK)
               : lm_sector_edge_bam(&p->sector, p->sector.line);
}

static bool is_lost(const struct lm_malfunctions *m, int32_t azimuth)
{
    return lm_malfunction_is(m, LM_MALFUNCTION_LOST_FROM) &&
           lm_malfunction_is(m, LM_MALFUNCTION_LOST_TO) &&
           azimuth >= lm_malfunction_bam(m, LM_MALFUNCTION_LOST_FROM) &&
           azimuth <= lm_malfunction_bam(m, LM_MALFUNCTION_LOST_TO);
}

/* Of a stuck antenna only the line is painted that it stands at. */
static void paint(struct lm_picture *p, uint32_t number)
{
    const struct lm_sector *s = &p->sector;
    const struct lm_malfunctions *m = p->lent.malfunctions;
    const int32_t left = lm_sector_edge_bam(s, number);
    const bool is_stuck = lm_malfunction_is(m, LM_MALFUNCTION_STUCK);
    if (is_stuck && (uint32_t)told_azimuth(p) - (uint32_t)left >= s->width) {
        return;
    }
    if (is_lost(m, left + (int32_t)(s->width / 2))) {
        memset(p->line.grey, 0, s->slant.cells);
    }
    const struct lm_ppi ppi = lm_view_ppi(&p->view, &p->frame, s->slant.cell_m_q8, s->edge_m_q8);
    lm_scan_conv_sector(&p->plane, &ppi, (fx_bam_t)lm_sector_edge_bam(s, number),
                        (fx_bam_t)lm_sector_edge_bam(s, number + 1), p->line.grey, s->slant.cells);
}

static uint64_t line_us(const struct lm_picture *p)
{
    return lm_sector_line_us(&p->sector);
}

static void set_beam(struct lm_picture *p)
{
    const struct lm_beam_setting beam = beam_of(p->lent.page);
    lm_sector_set_beam(&p->sector, &beam);
}

static uint32_t scale_m(const struct lm_picture *p)
{
    return p->lent.radar->range[p->lent.page->range_index].range_m;
}

/* A window keeps the position and heading of its sweep's start; the whole sector moves with the
 * aircraft. */
static struct lm_view view(const struct lm_picture *p)
{
    const struct lm_sector *s = &p->sector;
    const bool has_geometry = s->grid.cells != 0;
    const bool is_window = has_geometry && lm_sector_is_window(s);
    const struct lm_view_from from = {
        .position = is_window ? s->platform.position : lm_ownship_position(p->lent.ownship),
        .up = is_window ? s->up : p->lent.ownship->heading,
        .height_m_q10 = has_geometry ? s->grid.height_m_q10 - s->grid.reference_m_q10 : 0,
    };
    return is_window
               ? lm_view_of_window(&p->frame, &from, s->command.centre, s->half_m)
               : lm_view_of_sector(&p->frame, &from, scale_m(p), p->lent.options.is_sector_whole);
}

static const struct lm_tone_config *tone(const struct lm_picture *p)
{
    return &lm_radar_mode(p->lent.radar, p->lent.page->mode)->tone;
}

/* Of the field of view that is swept. It differs from the page's while the cursor is awaited. */
static uint32_t slew_percent(const struct lm_picture *p)
{
    return p->lent.radar->fov[p->sector.command.fov].slew_percent;
}

static bool needs_ownship(const struct lm_picture *p)
{
    (void)p;
    return true;
}

/* Set the cue: where the cursor would be in the whole sector. */
static void describe_window(const struct lm_picture *p, struct lm_symbols *symbols)
{
    const struct lm_view_from from = {lm_ownship_position(p->lent.ownship), p->view.up,
                                      p->view.height_m_q10};
    const struct lm_view whole =
        lm_view_of_sector(&p->frame, &from, scale_m(p), p->lent.options.is_sector_whole);
    struct lm_offset at;
    symbols->is_cue_shown =
        p->lent.cursor->is_placed && lm_view_find(&whole, p->lent.cursor->position, &at);
    if (symbols->is_cue_shown) {
        symbols->cue = lm_view_point(&whole, at);
    }
    symbols->is_finer_offered = p->lent.page->fov == LM_FOV_DBS1;
}

static void describe(const struct lm_picture *p, struct lm_symbols *symbols)
{
    const struct lm_radar *radar = p->lent.radar;
    symbols->range_nm = radar->range[p->lent.page->range_index].range_nm;
    symbols->azimuth_half = radar->azimuth_half[p->lent.page->azimuth_index];
    symbols->antenna_azimuth = told_azimuth(p);
    symbols->antenna_elevation = p->sector.tilt;
    if (p->lent.map->is_usable && p->sector.grid.cells != 0) {
        symbols->coarse_mm = lm_coverage_coarse_mm(&p->coverage, &p->lent.map->db, p->sector.lod,
                                                   lm_mm_of_m_q8(p->sector.slant.cell_m_q8));
    }
    if (p->view.shape == LM_VIEW_WINDOW) {
        describe_window(p, symbols);
    }
}

const struct lm_picture_methods lm_picture_sector = {
    .moves = true,
    .start = start,
    .restart = sweep_on,
    .prefetch = prefetch,
    .is_ready = is_ready,
    .begin = begin,
    .sample_ahead = sample_ahead,
    .draw_line = draw_line,
    .paint = paint,
    .line_us = line_us,
    .set_beam = set_beam,
    .view = view,
    .tone = tone,
    .slew_percent = slew_percent,
    .needs_ownship = needs_ownship,
    .describe = describe,
};
