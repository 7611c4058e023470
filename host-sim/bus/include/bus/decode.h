/* Decoder of a recorded bus: a log in, readable lines out. */
#ifndef BUS_DECODE_H
#define BUS_DECODE_H

#include "lm/bus_profile.h"

#include <stdio.h>

/* Write a line for each frame of the candump log `in`, called `path` in messages: what it means by
 * the profile, or why the display does not take it; then a summary of remarks. Returns 0, or -1
 * with the error reported. Lines that are no frames are reported and passed over. */
int bus_decode(FILE *out, FILE *in, const char *path, const struct lm_bus_profile *profile);

#endif
