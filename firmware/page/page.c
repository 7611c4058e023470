#include "page_keys.h"

#include "fx/mem.h"
#include "fx/sat.h"

const struct lm_page_cell lm_page_cells[LM_SAR_CELLS_OFFERED] = {
    {1000, "1M"}, {2000, "2M"}, {3000, "3M"}, {5000, "5M"}, {10000, "10M"}, {20000, "20M"}};

void lm_page_init(struct lm_page *p, const struct lm_radar *radar)
{
    memset(p, 0, sizeof *p);
    p->radar = radar;
    p->range = (uint8_t)lm_radar_find_range(radar, radar->range_start_nm);
    p->cell = 3;
    p->hidden = LM_OSB_BIT(OSB_FREEZE) | LM_OSB_BIT(OSB_SNOWPLOW) | LM_OSB_BIT(OSB_CURSOR_ZERO) |
                LM_OSB_BIT(OSB_STEERPOINT) | LM_OSB_BIT(OSB_BIT) | LM_OSB_BIT(OSB_RADAR) |
                LM_OSB_BIT(OSB_TEST) | LM_OSB_BIT(OSB_BARO) | LM_OSB_BIT(OSB_SWAP) |
                LM_OSB_BIT(OSB_CELL);
}

uint32_t lm_page_cell_mm(const struct lm_page *p)
{
    return lm_page_cells[p->cell].mm;
}

struct lm_tone_config lm_page_tone(const struct lm_page *p, const struct lm_tone_config *table)
{
    /* |gain| 30, |window| 20, |table| below 64 dB and the knob's 2: below 2^15 / 256 dB. */
    const int32_t gain_q8 = p->gain_db * 256 + p->knob * LM_KNOB_FULL_Q8 / LM_FULL_DEFLECTION;
    const int32_t black_q8 = table->black_q8 + p->black_db * 256;
    const int32_t white_q8 = table->white_q8 + p->white_db * 256;
    const int32_t gamma_q8 = table->gamma_q8 + p->gamma_tenths * 256 / 10;
    return (struct lm_tone_config){
        .black_q8 = (int16_t)(black_q8 - gain_q8),
        .white_q8 = (int16_t)(fx_max_i32(white_q8, black_q8 + 256) - gain_q8),
        .gamma_q8 = (uint16_t)fx_clamp_i32(gamma_q8, 64, 1024),
    };
}

/* Move a value by a step within its limits. Returns `effect` when it moved. */
static uint32_t step_int8(int8_t *value, int32_t step, int32_t limit, uint32_t effect)
{
    const int32_t moved = fx_clamp_i32(*value + step, -limit, limit);
    const bool has_moved = moved != *value;
    *value = (int8_t)moved;
    return has_moved ? effect : 0;
}

static uint32_t press_rocker(struct lm_page *p, uint8_t button)
{
    const uint8_t half = button - LM_OSBS - 1;
    const int32_t step = half & 1 ? -1 : 1;
    struct lm_palette_config *c = &p->palette;
    switch ((enum lm_rocker)(half / 2)) {
    case LM_ROCKER_GAIN: {
        const int32_t gain_db = fx_clamp_i32(p->gain_db + step, -LM_GAIN_MAX_DB, LM_GAIN_MAX_DB);
        const bool has_moved = gain_db != p->gain_db;
        p->gain_db = (int16_t)gain_db;
        return has_moved ? LM_EFFECT_TONE : 0;
    }
    case LM_ROCKER_SYM:
        return step_int8(&c->symbology, step, LM_ROCKER_STEPS, LM_EFFECT_PALETTE);
    case LM_ROCKER_BRT:
        return step_int8(&c->brightness, step, LM_ROCKER_STEPS, LM_EFFECT_PALETTE);
    case LM_ROCKER_CON:
        return step_int8(&c->contrast, step, LM_ROCKER_STEPS, LM_EFFECT_PALETTE);
    case LM_ROCKERS:
        break;
    }
    return 0;
}

uint8_t lm_page_range_last(const struct lm_page *p)
{
    return (uint8_t)lm_radar_range_last(p->radar, p->mode, p->field);
}

/* Begin the sector with this scale. */
static uint32_t take_range(struct lm_page *p, uint32_t range)
{
    const bool is_other = range != p->range;
    p->range = (uint8_t)range;
    return is_other ? LM_EFFECT_SECTOR | LM_EFFECT_RANGE : LM_EFFECT_SECTOR;
}

/* Begin the sector with the largest scale, up to the one at hand, that mode and field have. */
static uint32_t fit_range(struct lm_page *p)
{
    return take_range(p, fx_min_u32(p->range, lm_page_range_last(p)));
}

uint32_t lm_page_step_range(struct lm_page *p, int32_t step)
{
    const int32_t range = fx_clamp_i32(p->range + step, 0, lm_page_range_last(p));
    return range != p->range ? take_range(p, (uint32_t)range) : 0;
}

static bool is_within(int32_t value, int32_t low, int32_t high)
{
    return value >= low && value <= high;
}

uint32_t lm_page_select_range(struct lm_page *p, int32_t range_nm)
{
    const int32_t range = lm_radar_find_range(p->radar, range_nm);
    if (!is_within(range, 0, lm_page_range_last(p))) {
        return 0;
    }
    p->is_auto_range = false;
    return take_range(p, (uint32_t)range);
}

uint32_t lm_page_select_azimuth(struct lm_page *p, int32_t azimuth)
{
    if (!is_within(azimuth, 0, LM_AZIMUTHS - 1)) {
        return 0;
    }
    p->azimuth = (uint8_t)azimuth;
    return LM_EFFECT_SECTOR;
}

uint32_t lm_page_select_sector(struct lm_page *p, int32_t mode, int32_t field)
{
    if (!is_within(mode, 0, LM_SECTOR_MODES - 1) ||
        !is_within(field, 0, p->radar->mode[mode].field_last) ||
        p->range > lm_radar_range_last(p->radar, (uint32_t)mode, (uint32_t)field)) {
        return 0;
    }
    p->mode = (uint8_t)mode;
    p->field = (uint8_t)field;
    return LM_EFFECT_SECTOR | LM_EFFECT_TONE;
}

uint32_t lm_page_set_gain(struct lm_page *p, int32_t gain_db)
{
    if (!is_within(gain_db, -LM_GAIN_MAX_DB, LM_GAIN_MAX_DB)) {
        return 0;
    }
    p->gain_db = (int16_t)gain_db;
    return LM_EFFECT_TONE;
}

uint32_t lm_page_set_knob(struct lm_page *p, int32_t knob)
{
    if (!is_within(knob, -LM_FULL_DEFLECTION, LM_FULL_DEFLECTION)) {
        return 0;
    }
    p->knob = (int16_t)knob;
    return LM_EFFECT_TONE;
}

void lm_page_set_frozen(struct lm_page *p, bool is_frozen)
{
    p->is_frozen = is_frozen;
}

void lm_page_show_picture(struct lm_page *p, enum lm_picture_kind kind)
{
    p->picture = (uint8_t)kind;
    p->is_frozen = false;
}

void lm_page_note_tilt(struct lm_page *p, int32_t tilt)
{
    if (!p->is_tilt_manual) {
        p->tilt_tenths = (int16_t)(((int64_t)tilt * 3600 + (1LL << 31)) >> 32);
    }
}

static uint32_t press_range(struct lm_page *p, int32_t step)
{
    if (p->picture != LM_PICTURE_SECTOR) {
        return 0;
    }
    p->is_auto_range = false;
    return lm_page_step_range(p, step);
}

/* The sector's scan, which a window around the cursor does not have. */
static uint32_t press_azimuth(struct lm_page *p)
{
    if (p->picture != LM_PICTURE_SECTOR || p->field != LM_FIELD_NORM) {
        return 0;
    }
    p->azimuth = (uint8_t)((p->azimuth + 1) % LM_AZIMUTHS);
    return LM_EFFECT_SECTOR;
}

/* The next mode of the rotary, with a field and a scale that it has. In a patch: back to the
 * sector. */
static uint32_t press_mode(struct lm_page *p)
{
    if (p->picture != LM_PICTURE_SECTOR) {
        return LM_EFFECT_SECTOR | LM_EFFECT_TONE;
    }
    p->mode = (uint8_t)((p->mode + 1u) % LM_SECTOR_MODES);
    p->field = p->field > p->radar->mode[p->mode].field_last ? (uint8_t)LM_FIELD_NORM : p->field;
    return fit_range(p) | LM_EFFECT_TONE;
}

/* The next field of view that this mode has at this range. In a patch: the whole sector. */
static uint32_t press_field(struct lm_page *p)
{
    const uint8_t before = p->field;
    const struct lm_radar *radar = p->radar;
    if (p->picture != LM_PICTURE_SECTOR) {
        p->field = LM_FIELD_NORM;
        return LM_EFFECT_SECTOR;
    }
    for (uint32_t i = 0; i < LM_FIELDS; i++) {
        p->field = (uint8_t)((p->field + 1u) % LM_FIELDS);
        if (p->field <= radar->mode[p->mode].field_last && p->range <= lm_page_range_last(p)) {
            break;
        }
    }
    return p->field != before ? LM_EFFECT_SECTOR : 0;
}

static uint32_t press_cell(struct lm_page *p)
{
    p->cell = (uint8_t)((p->cell + 1u) % LM_SAR_CELLS_OFFERED);
    return p->picture == LM_PICTURE_PATCH ? LM_EFFECT_PATCH : 0;
}

static uint32_t set_snowplow(struct lm_page *p, bool is_on)
{
    const bool has_changed = p->is_snowplow != is_on;
    p->is_snowplow = is_on;
    return has_changed ? LM_EFFECT_SNOWPLOW : 0;
}

static uint32_t press_declutter(struct lm_page *p, bool is_long)
{
    if (is_long) {
        p->format = LM_FORMAT_DCLT;
    } else {
        p->is_decluttered = !p->is_decluttered;
    }
    return 0;
}

static uint32_t press_on_radar(struct lm_page *p, uint8_t osb, bool is_long)
{
    switch (osb) {
    case OSB_MODE:
        return press_mode(p);
    case OSB_AUTO:
        p->is_auto_range = !p->is_auto_range;
        return 0;
    case OSB_FIELD:
        return press_field(p);
    case OSB_OVERRIDE:
        p->is_override = !p->is_override;
        return 0;
    case OSB_BARO:
        p->is_baro = !p->is_baro;
        return LM_EFFECT_HEIGHT;
    case OSB_FREEZE:
        p->is_frozen = !p->is_frozen;
        return 0;
    case OSB_SNOWPLOW:
        return set_snowplow(p, !p->is_snowplow);
    case OSB_CURSOR_ZERO:
        return LM_EFFECT_CURSOR_HOME;
    case OSB_STEERPOINT:
        return set_snowplow(p, false);
    case OSB_DECLUTTER:
        return press_declutter(p, is_long);
    case OSB_CELL:
        return press_cell(p);
    case OSB_AZIMUTH:
        return press_azimuth(p);
    case OSB_RANGE_DOWN:
        return press_range(p, -1);
    case OSB_RANGE_UP:
        return press_range(p, 1);
    default:
        return 0;
    }
}

/* Half a degree up or down, from where the beam is. */
static uint32_t step_tilt(struct lm_page *p, int32_t step)
{
    const int32_t most =
        (int32_t)(((uint64_t)p->radar->antenna.tilt_max * 3600 + (1u << 31)) >> 32);
    p->is_tilt_manual = true;
    p->tilt_tenths = (int16_t)fx_clamp_i32(p->tilt_tenths + 5 * step, -most, most);
    return LM_EFFECT_BEAM;
}

static uint32_t reset_settings(struct lm_page *p)
{
    p->is_tilt_manual = p->is_pencil = p->is_slant = false;
    p->black_db = p->white_db = p->gamma_tenths = 0;
    p->gain_db = 0;
    memset(&p->palette, 0, sizeof p->palette);
    return LM_EFFECT_TONE | LM_EFFECT_PALETTE | LM_EFFECT_BEAM;
}

static uint32_t press_on_cntl(struct lm_page *p, uint8_t osb)
{
    switch (osb) {
    case OSB_TILT:
        p->is_tilt_manual = !p->is_tilt_manual;
        return LM_EFFECT_BEAM;
    case OSB_TILT_UP:
        return step_tilt(p, 1);
    case OSB_TILT_DOWN:
        return step_tilt(p, -1);
    case OSB_BEAM:
        p->is_pencil = !p->is_pencil;
        return LM_EFFECT_BEAM;
    case OSB_SLANT:
        p->is_slant = !p->is_slant;
        return p->picture == LM_PICTURE_PATCH ? LM_EFFECT_PATCH : 0;
    case OSB_BLACK_UP:
        return step_int8(&p->black_db, 1, LM_WINDOW_MAX_DB, LM_EFFECT_TONE);
    case OSB_BLACK_DOWN:
        return step_int8(&p->black_db, -1, LM_WINDOW_MAX_DB, LM_EFFECT_TONE);
    case OSB_WHITE_UP:
        return step_int8(&p->white_db, 1, LM_WINDOW_MAX_DB, LM_EFFECT_TONE);
    case OSB_WHITE_DOWN:
        return step_int8(&p->white_db, -1, LM_WINDOW_MAX_DB, LM_EFFECT_TONE);
    case OSB_GAMMA_UP:
        return step_int8(&p->gamma_tenths, 1, LM_GAMMA_MAX, LM_EFFECT_TONE);
    case OSB_GAMMA_DOWN:
        return step_int8(&p->gamma_tenths, -1, LM_GAMMA_MAX, LM_EFFECT_TONE);
    case OSB_TINT:
        p->palette.tint = (uint8_t)((p->palette.tint + 1u) % LM_TINTS);
        return LM_EFFECT_PALETTE;
    case OSB_NIGHT:
        p->palette.is_night = !p->palette.is_night;
        return LM_EFFECT_PALETTE;
    case OSB_RESET:
        return reset_settings(p);
    case OSB_DECLUTTER:
        p->format = LM_FORMAT_DCLT;
        return 0;
    default:
        return 0;
    }
}

static uint32_t press_on_dclt(struct lm_page *p, uint8_t osb)
{
    struct lm_label label;
    struct lm_page radar = *p;
    radar.format = LM_FORMAT_RADAR;
    radar.is_decluttered = false;
    if (osb == OSB_DECLUTTER) {
        p->format = LM_FORMAT_RADAR;
    } else if (lm_page_label(&radar, osb, &label)) {
        p->hidden ^= LM_OSB_BIT(osb);
    }
    return 0;
}

/* Keys that mean the same on every format: the control page and the direct access. */
static bool press_format(struct lm_page *p, uint8_t osb)
{
    switch (osb) {
    case OSB_CNTL:
        p->format = p->format == LM_FORMAT_CNTL ? LM_FORMAT_RADAR : LM_FORMAT_CNTL;
        return true;
    case OSB_BIT:
        p->format = LM_FORMAT_BIT;
        return true;
    case OSB_RADAR:
        p->format = LM_FORMAT_RADAR;
        return true;
    case OSB_TEST:
        p->format = LM_FORMAT_TEST;
        return true;
    default:
        return false;
    }
}

uint32_t lm_page_press(struct lm_page *p, struct lm_press press)
{
    const uint8_t osb = press.button;
    if (osb > LM_OSBS) {
        return press_rocker(p, osb);
    }
    if (p->format == LM_FORMAT_DCLT && osb != OSB_CNTL) {
        return press_on_dclt(p, osb);
    }
    if (press_format(p, osb)) {
        return 0;
    }
    if (osb == OSB_SWAP) {
        return LM_EFFECT_SWAP;
    }
    switch ((enum lm_format)p->format) {
    case LM_FORMAT_RADAR:
        return press_on_radar(p, osb, press.is_long);
    case LM_FORMAT_CNTL:
        return press_on_cntl(p, osb);
    case LM_FORMAT_DCLT:
    case LM_FORMAT_BIT:
    case LM_FORMAT_TEST:
        break;
    }
    return 0;
}

enum lm_key_style lm_page_key_style(const struct lm_page *p, uint8_t button)
{
    const uint32_t pairs = LM_OSB_BIT(OSB_BLACK_UP) | LM_OSB_BIT(OSB_BLACK_DOWN) |
                           LM_OSB_BIT(OSB_WHITE_UP) | LM_OSB_BIT(OSB_WHITE_DOWN) |
                           LM_OSB_BIT(OSB_GAMMA_UP) | LM_OSB_BIT(OSB_GAMMA_DOWN) |
                           LM_OSB_BIT(OSB_TILT_UP) | LM_OSB_BIT(OSB_TILT_DOWN);
    if (button > LM_OSBS || (p->format == LM_FORMAT_CNTL && (pairs & LM_OSB_BIT(button)))) {
        return LM_KEY_REPEATS;
    }
    return p->format == LM_FORMAT_RADAR && button == OSB_DECLUTTER ? LM_KEY_HAS_LONG : LM_KEY_ONCE;
}
