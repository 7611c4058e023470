#include "tracer/scene.h"

#include "embree_packet.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

static void set_facet(struct scene *s, uint32_t i, const struct vec corners[3], uint8_t material)
{
    const struct vec w =
        vec_cross(vec_sub(corners[1], corners[0]), vec_sub(corners[2], corners[0]));
    const double length = vec_length(w);
    const struct vec normal = length > 0 ? vec_scale(w, 1 / length) : (struct vec){0, 0, 1};
    s->facets[i] = (struct scene_facet){normal, vec_dot(normal, corners[0])};
    s->facet_materials[i] = material;
}

static int take_materials(struct scene *s, const struct mesh *m, uint32_t *ground,
                          const char *place)
{
    s->material_count = m->material_count;
    memcpy(s->materials, m->materials, sizeof s->materials);
    if (s->ground_half_m <= 0) {
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

static int take_facets(struct scene *s, const struct mesh *m, const char *place)
{
    uint32_t ground = 0;
    if (take_materials(s, m, &ground, place) != 0) {
        return -1;
    }
    s->triangle_count = m->triangle_count;
    s->facet_count = m->triangle_count + (s->ground_half_m > 0);
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
    if (s->ground_half_m > 0) {
        s->facets[m->triangle_count] = (struct scene_facet){{0, 0, 1}, 0};
        s->facet_materials[m->triangle_count] = (uint8_t)ground;
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
static bool fill_geometry(struct scene *s, RTCGeometry geometry, const struct mesh *m)
{
    float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                              RTC_FORMAT_FLOAT3, 12, m->vertex_count);
    uint32_t *indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                RTC_FORMAT_UINT3, 12, m->triangle_count);
    if (!vertices || !indices) {
        return false;
    }
    for (uint32_t i = 0; i < m->vertex_count; i++) {
        put_float3(vertices + (size_t)i * 3, m->vertices[i]);
    }
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        memcpy(indices + (size_t)i * 3, m->triangles[i].corner, 12);
    }
    s->vertices = vertices;
    s->corners = indices;
    return true;
}

static int build_tree(struct scene *s, const struct mesh *m, const char *place)
{
    RTCDevice device = s->device = rtcNewDevice(NULL);
    if (!device) {
        return hs_error(place, NULL, "Embree does not start: error %d",
                        (int)rtcGetDeviceError(NULL));
    }
    RTCScene tree = s->tree = rtcNewScene(device);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    const bool is_filled = tree && geometry && fill_geometry(s, geometry, m);
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
    *s = (struct scene){.ground_half_m = fmax(ground_half_m, 0)};
    if (m->is_full) {
        return hs_error(place, "reduce the model", "out of memory");
    }
    mesh_bounds(m, &s->low, &s->high);
    if (take_facets(s, m, place) != 0 || build_tree(s, m, place) != 0) {
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

void embree_pack(const struct scene_rays *rays, struct RTCRayHit16 *packet, int valid[SCENE_PACKET])
{
    struct RTCRay16 *r = &packet->ray;
    memcpy(r->org_x, rays->from[0], sizeof r->org_x);
    memcpy(r->org_y, rays->from[1], sizeof r->org_y);
    memcpy(r->org_z, rays->from[2], sizeof r->org_z);
    memcpy(r->dir_x, rays->along[0], sizeof r->dir_x);
    memcpy(r->dir_y, rays->along[1], sizeof r->dir_y);
    memcpy(r->dir_z, rays->along[2], sizeof r->dir_z);
    for (uint32_t i = 0; i < SCENE_PACKET; i++) {
        valid[i] = i < rays->count ? -1 : 0;
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

/* How far ray i goes until it meets the ground; INFINITY when it does not. */
static float way_to_ground_m(const struct scene *s, const struct scene_rays *rays, uint32_t i)
{
    const double height_m = (double)rays->from[2][i], climb = (double)rays->along[2][i];
    if (!(height_m * climb < 0)) {
        return INFINITY; /* level, or going away from it */
    }
    const double way_m = -height_m / climb;
    const double x = (double)rays->from[0][i] + way_m * (double)rays->along[0][i];
    const double y = (double)rays->from[1][i] + way_m * (double)rays->along[1][i];
    return fabs(x) <= s->ground_half_m && fabs(y) <= s->ground_half_m ? (float)way_m : INFINITY;
}

void scene_corners(const struct scene *s, uint32_t triangle, struct vec corners[3])
{
    for (int i = 0; i < 3; i++) {
        const float *v = s->vertices + 3 * (size_t)s->corners[3 * (size_t)triangle + (size_t)i];
        corners[i] = (struct vec){(double)v[0], (double)v[1], (double)v[2]};
    }
}

void scene_meet(const struct scene *s, const struct scene_rays *rays, uint32_t facets[SCENE_PACKET])
{
    struct RTCIntersectContext context = embree_context();
    _Alignas(64) int valid[SCENE_PACKET];
    struct RTCRayHit16 packet;
    embree_pack(rays, &packet, valid);
    for (uint32_t i = 0; i < rays->count; i++) {
        packet.ray.tfar[i] = way_to_ground_m(s, rays, i);
        facets[i] = isfinite(packet.ray.tfar[i]) ? s->facet_count - 1 : SCENE_MISS;
    }
    rtcIntersect16(valid, s->tree, &context, &packet);
    for (uint32_t i = 0; i < rays->count; i++) {
        if (packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID) {
            facets[i] = packet.hit.primID[i];
        }
    }
}

uint32_t scene_is_blocked(const struct scene *s, const struct scene_rays *rays)
{
    struct RTCIntersectContext context = embree_context();
    _Alignas(64) int valid[SCENE_PACKET];
    struct RTCRayHit16 packet;
    embree_pack(rays, &packet, valid);
    rtcOccluded16(valid, s->tree, &context, &packet.ray);
    uint32_t blocked = 0;
    for (uint32_t i = 0; i < rays->count; i++) {
        const bool is_hit = packet.ray.tfar[i] < 0; /* Embree sets it to -infinity */
        const bool is_under = isfinite(way_to_ground_m(s, rays, i));
        blocked |= (uint32_t)(is_hit || is_under) << i;
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
