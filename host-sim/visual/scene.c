#include "visual/scene.h"

#include "hs/class_table.h"
#include "hs/error.h"
#include "hs/progress.h"

#include <embree3/rtcore.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* File and folder of a path: files of one name in two folders are two pictures. */
static const char *short_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    while (slash && slash > path && slash[-1] != '/') {
        slash--;
    }
    return slash ? slash : path;
}

static void load_skin(struct visual_scene *s, const struct visual_material *m, const char *label)
{
    struct visual_skin *skin = &s->skins[s->skin_count++];
    *skin = (struct visual_skin){.wrap = {m->wrap[0], m->wrap[1]}};
    char name[VISUAL_PATCH_NAME_SIZE];
    if (!m->is_used) {
        return;
    }
    if (m->texture[0]) {
        const bool has_room = s->texture_bytes < (uint64_t)VISUAL_TEXTURE_MIB << 20;
        if (has_room && visual_texture_load(&skin->texture, m->texture) == 0) {
            s->texture_bytes += (uint64_t)skin->texture.width * (uint64_t)skin->texture.height * 5;
        } else if (s->lost_textures++ == 0) {
            snprintf(s->lost, sizeof s->lost, "%s", m->texture);
        }
    }
    if (skin->texture.width > 0) {
        snprintf(name, sizeof name, "%.*s", VISUAL_PATCH_NAME_SIZE - 1, short_name(m->texture));
    } else {
        snprintf(name, sizeof name, "%s%s%s", label, label[0] ? " " : "", m->name);
    }
    skin->patch = (uint16_t)visual_patch(s->patches, name[0] ? name : "unnamed");
}

int64_t visual_scene_skins(struct visual_scene *s, const struct visual_model *m, const char *label)
{
    const uint32_t first = s->skin_count, need = first + m->material_count;
    if (need > s->skin_room) {
        void *skins = realloc(s->skins, (size_t)need * 2 * sizeof *s->skins);
        if (!skins) {
            return hs_error(label, "reduce the model", "out of memory");
        }
        s->skins = skins;
        s->skin_room = 2 * need;
    }
    for (uint32_t i = 0; i < m->material_count; i++) {
        load_skin(s, &m->materials[i], label);
        if (m->materials[i].is_used && s->skins[s->skin_count - 1].patch == 0) {
            return hs_error(label, "import it in parts", "more than %d patches",
                            VISUAL_PATCHES_MAX);
        }
    }
    return first;
}

static int make_room(struct visual_scene *s, size_t more)
{
    const size_t need = s->facet_count + more;
    if (need > VISUAL_TRIANGLES_MAX) {
        return hs_error("--model", "import it in parts, or choose an --area",
                        "more than %d triangles", VISUAL_TRIANGLES_MAX);
    }
    if (need > s->facet_room) {
        void *facets = realloc(s->facets, (need + need / 2) * sizeof *s->facets);
        if (!facets) {
            return hs_error("--model", "import it in parts", "out of memory");
        }
        s->facets = facets;
        s->facet_room = need + need / 2;
    }
    return 0;
}

static struct visual_facet placed(const struct visual_triangle *t, const struct visual_place *p)
{
    struct visual_facet f = {.material = t->material};
    for (int i = 0; i < 3; i++) {
        const double e = (double)t->x[i], n = (double)t->y[i];
        f.x[i] = (float)(p->at[0] + p->by[0][0] * e + p->by[0][1] * n);
        f.y[i] = (float)(p->at[1] + p->by[1][0] * e + p->by[1][1] * n);
        f.z[i] = (float)(p->up + p->up_by * (double)t->z[i]);
        f.u[i] = t->u[i];
        f.v[i] = t->v[i];
        f.rgb[i] = t->rgb[i];
    }
    return f;
}

int visual_scene_place(struct visual_scene *s, const struct visual_model *m, uint32_t first_skin,
                       const struct visual_place *place, const uint8_t *class_of)
{
    if (make_room(s, m->triangle_count) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        struct visual_facet f = placed(&m->triangles[i], place);
        f.class_index = class_of[f.material];
        f.material += first_skin;
        s->facets[s->facet_count++] = f;
    }
    return 0;
}

/* A tree over some of the facets. */
struct look {
    const struct visual_scene *scene;
    RTCDevice device;
    RTCScene tree;
    uint32_t *facet_of; /* owned: of each triangle in the tree */
    uint32_t count;
    float from_z; /* above everything, and near it: Embree's distances are in single precision */
};

static bool fill_tree(const struct look *l, RTCGeometry g)
{
    float *at = rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12,
                                        3 * (size_t)l->count);
    uint32_t *corner =
        rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, l->count);
    for (uint32_t i = 0; at && corner && i < l->count; i++) {
        const struct visual_facet *f = &l->scene->facets[l->facet_of[i]];
        for (uint32_t k = 0; k < 3; k++) {
            const size_t v = 3 * (size_t)i + k;
            at[3 * v] = f->x[k];
            at[3 * v + 1] = f->y[k];
            at[3 * v + 2] = f->z[k];
            corner[v] = (uint32_t)v;
        }
    }
    return at && corner;
}

static void look_end(struct look *l)
{
    if (l->tree) {
        rtcReleaseScene(l->tree);
    }
    if (l->device) {
        rtcReleaseDevice(l->device);
    }
    free(l->facet_of);
}

static int look_begin(struct look *l, const bool *wants_class, const char *place)
{
    const struct visual_scene *s = l->scene;
    l->facet_of = malloc((s->facet_count + 1) * sizeof *l->facet_of);
    l->from_z = -INFINITY;
    for (uint32_t i = 0; l->facet_of && i < s->facet_count; i++) {
        if (!wants_class || wants_class[s->facets[i].class_index]) {
            l->facet_of[l->count++] = i;
            for (int k = 0; k < 3; k++) {
                l->from_z = fmaxf(l->from_z, s->facets[i].z[k] + 1);
            }
        }
    }
    if (l->count == 0) {
        return 0;
    }
    l->device = rtcNewDevice(NULL);
    l->tree = l->device ? rtcNewScene(l->device) : NULL;
    RTCGeometry g = l->tree ? rtcNewGeometry(l->device, RTC_GEOMETRY_TYPE_TRIANGLE) : NULL;
    const bool is_filled = g && fill_tree(l, g);
    if (is_filled) {
        rtcSetSceneFlags(l->tree, RTC_SCENE_FLAG_ROBUST);
        rtcCommitGeometry(g);
        rtcAttachGeometry(l->tree, g);
        rtcCommitScene(l->tree);
    }
    if (g) {
        rtcReleaseGeometry(g);
    }
    return is_filled && rtcGetDeviceError(l->device) == RTC_ERROR_NONE
               ? 0
               : hs_error(place, "reduce the model", "Embree cannot take it: out of memory");
}

static double area(const float *x, const float *y)
{
    return fabs(((double)x[1] - (double)x[0]) * ((double)y[2] - (double)y[0]) -
                ((double)x[2] - (double)x[0]) * ((double)y[1] - (double)y[0])) /
           2;
}

static double between(const float *a, const struct RTCRayHit *hit)
{
    const double u = (double)hit->hit.u, v = (double)hit->hit.v;
    return (1 - u - v) * (double)a[0] + u * (double)a[1] + v * (double)a[2];
}

/* The colour where a ray met a facet; its opacity is the fourth. A cell takes the level of the
 * texture whose pixels are about as large as it. */
static void colour(const struct look *l, const struct visual_facet *f, const struct RTCRayHit *hit,
                   uint8_t rgba[4])
{
    const struct visual_skin *skin = &l->scene->skins[f->material];
    const struct visual_texture *t = &skin->texture;
    memcpy(rgba, f->rgb, 3);
    rgba[3] = 255;
    if (t->width > 0) {
        const double pixels = area(f->u, f->v) * t->width * t->height;
        const double ratio = pixels / fmax(area(f->x, f->y), 1e-12);
        const int level = ratio > 1 ? (int)lround(fmin(0.5 * log2(ratio), 30)) : 0;
        memcpy(rgba,
               visual_texture_at(t, between(f->u, hit), between(f->v, hit), level, skin->wrap), 4);
    }
}

enum { LAYERS_MAX = 64 /* that are looked through in one cell */ };

/* The highest opaque surface at (x, y); NULL: none. */
static const struct visual_facet *look_at(const struct look *l, double x, double y,
                                          struct RTCRayHit *hit, uint8_t rgba[4])
{
    float below = 0;
    for (int i = 0; i < LAYERS_MAX; i++) {
        struct RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        *hit = (struct RTCRayHit){.ray = {.org_x = (float)x,
                                          .org_y = (float)y,
                                          .org_z = l->from_z,
                                          .dir_z = -1,
                                          .tnear = below,
                                          .tfar = INFINITY,
                                          .mask = UINT32_MAX},
                                  .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
        rtcIntersect1(l->tree, &context, hit);
        if (hit->hit.geomID == RTC_INVALID_GEOMETRY_ID) {
            return NULL;
        }
        const struct visual_facet *f = &l->scene->facets[l->facet_of[hit->hit.primID]];
        colour(l, f, hit, rgba);
        if (rgba[3] >= 128) {
            return f;
        }
        below = nextafterf(hit->ray.tfar, INFINITY);
    }
    return NULL;
}

static void look_row(const struct look *top, const struct look *ground, struct visual_canvas *c,
                     int y)
{
    struct RTCRayHit hit;
    uint8_t rgba[4];
    for (int x = 0; x < c->width; x++) {
        const size_t i = (size_t)y * (size_t)c->width + (size_t)x;
        const struct visual_facet *f = look_at(top, x + 0.5, y + 0.5, &hit, rgba);
        if (!f || between(f->z, &hit) <= (double)c->top[i]) {
            continue;
        }
        c->top[i] = (float)between(f->z, &hit);
        c->patch[i] = top->scene->skins[f->material].patch;
        c->classes[i] = f->class_index;
        for (int k = 0; k < 3; k++) {
            c->rgb[k][i] = rgba[k];
        }
        f = ground->count > 0 ? look_at(ground, x + 0.5, y + 0.5, &hit, rgba) : NULL;
        if (f) {
            c->ground[i] = (float)between(f->z, &hit);
        }
    }
}

int visual_scene_look(const struct visual_scene *s, struct visual_canvas *c,
                      const bool is_ground[256], const char *place)
{
    struct look top = {.scene = s}, ground = {.scene = s};
    int result = look_begin(&top, NULL, place);
    if (result == 0) {
        result = look_begin(&ground, is_ground, place);
    }
    if (result == 0 && top.count > 0) {
        struct hs_progress progress;
        hs_progress_begin(&progress, "look down", (uint64_t)c->height);
        for (int y = 0; y < c->height; y++) {
            look_row(&top, &ground, c, y);
            hs_progress_update(&progress, (uint64_t)y + 1);
        }
        hs_progress_end(&progress);
    }
    look_end(&top);
    look_end(&ground);
    return result;
}

void visual_scene_free(struct visual_scene *s)
{
    for (uint32_t i = 0; i < s->skin_count; i++) {
        visual_texture_free(&s->skins[i].texture);
    }
    free(s->facets);
    free(s->skins);
    *s = (struct visual_scene){.facets = NULL};
}
