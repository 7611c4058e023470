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

/* What the user wants of a recording that is shown. */
struct window_player {
    bool is_paused;
    double speed;   /* 1: as fast as it was flown; 1/64..64 */
    int32_t jump_s; /* wanted jump, forward or back; whoever jumps sets it to 0 */
};

/* From now on keys and mouse serve the player, which is borrowed, and nothing is operated. */
void window_watch(struct window *w, struct window_player *player);

/* The keys, for --help. */
extern const char window_player_help[];
extern const char window_keys_help[];

#endif
