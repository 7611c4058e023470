/* Keys that the operator presses on a page (lm/page.h).
 *
 * Invariant: that of `page`: every member of the page is in the range that lm/page.h gives it. The
 * kind of the picture, the kind of the track and the tilt are, too.
 *
 * Proved, for the built-in radar, any page that keeps it and any press of any button, short or
 * long: it is kept; no access outside an object, loops end. prove_bytes: a page taken from
 * bytes that pass the check keeps it, whatever they are.
 *
 * Assumed: writing the words of a label changes nothing else. */
#include "lm/page.h"
#include "lm/text.h"

#include "page_kept.h"

void lm_label_set(struct lm_label *label, const char *first, const char *second)
{
}

void lm_text_add(struct lm_text *text, const char *words)
{
}

void lm_text_number(struct lm_text *text, uint32_t number, uint32_t digits)
{
}

/* Each button has a page of its own, so that its format and the row of its key are constants. */
static void press_on(uint8_t format)
{
    const struct lm_page before = a_page();
    const uint8_t pressed = nondet_u8();
    const bool is_long = nondet_bool();
    for (uint8_t button = 1; button <= LM_BUTTONS; button++) {
        struct lm_page p = before;
        p.format = format;
        if (button == pressed) {
            (void)lm_page_press(&p, (struct lm_press){.button = button, .is_long = is_long});
            PROVE(is_kept(&p));
        }
    }
}

void prove_radar(void)
{
    press_on(LM_FORMAT_RADAR);
}

void prove_cntl(void)
{
    press_on(LM_FORMAT_CNTL);
}

void prove_bit(void)
{
    press_on(LM_FORMAT_BIT);
}

void prove_test(void)
{
    press_on(LM_FORMAT_TEST);
}

void prove_dclt(void)
{
    press_on(LM_FORMAT_DCLT);
}

void prove_style(void)
{
    const struct lm_page p = a_page();
    const uint8_t button = nondet_u8();
    ASSUME(button >= 1 && button <= LM_BUTTONS);
    PROVE(button <= LM_OSBS || lm_page_key_style(&p, button) == LM_KEY_REPEATS);
}

void prove_bytes(void)
{
    struct lm_page p = a_page();
    uint8_t byte[LM_PAGE_BYTES];
    for (uint32_t i = 0; i < LM_PAGE_BYTES; i++) {
        byte[i] = nondet_u8();
    }
    const bool is_whole = nondet_bool();
    if (lm_page_bytes_are_sound(&p, byte)) {
        lm_page_take(&p, byte, is_whole ? LM_PAGE_BYTES : LM_PAGE_SHARED_BYTES);
        PROVE(is_kept(&p));
    }
}
