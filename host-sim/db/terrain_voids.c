#include "terrain_mosaic.h"

#include "gdal_start.h"

#include "hs/error.h"

#include <cpl_string.h>
#include <gdal_alg.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NO_REGION = UINT32_MAX, FILL_MARGIN = 2, FILL_SMOOTHINGS = 2 };

/* The search for voids, one row after the other. */
struct search {
    struct terrain_mosaic *m;
    size_t run_capacity;
    uint32_t *parents; /* union-find over runs */
    float *metres[2];  /* the row before and this row */
    uint8_t *state[2];
    size_t previous_first, previous_end; /* runs of the row before */
};

static uint32_t root_of(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i) {
        parents[i] = parents[parents[i]];
        i = parents[i];
    }
    return i;
}

/* The lower number wins, so that regions are numbered from the north whatever joins them. */
static void join(uint32_t *parents, uint32_t a, uint32_t b)
{
    const uint32_t ra = root_of(parents, a), rb = root_of(parents, b);
    parents[ra > rb ? ra : rb] = ra > rb ? rb : ra;
}

static int add_run(struct search *s, int y, int x0, int x1)
{
    struct terrain_voids *v = &s->m->voids;
    if (v->run_count == s->run_capacity) {
        const size_t capacity = s->run_capacity ? 2 * s->run_capacity : 1024;
        struct terrain_run *runs = realloc(v->runs, capacity * sizeof *runs);
        v->runs = runs ? runs : v->runs;
        uint32_t *parents = realloc(s->parents, capacity * sizeof *parents);
        s->parents = parents ? parents : s->parents;
        if (!runs || !parents) {
            return hs_error(s->m->members[0].path, "use a terrain model with fewer voids",
                            "out of memory for its voids");
        }
        s->run_capacity = capacity;
    }
    const uint32_t number = (uint32_t)v->run_count++;
    v->runs[number] = (struct terrain_run){.y = y, .x0 = x0, .x1 = x1, .region = number};
    s->parents[number] = number;
    return 0;
}

static int find_runs(struct search *s, int y)
{
    const uint8_t *state = s->state[1];
    const int width = s->m->georef.width;
    for (int x = 0; x < width; x++) {
        if (state[x] != TERRAIN_VOID) {
            continue;
        }
        const int x0 = x;
        while (x + 1 < width && state[x + 1] == TERRAIN_VOID) {
            x++;
        }
        if (add_run(s, y, x0, x) != 0) {
            return -1;
        }
    }
    return 0;
}

static void join_rows(struct search *s, size_t first, size_t end)
{
    const struct terrain_run *runs = s->m->voids.runs;
    size_t i = s->previous_first, j = first;
    while (i < s->previous_end && j < end) {
        if (runs[i].x0 <= runs[j].x1 && runs[j].x0 <= runs[i].x1) {
            join(s->parents, (uint32_t)i, (uint32_t)j);
        }
        if (runs[i].x1 < runs[j].x1) {
            i++;
        } else {
            j++;
        }
    }
}

static int search_rows(struct search *s)
{
    const int width = s->m->georef.width;
    for (int y = 0; y < s->m->georef.height; y++) {
        const struct resample_window row = {0, y, width, 1};
        if (terrain_mosaic_read(s->m, &row, s->metres[1], s->state[1]) != 0) {
            return -1;
        }
        const size_t first = s->m->voids.run_count;
        if (find_runs(s, y) != 0) {
            return -1;
        }
        join_rows(s, first, s->m->voids.run_count);
        s->previous_first = first;
        s->previous_end = s->m->voids.run_count;
    }
    return 0;
}

/* Number the roots and gather each region's rectangle. */
static int make_regions(struct search *s)
{
    struct terrain_voids *v = &s->m->voids;
    size_t count = 0;
    for (uint32_t i = 0; i < v->run_count; i++) {
        const uint32_t root = root_of(s->parents, i);
        v->runs[i].region = root == i ? (uint32_t)count++ : v->runs[root].region;
    }
    v->regions = calloc(count, sizeof *v->regions);
    if (!v->regions) {
        return hs_error(s->m->members[0].path, NULL, "out of memory for its voids");
    }
    v->region_count = count;
    for (size_t i = 0; i < v->run_count; i++) {
        const struct terrain_run *run = &v->runs[i];
        struct terrain_region *r = &v->regions[run->region];
        if (r->pixels == 0) {
            *r = (struct terrain_region){run->x0, run->y, run->x1, run->y, 0, 0, 0, 0};
        }
        r->x0 = run->x0 < r->x0 ? run->x0 : r->x0;
        r->x1 = run->x1 > r->x1 ? run->x1 : r->x1;
        r->y1 = run->y;
        r->pixels += (uint64_t)(run->x1 - run->x0 + 1);
    }
    return 0;
}

static void count_rim(const struct terrain_mosaic *m, struct terrain_region *r, float metres,
                      uint8_t state)
{
    if (state == TERRAIN_MEASURED) {
        r->rim++;
        r->rim_sea += metres <= m->sea_level_m;
    }
}

/* Rim pixels left and right of the row's runs, and those of `beside`, the row above or below, that touch one. */
static void count_row_rim(struct search *s, size_t first, size_t end, bool with_ends, int beside)
{
    struct terrain_voids *v = &s->m->voids;
    for (size_t i = first; i < end; i++) {
        const struct terrain_run *run = &v->runs[i];
        struct terrain_region *r = &v->regions[run->region];
        if (with_ends && run->x0 > 0) {
            count_rim(s->m, r, s->metres[1][run->x0 - 1], s->state[1][run->x0 - 1]);
        }
        if (with_ends && run->x1 + 1 < s->m->georef.width) {
            count_rim(s->m, r, s->metres[1][run->x1 + 1], s->state[1][run->x1 + 1]);
        }
        for (int x = run->x0; x <= run->x1; x++) {
            count_rim(s->m, r, s->metres[beside][x], s->state[beside][x]);
        }
    }
}

static void swap_rows(struct search *s)
{
    float *metres = s->metres[0];
    uint8_t *state = s->state[0];
    s->metres[0] = s->metres[1];
    s->state[0] = s->state[1];
    s->metres[1] = metres;
    s->state[1] = state;
}

/* Second pass: what borders each region. Rows far from any void are not read again. */
static int measure_rims(struct search *s)
{
    const struct terrain_voids *v = &s->m->voids;
    const int width = s->m->georef.width, height = s->m->georef.height;
    size_t first = 0, end = 0;
    int held = -1; /* the row in slot 0 */
    while (end < v->run_count || first < end) {
        const size_t above_first = first, above_end = end;
        const int y = above_first < above_end ? v->runs[above_first].y + 1 : v->runs[end].y;
        if (held != y - 1 && y > 0) {
            const struct resample_window row = {0, y - 1, width, 1};
            if (terrain_mosaic_read(s->m, &row, s->metres[0], s->state[0]) != 0) {
                return -1;
            }
        }
        first = end;
        while (end < v->run_count && v->runs[end].y == y) {
            end++;
        }
        if (y == height) {
            break;
        }
        const struct resample_window row = {0, y, width, 1};
        if (terrain_mosaic_read(s->m, &row, s->metres[1], s->state[1]) != 0) {
            return -1;
        }
        count_row_rim(s, above_first, above_end, false, 1);
        if (y > 0) {
            count_row_rim(s, first, end, true, 0);
        } else {
            memset(s->state[0], TERRAIN_NONE, (size_t)width);
            count_row_rim(s, first, end, true, 0);
        }
        swap_rows(s);
        held = y;
    }
    return 0;
}

static struct resample_window window_around(const struct terrain_mosaic *m,
                                            const struct terrain_region *r)
{
    const int x0 = r->x0 > FILL_MARGIN ? r->x0 - FILL_MARGIN : 0;
    const int y0 = r->y0 > FILL_MARGIN ? r->y0 - FILL_MARGIN : 0;
    const int x1 = r->x1 + FILL_MARGIN < m->georef.width ? r->x1 + FILL_MARGIN : m->georef.width - 1;
    const int y1 =
        r->y1 + FILL_MARGIN < m->georef.height ? r->y1 + FILL_MARGIN : m->georef.height - 1;
    return (struct resample_window){x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

static enum terrain_filling choose_filling(const struct terrain_mosaic *m,
                                           const struct terrain_region *r)
{
    if (r->rim == 0) {
        return TERRAIN_LEFT_VOID;
    }
    if (2 * r->rim_sea > r->rim) {
        return TERRAIN_SEA;
    }
    const struct resample_window w = window_around(m, r);
    return (int64_t)w.width * w.height <= TERRAIN_FILL_MAX ? TERRAIN_INTERPOLATED : TERRAIN_LEFT_VOID;
}

/* A dataset in memory over pixels that stay ours. */
static GDALDatasetH wrap_pixels(const struct resample_window *w, GDALDataType type, void *pixels)
{
    GDALDatasetH dataset =
        GDALCreate(GDALGetDriverByName("MEM"), "", w->width, w->height, 0, type, NULL);
    char pointer[64], text[96];
    const int length = CPLPrintPointer(pointer, pixels, sizeof pointer - 1);
    pointer[length] = '\0';
    snprintf(text, sizeof text, "DATAPOINTER=%s", pointer);
    char *options[] = {text, NULL};
    if (dataset && GDALAddBand(dataset, type, options) != CE_None) {
        GDALClose(dataset);
        return NULL;
    }
    return dataset;
}

static int interpolate(const struct resample_window *w, float *metres, uint8_t *mask)
{
    GDALDatasetH picture = wrap_pixels(w, GDT_Float32, metres);
    GDALDatasetH holes = wrap_pixels(w, GDT_Byte, mask);
    char *options[] = {"TEMP_FILE_DRIVER=MEM", NULL};
    const double reach = hypot(w->width, w->height);
    int result = -1;
    if (picture && holes) {
        result = GDALFillNodata(GDALGetRasterBand(picture, 1), GDALGetRasterBand(holes, 1), reach, 0,
                                FILL_SMOOTHINGS, options, NULL, NULL) == CE_None
                     ? 0
                     : -1;
        GDALFlushCache(picture);
    }
    if (picture) {
        GDALClose(picture);
    }
    if (holes) {
        GDALClose(holes);
    }
    return result;
}

/* Keep the elevations of the region's own pixels, run after run from values[at]. */
static uint64_t keep_values(struct terrain_voids *v, uint32_t region, const struct resample_window *w,
                            const float *metres, uint64_t at)
{
    for (size_t i = 0; i < v->run_count; i++) {
        struct terrain_run *run = &v->runs[i];
        if (run->region != region) {
            continue;
        }
        run->value = at;
        for (int x = run->x0; x <= run->x1; x++) {
            const size_t from = (size_t)(run->y - w->y) * (size_t)w->width + (size_t)(x - w->x);
            v->values[at++] = metres[from];
        }
    }
    return at;
}

static int fill_region(struct terrain_mosaic *m, uint32_t region, uint64_t *value_count)
{
    struct terrain_voids *v = &m->voids;
    const struct resample_window w = window_around(m, &v->regions[region]);
    const size_t count = (size_t)w.width * (size_t)w.height;
    float *metres = malloc(count * sizeof *metres);
    uint8_t *mask = malloc(count);
    int result = -1;
    if (metres && mask && terrain_mosaic_read(m, &w, metres, mask) == 0) {
        for (size_t i = 0; i < count; i++) {
            mask[i] = mask[i] == TERRAIN_MEASURED;
            metres[i] = mask[i] ? metres[i] : 0.0f;
        }
        result = interpolate(&w, metres, mask);
        if (result != 0) {
            hs_error(m->members[0].path, "fill them with gdal_fillnodata.py first",
                     "its voids cannot be filled: %s", db_gdal_complaint());
        }
    }
    if (result == 0) {
        *value_count = keep_values(v, region, &w, metres, *value_count);
    }
    free(metres);
    free(mask);
    return result;
}

static int fill_regions(struct terrain_mosaic *m)
{
    struct terrain_voids *v = &m->voids;
    uint64_t total = 0, count = 0;
    for (size_t i = 0; i < v->region_count; i++) {
        v->regions[i].filling = choose_filling(m, &v->regions[i]);
        total += v->regions[i].filling == TERRAIN_INTERPOLATED ? v->regions[i].pixels : 0;
    }
    float *values = malloc((total ? total : 1) * sizeof *values);
    if (!values) {
        return hs_error(m->members[0].path, NULL, "out of memory for its voids");
    }
    /* The voids of the neighbours must look like voids while one is filled. */
    enum terrain_filling *filling = calloc(v->region_count, sizeof *filling);
    v->values = values;
    int result = filling ? 0 : hs_error(m->members[0].path, NULL, "out of memory for its voids");
    for (size_t i = 0; result == 0 && i < v->region_count; i++) {
        filling[i] = v->regions[i].filling;
        v->regions[i].filling = TERRAIN_LEFT_VOID;
    }
    for (uint32_t i = 0; result == 0 && i < v->region_count; i++) {
        if (filling[i] == TERRAIN_INTERPOLATED) {
            result = fill_region(m, i, &count);
        }
    }
    for (size_t i = 0; result == 0 && i < v->region_count; i++) {
        v->regions[i].filling = filling[i];
    }
    free(filling);
    return result;
}

static int search_and_fill(struct search *s)
{
    if (search_rows(s) != 0) {
        return -1;
    }
    if (s->m->voids.run_count == 0) {
        return 0;
    }
    return make_regions(s) == 0 && measure_rims(s) == 0 && fill_regions(s->m) == 0 ? 0 : -1;
}

int terrain_voids_fill(struct terrain_mosaic *m)
{
    const size_t width = (size_t)m->georef.width;
    struct search s = {.m = m};
    int result = -1;
    for (int i = 0; i < 2; i++) {
        s.metres[i] = malloc(width * sizeof(float));
        s.state[i] = malloc(width);
    }
    if (s.metres[0] && s.metres[1] && s.state[0] && s.state[1]) {
        result = search_and_fill(&s);
    } else {
        hs_error(m->members[0].path, NULL, "out of memory for its voids");
    }
    for (int i = 0; i < 2; i++) {
        free(s.metres[i]);
        free(s.state[i]);
    }
    free(s.parents);
    return result;
}

/* Index of the first run of row y or later. */
static size_t first_run(const struct terrain_voids *v, int y)
{
    size_t low = 0, high = v->run_count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (v->runs[middle].y < y) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low;
}

void terrain_voids_apply(const struct terrain_mosaic *m, const struct resample_window *window,
                         float *metres, uint8_t *state)
{
    const struct terrain_voids *v = &m->voids;
    if (v->region_count == 0) {
        return;
    }
    const int end_x = window->x + window->width;
    for (size_t i = first_run(v, window->y);
         i < v->run_count && v->runs[i].y < window->y + window->height; i++) {
        const struct terrain_run *run = &v->runs[i];
        const enum terrain_filling filling = v->regions[run->region].filling;
        const int x0 = run->x0 > window->x ? run->x0 : window->x;
        const int x1 = run->x1 < end_x - 1 ? run->x1 : end_x - 1;
        for (int x = x0; filling != TERRAIN_LEFT_VOID && x <= x1; x++) {
            const size_t at = (size_t)(run->y - window->y) * (size_t)window->width +
                              (size_t)(x - window->x);
            metres[at] = filling == TERRAIN_SEA ? (float)m->sea_level_m
                                                : v->values[run->value + (uint64_t)(x - run->x0)];
            state[at] = TERRAIN_FILLED;
        }
    }
}
