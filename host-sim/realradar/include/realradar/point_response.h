/* Point response, measured on cuts through a point: width of the main lobe at half power (IRW),
 * highest sidelobe (PSLR), energy outside the main lobe (ISLR). */
#ifndef REALRADAR_POINT_RESPONSE_H
#define REALRADAR_POINT_RESPONSE_H

#include "realradar/backproject.h"

/* A cut reaches 8 resolution cells to either side, in steps of 1/32 cell. */
enum { RR_CUT_CELLS = 8, RR_CUT_STEPS = 32, RR_CUT_SIZE = 2 * RR_CUT_CELLS * RR_CUT_STEPS + 1 };

struct rr_cut {
    double power[RR_CUT_SIZE]; /* the point itself in the middle */
    double irw_cells;          /* in the textbook cells of rr_resolution */
    double pslr_db;            /* highest lobe outside the main one over the peak, negative */
    double islr_db;            /* energy outside the main lobe over that inside it */
};

struct rr_response {
    struct rr_place place; /* of the peak, on the ground */
    double power;
    struct rr_cut range, cross;
};

/* Measure the cut whose `power` is filled in. The main lobe ends at the first minimum on each side.
 */
void rr_cut_measure(struct rr_cut *cut);

/* Find the peak within about a cell of `near` and measure both cuts through it. */
void rr_response_measure(struct rr_response *response, const struct rr_profiles *profiles,
                         const struct rr_resolution *resolution, struct rr_place near);

/* The brightest isolated points of a picture, brightest first: nothing within 6 m, outside the two
 * cells of the main and first sidelobes, comes within 14 dB of the point. Returns how many of
 * `most` there are. Cost: a few passes over the picture. */
int rr_find_reflectors(const struct rr_image *image, const struct rr_resolution *resolution,
                       struct rr_place *found, int most);

#endif
