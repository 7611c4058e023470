/* Control page: beam, tone and colours. */
#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/font.h"
#include "lm/units.h"
#include "page_table.h"

/* ---- the beam ---- */

static bool is_tilt_manual(const struct lm_page *p)
{
    return p->is_tilt_manual;
}

/* Tilt in degrees, and whether the operator or the radar sets it. */
static void label_tilt(const struct lm_page *p, struct lm_label *label)
{
    lm_label_tenths(label, p->is_tilt_manual ? "TILT" : "AUTO", p->tilt_tenths < 0 ? "-" : "+",
                    fx_abs_u32(p->tilt_tenths));
}

static uint32_t press_tilt(struct lm_page *p, int32_t step)
{
    (void)step;
    p->is_tilt_manual = !p->is_tilt_manual;
    return LM_EFFECT_BEAM;
}

/* Change the tilt by half a degree, starting from the present one. */
static uint32_t step_tilt(struct lm_page *p, int32_t step)
{
    const int32_t most = lm_deg_tenths_of_bam((int32_t)p->radar->antenna.tilt_max);
    p->is_tilt_manual = true;
    p->tilt_tenths = (int16_t)fx_clamp_i32(p->tilt_tenths + 5 * step, -most, most);
    return LM_EFFECT_BEAM;
}

static bool is_pencil(const struct lm_page *p)
{
    return p->is_pencil;
}

static void label_beam(const struct lm_page *p, struct lm_label *label)
{
    lm_label_set(label, "BEAM", p->is_pencil ? "PNCL" : "FAN");
}

static uint32_t press_beam(struct lm_page *p, int32_t step)
{
    (void)step;
    p->is_pencil = !p->is_pencil;
    return LM_EFFECT_BEAM;
}

static bool is_plan(const struct lm_page *p)
{
    return p->is_plan;
}

static void label_plan(const struct lm_page *p, struct lm_label *label)
{
    lm_label_set(label, "SAR", p->is_plan ? "PLAN" : "SLNT");
}

static uint32_t press_plan(struct lm_page *p, int32_t step)
{
    (void)step;
    p->is_plan = !p->is_plan;
    return p->picture == LM_PICTURE_PATCH ? LM_EFFECT_PATCH : 0;
}

/* ---- tone ---- */

static void label_black(const struct lm_page *p, struct lm_label *value)
{
    lm_label_number(value, "BLACK", p->black_db, true);
}

static uint32_t step_black(struct lm_page *p, int32_t step)
{
    return lm_page_step(&p->black_db, step, LM_WINDOW_MAX_DB, LM_EFFECT_TONE);
}

static void label_white(const struct lm_page *p, struct lm_label *value)
{
    lm_label_number(value, "WHITE", p->white_db, true);
}

static uint32_t step_white(struct lm_page *p, int32_t step)
{
    return lm_page_step(&p->white_db, step, LM_WINDOW_MAX_DB, LM_EFFECT_TONE);
}

static void label_gamma(const struct lm_page *p, struct lm_label *value)
{
    const uint32_t gamma_q8 = lm_page_tone(p, &lm_radar_mode(p->radar, p->mode)->tone).gamma_q8;
    lm_label_tenths(value, "GAMMA", "", (gamma_q8 * 10u + 128u) / 256u);
}

static uint32_t step_gamma(struct lm_page *p, int32_t step)
{
    return lm_page_step(&p->gamma_tenths, step, LM_GAMMA_MAX, LM_EFFECT_TONE);
}

/* ---- colours ---- */

static void label_tint(const struct lm_page *p, struct lm_label *label)
{
    static const char tints[LM_TINTS][6] = {"GREY", "GREEN", "AMBER"};
    lm_label_set(label, tints[p->palette.tint], "");
}

static uint32_t press_tint(struct lm_page *p, int32_t step)
{
    p->palette.tint = (uint8_t)((p->palette.tint + (uint32_t)step) % LM_TINTS);
    return LM_EFFECT_PALETTE;
}

static bool is_night(const struct lm_page *p)
{
    return p->palette.is_night;
}

static void label_night(const struct lm_page *p, struct lm_label *label)
{
    lm_label_set(label, p->palette.is_night ? "NIGHT" : "DAY", "");
}

static uint32_t press_night(struct lm_page *p, int32_t step)
{
    (void)step;
    p->palette.is_night = !p->palette.is_night;
    return LM_EFFECT_PALETTE;
}

/* ---- */

static uint32_t press_reset(struct lm_page *p, int32_t step)
{
    (void)step;
    p->is_tilt_manual = p->is_pencil = p->is_plan = false;
    p->black_db = p->white_db = p->gamma_tenths = 0;
    p->gain_db = 0;
    memset(&p->palette, 0, sizeof p->palette);
    return LM_EFFECT_TONE | LM_EFFECT_PALETTE | LM_EFFECT_BEAM;
}

static uint32_t press_declutter(struct lm_page *p, int32_t step)
{
    (void)step;
    p->format = LM_FORMAT_DCLT;
    return 0;
}

/* The two keys of a pair. */
#define UP(number, function)                                                                       \
    .osb = (number), .words = LM_GLYPH_UP, .press = (function), .step = 1, .repeats = true
#define DOWN(number, function)                                                                     \
    .osb = (number), .words = LM_GLYPH_DOWN, .press = (function), .step = -1, .repeats = true

static const struct lm_page_key keys[] = {
    {.osb = 1, .text = label_tilt, .is_on = is_tilt_manual, .press = press_tilt},
    {UP(2, step_tilt)},
    {DOWN(3, step_tilt)},
    {.osb = 4, .text = label_beam, .is_on = is_pencil, .press = press_beam},
    {UP(6, step_black), .value = label_black},
    {DOWN(7, step_black)},
    {.osb = 8, .text = label_tint, .press = press_tint, .step = 1},
    {.osb = 9, .text = label_night, .is_on = is_night, .press = press_night},
    {.osb = 10, .words = "RESET", .press = press_reset},
    {.osb = LM_OSB_DECLUTTER, .words = "DCLT", .press = press_declutter},
    {.osb = 16, .text = label_plan, .is_on = is_plan, .press = press_plan},
    {DOWN(17, step_white)},
    {UP(18, step_white), .value = label_white},
    {DOWN(19, step_gamma)},
    {UP(20, step_gamma), .value = label_gamma},
};

const struct lm_page_table lm_page_cntl = {.keys = keys, .count = sizeof keys / sizeof *keys};
