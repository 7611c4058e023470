/* Path of a moving target: its legs between places, ending where the firmware will end them. */
#ifndef IMAGE_PATH_H
#define IMAGE_PATH_H

#include "lm/geo.h"
#include "lm/target.h"

/* How far from its place a leg may end: what the firmware's steps of length and heading leave. */
#define IMAGE_PATH_SLACK_M 0.1

/* The leg from one place to another, ending there as lm_geo_direct goes it. Returns 0, or -1 when
 * it is shorter than 1 m, longer than LM_TARGET_LEG_MAX_M, or goes over a pole. */
int image_path_leg(struct lm_position from, struct lm_position to, struct lm_path_leg *leg);

/* Where a leg ends. */
struct lm_position image_path_end(const struct lm_path_leg *leg);

/* Metres between two places that are near each other. */
double image_path_apart_m(struct lm_position a, struct lm_position b);

#endif
