#include "reader.h"

#include "hs/error.h"

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double farthest_m = 1e7;

static uint8_t byte_of(double share)
{
    return (uint8_t)lround(255 * fmin(fmax(share, 0), 1));
}

static uint8_t wrap_of(enum aiTextureMapMode mode)
{
    return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? VISUAL_WRAP_CLAMP
           : mode == aiTextureMapMode_Mirror                                ? VISUAL_WRAP_MIRROR
                                                                            : VISUAL_WRAP_REPEAT;
}

struct reading {
    const struct reader_job *job;
    const struct aiScene *scene;
    struct reader_head head;
    unsigned *channels; /* owned: of texture coordinates, by material */
    uint8_t (*rgb)[3];  /* owned: by material */
    FILE *out;
};

static void put_path(char *to, const struct reading *r, const char *name)
{
    const char *slash = strrchr(r->job->path, '/');
    const int folder = slash && name[0] != '/' ? (int)(slash - r->job->path) + 1 : 0;
    if (snprintf(to, VISUAL_PATH_SIZE, "%.*s%s", folder, r->job->path, name) >= VISUAL_PATH_SIZE) {
        snprintf(to, VISUAL_PATH_SIZE, "a name that is too long");
    }
    for (char *c = to; *c; c++) {
        *c = *c == '\\' ? '/' : *c;
    }
}

static void put_texture(struct visual_material *to, const struct reading *r,
                        const struct aiMaterial *from, unsigned *channel)
{
    struct aiString name;
    enum aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    if (aiGetMaterialTexture(from, aiTextureType_DIFFUSE, 0, &name, NULL, channel, NULL, NULL,
                             modes, NULL) != aiReturn_SUCCESS ||
        name.length == 0) {
        return;
    }
    to->wrap[0] = wrap_of(modes[0]);
    to->wrap[1] = wrap_of(modes[1]);
    for (unsigned i = 0; i < r->scene->mNumTextures; i++) {
        char number[16];
        snprintf(number, sizeof number, "*%u", i);
        if (strcmp(name.data, number) == 0 ||
            strcmp(name.data, r->scene->mTextures[i]->mFilename.data) == 0) {
            snprintf(to->texture, sizeof to->texture, "*%u", i);
            return;
        }
    }
    put_path(to->texture, r, name.data);
}

/* glTF's colours are linear, all others' are as a screen shows them. */
static bool is_linear(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && (strcasecmp(dot, ".gltf") == 0 || strcasecmp(dot, ".glb") == 0);
}

static double shown(double share, bool linear)
{
    return !linear              ? share
           : share <= 0.0031308 ? 12.92 * share
                                : 1.055 * pow(share, 1 / 2.4) - 0.055;
}

static bool put_materials(struct reading *r)
{
    const bool linear = is_linear(r->job->path);
    for (unsigned i = 0; i < r->scene->mNumMaterials; i++) {
        const struct aiMaterial *from = r->scene->mMaterials[i];
        struct visual_material to = {.name = ""};
        struct aiString name = {0};
        struct aiColor4D c = {0.7f, 0.7f, 0.7f, 1};
        aiGetMaterialString(from, AI_MATKEY_NAME, &name);
        snprintf(to.name, sizeof to.name, "%.*s", VISUAL_NAME_SIZE - 1, name.data);
        aiGetMaterialColor(from, AI_MATKEY_COLOR_DIFFUSE, &c);
        put_texture(&to, r, from, &r->channels[i]);
        r->rgb[i][0] = byte_of(shown((double)c.r, linear));
        r->rgb[i][1] = byte_of(shown((double)c.g, linear));
        r->rgb[i][2] = byte_of(shown((double)c.b, linear));
        if (fwrite(&to, sizeof to, 1, r->out) != 1) {
            return false;
        }
    }
    return true;
}

/* A corner in metres, z up. A model with y up looks along -z to the north. */
static bool put_corner(struct visual_triangle *t, int corner, struct aiVector3D p,
                       const struct reader_job *job)
{
    const double k = job->metres_per_unit;
    const double x = k * (double)p.x, y = k * (double)p.y, z = k * (double)p.z;
    t->x[corner] = (float)x;
    t->y[corner] = (float)(job->up == VISUAL_UP_Y ? -z : y);
    t->z[corner] = (float)(job->up == VISUAL_UP_Y ? y : z);
    return fabs(x) <= farthest_m && fabs(y) <= farthest_m && fabs(z) <= farthest_m;
}

static void put_colour(struct visual_triangle *t, const struct reading *r,
                       const struct aiMesh *mesh, const unsigned *corners)
{
    double sum[3] = {3, 3, 3};
    if (mesh->mColors[0]) {
        memset(sum, 0, sizeof sum);
        for (int i = 0; i < 3; i++) {
            const struct aiColor4D c = mesh->mColors[0][corners[i]];
            sum[0] += (double)c.r;
            sum[1] += (double)c.g;
            sum[2] += (double)c.b;
        }
    }
    for (int i = 0; i < 3; i++) {
        t->rgb[i] = byte_of(r->rgb[mesh->mMaterialIndex][i] / 255.0 * sum[i] / 3);
    }
}

static bool is_upright(const struct visual_triangle *t)
{
    const double ax = (double)t->x[1] - (double)t->x[0], ay = (double)t->y[1] - (double)t->y[0];
    const double bx = (double)t->x[2] - (double)t->x[0], by = (double)t->y[2] - (double)t->y[0];
    const double longest = fmax(hypot(ax, ay), hypot(bx, by));
    return fabs(ax * by - ay * bx) <= 1e-7 * longest * longest;
}

static bool put_triangle(struct reading *r, const struct aiMesh *mesh, const struct aiFace *face)
{
    struct visual_triangle t = {.material = mesh->mMaterialIndex};
    const unsigned channel = r->channels[mesh->mMaterialIndex];
    const struct aiVector3D *places =
        channel < AI_MAX_NUMBER_OF_TEXTURECOORDS ? mesh->mTextureCoords[channel] : NULL;
    bool is_near = true;
    for (int i = 0; i < 3; i++) {
        is_near = put_corner(&t, i, mesh->mVertices[face->mIndices[i]], r->job) && is_near;
        if (places) {
            t.u[i] = places[face->mIndices[i]].x;
            t.v[i] = places[face->mIndices[i]].y;
            is_near = is_near && isfinite(t.u[i]) && isfinite(t.v[i]);
        }
    }
    if (!is_near) {
        r->head.not_finite++;
        return true;
    }
    if (!r->job->keeps_walls && is_upright(&t)) {
        r->head.upright++;
        return true;
    }
    put_colour(&t, r, mesh, face->mIndices);
    r->head.triangle_count++;
    return fwrite(&t, sizeof t, 1, r->out) == 1;
}

static bool put_meshes(struct reading *r)
{
    for (unsigned m = 0; m < r->scene->mNumMeshes; m++) {
        const struct aiMesh *mesh = r->scene->mMeshes[m];
        for (unsigned f = 0; mesh->mMaterialIndex < r->scene->mNumMaterials && f < mesh->mNumFaces;
             f++) {
            if (mesh->mFaces[f].mNumIndices == 3 && !put_triangle(r, mesh, &mesh->mFaces[f])) {
                return false;
            }
        }
    }
    return true;
}

static bool put_embedded(struct reading *r)
{
    for (unsigned i = 0; i < r->scene->mNumTextures; i++) {
        const struct aiTexture *t = r->scene->mTextures[i];
        const uint64_t bytes = t->mHeight == 0 ? t->mWidth : 0; /* as a file; else bare pixels */
        if (fwrite(&bytes, sizeof bytes, 1, r->out) != 1 ||
            fwrite(t->pcData, 1, bytes, r->out) != bytes) {
            return false;
        }
    }
    r->head.embedded_count = r->scene->mNumTextures;
    return true;
}

static int count_faces(const struct reading *r)
{
    uint64_t faces = 0;
    for (unsigned m = 0; m < r->scene->mNumMeshes; m++) {
        faces += r->scene->mMeshes[m]->mNumFaces;
    }
    if (faces > VISUAL_TRIANGLES_MAX || r->scene->mNumMaterials > VISUAL_MATERIALS_MAX) {
        return hs_error(r->job->name, "cut it into several, or reduce it",
                        "has %llu triangles and %u materials; %d and %d are read",
                        (unsigned long long)faces, r->scene->mNumMaterials, VISUAL_TRIANGLES_MAX,
                        VISUAL_MATERIALS_MAX);
    }
    return faces > 0 ? 0 : hs_error(r->job->name, "export its surfaces", "has no surface");
}

static int write_all(struct reading *r)
{
    r->head.material_count = r->scene->mNumMaterials;
    r->channels = calloc(r->scene->mNumMaterials + 1, sizeof *r->channels);
    r->rgb = calloc(r->scene->mNumMaterials + 1, sizeof *r->rgb);
    r->out = fdopen(r->job->out_fd, "wb");
    const bool is_whole = r->channels && r->rgb && r->out &&
                          fwrite(&r->head, sizeof r->head, 1, r->out) == 1 && put_materials(r) &&
                          put_meshes(r) && put_embedded(r) && fseek(r->out, 0, SEEK_SET) == 0 &&
                          fwrite(&r->head, sizeof r->head, 1, r->out) == 1 && fflush(r->out) == 0;
    free(r->channels);
    free(r->rgb);
    return is_whole ? 0 : hs_error(r->job->name, "reduce the model", "out of memory");
}

/* Area times two as a vector: of a polygon, about its first corner. */
static struct aiVector3D area_of(const struct aiMesh *mesh, const struct aiFace *face)
{
    const struct aiVector3D *v = mesh->mVertices, o = v[face->mIndices[0]];
    double x = 0, y = 0, z = 0;
    for (unsigned i = 1; i + 1 < face->mNumIndices; i++) {
        const struct aiVector3D p = v[face->mIndices[i]], q = v[face->mIndices[i + 1]];
        const double px = (double)p.x - (double)o.x, py = (double)p.y - (double)o.y,
                     pz = (double)p.z - (double)o.z;
        const double qx = (double)q.x - (double)o.x, qy = (double)q.y - (double)o.y,
                     qz = (double)q.z - (double)o.z;
        x += py * qz - pz * qy;
        y += pz * qx - px * qz;
        z += px * qy - py * qx;
    }
    return (struct aiVector3D){(float)x, (float)y, (float)z};
}

/* A face before it is divided: its corners lie from `low` to `high`. */
struct outline {
    struct aiVector3D area;
    unsigned corners, low, high;
};

static double dot(struct aiVector3D a, struct aiVector3D b)
{
    return (double)a.x * (double)b.x + (double)a.y * (double)b.y + (double)a.z * (double)b.z;
}

static struct outline outline_of(const struct aiMesh *mesh, const struct aiFace *face)
{
    struct outline o = {.corners = face->mNumIndices, .low = UINT_MAX};
    for (unsigned i = 0; i < face->mNumIndices; i++) {
        o.low = face->mIndices[i] < o.low ? face->mIndices[i] : o.low;
        o.high = face->mIndices[i] > o.high ? face->mIndices[i] : o.high;
    }
    if (o.corners > 3) {
        o.area = area_of(mesh, face);
    }
    return o;
}

static bool is_part(const struct aiFace *face, const struct outline *o)
{
    bool is_inside = true;
    for (unsigned i = 0; i < face->mNumIndices; i++) {
        is_inside = is_inside && face->mIndices[i] >= o->low && face->mIndices[i] <= o->high;
    }
    return is_inside;
}

/* The triangles of a simple polygon all turn as it does, and their areas add up to its own. A
 * little is forgiven to rounded numbers, and the triangles below 1e-5 that Assimp leaves out.
 * Moves `*at` behind them. */
static bool is_filled(const struct aiMesh *mesh, unsigned *at, const struct outline *o)
{
    const double area = sqrt(dot(o->area, o->area)), little = 1e-4 * area + 2e-5 * o->corners;
    double sum = 0, least = 0;
    for (unsigned i = 0; i < o->corners - 2 && *at < mesh->mNumFaces; i++, ++*at) {
        if (!is_part(&mesh->mFaces[*at], o)) {
            break;
        }
        const struct aiVector3D own = area_of(mesh, &mesh->mFaces[*at]);
        const double part = area > 0 ? dot(own, o->area) / area : sqrt(dot(own, own));
        sum += part;
        least = fmin(least, part);
    }
    return least >= -little && fabs(sum - area) <= little;
}

/* Faces of the divided mesh that are not filled, or all when they cannot be told apart. */
static unsigned count_crossed(const struct aiMesh *mesh, const struct outline *outline,
                              unsigned count)
{
    unsigned at = 0, crossed = 0;
    for (unsigned f = 0; f < count; f++) {
        if (outline[f].corners > 3) {
            crossed += !is_filled(mesh, &at, &outline[f]);
        } else {
            at++;
        }
    }
    return at == mesh->mNumFaces ? crossed : count;
}

/* Divide faces into triangles, and count those for which that went wrong. */
static int divide_faces(struct reading *r)
{
    unsigned total = 0, at = 0;
    for (unsigned m = 0; m < r->scene->mNumMeshes; m++) {
        total += r->scene->mMeshes[m]->mNumFaces;
    }
    struct outline *outlines = calloc((size_t)total + 1, sizeof *outlines);
    unsigned *counts = calloc((size_t)r->scene->mNumMeshes + 1, sizeof *counts);
    for (unsigned m = 0; outlines && counts && m < r->scene->mNumMeshes; m++) {
        counts[m] = r->scene->mMeshes[m]->mNumFaces;
        for (unsigned f = 0; f < counts[m]; f++) {
            outlines[at++] = outline_of(r->scene->mMeshes[m], &r->scene->mMeshes[m]->mFaces[f]);
        }
    }
    r->scene = aiApplyPostProcessing(r->scene, aiProcess_Triangulate);
    at = 0;
    for (unsigned m = 0; r->scene && outlines && counts && m < r->scene->mNumMeshes; m++) {
        r->head.crossed += count_crossed(r->scene->mMeshes[m], outlines + at, counts[m]);
        at += counts[m];
    }
    const bool has_memory = outlines && counts;
    free(outlines);
    free(counts);
    return has_memory ? 0 : hs_error(r->job->name, "reduce the model", "out of memory");
}

static int import(struct reading *r)
{
    r->scene = aiImportFile(r->job->path, aiProcess_ValidateDataStructure);
    if (r->scene && divide_faces(r) != 0) {
        return -1;
    }
    if (r->scene) {
        r->scene = aiApplyPostProcessing(
            r->scene, aiProcess_SortByPType | aiProcess_PreTransformVertices |
                          aiProcess_TransformUVCoords | aiProcess_ValidateDataStructure);
    }
    return r->scene ? 0
                    : hs_error(r->job->name, "open it in a modelling program and save it anew",
                               "cannot be read: %s", aiGetErrorString());
}

int reader_assimp(void *context)
{
    struct reading r = {.job = context};
    return import(&r) == 0 && count_faces(&r) == 0 && write_all(&r) == 0 ? READER_DONE
                                                                         : READER_REPORTED;
}
