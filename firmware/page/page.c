#include "lm/units.h"
#include "page_table.h"

#include <stddef.h>

#include "fx/mem.h"
#include "fx/sat.h"

#define OSB_BIT(osb) (1u << ((osb)-1))

/* ---- the keys of a page ---- */

static bool is_format(const struct lm_page *p, enum lm_format format)
{
    return p->format == format;
}

static uint32_t open_format(struct lm_page *p, enum lm_format format)
{
    p->format = (uint8_t)format;
    return 0;
}

static bool is_on_cntl(const struct lm_page *p)
{
    return is_format(p, LM_FORMAT_CNTL);
}

static bool is_on_bit(const struct lm_page *p)
{
    return is_format(p, LM_FORMAT_BIT);
}

static bool is_on_radar(const struct lm_page *p)
{
    return is_format(p, LM_FORMAT_RADAR);
}

static bool is_on_test(const struct lm_page *p)
{
    return is_format(p, LM_FORMAT_TEST);
}

static uint32_t press_cntl(struct lm_page *p, int32_t step)
{
    (void)step;
    return open_format(p, is_on_cntl(p) ? LM_FORMAT_RADAR : LM_FORMAT_CNTL);
}

static uint32_t press_bit(struct lm_page *p, int32_t step)
{
    (void)step;
    return open_format(p, LM_FORMAT_BIT);
}

static uint32_t press_radar(struct lm_page *p, int32_t step)
{
    (void)step;
    return open_format(p, LM_FORMAT_RADAR);
}

static uint32_t press_test(struct lm_page *p, int32_t step)
{
    (void)step;
    return open_format(p, LM_FORMAT_TEST);
}

static uint32_t press_swap(struct lm_page *p, int32_t step)
{
    (void)p, (void)step;
    return LM_EFFECT_SWAP;
}

/* Keys that do the same on every page. */
static const struct lm_page_key common[] = {
    {.osb = LM_OSB_CNTL, .words = "CNTL", .is_on = is_on_cntl, .press = press_cntl},
    {.osb = 12, .words = "BIT", .is_on = is_on_bit, .starts_hidden = true, .press = press_bit},
    {.osb = 13, .words = "FCR", .is_on = is_on_radar, .starts_hidden = true, .press = press_radar},
    {.osb = 14, .words = "TEST", .is_on = is_on_test, .starts_hidden = true, .press = press_test},
    {.osb = 15, .words = "SWAP", .starts_hidden = true, .press = press_swap},
};
enum { COMMON = sizeof common / sizeof *common };

/* Pages of text or a pattern, whose keys are the common ones. */
static const struct lm_page_table plain = {0};

static const struct lm_page_table *const tables[LM_FORMATS] = {
    [LM_FORMAT_RADAR] = &lm_page_radar, [LM_FORMAT_CNTL] = &lm_page_cntl,
    [LM_FORMAT_DCLT] = &lm_page_dclt,   [LM_FORMAT_BIT] = &plain,
    [LM_FORMAT_TEST] = &plain,
};

static const struct lm_page_table *table_of(const struct lm_page *p)
{
    return tables[p->format];
}

static const struct lm_page_key *find_in(const struct lm_page_key *keys, uint32_t count,
                                         uint8_t osb)
{
    for (uint32_t i = 0; i < count; i++) {
        if (keys[i].osb == osb) {
            return &keys[i];
        }
    }
    return NULL;
}

/* The key of a page: its own, or a common one; NULL if there is none. */
static const struct lm_page_key *find_key(const struct lm_page_table *table, uint8_t osb)
{
    const struct lm_page_table *shown = table->chooses_for ? table->chooses_for : table;
    const struct lm_page_key *key = find_in(shown->keys, shown->count, osb);
    return key ? key : find_in(common, COMMON, osb);
}

/* ---- */

void lm_page_init(struct lm_page *p, const struct lm_radar *radar)
{
    memset(p, 0, sizeof *p);
    p->radar = radar;
    p->range_index = (uint8_t)lm_radar_find_range(radar, radar->range_start_nm);
    p->cell_mm = 5000;
    for (uint32_t osb = 1; osb <= LM_OSBS; osb++) {
        const struct lm_page_key *key = find_key(&lm_page_radar, (uint8_t)osb);
        p->hidden |= key && key->starts_hidden ? OSB_BIT(osb) : 0;
    }
}

struct lm_tone_config lm_page_tone(const struct lm_page *p, const struct lm_tone_config *table)
{
    /* |gain| 30, |window| 20, |table| below 64 dB and the knob's 2: below 2^15 / 256 dB. */
    const int32_t gain_db_q8 =
        lm_db_q8_of_db(p->gain_db) + p->knob * LM_KNOB_FULL_Q8 / LM_FULL_DEFLECTION;
    const int32_t black_db_q8 = table->black_db_q8 + lm_db_q8_of_db(p->black_db);
    const int32_t white_db_q8 = table->white_db_q8 + lm_db_q8_of_db(p->white_db);
    const int32_t gamma_q8 = table->gamma_q8 + p->gamma_tenths * 256 / 10;
    return (struct lm_tone_config){
        .black_db_q8 = (int16_t)(black_db_q8 - gain_db_q8),
        .white_db_q8 = (int16_t)(fx_max_i32(white_db_q8, black_db_q8 + 256) - gain_db_q8),
        .gamma_q8 = (uint16_t)fx_clamp_i32(gamma_q8, 64, 1024),
    };
}

uint32_t lm_page_step(int8_t *value, int32_t step, int32_t limit, uint32_t effect)
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
        p->gain_db = (int8_t)gain_db;
        return has_moved ? LM_EFFECT_TONE : 0;
    }
    case LM_ROCKER_SYM:
        return lm_page_step(&c->symbology, step, LM_ROCKER_STEPS, LM_EFFECT_PALETTE);
    case LM_ROCKER_BRT:
        return lm_page_step(&c->brightness, step, LM_ROCKER_STEPS, LM_EFFECT_PALETTE);
    case LM_ROCKER_CON:
        return lm_page_step(&c->contrast, step, LM_ROCKER_STEPS, LM_EFFECT_PALETTE);
    case LM_ROCKERS:
        break;
    }
    return 0;
}

uint8_t lm_page_range_last(const struct lm_page *p)
{
    return (uint8_t)lm_radar_range_last(p->radar, p->mode, p->fov);
}

/* Select a scale, and start the sector with it. */
static uint32_t take_range(struct lm_page *p, uint32_t range)
{
    const bool is_other = range != p->range_index;
    p->range_index = (uint8_t)range;
    return is_other ? LM_EFFECT_SECTOR | LM_EFFECT_RANGE : LM_EFFECT_SECTOR;
}

uint32_t lm_page_fit_range(struct lm_page *p)
{
    return take_range(p, fx_min_u32(p->range_index, lm_page_range_last(p)));
}

uint32_t lm_page_step_range(struct lm_page *p, int32_t step)
{
    const int32_t range = fx_clamp_i32(p->range_index + step, 0, lm_page_range_last(p));
    return range != p->range_index ? take_range(p, (uint32_t)range) : 0;
}

uint32_t lm_page_select_range(struct lm_page *p, int32_t range_nm)
{
    const int32_t range = lm_radar_find_range(p->radar, range_nm);
    if (!fx_is_within_i32(range, 0, lm_page_range_last(p))) {
        return 0;
    }
    p->is_auto_range = false;
    return take_range(p, (uint32_t)range);
}

uint32_t lm_page_select_azimuth(struct lm_page *p, int32_t azimuth)
{
    if (!fx_is_within_i32(azimuth, 0, LM_AZIMUTHS - 1)) {
        return 0;
    }
    p->azimuth_index = (uint8_t)azimuth;
    return LM_EFFECT_SECTOR;
}

uint32_t lm_page_select_sector(struct lm_page *p, int32_t mode, int32_t fov)
{
    if (!fx_is_within_i32(mode, 0, LM_SECTOR_CHOICES - 1) ||
        !fx_is_within_i32(fov, 0, (int32_t)lm_radar_fov_last(p->radar, (uint32_t)mode)) ||
        p->range_index > lm_radar_range_last(p->radar, (uint32_t)mode, (uint32_t)fov)) {
        return 0;
    }
    p->mode = (uint8_t)mode;
    p->fov = (uint8_t)fov;
    return LM_EFFECT_SECTOR | LM_EFFECT_TONE;
}

uint32_t lm_page_set_gain(struct lm_page *p, int32_t gain_db)
{
    if (!fx_is_within_i32(gain_db, -LM_GAIN_MAX_DB, LM_GAIN_MAX_DB)) {
        return 0;
    }
    p->gain_db = (int8_t)gain_db;
    return LM_EFFECT_TONE;
}

uint32_t lm_page_set_knob(struct lm_page *p, int32_t knob)
{
    if (!fx_is_within_i32(knob, -LM_FULL_DEFLECTION, LM_FULL_DEFLECTION)) {
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

void lm_page_note_patch(struct lm_page *p, const struct lm_sar_command *patch)
{
    p->cell_mm = patch->cell_mm;
    p->is_plan = patch->is_plan;
}

void lm_page_note_track(struct lm_page *p, uint8_t kind)
{
    p->track = kind;
}

void lm_page_note_tilt(struct lm_page *p, int32_t tilt)
{
    if (!p->is_tilt_manual) {
        p->tilt_tenths = (int16_t)lm_deg_tenths_of_bam(tilt);
    }
}

/* ---- the page as bytes ---- */

enum { FIRST_BYTE = offsetof(struct lm_page, format) };

_Static_assert(offsetof(struct lm_page, palette) == FIRST_BYTE + LM_PAGE_SHARED_BYTES &&
                   offsetof(struct lm_page, is_frozen) == FIRST_BYTE + LM_PAGE_BYTES - 1 &&
                   offsetof(struct lm_page, picture) == FIRST_BYTE + 1,
               "the bytes stand together");

void lm_page_bytes(const struct lm_page *p, uint8_t byte[LM_PAGE_BYTES])
{
    memcpy(byte, (const uint8_t *)p + FIRST_BYTE, LM_PAGE_BYTES);
}

bool lm_page_bytes_are_sound(const struct lm_page *p, const uint8_t byte[LM_PAGE_BYTES])
{
    /* The most of each; a negative one is also the least. */
    static const int16_t most[LM_PAGE_BYTES] = {LM_FORMATS - 1,
                                                LM_PICTURES - 1,
                                                LM_SECTOR_CHOICES - 1,
                                                LM_FOVS - 1,
                                                INT8_MAX,
                                                LM_AZIMUTHS - 1,
                                                1,
                                                1,
                                                1,
                                                1,
                                                1,
                                                1,
                                                1,
                                                1,
                                                -LM_GAIN_MAX_DB,
                                                -LM_WINDOW_MAX_DB,
                                                -LM_WINDOW_MAX_DB,
                                                -LM_GAMMA_MAX,
                                                LM_TINTS - 1,
                                                1,
                                                -LM_ROCKER_STEPS,
                                                -LM_ROCKER_STEPS,
                                                -LM_ROCKER_STEPS,
                                                1};
    for (uint32_t i = 0; i < LM_PAGE_BYTES; i++) {
        const int32_t limit = most[i];
        if (!fx_is_within_i32((int8_t)byte[i], fx_min_i32(limit, 0), (int32_t)fx_abs_u32(limit))) {
            return false;
        }
    }
    return byte[3] <= lm_radar_fov_last(p->radar, byte[2]) &&
           byte[4] <= lm_radar_range_last(p->radar, byte[2], byte[3]);
}

void lm_page_take(struct lm_page *p, const uint8_t byte[LM_PAGE_BYTES], uint32_t count)
{
    const uint8_t picture = p->picture;
    memcpy((uint8_t *)p + FIRST_BYTE, byte, count);
    p->picture = picture;
}

/* ---- presses, labels and values of keys ---- */

static bool label_of_key(const struct lm_page *p, const struct lm_page_key *key,
                         struct lm_label *label)
{
    if ((!key->words && !key->text) || (key->is_shown && !key->is_shown(p))) {
        return false;
    }
    if (key->text) {
        key->text(p, label);
    } else {
        lm_label_set(label, key->words, "");
    }
    label->is_inverse = key->is_on && key->is_on(p);
    return true;
}

static bool is_hidden(const struct lm_page *p, uint8_t osb)
{
    return (p->hidden & OSB_BIT(osb)) != 0;
}

/* True if declutter hides the label. The label of an unusual setting stays. */
static bool is_taken_away(const struct lm_page *p, const struct lm_page_key *key)
{
    const bool stays = key->stays_when_on && key->is_on && key->is_on(p);
    return table_of(p)->is_decluttered && p->is_decluttered && is_hidden(p, key->osb) && !stays;
}

bool lm_page_label(const struct lm_page *p, uint8_t osb, struct lm_label *label)
{
    const struct lm_page_table *table = table_of(p);
    const struct lm_page_key *key = find_key(table, osb);
    if (!key || is_taken_away(p, key) || !label_of_key(p, key, label)) {
        return false;
    }
    if (table->chooses_for) { /* labels that declutter hides are inverse */
        label->is_inverse = osb == LM_OSB_DECLUTTER || is_hidden(p, osb);
    }
    return true;
}

bool lm_page_value(const struct lm_page *p, uint8_t osb, struct lm_label *value)
{
    const struct lm_page_key *key = find_key(table_of(p), osb);
    if (!key || !key->value || (key->has_value && !key->has_value(p))) {
        return false;
    }
    key->value(p, value);
    value->is_inverse = false;
    return true;
}

/* Switch whether declutter hides the label of this key. */
static uint32_t choose(struct lm_page *p, uint8_t osb)
{
    struct lm_label label;
    if (osb == LM_OSB_DECLUTTER) {
        p->format = LM_FORMAT_RADAR;
    } else if (lm_page_label(p, osb, &label)) {
        p->hidden ^= OSB_BIT(osb);
    }
    return 0;
}

uint32_t lm_page_press(struct lm_page *p, struct lm_press press)
{
    const uint8_t osb = press.button;
    if (osb > LM_OSBS) {
        return press_rocker(p, osb);
    }
    const struct lm_page_table *table = table_of(p);
    if (table->chooses_for && osb != LM_OSB_CNTL) {
        return choose(p, osb);
    }
    const struct lm_page_key *key = find_key(table, osb);
    if (key && press.is_long && key->hold) {
        return key->hold(p);
    }
    return key && key->press ? key->press(p, key->step) : 0;
}

enum lm_key_style lm_page_key_style(const struct lm_page *p, uint8_t button)
{
    const struct lm_page_table *table = table_of(p);
    const struct lm_page_key *key = button <= LM_OSBS ? find_key(table, button) : NULL;
    if (button > LM_OSBS || (key && key->repeats)) {
        return LM_KEY_REPEATS;
    }
    return key && key->hold && !table->chooses_for ? LM_KEY_HAS_LONG : LM_KEY_ONCE;
}
