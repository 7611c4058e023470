#include "bare.h"

#include "embree_packet.h"

#include <stdlib.h>

struct bare_packet {
    struct RTCRayHit8 rays;
    _Alignas(32) int valid[SCENE_PACKET];
    bool is_shadow;
};

void bare_keep(struct bare_rays *b, const struct scene_rays *rays, bool is_shadow)
{
    if (b->count == b->room) {
        const size_t room = b->room > 0 ? 2 * b->room : 4096;
        struct bare_packet *larger = aligned_alloc(64, (room * sizeof *larger + 63) / 64 * 64);
        if (!larger) {
            b->is_out_of_memory = true;
            return;
        }
        for (size_t i = 0; i < b->count; i++) {
            larger[i] = b->packets[i];
        }
        free(b->packets);
        b->packets = larger;
        b->room = room;
    }
    struct bare_packet *p = &b->packets[b->count++];
    embree_pack(rays, &p->rays, p->valid);
    p->is_shadow = is_shadow;
}

size_t bare_cast(const struct scene *s, const struct bare_rays *b, size_t first, size_t end)
{
    size_t met = 0;
    for (size_t i = first; i < end; i++) {
        const struct bare_packet *p = &b->packets[i];
        struct RTCIntersectContext context = embree_context();
        struct RTCRayHit8 rays = p->rays; /* Embree writes into it */
        if (p->is_shadow) {
            rtcOccluded8(p->valid, s->tree, &context, &rays.ray);
            met += rays.ray.tfar[0] < 0;
        } else {
            rtcIntersect8(p->valid, s->tree, &context, &rays);
            met += rays.hit.geomID[0] != RTC_INVALID_GEOMETRY_ID;
        }
    }
    return met;
}

void bare_free(struct bare_rays *b)
{
    free(b->packets);
    *b = (struct bare_rays){0};
}
