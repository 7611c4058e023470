/* What the operator selects by keys and what an instructor commands (lm/page.h).
 *
 * Invariant: every member of the page is in the range that lm/page.h gives it: format, mode, field
 * of view and scale that the mode has, width, gain, knob, window, gamma, palette, hidden labels.
 *
 * Proved, for the built-in radar, any page that keeps it and any command: it is kept; no
 * access outside an object, loops end; a command out of its range returns 0. A page after power-up
 * keeps it.
 *
 * Assumed: an automatic range steps by one. */
#include "lm/page.h"

#include "page_kept.h"

void prove_init(void)
{
    struct lm_page p;
    lm_page_init(&p, &lm_radar_default);
    PROVE(is_kept(&p));
}

void prove_command(void)
{
    struct lm_page p = a_page();
    const uint32_t which = nondet_u32();
    uint32_t effects = 0;
    bool is_sound = true;
    const int32_t a = nondet_i32(), b = nondet_i32();
    switch (which) {
    case 0:
        effects = lm_page_select_range(&p, a);
        break;
    case 1:
        effects = lm_page_select_azimuth(&p, a);
        is_sound = a >= 0 && a < LM_AZIMUTHS;
        break;
    case 2:
        effects = lm_page_select_sector(&p, a, b);
        is_sound = a >= 0 && a < LM_SECTOR_CHOICES && b >= 0 && b < LM_FOVS;
        break;
    case 3:
        effects = lm_page_set_gain(&p, a);
        is_sound = is_within(a, LM_GAIN_MAX_DB);
        break;
    case 4:
        effects = lm_page_set_knob(&p, a);
        is_sound = is_within(a, LM_FULL_DEFLECTION);
        break;
    case 5:
        effects = lm_page_step_range(&p, nondet_bool() ? 1 : -1);
        break;
    default:
        break;
    }
    PROVE(is_kept(&p) && (is_sound || effects == 0));
}
