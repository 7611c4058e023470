#include "visual/cdb_models.h"

#include "gis/gdal_start.h"
#include "hs/error.h"
#include "hs/progress.h"

#include <cpl_string.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <math.h>
#include <ogr_api.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORD = 64, MEMBERS_MAX = 1 << 20 };

/* What the tables say of a feature: first its own row, then that of its class name. */
struct feature {
    char cnam[WORD], facc[WORD], modl[WORD];
    int fsc;
    double turn_deg, scale[3], height_m, length_m, width_m;
    bool is_absolute; /* its z is above sea level and not above the ground */
    double longitude, latitude, z;
};

struct cached {
    char path[CDB_PATH_SIZE];
    struct visual_model model;
    uint32_t first_skin;
    bool is_read;
};

struct placing {
    const struct cdb_models *m;
    struct visual_scene *scene;
    struct cdb_models_count *count;
    char **members;       /* owned list: paths of all model files */
    struct cached *cache; /* owned */
    size_t cached, cache_room;
    struct feature *rows; /* owned: classes of the tile at hand */
    size_t row_count;
};

static void take_text(OGRFeatureH f, const char *field, char *to)
{
    const int i = OGR_F_GetFieldIndex(f, field);
    if (i >= 0 && OGR_F_IsFieldSetAndNotNull(f, i)) {
        snprintf(to, WORD, "%s", OGR_F_GetFieldAsString(f, i));
    }
}

static void take_number(OGRFeatureH f, const char *field, double *to)
{
    const int i = OGR_F_GetFieldIndex(f, field);
    if (i >= 0 && OGR_F_IsFieldSetAndNotNull(f, i)) {
        const double v = OGR_F_GetFieldAsDouble(f, i);
        *to = isfinite(v) ? v : *to;
    }
}

static void take_fields(OGRFeatureH f, struct feature *to)
{
    char absolute[WORD] = "";
    double fsc = to->fsc;
    take_text(f, "CNAM", to->cnam);
    take_text(f, "FACC", to->facc);
    take_text(f, "MODL", to->modl);
    take_text(f, "AHGT", absolute);
    take_number(f, "FSC", &fsc);
    take_number(f, "AO1", &to->turn_deg);
    take_number(f, "SCALx", &to->scale[0]);
    take_number(f, "SCALy", &to->scale[1]);
    take_number(f, "SCALz", &to->scale[2]);
    take_number(f, "HGT", &to->height_m);
    take_number(f, "BBL", &to->length_m);
    take_number(f, "BBW", &to->width_m);
    to->fsc = fsc >= 0 && fsc <= 999 ? (int)fsc : 0;
    to->is_absolute = absolute[0] ? absolute[0] == 'T' || absolute[0] == 't' : to->is_absolute;
}

static const struct feature blank = {.scale = {1, 1, 1}};

/* A file of points or classes; many of real trees are empty, and then it is NULL without a word. */
static GDALDatasetH open_table(const char *path)
{
    VSIStatBufL status;
    if (VSIStatL(path, &status) != 0 || status.st_size < 100) {
        return NULL;
    }
    return GDALOpenEx(path, GDAL_OF_VECTOR | GDAL_OF_READONLY, NULL, NULL, NULL);
}

/* N32W118_D100_S001_T001_... to the class table of the same tile, T002. */
static bool class_table_path(const struct cdb_tile *t, char *path)
{
    snprintf(path, CDB_PATH_SIZE, "%s", t->path);
    char *selector = strstr(strrchr(path, '/'), "_T001_");
    char *dot = strrchr(path, '.');
    if (!selector || !dot) {
        return false;
    }
    selector[4] = '2';
    snprintf(dot, 5, ".dbf");
    return true;
}

static int read_rows(struct placing *p, const struct cdb_tile *t)
{
    char path[CDB_PATH_SIZE];
    free(p->rows);
    p->rows = NULL;
    p->row_count = 0;
    GDALDatasetH file = class_table_path(t, path) ? open_table(path) : NULL;
    OGRLayerH layer = file ? GDALDatasetGetLayer(file, 0) : NULL;
    const GIntBig rows = layer ? OGR_L_GetFeatureCount(layer, 1) : 0;
    int result = 0;
    if (rows > 0 && rows < MEMBERS_MAX) {
        p->rows = calloc((size_t)rows, sizeof *p->rows);
        result = p->rows ? 0 : hs_error(path, NULL, "out of memory");
    }
    OGRFeatureH f;
    while (p->rows && (GIntBig)p->row_count < rows && (f = OGR_L_GetNextFeature(layer))) {
        p->rows[p->row_count] = blank;
        take_fields(f, &p->rows[p->row_count++]);
        OGR_F_Destroy(f);
    }
    if (file) {
        GDALClose(file);
    }
    return result;
}

static const struct feature *row_of(const struct placing *p, const char *cnam)
{
    for (size_t i = 0; i < p->row_count; i++) {
        if (cnam[0] && strcmp(p->rows[i].cnam, cnam) == 0) {
            return &p->rows[i];
        }
    }
    return &blank;
}

static char **list_archive(char **members, const char *path)
{
    char *inside = NULL;
    char **names = asprintf(&inside, "/vsizip/%s", path) > 0 ? VSIReadDir(inside) : NULL;
    for (int i = 0; names && names[i] && CSLCount(members) < MEMBERS_MAX; i++) {
        char *member = NULL;
        if (asprintf(&member, "%s/%s", inside, names[i]) > 0) {
            members = CSLAddString(members, member);
        }
        free(member);
    }
    CSLDestroy(names);
    free(inside);
    return members;
}

static char **list_folder(char **members, const char *folder)
{
    char **names = VSIReadDirRecursive(folder);
    for (int i = 0; names && names[i] && i < MEMBERS_MAX; i++) {
        char *path = NULL;
        const size_t length = strlen(names[i]);
        if (length > 4 && strcmp(names[i] + length - 4, ".flt") == 0 &&
            asprintf(&path, "%s/%s", folder, names[i]) > 0) {
            members = CSLAddString(members, path);
            free(path);
        }
    }
    CSLDestroy(names);
    return members;
}

/* All models: those of places in archives by tile, those of kinds in a library of their own. */
static int list_members(struct placing *p, struct visual_cdb *cdb)
{
    struct cdb_tiles archives = {.items = NULL};
    char folder[CDB_PATH_SIZE];
    if (visual_cdb_tiles(cdb, &archives, 300, ".zip\0") != 0) {
        return -1;
    }
    for (size_t i = 0; i < archives.count; i++) {
        p->members = list_archive(p->members, archives.items[i].path);
    }
    cdb_tiles_free(&archives);
    snprintf(folder, sizeof folder, "%s/GTModel/500_GTModelGeometry", cdb->root);
    p->members = list_folder(p->members, folder);
    return 0;
}

static const char *member_of(const struct placing *p, const struct feature *f)
{
    char *ending = NULL;
    if (!f->modl[0] || asprintf(&ending, "_%s_%03d_%s.flt", f->facc, f->fsc, f->modl) < 0) {
        return NULL;
    }
    const size_t length = strlen(ending);
    const char *found = NULL;
    for (char **m = p->members; m && *m && !found; m++) {
        const size_t all = strlen(*m);
        found = all > length && strcmp(*m + all - length, ending) == 0 ? *m : NULL;
    }
    free(ending);
    return found;
}

/* Textures are named from the folder of the archive. */
static void search_folder(const char *member, char *folder)
{
    const char *from = strncmp(member, "/vsizip/", 8) == 0 ? member + 8 : member;
    const char *zip = strstr(from, ".zip/");
    snprintf(folder, CDB_PATH_SIZE, "%.*s", zip ? (int)(zip - from) : (int)strlen(from), from);
    char *slash = strrchr(folder, '/');
    if (slash) {
        *slash = '\0';
    }
}

static struct cached *new_cached(struct placing *p, const char *path)
{
    if (p->cached == p->cache_room) {
        const size_t room = p->cache_room ? 2 * p->cache_room : 32;
        void *cache = realloc(p->cache, room * sizeof *p->cache);
        if (!cache) {
            return NULL;
        }
        p->cache = cache;
        p->cache_room = room;
    }
    struct cached *c = &p->cache[p->cached++];
    *c = (struct cached){.first_skin = 0};
    snprintf(c->path, sizeof c->path, "%s", path);
    return c;
}

static void count_lost(struct cdb_models_count *count, const struct visual_model *m)
{
    if (count->lost_textures == 0) {
        snprintf(count->lost, sizeof count->lost, "%s", m->lost);
    }
    count->lost_textures += m->lost_textures;
}

/* A model read before, or now; NULL with the error reported: no memory. */
static struct cached *model_of(struct placing *p, const struct feature *f, const char *path)
{
    for (size_t i = 0; i < p->cached; i++) {
        if (strcmp(p->cache[i].path, path) == 0) {
            return &p->cache[i];
        }
    }
    struct cached *c = new_cached(p, path);
    char folder[CDB_PATH_SIZE];
    if (!c) {
        hs_error(path, NULL, "out of memory");
        return NULL;
    }
    search_folder(path, folder);
    if (visual_model_read(&c->model, path, folder, &(struct visual_axes){0}) == 0) {
        const int64_t first = visual_scene_skins(p->scene, &c->model, f->modl);
        c->is_read = first >= 0;
        c->first_skin = first >= 0 ? (uint32_t)first : 0;
        count_lost(p->count, &c->model);
    }
    return c;
}

/* The roof of a box: its walls are not seen from above. */
static struct cached *box_of(struct placing *p, const struct feature *f)
{
    char name[CDB_PATH_SIZE];
    snprintf(name, sizeof name, "box %g %g %g", f->length_m, f->width_m, f->height_m);
    for (size_t i = 0; i < p->cached; i++) {
        if (strcmp(p->cache[i].path, name) == 0) {
            return &p->cache[i];
        }
    }
    struct cached *c = new_cached(p, name);
    struct visual_triangle *t = c ? calloc(2, sizeof *t) : NULL;
    struct visual_material *material = t ? calloc(1, sizeof *material) : NULL;
    if (!material) {
        free(t);
        hs_error(name, NULL, "out of memory");
        return NULL;
    }
    const float x = (float)(f->length_m / 2), y = (float)(f->width_m / 2), z = (float)f->height_m;
    t[0] = (struct visual_triangle){{-x, x, x}, {-y, -y, y}, {z, z, z},       {0},
                                    {0},        0,           {128, 128, 128}, 0};
    t[1] = (struct visual_triangle){{-x, x, -x}, {-y, y, y}, {z, z, z},       {0},
                                    {0},         0,          {128, 128, 128}, 0};
    snprintf(material->name, sizeof material->name, "box");
    material->is_used = true;
    c->model = (struct visual_model){
        .triangles = t, .materials = material, .triangle_count = 2, .material_count = 1};
    const int64_t first = visual_scene_skins(p->scene, &c->model, "");
    c->is_read = first >= 0;
    c->first_skin = first >= 0 ? (uint32_t)first : 0;
    return c;
}

/* Metres of a degree on WGS 84. */
static void metres_per_degree(double latitude, double metres[2])
{
    const double a = 6378137.0, e2 = 6.69437999014e-3, radian = 0.017453292519943295;
    const double sine = sin(latitude * radian), root = sqrt(1 - e2 * sine * sine);
    metres[0] = radian * a / root * cos(latitude * radian);
    metres[1] = radian * a * (1 - e2) / (root * root * root);
}

static double ground_at(const struct cdb_models *m, double longitude, double latitude)
{
    if (!m->posts) {
        return 0;
    }
    const struct cdb_grid *g = m->post_grid;
    const double y = cdb_pixel_degrees(g->level), x = y * g->geocell_width;
    const double column = (longitude + 180) / x - (double)g->first[0];
    const double row = (double)g->height - 1 - ((latitude + 90) / y - (double)g->first[1]);
    const int c = (int)fmin(fmax(round(column), 0), g->width - 1);
    const int r = (int)fmin(fmax(round(row), 0), g->height - 1);
    const double z = (double)m->posts[(size_t)r * (size_t)g->width + (size_t)c];
    return isnan(z) ? 0 : z;
}

static struct visual_place place_of(const struct cdb_models *m, const struct feature *f)
{
    double metres[2];
    metres_per_degree(f->latitude, metres);
    const struct cdb_grid *g = m->cells;
    const double y = cdb_pixel_degrees(g->level), x = y * g->geocell_width;
    const double turn = f->turn_deg * 0.017453292519943295;
    const double east = 1 / (metres[0] * x), south = -1 / (metres[1] * y);
    struct visual_place p = {
        .at = {(f->longitude + 180) / x - (double)g->first[0],
               (double)(g->first[1] + g->height) - (f->latitude + 90) / y},
        .by = {{east * cos(turn) * f->scale[0], east * sin(turn) * f->scale[1]},
               {-south * sin(turn) * f->scale[0], south * cos(turn) * f->scale[1]}},
        .up = f->z,
        .up_by = f->scale[2]};
    if (f->is_absolute) {
        p.up -= ground_at(m, f->longitude, f->latitude);
    }
    return p;
}

static int place_cached(struct placing *p, const struct cached *c, const struct feature *f)
{
    const struct cdb_models *m = p->m;
    uint8_t *classes = malloc(c->model.material_count + 1);
    if (!classes) {
        return hs_error(c->path, NULL, "out of memory");
    }
    const int of_feature = m->class_of(m->class_context, f->facc);
    bool is_classed = of_feature >= 0;
    for (uint32_t i = 0; i < c->model.material_count; i++) {
        const int own = m->class_of(m->class_context, c->model.materials[i].name);
        const int found = own >= 0 ? own : of_feature;
        classes[i] = found >= 0 ? (uint8_t)found : DB_CLASS_NODATA;
        is_classed = is_classed || own >= 0;
    }
    p->count->unclassed += !is_classed;
    const struct visual_place place = place_of(m, f);
    const int result = visual_scene_place(p->scene, &c->model, c->first_skin, &place, classes);
    free(classes);
    return result;
}

static bool is_box(const struct feature *f)
{
    return f->height_m > 0 && f->length_m > 0 && f->width_m > 0 && f->height_m < 1000 &&
           f->length_m < 10000 && f->width_m < 10000;
}

static int place_feature(struct placing *p, const struct feature *f)
{
    const char *path = member_of(p, f);
    const bool boxed = !path && p->m->boxes && is_box(f);
    if (!path && !boxed) {
        if (p->count->missing++ == 0) {
            snprintf(p->count->first_missing, VISUAL_PATH_SIZE, "%s %s",
                     f->facc[0] ? f->facc : f->cnam, f->modl);
        }
        return 0;
    }
    const struct cached *c = boxed ? box_of(p, f) : model_of(p, f, path);
    if (!c) {
        return -1;
    }
    if (!c->is_read) {
        p->count->unreadable++;
        return 0;
    }
    p->count->placed += !boxed;
    p->count->boxed += boxed;
    return place_cached(p, c, f);
}

static bool is_within(const struct cdb_area *a, const struct feature *f)
{
    return f->longitude >= a->west && f->longitude < a->east && f->latitude >= a->south &&
           f->latitude < a->north;
}

static int place_layer(struct placing *p, OGRLayerH layer)
{
    int result = 0;
    OGRFeatureH of;
    while (result == 0 && (of = OGR_L_GetNextFeature(layer))) {
        struct feature f = blank;
        char cnam[WORD] = "";
        take_text(of, "CNAM", cnam);
        f = *row_of(p, cnam);
        take_fields(of, &f);
        const OGRGeometryH at = OGR_F_GetGeometryRef(of);
        if (at && wkbFlatten(OGR_G_GetGeometryType(at)) == wkbPoint) {
            f.longitude = OGR_G_GetX(at, 0);
            f.latitude = OGR_G_GetY(at, 0);
            f.z = OGR_G_GetZ(at, 0);
            if (is_within(&p->m->cdb->area, &f)) {
                p->count->features++;
                result = place_feature(p, &f);
            }
        }
        OGR_F_Destroy(of);
    }
    return result;
}

static int place_tile(struct placing *p, const struct cdb_tile *t)
{
    if (t->selector[1] != 1) {
        return 0; /* T002 and above are tables of T001 */
    }
    GDALDatasetH file = open_table(t->path);
    OGRLayerH layer = file ? GDALDatasetGetLayer(file, 0) : NULL;
    int result = layer ? read_rows(p, t) : 0;
    if (result == 0 && layer) {
        result = place_layer(p, layer);
    }
    if (file) {
        GDALClose(file);
    }
    return result;
}

static int place_dataset(struct placing *p, struct visual_cdb *cdb, int dataset)
{
    struct cdb_tiles tiles = {.items = NULL};
    if (visual_cdb_tiles(cdb, &tiles, dataset, ".shp\0") != 0) {
        return -1;
    }
    struct hs_progress progress;
    hs_progress_begin(&progress, "models", tiles.count);
    int result = 0;
    for (size_t i = 0; result == 0 && i < tiles.count; i++) {
        result = place_tile(p, &tiles.items[i]);
        hs_progress_update(&progress, i + 1);
    }
    hs_progress_end(&progress);
    cdb_tiles_free(&tiles);
    return result;
}

int visual_cdb_place_models(const struct cdb_models *m, struct visual_cdb *cdb,
                            struct visual_scene *scene, struct cdb_models_count *count)
{
    struct placing p = {.m = m, .scene = scene, .count = count};
    *count = (struct cdb_models_count){.features = 0};
    int result = list_members(&p, cdb);
    if (result == 0) {
        result = place_dataset(&p, cdb, CDB_GS_FEATURE);
    }
    if (result == 0) {
        result = place_dataset(&p, cdb, CDB_GT_FEATURE);
    }
    for (size_t i = 0; i < p.cached; i++) {
        visual_model_free(&p.cache[i].model);
    }
    free(p.cache);
    free(p.rows);
    CSLDestroy(p.members);
    return result;
}
