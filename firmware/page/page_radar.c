/* Radar page: mode, field of view and scales of the picture, cursor, declutter. */
#include "lm/font.h"
#include "lm/text.h"
#include "page_table.h"

/* Cells of a patch that the page offers, mm. A command may ask for others. */
static const uint16_t cells_mm[] = {1000, 2000, 3000, 5000, 10000, 20000};
enum { CELLS = sizeof cells_mm / sizeof *cells_mm };

static bool is_patch(const struct lm_page *p)
{
    return p->picture == LM_PICTURE_PATCH;
}

static bool is_sector(const struct lm_page *p)
{
    return p->picture == LM_PICTURE_SECTOR;
}

/* ---- mode, field of view ---- */

static void label_mode(const struct lm_page *p, struct lm_label *label)
{
    lm_label_set(label, lm_radar_mode_name(p->radar, p->mode), "");
}

/* Select the next mode, with a field of view and a scale that it has. In a patch: return to the
 * sector. */
static uint32_t press_mode(struct lm_page *p, int32_t step)
{
    if (!is_sector(p)) {
        return LM_EFFECT_SECTOR | LM_EFFECT_TONE;
    }
    p->mode = (uint8_t)((p->mode + (uint32_t)step) % LM_SECTOR_CHOICES);
    p->fov = p->fov > lm_radar_fov_last(p->radar, p->mode) ? (uint8_t)LM_FOV_NORM : p->fov;
    return lm_page_fit_range(p) | LM_EFFECT_TONE;
}

static void label_fov(const struct lm_page *p, struct lm_label *label)
{
    lm_label_set(label, is_patch(p) ? "SAR" : p->radar->fov[p->fov].name, "");
}

/* Select the next field of view that this mode has at this range. In a patch: NORM. */
static uint32_t press_fov(struct lm_page *p, int32_t step)
{
    const uint8_t before = p->fov;
    if (!is_sector(p)) {
        p->fov = LM_FOV_NORM;
        return LM_EFFECT_SECTOR;
    }
    for (uint32_t i = 0; i < LM_FOVS; i++) {
        p->fov = (uint8_t)((p->fov + (uint32_t)step) % LM_FOVS);
        if (p->fov <= lm_radar_fov_last(p->radar, p->mode) &&
            p->range_index <= lm_page_range_last(p)) {
            break;
        }
    }
    return p->fov != before ? LM_EFFECT_SECTOR : 0;
}

static void label_cell(const struct lm_page *p, struct lm_label *label)
{
    struct lm_text t = {0};
    const uint32_t tenths = (p->cell_mm + 50) / 100;
    lm_text_number(&t, tenths / 10, 1);
    if (tenths % 10 != 0) {
        lm_text_add(&t, ".");
        lm_text_number(&t, tenths % 10, 1);
    }
    lm_text_add(&t, "M");
    lm_label_set(label, "CELL", t.words);
}

/* In a sector the key is free: a patch begins with the cell of the one before. */
static uint32_t press_cell(struct lm_page *p, int32_t step)
{
    if (!is_patch(p)) {
        return 0;
    }
    (void)step;
    uint32_t larger = 0;
    while (larger < CELLS && cells_mm[larger] <= p->cell_mm) {
        larger++;
    }
    p->cell_mm = cells_mm[larger % CELLS];
    return LM_EFFECT_PATCH;
}

/* ---- scales ---- */

static void label_auto(const struct lm_page *p, struct lm_label *label)
{
    lm_label_set(label, p->is_auto_range ? "AUTO" : "MAN", "");
}

static uint32_t press_auto(struct lm_page *p, int32_t step)
{
    (void)step;
    p->is_auto_range = !p->is_auto_range;
    return 0;
}

/* A window around the cursor has no scan of its own. */
static bool has_azimuth(const struct lm_page *p)
{
    return is_sector(p) && p->fov == LM_FOV_NORM;
}

/* The sector's half angle in tens of degrees, under an A. */
static void label_azimuth(const struct lm_page *p, struct lm_label *label)
{
    const fx_bam_t half = p->radar->azimuth_half[p->azimuth_index];
    const char digit[2] = {(char)('0' + (((uint64_t)half * 36 + (1u << 31)) >> 32) % 10), 0};
    lm_label_set(label, "A", digit);
}

static uint32_t press_azimuth(struct lm_page *p, int32_t step)
{
    if (!has_azimuth(p)) {
        return 0;
    }
    p->azimuth_index = (uint8_t)((p->azimuth_index + (uint32_t)step) % LM_AZIMUTHS);
    return LM_EFFECT_SECTOR;
}

static bool has_smaller(const struct lm_page *p)
{
    return is_sector(p) && p->range_index > 0;
}

static bool has_larger(const struct lm_page *p)
{
    return is_sector(p) && p->range_index < lm_page_range_last(p);
}

static void label_range(const struct lm_page *p, struct lm_label *value)
{
    lm_label_number(value, "", p->radar->range[p->range_index].range_nm, false);
}

static uint32_t press_range(struct lm_page *p, int32_t step)
{
    if (!is_sector(p)) {
        return 0;
    }
    p->is_auto_range = false;
    return lm_page_step_range(p, step);
}

/* ---- switches ---- */

static bool is_override(const struct lm_page *p)
{
    return p->is_override;
}

static uint32_t press_override(struct lm_page *p, int32_t step)
{
    (void)step;
    p->is_override = !p->is_override;
    return 0;
}

static bool is_baro(const struct lm_page *p)
{
    return p->is_baro;
}

static uint32_t press_baro(struct lm_page *p, int32_t step)
{
    (void)step;
    p->is_baro = !p->is_baro;
    return LM_EFFECT_HEIGHT;
}

static bool is_frozen(const struct lm_page *p)
{
    return p->is_frozen;
}

static uint32_t press_freeze(struct lm_page *p, int32_t step)
{
    (void)step;
    p->is_frozen = !p->is_frozen;
    return 0;
}

/* ---- the cursor ---- */

static bool is_snowplow(const struct lm_page *p)
{
    return p->is_snowplow;
}

static bool is_held(const struct lm_page *p)
{
    return !p->is_snowplow;
}

static uint32_t set_snowplow(struct lm_page *p, bool is_on)
{
    const bool has_changed = p->is_snowplow != is_on;
    p->is_snowplow = is_on;
    return has_changed ? LM_EFFECT_SNOWPLOW : 0;
}

static uint32_t press_snowplow(struct lm_page *p, int32_t step)
{
    (void)step;
    return set_snowplow(p, !p->is_snowplow);
}

static uint32_t press_steerpoint(struct lm_page *p, int32_t step)
{
    (void)step;
    return set_snowplow(p, false);
}

static uint32_t press_cursor_zero(struct lm_page *p, int32_t step)
{
    (void)p, (void)step;
    return LM_EFFECT_CURSOR_HOME;
}

/* ---- the track ---- */

static bool is_tracking(const struct lm_page *p)
{
    return p->track != 0;
}

/* Blank without a track, as in the sources of the format. */
static void label_track(const struct lm_page *p, struct lm_label *label)
{
    static const char kinds[4][5] = {"", "FTT", "GMTT", "AGR"};
    lm_label_set(label, kinds[p->track & 3], "");
}

static uint32_t press_track(struct lm_page *p, int32_t step)
{
    (void)p, (void)step;
    return LM_EFFECT_TRACK;
}

static uint32_t hold_track(struct lm_page *p)
{
    (void)p;
    return LM_EFFECT_RANGING;
}

/* ---- declutter ---- */

static bool is_decluttered(const struct lm_page *p)
{
    return p->is_decluttered;
}

static uint32_t press_declutter(struct lm_page *p, int32_t step)
{
    (void)step;
    p->is_decluttered = !p->is_decluttered;
    return 0;
}

static uint32_t open_choice(struct lm_page *p)
{
    p->format = LM_FORMAT_DCLT;
    return 0;
}

static const struct lm_page_key keys[] = {
    {.osb = 1, .text = label_mode, .press = press_mode, .step = 1},
    {.osb = 2, .text = label_auto, .is_shown = is_sector, .press = press_auto},
    {.osb = 3, .text = label_fov, .press = press_fov, .step = 1},
    {.osb = 4,
     .words = "OVRD",
     .is_on = is_override,
     .stays_when_on = true,
     .press = press_override},
    {.osb = 6,
     .words = "BARO",
     .is_on = is_baro,
     .starts_hidden = true,
     .stays_when_on = true,
     .press = press_baro},
    {.osb = 7,
     .words = "FZ",
     .is_on = is_frozen,
     .starts_hidden = true,
     .stays_when_on = true,
     .press = press_freeze},
    {.osb = 8,
     .words = "SP",
     .is_on = is_snowplow,
     .starts_hidden = true,
     .stays_when_on = true,
     .press = press_snowplow},
    {.osb = 9, .words = "CZ", .starts_hidden = true, .press = press_cursor_zero},
    {.osb = 10, .words = "STP", .is_on = is_held, .starts_hidden = true, .press = press_steerpoint},
    {.osb = LM_OSB_DECLUTTER,
     .words = "DCLT",
     .is_on = is_decluttered,
     .press = press_declutter,
     .hold = open_choice},
    {.osb = 16,
     .text = label_cell,
     .is_shown = is_patch,
     .starts_hidden = true,
     .press = press_cell,
     .step = 1},
    {.osb = 17,
     .text = label_track,
     .is_shown = is_tracking,
     .is_on = is_tracking,
     .stays_when_on = true,
     .press = press_track,
     .hold = hold_track},
    {.osb = 18, .text = label_azimuth, .is_shown = has_azimuth, .press = press_azimuth, .step = 1},
    {.osb = 19, .words = LM_GLYPH_DOWN, .is_shown = has_smaller, .press = press_range, .step = -1},
    {.osb = 20,
     .words = LM_GLYPH_UP,
     .is_shown = has_larger,
     .value = label_range,
     .has_value = is_sector,
     .press = press_range,
     .step = 1},
};

const struct lm_page_table lm_page_radar = {
    .keys = keys, .count = sizeof keys / sizeof *keys, .is_decluttered = true};

/* Declutter page, on which the operator chooses the labels that declutter hides. */
const struct lm_page_table lm_page_dclt = {.chooses_for = &lm_page_radar};
