#include "infrared/past_suns.h"

#include <math.h>

/* What is left, after so many seconds, of a stroke of heat on a half space that gives heat to the
 * air (Carslaw and Jaeger, 2.7). The exchange of 20 W/(m2 K) and the thermal inertia of 1200, which
 * set the rate, are UNSOURCED: those of a street in a light wind. */
static double left_after(double seconds)
{
    static const double rate = (20.0 / 1200) * (20.0 / 1200), pi = 3.14159265358979323846;
    const double root = sqrt(rate * seconds);
    return 1 / sqrt(pi * seconds) - sqrt(rate) * exp(root * root) * erfc(root);
}

int ir_past_suns(const struct ir_weather *w, double hour, struct ir_past_sun suns[IR_PAST_SUNS])
{
    int count = 0;
    double whole = 0;
    for (int i = 0; i < IR_PAST_SUNS; i++) {
        const double ago_h = i + 0.5;
        const struct ir_air air = ir_weather_at(w, hour - ago_h);
        if (air.sun[2] > 0 && air.beam_w_m2 > 0) {
            suns[count] =
                (struct ir_past_sun){{air.sun[0], air.sun[1], air.sun[2]},
                                     air.beam_w_m2 * air.sun[2] * left_after(3600 * ago_h)};
            whole += suns[count++].weight;
        }
    }
    for (int i = 0; i < count; i++) {
        suns[i].weight /= whole;
    }
    return count;
}
