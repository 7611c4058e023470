#include "tracking.h"

#include "fx/sat.h"
#include "lm/const.h"
#include "lm/units.h"
#include "ownship.h"

/* A target is taken up to a fortieth of the range from the cursor, and in a window a fortieth of
 * its side: 0.05 of half the picture [FreeFalcon, gmscope.cpp, DoGMDesignate]. What stands still
 * must lie four times nearer, or the place itself is tracked: UNSOURCED. */
enum { GATE_SHARE = 40, STILL_SHARE = 4, WORDS_SHOWN_US = 4000000 };

static bool has_cursor(const struct lm_unit *u)
{
    return u->page.format != LM_FORMAT_BIT && u->page.format != LM_FORMAT_TEST;
}

static enum lm_refusal refusal_of(const struct lm_unit *u, bool needs_cursor)
{
    return !has_cursor(u)                         ? LM_REFUSED_PAGE
           : !u->map.is_usable                    ? LM_REFUSED_MAP
           : u->page.is_override                  ? LM_REFUSED_SILENT
           : !lm_ownship_is_known(&u->ownship)    ? LM_REFUSED_NAV
           : needs_cursor && !u->cursor.is_placed ? LM_REFUSED_CURSOR
                                                  : LM_REFUSED_NOT;
}

/* What the glass shows from side to side of the cursor's surroundings. */
static uint32_t side_m(const struct lm_unit *u)
{
    const struct lm_radar *radar = u->map.radar;
    const uint32_t range_m = radar->range[u->page.range_index].range_m;
    if (u->page.picture == LM_PICTURE_PATCH) {
        return (uint32_t)((uint64_t)u->picture.sar.command.cell_mm * radar->sar.cells / 1000);
    }
    return u->page.fov == LM_FOV_NORM
               ? range_m
               : range_m * 2 * radar->fov[u->page.fov].window_permille / 1000;
}

static bool is_for_movers(const struct lm_unit *u)
{
    return u->page.picture == LM_PICTURE_SECTOR &&
           (u->page.mode == LM_SECTOR_GMT || u->page.mode == LM_SECTOR_SEA);
}

enum lm_refusal lm_tracking_designate(struct lm_unit *u, uint64_t now_us)
{
    const enum lm_refusal reason = refusal_of(u, true);
    if (reason != LM_REFUSED_NOT) {
        return reason;
    }
    if (u->cursor.is_snowplow) {
        lm_cursor_stabilise(&u->cursor);
        return LM_REFUSED_NOT;
    }
    const bool is_mover = is_for_movers(u);
    const uint32_t gate_m = side_m(u) / GATE_SHARE / (is_mover ? 1 : STILL_SHARE);
    u->cursor.is_home = false;
    lm_track_begin(&u->track, is_mover ? LM_TRACK_MOVER : LM_TRACK_FIXED, u->cursor.position,
                   gate_m + 1, now_us);
    u->track_mode = u->page.mode;
    return LM_REFUSED_NOT;
}

enum lm_refusal lm_tracking_range(struct lm_unit *u, uint64_t now_us)
{
    const enum lm_refusal reason = refusal_of(u, false);
    if (reason != LM_REFUSED_NOT) {
        return reason;
    }
    if (u->track.state != LM_TRACK_OFF && u->track.kind == LM_TRACK_RANGING) {
        lm_track_end(&u->track, LM_TRACK_SOUND, now_us);
        return LM_REFUSED_NOT;
    }
    lm_track_begin(&u->track, LM_TRACK_RANGING, u->cursor.position, 0, now_us);
    u->track_mode = u->page.mode;
    return LM_REFUSED_NOT;
}

uint32_t lm_tracking_listed(const struct lm_unit *u)
{
    const struct lm_track *t = &u->track;
    const bool is_listed = t->state != LM_TRACK_OFF && t->has_target && !t->is_live &&
                           t->index < u->map.target_set.count;
    return is_listed ? u->map.targets[t->index].crc : 0;
}

void lm_tracking_renumber(struct lm_unit *u, uint32_t tracked, uint64_t now_us)
{
    uint32_t i = 0;
    u->track.search.next = 0;
    u->track.search.has_best = false;
    while (i < u->map.target_set.count && u->map.targets[i].crc != tracked) {
        i++;
    }
    if (tracked != 0 && i < u->map.target_set.count) {
        u->track.index = (uint16_t)i;
    } else if (tracked != 0) {
        lm_track_end(&u->track, LM_TRACK_NOTHING, now_us);
    }
}

bool lm_tracking_drop(struct lm_unit *u, uint64_t now_us)
{
    const bool is_on = u->track.state != LM_TRACK_OFF;
    if (is_on) {
        lm_track_end(&u->track, LM_TRACK_SOUND, now_us);
    }
    return is_on;
}

void lm_tracking_hold_cursor(struct lm_unit *u)
{
    if (lm_tracking_is_locked(u) && u->track.kind != LM_TRACK_RANGING) {
        lm_cursor_put(&u->cursor, u->track.seen.position);
    }
}

static struct lm_track_scene scene_of(struct lm_unit *u)
{
    const struct lm_ownship *own = &u->ownship;
    return (struct lm_track_scene){
        .radar = u->map.radar,
        .tiles = &u->map.tiles,
        .targets = &u->map.target_set,
        .environment = &u->weather.now,
        .malfunctions = &u->malfunctions.now,
        .platform = lm_ownship_platform(own, &u->map, u->exercise.time_us),
        .pitch = own->pitch,
        .mode = u->page.mode,
        .fov = u->page.fov,
        .range_index = u->page.range_index,
        .is_sending = !u->page.is_override && !u->page.is_frozen,
        .is_nav_good = (u->flags & LM_FLAG_NAV_STALE) == 0 &&
                       (u->track.kind != LM_TRACK_RANGING || own->attitude_quality == LM_NAV_GOOD),
        .line = &u->picture.line.ground,
    };
}

void lm_tracking_step(struct lm_unit *u, uint64_t now_us)
{
    struct lm_track *t = &u->track;
    const bool was_held = lm_tracking_holds_antenna(u);
    const bool is_possible = u->map.is_usable && lm_ownship_is_known(&u->ownship) &&
                             u->ownship.height_quality != LM_NAV_DEAD;
    if (t->state != LM_TRACK_OFF && (!is_possible || u->page.mode != u->track_mode)) {
        lm_track_end(t, is_possible ? LM_TRACK_SOUND : LM_TRACK_NO_NAV, now_us);
    }
    if (t->state != LM_TRACK_OFF) {
        const struct lm_track_scene scene = scene_of(u);
        lm_track_step(t, &scene, now_us);
    }
    lm_page_note_track(&u->page, t->state != LM_TRACK_OFF ? t->kind : LM_TRACK_NONE);
    lm_tracking_hold_cursor(u);
    if (lm_tracking_holds_antenna(u) && !was_held) {
        lm_picture_remove(&u->picture);
    }
}

/* ---- on the glass ---- */

static void add_tenths(struct lm_text *t, uint32_t tenths, const char *unit)
{
    lm_text_number(t, tenths / 10, 1);
    lm_text_add(t, ".");
    lm_text_number(t, tenths % 10, 1);
    lm_text_add(t, unit);
}

static const char *name_of(uint8_t kind)
{
    return kind == LM_TRACK_FIXED ? "FTT" : kind == LM_TRACK_MOVER ? "GMTT" : "AGR";
}

/* `loss`: enum lm_track_loss. */
static const char *loss_word(uint8_t loss)
{
    static const char words[LM_TRACK_LOSSES][8] = {
        [LM_TRACK_SOUND] = "",        [LM_TRACK_SILENT] = "SILENT",  [LM_TRACK_NO_NAV] = "NAV",
        [LM_TRACK_LIMITS] = "LIMITS", [LM_TRACK_SHADOW] = "SHADOW",  [LM_TRACK_WEAK] = "WEAK",
        [LM_TRACK_NOTCH] = "NOTCH",   [LM_TRACK_NOTHING] = "NO TGT",
    };
    return words[loss];
}

/* "FTT 12.3NM", "GMTT 8.0NM 23KT", "GMTT COAST NOTCH", "GMTT LOST NOTCH". */
static void write_words(const struct lm_track *t, struct lm_text *text)
{
    lm_text_add(text, name_of(t->kind));
    if (t->state == LM_TRACK_HELD) {
        const uint64_t tenths = ((uint64_t)t->seen.slant_m_q8 * 10 / 256 + LM_NM_M / 2) / LM_NM_M;
        lm_text_add(text, " ");
        add_tenths(text, (uint32_t)tenths, "NM");
        if (t->kind == LM_TRACK_MOVER) {
            lm_text_add(text, " ");
            lm_text_number(text,
                           (uint32_t)(((uint64_t)t->seen.speed_mm_s * 3600 + 926000) / 1852000), 1);
            lm_text_add(text, "KT");
        }
        return;
    }
    lm_text_add(text, t->state == LM_TRACK_SEARCHING  ? " ACQ"
                      : t->state == LM_TRACK_COASTING ? " COAST "
                                                      : " LOST ");
    lm_text_add(text, t->state == LM_TRACK_SEARCHING ? "" : loss_word(t->loss));
}

static bool is_told(const struct lm_unit *u)
{
    const struct lm_track *t = &u->track;
    return t->state != LM_TRACK_OFF ||
           (t->loss != LM_TRACK_SOUND && u->now_us - t->ended_us < WORDS_SHOWN_US);
}

void lm_tracking_describe(const struct lm_unit *u, struct lm_symbols *s)
{
    const struct lm_track *t = &u->track;
    struct lm_offset at;
    if (t->kind == LM_TRACK_NONE || !is_told(u)) {
        return;
    }
    write_words(t, &s->track_words);
    if (!lm_tracking_is_locked(u)) {
        return;
    }
    s->track_shape = t->state == LM_TRACK_COASTING ? LM_SHAPE_HOLLOW
                     : t->kind == LM_TRACK_RANGING ? LM_SHAPE_CROSS
                                                   : LM_SHAPE_FILLED;
    s->has_track_course = t->kind == LM_TRACK_MOVER;
    s->track_course = t->seen.course - s->view.up;
    if (lm_tracking_holds_antenna(u)) {
        s->antenna_azimuth = (int32_t)(t->seen.bearing - u->ownship.heading);
        s->antenna_elevation = t->seen.angle;
    }
    if (lm_view_find(&s->view, t->seen.position, &at)) {
        s->track = lm_view_point(&s->view, at);
    } else {
        s->track_shape = LM_SHAPE_NONE;
    }
}
