/* Rows of one bounce side by side, so that a network can be asked for all of them at once, after
 * those of the bounce before. */
#ifndef NETEM_BOUNCE_ORDER_H
#define NETEM_BOUNCE_ORDER_H

#include "netem/paths.h"

/* Gives the rows of paths with `from` other numbers, in order of their bounces, and says in `until`
 * where each bounce ends. A row's `from` has a lower number on entry and on return. Returns 0, or
 * -1 out of memory, reported. */
int nm_paths_order(struct nm_paths *paths);

#endif
