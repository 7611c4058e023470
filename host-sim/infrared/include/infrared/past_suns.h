/* Past suns: where the sun stood in the last 24 hours, and how much of the warmth that its beam
 * left in level ground is still there. A place is as much colder as the suns that something hid. */
#ifndef INFRARED_PAST_SUNS_H
#define INFRARED_PAST_SUNS_H

#include "infrared/weather.h"

enum { IR_PAST_SUNS = 24 };

struct ir_past_sun {
    double direction[3]; /* unit vector: east, north, up, which is above 0 */
    double weight;       /* those of all sum to 1 */
};

/* Fill `suns` for an hour of the day, one an hour. Returns how many were up. */
int ir_past_suns(const struct ir_weather *w, double hour, struct ir_past_sun suns[IR_PAST_SUNS]);

#endif
