/* Window of the bench on the PC's screen (SDL2): bezel, display, mouse and keyboard. */
#ifndef SIM_WINDOW_H
#define SIM_WINDOW_H

#include "sim/bezel.h"
#include "sim/hands.h"

#include <stdbool.h>
#include <stdint.h>

struct window; /* opaque */

/* Open a window of the bezel's size, which the user may change. What he does in it goes to `hands`,
 * which is borrowed. NULL, with the reason reported as a warning, when there is no screen. */
struct window *window_open(const struct bezel *bezel, struct hands *hands);
void window_close(struct window *w); /* NULL is fine */

/* Take what the user did. Returns false when he has closed the window or pressed Escape. */
bool window_poll(struct window *w);

/* Show a picture of the bezel's size. */
void window_show(struct window *w, const uint32_t *pixels);

/* The keys, for --help. */
extern const char window_keys_help[];

#endif
