/* Ray packets in the form in which Embree takes sixteen rays at once. */
#ifndef TRACER_EMBREE_PACKET_H
#define TRACER_EMBREE_PACKET_H

#include "tracer/scene.h"

#include <embree3/rtcore.h>

/* Rays of a packet are taken together: neighbours stay neighbours over some bounces, and even on a
 * tank, whose rays scatter, this takes half the time of taking them one by one (measured). */
struct RTCIntersectContext embree_context(void);

/* Fill a packet; lanes without a ray are masked out by `valid`. */
void embree_pack(const struct scene_rays *rays, struct RTCRayHit16 *packet,
                 int valid[SCENE_PACKET]);

#endif
