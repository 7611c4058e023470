/* Rays in the form that Embree takes eight of them at once. */
#ifndef TARGET_EMBREE_PACKET_H
#define TARGET_EMBREE_PACKET_H

#include "scene.h"

#include <embree3/rtcore.h>

struct RTCIntersectContext embree_context(bool is_parallel);

/* Fill a packet; unused lanes repeat the first ray and are masked out by `valid`. */
void embree_pack(const struct scene_rays *rays, struct RTCRayHit8 *packet, int valid[SCENE_PACKET]);

#endif
