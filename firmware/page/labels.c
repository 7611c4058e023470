#include "fx/mem.h"
#include "lm/font.h"
#include "lm/text.h"
#include "page_keys.h"

static bool say(struct lm_label *label, const char *first, const char *second, bool is_inverse)
{
    struct lm_text lines[2] = {0};
    lm_text_add(&lines[0], first);
    lm_text_add(&lines[1], second);
    for (uint32_t i = 0; i < 2; i++) {
        lines[i].words[sizeof label->line[i] - 1] = 0;
        memcpy(label->line[i], lines[i].words, sizeof label->line[i]);
    }
    label->is_inverse = is_inverse;
    return true;
}

static bool say_number(struct lm_label *label, const char *name, int32_t value, bool is_signed)
{
    struct lm_text t = {0};
    if (is_signed) {
        lm_text_signed(&t, value);
    } else {
        lm_text_number(&t, (uint32_t)value, 1);
    }
    return *name ? say(label, name, t.words, false) : say(label, t.words, "", false);
}

/* The sector's half angle in tens of degrees, under an A. */
static bool say_azimuth(const struct lm_page *p, struct lm_label *label)
{
    const fx_bam_t half = p->radar->azimuth_half[p->azimuth];
    const char digit[2] = {(char)('0' + (((uint64_t)half * 36 + (1u << 31)) >> 32) % 10), 0};
    return say(label, "A", digit, false);
}

/* Labels that only a sector has. */
static bool sector_label(const struct lm_page *p, uint8_t osb, struct lm_label *label)
{
    switch (osb) {
    case OSB_AUTO:
        return say(label, p->is_auto_range ? "AUTO" : "MAN", "", false);
    case OSB_AZIMUTH:
        return p->field == LM_FIELD_NORM && say_azimuth(p, label);
    case OSB_RANGE_DOWN:
        return p->range > 0 && say(label, LM_GLYPH_DOWN, "", false);
    case OSB_RANGE_UP:
        return p->range < lm_page_range_last(p) && say(label, LM_GLYPH_UP, "", false);
    default:
        return false;
    }
}

static bool radar_label(const struct lm_page *p, uint8_t osb, struct lm_label *label)
{
    switch (osb) {
    case OSB_MODE:
        return say(label, p->radar->mode[p->mode].name, "", false);
    case OSB_FIELD:
        return say(label, p->picture == LM_PICTURE_PATCH ? "SAR" : p->radar->field[p->field].name,
                   "", false);
    case OSB_OVERRIDE:
        return say(label, "OVRD", "", p->is_override);
    case OSB_BARO:
        return say(label, "BARO", "", p->is_baro);
    case OSB_FREEZE:
        return say(label, "FZ", "", p->is_frozen);
    case OSB_SNOWPLOW:
        return say(label, "SP", "", p->is_snowplow);
    case OSB_CURSOR_ZERO:
        return say(label, "CZ", "", false);
    case OSB_STEERPOINT:
        return say(label, "STP", "", !p->is_snowplow);
    case OSB_DECLUTTER:
        return say(label, "DCLT", "", p->is_decluttered);
    case OSB_SWAP:
        return say(label, "SWAP", "", false);
    case OSB_CELL:
        return say(label, "CELL", lm_page_cells[p->cell].label, false);
    default:
        return p->picture == LM_PICTURE_SECTOR && sector_label(p, osb, label);
    }
}

/* Degrees up of the beam's axis, and who points it. */
static bool say_tilt(const struct lm_page *p, struct lm_label *label)
{
    const uint32_t tenths = (uint32_t)(p->tilt_tenths < 0 ? -p->tilt_tenths : p->tilt_tenths);
    struct lm_text t = {0};
    lm_text_add(&t, p->tilt_tenths < 0 ? "-" : "+");
    lm_text_number(&t, tenths / 10, 1);
    lm_text_add(&t, ".");
    lm_text_number(&t, tenths % 10, 1);
    return say(label, p->is_tilt_manual ? "TILT" : "AUTO", t.words, p->is_tilt_manual);
}

static bool cntl_label(const struct lm_page *p, uint8_t osb, struct lm_label *label)
{
    static const char tints[LM_TINTS][6] = {"GREY", "GREEN", "AMBER"};
    switch (osb) {
    case OSB_TILT:
        return say_tilt(p, label);
    case OSB_BEAM:
        return say(label, "BEAM", p->is_pencil ? "PNCL" : "FAN", p->is_pencil);
    case OSB_SLANT:
        return say(label, "SAR", p->is_slant ? "SLNT" : "PLAN", p->is_slant);
    case OSB_TILT_UP:
    case OSB_BLACK_UP:
    case OSB_WHITE_UP:
    case OSB_GAMMA_UP:
        return say(label, LM_GLYPH_UP, "", false);
    case OSB_TILT_DOWN:
    case OSB_BLACK_DOWN:
    case OSB_WHITE_DOWN:
    case OSB_GAMMA_DOWN:
        return say(label, LM_GLYPH_DOWN, "", false);
    case OSB_TINT:
        return say(label, tints[p->palette.tint], "", false);
    case OSB_NIGHT:
        return say(label, p->palette.is_night ? "NIGHT" : "DAY", "", p->palette.is_night);
    case OSB_RESET:
        return say(label, "RESET", "", false);
    case OSB_DECLUTTER:
        return say(label, "DCLT", "", false);
    case OSB_SWAP:
        return say(label, "SWAP", "", false);
    default:
        return false;
    }
}

/* The labels of the keys that mean the same everywhere. */
static bool format_label(const struct lm_page *p, uint8_t osb, struct lm_label *label)
{
    switch (osb) {
    case OSB_CNTL:
        return say(label, "CNTL", "", p->format == LM_FORMAT_CNTL);
    case OSB_BIT:
        return say(label, "BIT", "", p->format == LM_FORMAT_BIT);
    case OSB_RADAR:
        return say(label, "FCR", "", p->format == LM_FORMAT_RADAR);
    case OSB_TEST:
        return say(label, "TEST", "", p->format == LM_FORMAT_TEST);
    case OSB_SWAP:
        return say(label, "SWAP", "", false);
    default:
        return false;
    }
}

/* Whether declutter takes the label away. What is out of the ordinary stays. */
static bool is_hidden(const struct lm_page *p, uint8_t osb)
{
    const bool is_unusual = (osb == OSB_OVERRIDE && p->is_override) ||
                            (osb == OSB_FREEZE && p->is_frozen) ||
                            (osb == OSB_BARO && p->is_baro) ||
                            (osb == OSB_SNOWPLOW && p->is_snowplow) || osb == OSB_DECLUTTER;
    return p->is_decluttered && (p->hidden & LM_OSB_BIT(osb)) && !is_unusual;
}

/* On the choice page each label stands as on the radar page, inverse when declutter takes it. */
static bool dclt_label(const struct lm_page *p, uint8_t osb, struct lm_label *label)
{
    const bool has_label = format_label(p, osb, label) || radar_label(p, osb, label);
    label->is_inverse = osb == OSB_DECLUTTER || (p->hidden & LM_OSB_BIT(osb));
    return has_label;
}

bool lm_page_label(const struct lm_page *p, uint8_t osb, struct lm_label *label)
{
    switch ((enum lm_format)p->format) {
    case LM_FORMAT_RADAR:
        return !is_hidden(p, osb) && (format_label(p, osb, label) || radar_label(p, osb, label));
    case LM_FORMAT_CNTL:
        return format_label(p, osb, label) || cntl_label(p, osb, label);
    case LM_FORMAT_DCLT:
        return dclt_label(p, osb, label);
    case LM_FORMAT_BIT:
    case LM_FORMAT_TEST:
        break;
    }
    return format_label(p, osb, label);
}

static bool say_gamma(const struct lm_page *p, struct lm_label *value)
{
    const uint32_t tenths =
        (lm_page_tone(p, &p->radar->mode[p->mode].tone).gamma_q8 * 10u + 128u) / 256u;
    struct lm_text t = {0};
    lm_text_number(&t, tenths / 10, 1);
    lm_text_add(&t, ".");
    lm_text_number(&t, tenths % 10, 1);
    return say(value, "GAMMA", t.words, false);
}

bool lm_page_value(const struct lm_page *p, uint8_t osb, struct lm_label *value)
{
    const bool is_range_shown = p->format == LM_FORMAT_RADAR || p->format == LM_FORMAT_DCLT;
    if (is_range_shown && osb == OSB_RANGE_UP && p->picture == LM_PICTURE_SECTOR) {
        return say_number(value, "", p->radar->range[p->range].range_nm, false);
    }
    if (p->format != LM_FORMAT_CNTL) {
        return false;
    }
    switch (osb) {
    case OSB_GAMMA_UP:
        return say_gamma(p, value);
    case OSB_WHITE_UP:
        return say_number(value, "WHITE", p->white_db, true);
    case OSB_BLACK_UP:
        return say_number(value, "BLACK", p->black_db, true);
    default:
        return false;
    }
}
