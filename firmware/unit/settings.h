/* Settings of a unit, given and taken (lm/settings.h). */
#ifndef LM_UNIT_SETTINGS_H
#define LM_UNIT_SETTINGS_H

#include "lm/unit.h"

/* lm_settings_give is in lm/unit.h. */

/* True if the page's bytes are sound and the cursor is on the earth. The other numbers are brought
 * into their range when they are taken. */
bool lm_settings_are_sound(const struct lm_unit *u, const struct lm_settings *s);

/* Take sound settings: the first `bytes` of the page, cursor and patch. A track ends. A patch is
 * drawn anew, seen from where it was seen; if that is refused, and if not, the sector begins. */
void lm_settings_take(struct lm_unit *u, const struct lm_settings *s, uint32_t bytes,
                      uint64_t now_us);

/* Take the board's settings, if it has any and they are sound. */
void lm_settings_restore(struct lm_unit *u);

#endif
