#include "tracer/embree_baseline.h"

#include "embree_packet.h"

#include <stdlib.h>

struct embree_baseline_packet {
    struct RTCRayHit16 rays;
    _Alignas(64) int valid[SCENE_PACKET];
    bool is_shadow;
};

static void keep_packet(struct embree_baseline_rays *b, const struct scene_rays *rays,
                        bool is_shadow)
{
    if (b->count == b->room) {
        const size_t room = b->room > 0 ? 2 * b->room : 4096;
        struct embree_baseline_packet *larger =
            aligned_alloc(64, (room * sizeof *larger + 63) / 64 * 64);
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
    struct embree_baseline_packet *p = &b->packets[b->count++];
    embree_pack(rays, &p->rays, p->valid);
    p->is_shadow = is_shadow;
}

void embree_baseline_keep(struct embree_baseline_rays *b, struct vec from, struct vec along,
                          bool is_shadow)
{
    struct scene_rays *pending = &b->pending[is_shadow];
    scene_rays_add(pending, from, along);
    if (pending->count == SCENE_PACKET) {
        keep_packet(b, pending, is_shadow);
        pending->count = 0;
    }
}

void embree_baseline_flush(struct embree_baseline_rays *b)
{
    for (int is_shadow = 0; is_shadow < 2; is_shadow++) {
        if (b->pending[is_shadow].count > 0) {
            keep_packet(b, &b->pending[is_shadow], is_shadow);
        }
        b->pending[is_shadow].count = 0;
    }
}

size_t embree_baseline_cast(const struct scene *s, const struct embree_baseline_rays *b,
                            size_t first, size_t end)
{
    size_t met = 0;
    for (size_t i = first; i < end; i++) {
        const struct embree_baseline_packet *p = &b->packets[i];
        struct RTCIntersectContext context = embree_context();
        struct RTCRayHit16 rays = p->rays; /* Embree writes into it */
        if (p->is_shadow) {
            rtcOccluded16(p->valid, s->tree, &context, &rays.ray);
            met += rays.ray.tfar[0] < 0;
        } else {
            rtcIntersect16(p->valid, s->tree, &context, &rays);
            met += rays.hit.geomID[0] != RTC_INVALID_GEOMETRY_ID;
        }
    }
    return met;
}

void embree_baseline_free(struct embree_baseline_rays *b)
{
    free(b->packets);
    *b = (struct embree_baseline_rays){0};
}
