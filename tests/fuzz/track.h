/* The readers of landmass-nav behind one door. */
#ifndef FUZZ_TRACK_H
#define FUZZ_TRACK_H

#include "fuzz.h"
#include "nav/read_track.h"

/* Read the input as a track; complete it and send parts of it when it is one. Returns 0. */
int fuzz_track(const uint8_t *data, size_t size, enum nav_format format);

#endif
