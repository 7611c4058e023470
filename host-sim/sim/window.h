/* The glass as a window on the PC's screen (SDL2). */
#ifndef SIM_WINDOW_H
#define SIM_WINDOW_H

#include <stdbool.h>
#include <stdint.h>

struct window; /* opaque */

/* Open a window of that size. NULL, with the reason reported as a warning, when there is no screen.
 */
struct window *window_open(uint16_t width_px, uint16_t height_px);
void window_close(struct window *w); /* NULL is fine */

/* Show the picture. Returns false when the user has closed the window or pressed Escape. */
bool window_show(struct window *w, const uint32_t *pixels);

#endif
