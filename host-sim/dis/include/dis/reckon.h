/* Dead reckoning: where an entity is some time after the PDU that told of it.
 *
 * Source of the models: IEEE Std 1278.1-2012, Annex E, DRM 1 to 9. The letters: F or R, the
 * orientation is fixed or rotates; P or V, the position has a rate alone, or its rate one too; W or
 * B, velocity and acceleration are along the axes of the world or of the body. The law of R with B
 * is the integral of rotating body axes:
 *
 *     place = place0 + R0^T (R1 v + R2 a),  R1 = int exp(W t) dt,  R2 = int t exp(W t) dt
 *
 * with W the cross product by the angular velocity. An algorithm that the standard does not have
 * stands still, as DRM 1. */
#ifndef DIS_RECKON_H
#define DIS_RECKON_H

#include "dis/pdu.h"

enum dis_algorithm {
    DIS_STATIC = 1,
    DIS_FPW,
    DIS_RPW,
    DIS_RVW,
    DIS_FVW,
    DIS_FPB,
    DIS_RPB,
    DIS_RVB,
    DIS_FVB
};

/* Of an instant, in geocentric axes. */
struct dis_state {
    double place_m[3], velocity_m_s[3];
    double acceleration_m_s2[3]; /* of body axes: turned with them, without what the turn adds */
    double forward[3];           /* unit vector along the body */
    double turn_rad_s[3];
};

/* `after_s` behind the PDU, 0 or more. */
struct dis_state dis_reckon(const struct dis_motion *motion, double after_s);

#endif
