/* Traced records known in closed form, for tests of what is built on them without a tracer. Psi is
 * the depression; the radar stands in the direction (0, -cos psi, sin psi) of across, away, up.
 * Cells are 0.1 m, the wavelength 0.03125 m, the picture is large enough for all echoes. */
#ifndef KNOWN_RECORDS_H
#define KNOWN_RECORDS_H

#include "tracer/records.h"

/* A level plate of material 0 "metal", side_m across and away, its middle at the origin, under a
 * plane of rays * rays that just covers it. One bounce: theta1 = theta2 = 90 degrees - psi, theta4
 * = 0, range = away * cos psi. */
void known_plate(struct trace_records *r, double side_m, double depression_deg, uint32_t rays);

/* A dihedral, side_m across: an upright wall of material 0 "metal", height_m high, at away = 0, and
 * before it a floor of material 1 "floor", as deep as the wall's light reaches: height / tan psi.
 * The plane of rays * rays (`rays` even) just covers both; its upper half meets the wall.
 *   Bounce 1: wall theta1 = psi, range = -up * sin psi; floor theta1 = 90 - psi, range = away * cos
 *   psi. Both before the seam, one over the other.
 *   Bounce 2: each ray meets the other surface, with theta1 = theta2 = that surface's own angle and
 *   theta4 = twice it. All echoes lie in the seam: range 0. */
void known_dihedral(struct trace_records *r, double side_m, double height_m, double depression_deg,
                    uint32_t rays);

#endif
