#include "scene.h"

#include "embree_packet.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

static bool has_ground(double ground_half_m)
{
    return ground_half_m > 0;
}

/* Corner i of the ground: counter-clockwise from above. */
static struct vec ground_corner(uint32_t i, double half_m)
{
    return (struct vec){i == 1 || i == 2 ? half_m : -half_m, i >= 2 ? half_m : -half_m, 0};
}

static void set_facet(struct scene *s, uint32_t i, const struct vec corners[3], uint8_t material)
{
    const struct vec w =
        vec_cross(vec_sub(corners[1], corners[0]), vec_sub(corners[2], corners[0]));
    const double length = vec_length(w);
    const struct vec normal = length > 0 ? vec_scale(w, 1 / length) : (struct vec){0, 0, 1};
    s->facets[i] = (struct scene_facet){normal, vec_dot(normal, corners[0])};
    s->facet_materials[i] = material;
}

static int take_materials(struct scene *s, const struct mesh *m, double ground_half_m,
                          uint32_t *ground, const char *place)
{
    s->material_count = m->material_count;
    memcpy(s->materials, m->materials, sizeof s->materials);
    if (!has_ground(ground_half_m)) {
        return 0;
    }
    struct mesh names = {.material_count = m->material_count};
    memcpy(names.materials, m->materials, sizeof names.materials);
    *ground = mesh_material(&names, "ground");
    if (*ground == TRACE_MATERIALS_MAX) {
        return hs_error(place, "use at most 31 materials", "no room for the ground's material");
    }
    s->material_count = names.material_count;
    memcpy(s->materials, names.materials, sizeof s->materials);
    return 0;
}

static int take_facets(struct scene *s, const struct mesh *m, double ground_half_m,
                       const char *place)
{
    uint32_t ground = 0;
    if (take_materials(s, m, ground_half_m, &ground, place) != 0) {
        return -1;
    }
    s->facet_count = m->triangle_count + (has_ground(ground_half_m) ? 2 : 0);
    s->facets = malloc(s->facet_count * sizeof *s->facets);
    s->facet_materials = malloc(s->facet_count);
    if (!s->facets || !s->facet_materials) {
        return hs_error(place, "reduce the model", "out of memory");
    }
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        const uint32_t *c = m->triangles[i].corner;
        const struct vec corners[3] = {m->vertices[c[0]], m->vertices[c[1]], m->vertices[c[2]]};
        set_facet(s, i, corners, (uint8_t)m->triangles[i].material);
    }
    for (uint32_t i = m->triangle_count; i < s->facet_count; i++) {
        const uint32_t half = i - m->triangle_count;
        const struct vec corners[3] = {ground_corner(0, ground_half_m),
                                       ground_corner(half + 1, ground_half_m),
                                       ground_corner(half + 2, ground_half_m)};
        set_facet(s, i, corners, (uint8_t)ground);
    }
    return 0;
}

static void put_float3(float *to, struct vec v)
{
    to[0] = (float)v.x;
    to[1] = (float)v.y;
    to[2] = (float)v.z;
}

/* Embree's own copy of the triangles, in single precision. Embree's memory is zeroed by nobody. */
static bool fill_geometry(RTCGeometry geometry, const struct scene *s, const struct mesh *m,
                          double ground_half_m)
{
    const uint32_t extra = has_ground(ground_half_m) ? 4 : 0;
    float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                              RTC_FORMAT_FLOAT3, 12, m->vertex_count + extra);
    uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                RTC_FORMAT_UINT3, 12, s->facet_count);
    if (!vertices || !indices) {
        return false;
    }
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        put_float3(vertices + (size_t)i * 3, m->vertices[i]);
    }
    for (uint32_t i = 0; i < extra; i++) {
        put_float3(vertices + ((size_t)m->vertex_count + i) * 3, ground_corner(i, ground_half_m));
    }
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        memcpy(indices + (size_t)i * 3, m->triangles[i].corner, 12);
    }
    for (uint32_t i = m->triangle_count; i < s->facet_count; i++) {
        const uint32_t half = i - m->triangle_count;
        const uint32_t corners[3] = {m->vertex_count, m->vertex_count + half + 1,
                                     m->vertex_count + half + 2};
        memcpy(indices + (size_t)i * 3, corners, 12);
    }
    return true;
}

static int build_tree(struct scene *s, const struct mesh *m, double ground_half_m,
                      const char *place)
{
    RTCDevice device = s->device = rtcNewDevice(NULL);
    if (!device) {
        return hs_error(place, NULL, "Embree does not start: error %d",
                        (int)rtcGetDeviceError(NULL));
    }
    RTCScene tree = s->tree = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const bool is_filled = tree && geometry && fill_geometry(geometry, s, m, ground_half_m);
    if (is_filled) {
        rtcSetSceneFlags(tree, RTC_SCENE_FLAG_ROBUST); /* no ray slips through an edge */
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(tree, geometry);
        rtcCommitScene(tree);
    }
    rtcReleaseGeometry(geometry);
    const int fault = (int)rtcGetDeviceError(device);
    return is_filled && fault == RTC_ERROR_NONE
               ? 0
               : hs_error(place, "reduce the model", "Embree cannot take it: error %d", fault);
}

int scene_open(struct scene *s, const struct mesh *m, double ground_half_m, const char *place)
{
    *s = (struct scene){0};
    if (m->is_full) {
        return hs_error(place, "reduce the model", "out of memory");
    }
    mesh_bounds(m, &s->low, &s->high);
    if (take_facets(s, m, ground_half_m, place) != 0 ||
        build_tree(s, m, ground_half_m, place) != 0) {
        scene_close(s);
        return -1;
    }
    return 0;
}

struct RTCIntersectContext embree_context(void)
{
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    return context;
}

void embree_pack(const struct scene_rays *rays, struct RTCRayHit8 *packet, int valid[SCENE_PACKET])
{
    struct RTCRay8 *r = &packet->ray;
    for (uint32_t i = 0; i < SCENE_PACKET; i++) {
        const uint32_t k = i < rays->count ? i : 0;
        valid[i] = i < rays->count ? -1 : 0;
        r->org_x[i] = (float)rays->from[k].x;
        r->org_y[i] = (float)rays->from[k].y;
        r->org_z[i] = (float)rays->from[k].z;
        r->dir_x[i] = (float)rays->along[k].x;
        r->dir_y[i] = (float)rays->along[k].y;
        r->dir_z[i] = (float)rays->along[k].z;
        r->tnear[i] = 0;
        r->tfar[i] = INFINITY;
        r->time[i] = 0;
        r->mask[i] = UINT32_MAX;
        r->id[i] = i;
        r->flags[i] = 0;
        packet->hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
        packet->hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
    }
}

void scene_meet(const struct scene *s, const struct scene_rays *rays, uint32_t facets[SCENE_PACKET])
{
    struct RTCIntersectContext context = embree_context();
    _Alignas(32) int valid[SCENE_PACKET];
    struct RTCRayHit8 packet;
    embree_pack(rays, &packet, valid);
    rtcIntersect8(valid, s->tree, &context, &packet);
    for (uint32_t i = 0; i < rays->count; i++) {
        facets[i] =
            packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID ? SCENE_MISS : packet.hit.primID[i];
    }
}

uint32_t scene_is_blocked(const struct scene *s, const struct scene_rays *rays)
{
    struct RTCIntersectContext context = embree_context();
    _Alignas(32) int valid[SCENE_PACKET];
    struct RTCRayHit8 packet;
    embree_pack(rays, &packet, valid);
    rtcOccluded8(valid, s->tree, &context, &packet.ray);
    uint32_t blocked = 0;
    for (uint32_t i = 0; i < rays->count; i++) {
        blocked |= (uint32_t)(packet.ray.tfar[i] < 0) << i; /* Embree sets it to -infinity */
    }
    return blocked;
}

void scene_close(struct scene *s)
{
    if (s->tree) {
        rtcReleaseScene(s->tree);
    }
    if (s->device) {
        rtcReleaseDevice(s->device);
    }
    free(s->facets);
    free(s->facet_materials);
    *s = (struct scene){0};
}
