#include "visual/model.h"

#include "obj_check.h"
#include "reader.h"

#include "hs/error.h"

#include <assimp/cimport.h>
#include <cpl_conv.h>
#include <cpl_vsi.h>
#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

enum { MODEL_BYTES_MAX = 1 << 30 /* of a file, also of one in an archive */ };

/* Kinds of files that say themselves how long a unit is and what is up, as their readers hand it
 * on. */
static const struct kind {
    const char *ending;
    enum visual_up up;
} kinds[] = {
    {".gltf", VISUAL_UP_Y}, {".glb", VISUAL_UP_Y}, {".dae", VISUAL_UP_Y}, {".flt", VISUAL_UP_Z}};

static const char *ending_of(const char *path)
{
    const char *dot = strrchr(path, '.');
    return dot && !strchr(dot, '/') ? dot : "";
}

static bool is_openflight(const char *path)
{
    return strcasecmp(ending_of(path), ".flt") == 0;
}

static const struct kind *kind_of(const char *path)
{
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        if (strcasecmp(ending_of(path), kinds[i].ending) == 0) {
            return &kinds[i];
        }
    }
    return NULL;
}

bool visual_model_says_axes(const char *path)
{
    return kind_of(path) != NULL;
}

static int choose_axes(struct reader_job *job, const struct visual_axes *axes)
{
    const bool is_given = axes->metres_per_unit > 0 || axes->up != VISUAL_UP_UNKNOWN;
    const struct kind *kind = kind_of(job->path);
    if (kind) {
        job->metres_per_unit = 1;
        job->up = kind->up;
        return is_given ? hs_error(job->name, "leave out --unit and --up",
                                   "says itself how long its unit is and what is up")
                        : 0;
    }
    if (!aiIsExtensionSupported(ending_of(job->path))) {
        return hs_error(job->name, "convert it to glTF, Collada, OBJ or OpenFlight (.flt)",
                        "is no kind of model that is read");
    }
    job->metres_per_unit = axes->metres_per_unit;
    job->up = axes->up;
    return axes->metres_per_unit > 0 && axes->up != VISUAL_UP_UNKNOWN
               ? 0
               : hs_error(job->name, "say it with --unit m|cm|mm|ft|us-ft|in and --up y|z",
                          "does not say how long its unit is or what is up");
}

/* A reader's file, believed only as far as its length goes. */
struct taking {
    const uint8_t *bytes;
    uint64_t left;
};

static bool take(struct taking *t, void *to, uint64_t bytes)
{
    if (bytes > t->left) {
        return false;
    }
    memcpy(to, t->bytes, bytes);
    t->bytes += bytes;
    t->left -= bytes;
    return true;
}

static bool take_embedded(struct visual_model *m, struct taking *t, const char *path)
{
    static uint32_t number;
    const char *slash = strrchr(path, '/');
    m->embedded_names = calloc(m->embedded_count + 1, sizeof *m->embedded_names);
    m->embedded = malloc(t->left + 1);
    uint8_t *to = m->embedded;
    const uint32_t count = m->embedded_count;
    m->embedded_count = 0;
    for (uint32_t i = 0; m->embedded_names && to && i < count; i++) {
        uint64_t bytes;
        if (!take(t, &bytes, sizeof bytes) || !take(t, to, bytes)) {
            return false;
        }
        char *name = m->embedded_names[m->embedded_count++];
        snprintf(name, VISUAL_NAME_SIZE, "/vsimem/%u-%.32s/texture-%u", number++,
                 slash ? slash + 1 : path, i);
        VSIFCloseL(VSIFileFromMemBuffer(name, to, bytes, 0));
        to += bytes;
    }
    return m->embedded_names && m->embedded;
}

/* Names of embedded textures, "*3", become those under which GDAL finds them. */
static void name_embedded(struct visual_model *m)
{
    for (uint32_t i = 0; i < m->material_count; i++) {
        struct visual_material *material = &m->materials[i];
        material->name[VISUAL_NAME_SIZE - 1] = '\0';
        material->texture[VISUAL_PATH_SIZE - 1] = '\0';
        const unsigned long at =
            material->texture[0] == '*' ? strtoul(material->texture + 1, NULL, 10) : UINT32_MAX;
        if (at < m->embedded_count) {
            snprintf(material->texture, VISUAL_PATH_SIZE, "%s", m->embedded_names[at]);
        }
    }
}

static bool take_model(struct visual_model *m, struct taking *t, const char *path)
{
    struct reader_head head;
    if (!take(t, &head, sizeof head) || head.triangle_count > VISUAL_TRIANGLES_MAX ||
        head.material_count > VISUAL_MATERIALS_MAX || head.embedded_count > VISUAL_MATERIALS_MAX) {
        return false;
    }
    m->triangle_count = head.triangle_count;
    m->material_count = head.material_count;
    m->embedded_count = head.embedded_count;
    m->upright = head.upright;
    m->not_finite = head.not_finite;
    m->crossed = head.crossed;
    m->triangles = malloc((size_t)m->triangle_count * sizeof *m->triangles + 1);
    m->materials = malloc((size_t)m->material_count * sizeof *m->materials + 1);
    if (!m->triangles || !m->materials ||
        !take(t, m->materials, (uint64_t)m->material_count * sizeof *m->materials) ||
        !take(t, m->triangles, (uint64_t)m->triangle_count * sizeof *m->triangles) ||
        !take_embedded(m, t, path)) {
        return false;
    }
    for (uint32_t i = 0; i < m->triangle_count; i++) {
        if (m->triangles[i].material >= m->material_count) {
            return false;
        }
        m->materials[m->triangles[i].material].is_used = true;
    }
    name_embedded(m);
    return true;
}

static int take_file(struct visual_model *m, int fd, const char *name)
{
    struct stat status;
    if (fstat(fd, &status) != 0 || status.st_size <= 0) {
        return hs_error(name, NULL, "its reader wrote nothing");
    }
    void *bytes = mmap(NULL, (size_t)status.st_size, PROT_READ, MAP_PRIVATE, fd, 0);
    if (bytes == MAP_FAILED) {
        return hs_error(name, "reduce the model", "out of memory");
    }
    struct taking t = {bytes, (uint64_t)status.st_size};
    const bool is_taken = take_model(m, &t, name);
    munmap(bytes, (size_t)status.st_size);
    return is_taken ? 0 : hs_error(name, "reduce the model", "out of memory for its triangles");
}

static int read_with_assimp(struct visual_model *m, struct reader_job *job)
{
    if (strcasecmp(ending_of(job->path), ".obj") == 0 && obj_check(job->path, job->name) != 0) {
        return -1;
    }
    job->out_fd = memfd_create("landmass-model", MFD_CLOEXEC);
    if (job->out_fd < 0) {
        return hs_error(job->name, NULL, "out of memory");
    }
    const int result =
        reader_run(reader_assimp, job, job->name) == 0 ? take_file(m, job->out_fd, job->name) : -1;
    close(job->out_fd);
    return result;
}

static int remove_entry(const char *path, const struct stat *status, int kind, struct FTW *at)
{
    (void)status, (void)kind, (void)at;
    return remove(path);
}

static int read_openflight(struct visual_model *m, struct reader_job *job, const char *search)
{
    char folder[VISUAL_PATH_SIZE], converted[VISUAL_PATH_SIZE + 16];
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/landmass-XXXXXX", temporary ? temporary : "/tmp");
    if (!mkdtemp(folder)) {
        return hs_error(folder, "set TMPDIR to a folder that can be written",
                        "cannot be made for the converted model");
    }
    int result = 0;
    if (strncmp(job->path, "/vsi", 4) == 0) {
        snprintf(converted, sizeof converted, "%s/model.flt", folder);
        result = CPLCopyFile(converted, job->path) == 0
                     ? reader_osgconv(m, converted, search, folder)
                     : hs_error(job->name, "look into the archive", "cannot be taken out of it");
    } else {
        result = reader_osgconv(m, job->path, search, folder);
    }
    if (result == 0) {
        snprintf(converted, sizeof converted, "%s/model.obj", folder);
        struct reader_job again = *job;
        again.path = converted;
        result = read_with_assimp(m, &again);
    }
    nftw(folder, remove_entry, 8, FTW_DEPTH | FTW_PHYS);
    return result;
}

int visual_model_read(struct visual_model *m, const char *path, const char *search,
                      const struct visual_axes *axes)
{
    *m = (struct visual_model){.triangles = NULL};
    struct reader_job job = {.path = path, .name = path, .keeps_walls = axes->keeps_walls};
    VSIStatBufL status;
    if (VSIStatL(path, &status) != 0) {
        return hs_error(path, "check the name", "cannot be opened");
    }
    if (!VSI_ISREG(status.st_mode)) {
        return hs_error(path, "give the file of a model", "is no ordinary file");
    }
    if (status.st_size > MODEL_BYTES_MAX) {
        return hs_error(path, "cut it into several", "is larger than %d MiB",
                        MODEL_BYTES_MAX >> 20);
    }
    if (choose_axes(&job, axes) != 0) {
        return -1;
    }
    sigset_t before;
    reader_hold_signals(&before);
    const int result =
        is_openflight(path) ? read_openflight(m, &job, search) : read_with_assimp(m, &job);
    reader_release_signals(&before);
    if (result != 0) {
        visual_model_free(m);
        return -1;
    }
    return 0;
}

void visual_model_free(struct visual_model *m)
{
    for (uint32_t i = 0; i < m->embedded_count; i++) {
        VSIUnlink(m->embedded_names[i]);
    }
    free(m->embedded);
    free(m->embedded_names);
    free(m->triangles);
    free(m->materials);
    *m = (struct visual_model){.triangles = NULL};
}
