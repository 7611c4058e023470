/* Patch: the kind of picture that SAR makes. Its tiles are read first, then it is drawn once. */
#include "fx/const.h"
#include "fx/sat.h"
#include "lm/units.h"
#include "ownship.h"
#include "picture_kind.h"

enum {
    ACQUIRE_US = 500000,       /* longest wait for another tile */
    ACQUIRE_MOST_US = 2000000, /* longest wait for all of them */
    SAMPLES_A_STEP = 3,        /* lines sampled a step; one that needs more waits */
    /* Tiles are requested for every fourth line, eight lines a step. */
    LINES_APART = 4,
    PREFETCHES_A_STEP = 8
};

static uint32_t lines_of(const struct lm_picture *p)
{
    return p->sar.lines;
}

static uint32_t cells_of(const struct lm_picture *p)
{
    return p->lent.radar->sar.cells;
}

/* Lateral acceleration: rate of turn times speed, below 2^31 / 2^29.3 rad/s times 2^21 mm/s. */
static uint32_t lateral_mm_s2(const struct lm_ownship *own)
{
    const uint64_t turn_bam_s = fx_abs_u32(own->turn_bam_s);
    return (uint32_t)(turn_bam_s * (uint32_t)own->ground_speed_mm_s / FX_BAM_PER_RADIAN);
}

/* Set the geometry of a patch that is seen from the ownship, and the aircraft's flight. False if
 * navigation is not good enough. */
static bool resolve_command(const struct lm_picture *p, struct lm_sar_command *command,
                            struct lm_sar_flight *flight)
{
    const struct lm_ownship *own = p->lent.ownship;
    if (own->position_quality != LM_NAV_GOOD || own->height_quality != LM_NAV_GOOD ||
        own->heading_quality != LM_NAV_GOOD || own->velocity_quality != LM_NAV_GOOD) {
        return false;
    }
    /* The azimuth of a geodesic changes along it. At the patch, the line of sight is the azimuth
     * back to the aircraft, reversed. */
    uint32_t distance_m_q8;
    fx_bam_t back, bearing;
    lm_geo_inverse(command->centre, lm_ownship_position(own), &distance_m_q8, &back);
    lm_geo_inverse(lm_ownship_position(own), command->centre, &distance_m_q8, &bearing);
    command->look_azimuth = back + FX_BAM_180;
    command->range_m = lm_m_of_m_q8(distance_m_q8);
    command->height_m_q6 = lm_antenna_height_m_q6(own, p->lent.map);
    *flight = (struct lm_sar_flight){.speed_mm_s = (uint32_t)own->ground_speed_mm_s,
                                     .track = own->track,
                                     .bearing = bearing,
                                     .heading = own->heading,
                                     .lateral_mm_s2 = lateral_mm_s2(own)};
    return true;
}

static struct lm_sar_relief relief_of(const struct lm_picture *p,
                                      const struct lm_sar_command *command)
{
    return lm_sar_relief_of(&p->lent.map->tiles, p->lent.radar, command);
}

/* Longer than half the diagonal of a patch. */
static uint32_t patch_reach_m(const struct lm_picture *p, const struct lm_sar_command *command)
{
    return (uint32_t)((uint64_t)p->lent.radar->cells * command->cell_mm / 1000 + 1);
}

static enum lm_refusal start(struct lm_picture *p, const struct lm_sar_command *patch,
                             uint64_t now_us)
{
    struct lm_sar_flight flight;
    struct lm_sar_command command = *patch;
    struct lm_unit_map *map = p->lent.map;
    const bool is_in_flight = command.is_from_ownship;
    const struct lm_malfunctions *broken = p->lent.malfunctions;
    const int32_t loss_db_q8 = lm_malfunction_loss_db_q8(broken);
    if (!map->is_usable) {
        return LM_REFUSED_MAP;
    }
    if (lm_malfunction_is(broken, LM_MALFUNCTION_NO_TRANSMIT)) {
        return LM_REFUSED_SILENT;
    }
    if (lm_malfunction_is(broken, LM_MALFUNCTION_STUCK)) {
        return LM_REFUSED_GIMBAL;
    }
    if (is_in_flight && !resolve_command(p, &command, &flight)) {
        return LM_REFUSED_NAV;
    }
    lm_unit_map_look(map, command.centre, patch_reach_m(p, &command));
    const struct lm_sar_setup scene = {
        .flight = is_in_flight ? &flight : NULL,
        .targets = &map->target_set,
        .chips = &map->chips,
        .relief = relief_of(p, &command),
        .epoch = p->lent.exercise->seed,
        .sea_state = p->lent.environment->sea_state,
        .environment = p->lent.environment,
        .time_us = p->lent.exercise->time_us,
        .noise_rise_db_q8 = loss_db_q8 + lm_malfunction_q8(broken, LM_MALFUNCTION_NOISE)};
    const enum lm_refusal reason = lm_sar_judge(p->lent.radar, &command, &scene);
    if (reason != LM_REFUSED_NOT) {
        return reason;
    }
    (void)lm_sar_start(&p->sar, p->lent.radar, &map->db, &command, &scene); /* it is judged */
    lm_page_note_patch(p->lent.page, &command);
    p->patch_loss_db_q8 = loss_db_q8;
    lm_sar_prefetch_targets(&p->sar, &map->tiles);
    p->targets_left_out += p->sar.candidates.left_out;
    const struct lm_patch_fan fan = {.lines = p->sar.lines,
                                     .cells = cells_of(p),
                                     .centre_m_q8 = p->sar.geometry.centre_m_q8,
                                     .cell_m_q8 = p->sar.geometry.cell_m_q8};
    lm_patch_painter_set(&p->painter, &p->frame, &fan);
    p->is_cursor_awaited = false;
    p->acquire.is_reading = true;
    p->acquire.has_tiles = false;
    p->acquire.lines_asked_for = 0;
    p->acquire.until_us = now_us + ACQUIRE_US;
    p->acquire.most_us = now_us + ACQUIRE_MOST_US;
    p->acquire.tiles_read = map->tiles.count.tiles_read;
    return LM_REFUSED_NOT;
}

static void restart(struct lm_picture *p)
{
    lm_sar_restart(&p->sar);
}

/* While tiles are being read, request those of some more lines: of every fourth, and of the
 * last. */
static void prefetch(struct lm_picture *p)
{
    const uint32_t lines = lines_of(p);
    uint32_t line = p->acquire.lines_asked_for;
    for (uint32_t n = 0; p->acquire.is_reading && n < PREFETCHES_A_STEP && line < lines; n++) {
        lm_sar_prefetch(&p->sar, &p->lent.map->tiles, line);
        line = line == lines - 1 ? lines : fx_min_u32(line + LINES_APART, lines - 1);
    }
    p->acquire.lines_asked_for = line;
}

/* Read the patch's relief again when its tiles have been read, as that of the start may be from
 * coarser tiles. True if it changed: then its tiles and the targets' are requested once more. */
static bool refresh_relief(struct lm_picture *p)
{
    const struct lm_sar_relief relief = relief_of(p, &p->sar.command), *const was = &p->sar.relief;
    if (relief.reference_m_q10 == was->reference_m_q10 &&
        relief.near_fall_m_q10 == was->near_fall_m_q10 &&
        relief.far_rise_m_q10 == was->far_rise_m_q10) {
        return false;
    }
    const uint32_t overscan = p->sar.overscan, traced = p->sar.traced;
    lm_sar_set_relief(&p->sar, &p->lent.map->db, &relief);
    lm_sar_prefetch_targets(&p->sar, &p->lent.map->tiles);
    p->acquire.has_tiles = false;
    if (p->sar.overscan != overscan || p->sar.traced != traced) {
        p->acquire.lines_asked_for = 0;
    }
    return true;
}

/* While tiles come, wait for more: those that are late are rectangles of coarser ground. */
static void wait_on(struct lm_picture *p, uint64_t now_us)
{
    const uint32_t tiles_read = p->lent.map->tiles.count.tiles_read;
    if (p->acquire.tiles_read != tiles_read) {
        const uint64_t until_us = now_us + ACQUIRE_US, most_us = p->acquire.most_us;
        p->acquire.tiles_read = tiles_read;
        p->acquire.until_us = until_us < most_us ? until_us : most_us;
    }
}

static bool is_ready(struct lm_picture *p, uint64_t now_us)
{
    struct lm_unit_map *map = p->lent.map;
    if (p->acquire.is_reading) {
        wait_on(p, now_us);
        const bool is_late = now_us >= p->acquire.until_us;
        p->acquire.has_tiles |= p->acquire.lines_asked_for == lines_of(p) &&
                                lm_tile_cache_is_idle(&map->tiles) &&
                                lm_chips_are_settled(&map->chips);
        /* Detail is placed in cells that count from the first one of the relief's overscan. */
        const bool has_relief = p->sar.detail_state == LM_SAR_DETAIL_LOADING ||
                                ((p->acquire.has_tiles || is_late) && !refresh_relief(p));
        p->acquire.is_reading = !has_relief || !lm_sar_load_detail(&p->sar, &map->tiles, is_late);
        p->next_line_us = now_us + p->sar.line_us; /* the dwell begins */
    }
    return !p->acquire.is_reading && p->sar.line < lines_of(p);
}

static enum lm_sweep begin_none(struct lm_picture *p, uint64_t now_us)
{
    (void)p;
    (void)now_us;
    return LM_SWEEP_GOES_ON;
}

static bool sample_ahead(struct lm_picture *p, uint64_t now_us, uint32_t *azimuths)
{
    const uint32_t sampled = p->sar.sampled;
    const bool has_all =
        lm_sar_sample_ahead(&p->sar, &p->lent.map->tiles, SAMPLES_A_STEP, &p->line);
    *azimuths -= fx_min_u32(p->sar.sampled - sampled, *azimuths);
    if (!has_all && p->sar.line == 0) {
        p->next_line_us = now_us; /* the first line creates no backlog */
    }
    return has_all;
}

static uint32_t draw_line(struct lm_picture *p, uint64_t now_us)
{
    (void)now_us;
    const uint32_t number = p->sar.line;
    lm_sar_draw_line(&p->sar, &p->lent.map->tiles, &p->tone[LM_PICTURE_PATCH], &p->line);
    lm_coverage_add(&p->coverage, &p->line.ground, cells_of(p));
    lm_coverage_judge(&p->coverage);
    return number;
}

static void paint(struct lm_picture *p, uint32_t number)
{
    lm_scan_conv_patch(&p->painter, &p->plane, number, p->line.grey);
}

static uint64_t line_us(const struct lm_picture *p)
{
    return p->sar.line_us;
}

static void set_beam_none(struct lm_picture *p)
{
    (void)p;
}

static struct lm_view view(const struct lm_picture *p)
{
    const struct lm_sar_command *c = &p->sar.command;
    return lm_view_of_patch(&p->frame, c->centre, c->look_azimuth, cells_of(p), c->cell_mm);
}

static const struct lm_tone_config *tone(const struct lm_picture *p)
{
    return &p->lent.radar->sar.tone;
}

static uint32_t slew_percent(const struct lm_picture *p)
{
    (void)p;
    return 100;
}

static bool needs_ownship(const struct lm_picture *p)
{
    return p->sar.command.is_from_ownship;
}

static void describe(const struct lm_picture *p, struct lm_symbols *symbols)
{
    symbols->patch_cell_mm = p->sar.command.cell_mm;
    symbols->patch_percent = (uint16_t)(p->sar.line * 100 / lines_of(p));
    symbols->patch_to_go_s = (uint32_t)((lm_sar_time_to_go_us(&p->sar) + 999999) / 1000000);
    symbols->coarse_mm =
        lm_coverage_coarse_mm(&p->coverage, &p->lent.map->db, p->sar.lod, p->sar.command.cell_mm);
    symbols->patch_look = p->sar.command.look_azimuth;
}

const struct lm_picture_methods lm_picture_patch = {
    .moves = false,
    .start = start,
    .restart = restart,
    .prefetch = prefetch,
    .is_ready = is_ready,
    .begin = begin_none,
    .sample_ahead = sample_ahead,
    .draw_line = draw_line,
    .paint = paint,
    .line_us = line_us,
    .set_beam = set_beam_none,
    .view = view,
    .tone = tone,
    .slew_percent = slew_percent,
    .needs_ownship = needs_ownship,
    .describe = describe,
};
