#include "settings.h"

#include <stddef.h>

#include "commands.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/units.h"
#include "tracking.h"

enum {
    PICTURE = 1, /* byte of the page */
    IS_PLACED = 1 << 24,
    IS_HOME = 1 << 25,
    IS_SNOWPLOW = 1 << 26,
    HIDDEN = (1 << LM_OSBS) - 1
};

/* Displays of both orders of bytes could not exchange them. */
_Static_assert(sizeof(struct lm_settings) == LM_SETTINGS_BYTES &&
                   __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__,
               "numbers are told as they lie in memory, the least byte first");
_Static_assert(offsetof(struct lm_sar_command, cell_mm) == 8 &&
                   offsetof(struct lm_settings, cell_mm) ==
                       offsetof(struct lm_settings, centre) + 8 &&
                   offsetof(struct lm_sar_command, height_m_q6) ==
                       offsetof(struct lm_sar_command, look_azimuth) + 8 &&
                   offsetof(struct lm_settings, height_m_q6) ==
                       offsetof(struct lm_settings, look_azimuth) + 8,
               "numbers of a patch are copied together");

void lm_settings_give(const struct lm_unit *u, struct lm_settings *s)
{
    const struct lm_cursor *c = &u->cursor;
    const struct lm_sar_command *patch = &u->picture.sar.command;
    lm_page_bytes(&u->page, s->page);
    s->hidden = u->page.hidden | (c->is_placed ? IS_PLACED : 0u) | (c->is_home ? IS_HOME : 0u) |
                (c->is_snowplow ? IS_SNOWPLOW : 0u);
    s->tilt_tenths = u->page.tilt_tenths;
    memcpy(&s->centre, &patch->centre, 12);
    memcpy(&s->look_azimuth, &patch->look_azimuth, 12);
    if (u->page.picture != LM_PICTURE_PATCH) {
        s->cell_mm = u->page.cell_mm;
    }
    s->cursor = c->position;
}

bool lm_settings_are_sound(const struct lm_unit *u, const struct lm_settings *s)
{
    return lm_page_bytes_are_sound(&u->page, s->page) &&
           fx_abs_u32((int32_t)s->cursor.latitude) <= FX_BAM_90;
}

static void take_page(struct lm_page *p, const struct lm_settings *s, uint32_t bytes)
{
    const struct lm_radar *radar = p->radar;
    const int32_t most = lm_deg_tenths_of_bam((int32_t)radar->antenna.tilt_max);
    lm_page_take(p, s->page, bytes);
    p->hidden = s->hidden & HIDDEN;
    p->tilt_tenths = (int16_t)fx_clamp_i32(s->tilt_tenths, -most, most);
    p->cell_mm = fx_max_u32(radar->sar.cell_min_mm, fx_min_u32(s->cell_mm, radar->sar.cell_max_mm));
}

void lm_settings_take(struct lm_unit *u, const struct lm_settings *s, uint32_t bytes,
                      uint64_t now_us)
{
    struct lm_cursor *c = &u->cursor;
    struct lm_sar_command patch = {.is_plan = s->page[7]};
    take_page(&u->page, s, bytes);
    c->position = s->cursor;
    c->is_placed = (s->hidden & IS_PLACED) != 0;
    c->is_home = (s->hidden & IS_HOME) != 0;
    c->is_snowplow = (s->hidden & IS_SNOWPLOW) != 0;
    (void)lm_tracking_drop(u, now_us);
    memcpy(&patch.centre, &s->centre, 12);
    memcpy(&patch.look_azimuth, &s->look_azimuth, 12);
    if (s->page[PICTURE] != LM_PICTURE_PATCH ||
        lm_picture_start(&u->picture, LM_PICTURE_PATCH, &patch, now_us) != LM_REFUSED_NOT) {
        lm_picture_start(&u->picture, LM_PICTURE_SECTOR, NULL, now_us);
    }
    lm_apply_effects(u, LM_EFFECT_TONE | LM_EFFECT_BEAM | LM_EFFECT_HEIGHT | LM_EFFECT_PALETTE,
                     now_us);
}

void lm_settings_restore(struct lm_unit *u)
{
    const struct lm_settings *kept = u->board->settings;
    u->is_restored = kept != NULL && lm_settings_are_sound(u, kept);
    if (u->is_restored) {
        struct lm_settings s = *kept;
        s.page[PICTURE] = LM_PICTURE_SECTOR;
        lm_settings_take(u, &s, LM_PAGE_BYTES, 0);
    }
}
