/* The built-in scene: land, and everything painted on it. */
#ifndef SCENE_H
#define SCENE_H

#include "scene/painting.h"

/* All of it. Returns 0, or -1 when memory is short (reported). `size` and `cell_m` are set and
 * within the limits of the command line. */
int scene_make(struct scene *s);
void scene_free(struct scene *s);

#endif
