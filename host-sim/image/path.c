#include "image/path.h"

#include "hs/angle.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

double image_path_apart_m(struct lm_position a, struct lm_position b)
{
    uint32_t distance_q8;
    fx_bam_t azimuth;
    lm_geo_inverse(a, b, &distance_q8, &azimuth);
    return distance_q8 / 256.0;
}

struct lm_position image_path_end(const struct lm_path_leg *leg)
{
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, (struct lm_position){leg->latitude, leg->longitude});
    return lm_geo_direct(&origin, leg->heading, (uint32_t)((uint64_t)leg->length_mm * 32 / 125));
}

/* lm_geo_inverse is good to 0.2 %, lm_geo_direct to centimetres: what the one misses by, the other
 * tells, and each round leaves the 0.2 % of that, and what meridians converge over the leg. */
int image_path_leg(struct lm_position from, struct lm_position to, struct lm_path_leg *leg)
{
    uint32_t distance_q8;
    fx_bam_t heading;
    lm_geo_inverse(from, to, &distance_q8, &heading);
    double length_m = distance_q8 / 256.0, turn = hs_degrees(heading) * pi / 180;
    *leg = (struct lm_path_leg){.latitude = from.latitude, .longitude = from.longitude};
    for (int round = 0; round < 12; round++) {
        if (!(length_m >= 1 && length_m <= LM_TARGET_LEG_MAX_M)) {
            return -1;
        }
        leg->heading = hs_bam(turn * 180 / pi);
        leg->length_mm = (uint32_t)lround(length_m * 1000);
        lm_geo_inverse(image_path_end(leg), to, &distance_q8, &heading);
        const double miss_m = distance_q8 / 256.0;
        const double off = hs_degrees(heading - leg->heading) * pi / 180;
        length_m += miss_m * cos(off);
        turn += miss_m * sin(off) / length_m;
    }
    return image_path_apart_m(image_path_end(leg), to) <= IMAGE_PATH_SLACK_M ? 0 : -1;
}
