/* Flight simulator as the source of landmass-nav. */
#ifndef NAV_PROGRAM_SIMULATOR_H
#define NAV_PROGRAM_SIMULATOR_H

#include "options.h"

/* Send what the simulator of the command flies, until --seconds are over or a signal ends the
 * program; report. Returns 0, or -1 with the error reported: a port or an interface that cannot be
 * used, a log that cannot be written, or no usable datagram at all. */
int nav_fly_simulator(const struct command *c);

#endif
