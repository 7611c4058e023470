/* Squint: the picture of a radar that does not look square to its flight.
 *
 * A picture's second axis is where the line of sight turns to as the radar flies on: the part of
 * the flight's direction v that is square to the sight s, c = v - (v s) s. Square to the flight it
 * is level, and what stands up leans towards the radar alone. With squint it is not, and what
 * stands up leans along it too. So does level ground, which appears turned in the picture. */
#ifndef TRACER_SQUINT_H
#define TRACER_SQUINT_H

#include "tracer/records.h"
#include "tracer/vec.h"

/* The direction c, of unit length, in axes across, away, up. The radar flies level and has what it
 * looks at on its left; squint is positive when that is ahead. */
struct vec squint_axis(double squint_deg, double depression_deg);

/* Move the echoes of all records to where they lie along c: across_m becomes the mean of the places
 * where a ray left the plane and came back to it, along c. What it needs of the height follows from
 * the records. Rays are those of the picture without squint: a corner of the ground is missing. */
void squint_records(struct trace_records *r, double squint_deg);

#endif
