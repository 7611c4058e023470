#include "report.h"

#include "flags.h"
#include "follow.h"
#include "fx/sat.h"
#include "lm/canas_report.h"
#include "lm/units.h"
#include "ownship.h"
#include "swap.h"
#include "tracking.h"

enum { RANGE_MOST_M = 400000 }; /* of lm_slant_of_ground_m_q8 */

_Static_assert(LM_REFUSED_MAP == 5 && LM_REFUSED_DWELL == 13 && LM_REFUSED_SWAP == 14 &&
                   LM_REFUSED_POLE == 15 && LM_FORMAT_TEST == 4 && LM_FOV_DBS2 == 3 &&
                   LM_SECTOR_BEACON == 3,
               "docs/bus.md tells others these numbers");

static void tell(struct lm_report *r, enum lm_report_item item, uint32_t word)
{
    r->word[item] = word;
    r->known |= (uint32_t)1 << item;
}

/* |height| < 2^31 m * 1024, times 125 below 2^38. */
static uint32_t mm_of_m_q10(int32_t height_m_q10)
{
    return (uint32_t)(int32_t)((int64_t)height_m_q10 * 125 / 128);
}

static void tell_position(struct lm_report *r, enum lm_report_item latitude,
                          struct lm_position position)
{
    tell(r, latitude, lm_ten_millionths_of_bam(position.latitude));
    tell(r, latitude + 1, lm_ten_millionths_of_bam(position.longitude));
}

/* Slant range by the law of the radar's pictures. */
static uint32_t slant_mm(const struct lm_unit *u)
{
    const int32_t above_m_q10 =
        lm_m_q10_of_m_q6(lm_antenna_height_m_q6(&u->ownship, &u->map)) - u->cursor_elevation_m_q10;
    return lm_mm_of_m_q8(lm_slant_of_ground_m_q8(lm_m_q8_of_m(u->cursor.range_m), above_m_q10));
}

static void tell_cursor(const struct lm_unit *u, struct lm_report *r)
{
    const struct lm_cursor *c = &u->cursor;
    if (!c->is_placed || !lm_ownship_is_known(&u->ownship)) {
        return;
    }
    tell_position(r, LM_REPORT_CURSOR_LATITUDE, c->position);
    tell(r, LM_REPORT_CURSOR_BEARING, lm_ten_millionths_of_bam(c->bearing));
    const bool is_near = c->range_m <= RANGE_MOST_M;
    if (is_near) {
        tell(r, LM_REPORT_CURSOR_RANGE, lm_mm_of_m(c->range_m));
    }
    if (u->map.is_usable && u->cursor_elevation_m_q10 != LM_NO_ELEVATION) {
        tell(r, LM_REPORT_CURSOR_ELEVATION, mm_of_m_q10(u->cursor_elevation_m_q10));
        if (is_near && u->ownship.height_quality != LM_NAV_DEAD) {
            tell(r, LM_REPORT_CURSOR_SLANT, slant_mm(u));
        }
    }
}

static bool shows_patch(const struct lm_unit *u)
{
    return u->page.picture == LM_PICTURE_PATCH;
}

static void tell_place(struct lm_unit *u, struct lm_report *r)
{
    const bool is_tracked = lm_tracking_is_locked(u) && u->track.kind == LM_TRACK_FIXED;
    if (!is_tracked && !shows_patch(u)) {
        return;
    }
    const struct lm_position centre =
        is_tracked ? u->track.seen.position : u->picture.sar.command.centre;
    const int32_t elevation_m_q10 = lm_elevation_at(u, centre);
    tell_position(r, LM_REPORT_PLACE_LATITUDE, centre);
    if (elevation_m_q10 != LM_NO_ELEVATION) {
        tell(r, LM_REPORT_PLACE_ELEVATION, mm_of_m_q10(elevation_m_q10));
    }
}

static uint32_t switches_of(const struct lm_page *page)
{
    return (page->is_frozen ? LM_REPORT_FROZEN : 0u) | (page->is_override ? LM_REPORT_SILENT : 0u) |
           (page->is_snowplow ? LM_REPORT_SNOWPLOW : 0u) |
           (page->is_auto_range ? LM_REPORT_AUTO_RANGE : 0u) |
           (page->is_tilt_manual ? LM_REPORT_MANUAL_TILT : 0u) |
           (page->is_pencil ? LM_REPORT_PENCIL : 0u) | (page->is_plan ? LM_REPORT_PLAN : 0u);
}

static uint32_t patch_state(const struct lm_unit *u)
{
    const struct lm_sar *sar = &u->picture.sar;
    if (!shows_patch(u)) {
        return LM_REPORT_NO_PATCH;
    }
    return u->picture.acquire.is_reading ? LM_REPORT_READING
           : sar->line < sar->lines      ? LM_REPORT_DRAWING
                                         : LM_REPORT_DRAWN;
}

static void tell_patch(const struct lm_unit *u, struct lm_report *r)
{
    const struct lm_sar *sar = &u->picture.sar;
    const uint32_t percent = shows_patch(u) ? sar->line * 100 / fx_max_u32(sar->lines, 1) : 0;
    const uint32_t refusal = u->flags & LM_FLAG_UNABLE ? (uint32_t)u->unable.reason : 0;
    tell(r, LM_REPORT_PATCH, patch_state(u) << 16 | percent << 8 | refusal);
    if (shows_patch(u)) {
        tell(r, LM_REPORT_PATCH_CELL, sar->command.cell_mm);
    }
}

static void tell_state(const struct lm_unit *u, struct lm_report *r)
{
    const struct lm_page *page = &u->page;
    const struct lm_radar *radar = page->radar;
    const uint64_t half = radar->azimuth_half[page->azimuth_index];
    const uint32_t half_deg = (uint32_t)((half * 360 + (1u << 31)) >> 32);
    tell(r, LM_REPORT_PICTURE,
         (uint32_t)page->picture << 24 | (uint32_t)page->mode << 16 | (uint32_t)page->fov << 8 |
             page->format);
    tell(r, LM_REPORT_RANGE_SCALE, radar->range[page->range_index].range_nm);
    tell(r, LM_REPORT_SETTINGS, half_deg << 8 | switches_of(page));
    tell(r, LM_REPORT_GAIN, (uint32_t)page->gain_db & 0xff);
    tell_patch(u, r);
}

/* Slant ranges are below 400 km: 2^29 mm. */
static void tell_track(const struct lm_unit *u, struct lm_report *r)
{
    const struct lm_track *t = &u->track;
    const struct lm_track_seen *seen = &t->seen;
    tell(r, LM_REPORT_TRACK,
         (uint32_t)t->kind << 24 | (uint32_t)t->state << 16 | (uint32_t)t->loss << 8 | t->number);
    if (!lm_tracking_is_locked(u)) {
        return;
    }
    tell_position(r, LM_REPORT_TRACK_LATITUDE, seen->position);
    tell(r, LM_REPORT_TRACK_ELEVATION, mm_of_m_q10(seen->elevation_m_q10));
    tell(r, LM_REPORT_TRACK_BEARING, lm_ten_millionths_of_bam(seen->bearing));
    tell(r, LM_REPORT_TRACK_SLANT, lm_mm_of_m_q8(seen->slant_m_q8));
    tell(r, LM_REPORT_TRACK_RATE, (uint32_t)seen->range_rate_mm_s);
    tell(r, LM_REPORT_TRACK_SPEED, seen->speed_mm_s);
    if (seen->speed_mm_s != 0) {
        tell(r, LM_REPORT_TRACK_COURSE, lm_ten_millionths_of_bam(seen->course));
    }
}

void lm_send_reports(struct lm_unit *u, uint64_t now_us)
{
    const uint32_t sets = lm_canas_report_due(&u->report, now_us);
    if (sets != 0) {
        struct lm_report values = {.is_stale = (u->flags & LM_FLAG_NAV_STALE) != 0};
        /* These two have the shortest period, which divides the others': they are due with each. */
        tell_cursor(u, &values);
        tell_track(u, &values);
        if (sets >> LM_REPORT_PLACE & 1) {
            tell_place(u, &values);
            lm_canas_service_tell_state(&u->service, now_us);
        }
        if (sets >> LM_REPORT_STATE & 1) {
            tell_state(u, &values);
        }
        lm_canas_report_begin(&u->report, sets, &values, now_us);
    }
    lm_canas_control_send(&u->control_bus, u->board->can); /* what happened, before what is */
    lm_swap_send(u, now_us);
    lm_canas_report_send(&u->report, u->board->can);
}
