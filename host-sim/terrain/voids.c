#include "terrain/voids.h"

#include "fill.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

enum { FILL_MARGIN = 2, STRIP_PIXELS = 8 << 20 };

/* The mosaic a strip of rows at a time: some formats hold whole columns in a block, and row by row
 * they would be decoded over and over. */
struct strip {
    const struct terrain_mosaic *m;
    int first, rows, capacity; /* rows held now, and at most */
    float *metres;
    uint8_t *state;
};

/* The search for voids. */
struct search {
    struct terrain_voids *v;
    const struct terrain_mosaic *m;
    struct strip strip;
    size_t run_capacity;
    uint32_t *parents; /* union-find over runs */
};

/* A row of pixels, or NULLs above the first one. Good until the next row is asked for. */
struct row {
    const float *metres;
    const uint8_t *state;
};

static int strip_open(struct strip *s, const struct terrain_mosaic *m)
{
    const size_t width = (size_t)m->georef.width;
    const size_t fitting = STRIP_PIXELS / width + 2;
    *s = (struct strip){.m = m};
    s->capacity = fitting < (size_t)m->georef.height ? (int)fitting : m->georef.height;
    s->metres = malloc((size_t)s->capacity * width * sizeof *s->metres);
    s->state = malloc((size_t)s->capacity * width);
    return s->metres && s->state
               ? 0
               : hs_error(m->members[0].path, NULL, "out of memory for its voids");
}

static void strip_close(struct strip *s)
{
    free(s->metres);
    free(s->state);
}

/* Row y and the one above it. */
static int strip_rows(struct strip *s, int y, struct row *above, struct row *here)
{
    const int need = y > 0 ? y - 1 : 0;
    const int height = s->m->georef.height;
    if (need < s->first || y >= s->first + s->rows) {
        s->first = need;
        s->rows = s->capacity < height - need ? s->capacity : height - need;
        const struct resample_window w = {0, s->first, s->m->georef.width, s->rows};
        if (terrain_mosaic_read(s->m, &w, s->metres, s->state) != 0) {
            s->rows = 0;
            return -1;
        }
    }
    const size_t width = (size_t)s->m->georef.width, at = (size_t)(y - s->first) * width;
    *here = (struct row){s->metres + at, s->state + at};
    *above =
        y > 0 ? (struct row){here->metres - width, here->state - width} : (struct row){NULL, NULL};
    return 0;
}

static uint32_t root_of(uint32_t *parents, uint32_t i)
{
    /* Asked only of runs that were added. NOLINTNEXTLINE(clang-analyzer-core.NullDereference) */
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
    struct terrain_voids *v = s->v;
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
    /* There is room: made above, or before. NOLINTNEXTLINE(clang-analyzer-core.NullDereference) */
    s->parents[number] = number;
    return 0;
}

static int find_runs(struct search *s, int y, const uint8_t *state)
{
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

/* Runs first..middle-1 are those of a row, middle..end-1 those of the next. */
static void join_rows(struct search *s, size_t first, size_t middle, size_t end)
{
    const struct terrain_run *runs = s->v->runs;
    size_t i = first, j = middle;
    while (i < middle && j < end) {
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
    size_t first = 0;
    for (int y = 0; y < s->m->georef.height; y++) {
        const size_t middle = s->v->run_count;
        struct row above, here;
        if (strip_rows(&s->strip, y, &above, &here) != 0 || find_runs(s, y, here.state) != 0) {
            return -1;
        }
        join_rows(s, first, middle, s->v->run_count);
        first = middle;
    }
    return 0;
}

/* Number the roots and gather each region's rectangle. */
static int make_regions(struct search *s)
{
    struct terrain_voids *v = s->v;
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
            *r = (struct terrain_region){
                .x0 = run->x0, .y0 = run->y, .x1 = run->x1, .y1 = run->y, .first_run = i};
        }
        r->x0 = run->x0 < r->x0 ? run->x0 : r->x0;
        r->x1 = run->x1 > r->x1 ? run->x1 : r->x1;
        r->y1 = run->y;
        r->pixels += (uint64_t)(run->x1 - run->x0 + 1);
    }
    return 0;
}

static void count_rim(const struct terrain_voids *v, struct terrain_region *r, float metres,
                      uint8_t state)
{
    if (state == TERRAIN_MEASURED) {
        r->rim++;
        r->rim_sea += metres <= v->sea_level_m;
    }
}

/* Rim pixels left and right of a run in its own row. */
static void count_ends(struct search *s, const struct terrain_run *run, const struct row *here)
{
    struct terrain_region *r = &s->v->regions[run->region];
    if (run->x0 > 0) {
        count_rim(s->v, r, here->metres[run->x0 - 1], here->state[run->x0 - 1]);
    }
    if (run->x1 + 1 < s->m->georef.width) {
        count_rim(s->v, r, here->metres[run->x1 + 1], here->state[run->x1 + 1]);
    }
}

/* Rim pixels that touch a run from the row above or below. */
static void count_side(struct search *s, const struct terrain_run *run, const struct row *beside)
{
    struct terrain_region *r = &s->v->regions[run->region];
    for (int x = run->x0; x <= run->x1; x++) {
        count_rim(s->v, r, beside->metres[x], beside->state[x]);
    }
}

/* Second pass: what borders each region. */
static int measure_rims(struct search *s)
{
    const struct terrain_voids *v = s->v;
    size_t first = 0, middle = 0, end = 0; /* runs of the row above, and of this row */
    for (int y = 0; y < s->m->georef.height; y++) {
        struct row above, here;
        if (strip_rows(&s->strip, y, &above, &here) != 0) {
            return -1;
        }
        first = middle;
        middle = end;
        while (end < v->run_count && v->runs[end].y == y) {
            end++;
        }
        for (size_t i = first; i < middle; i++) {
            count_side(s, &v->runs[i], &here);
        }
        for (size_t i = middle; i < end; i++) {
            count_ends(s, &v->runs[i], &here);
            if (above.state) {
                count_side(s, &v->runs[i], &above);
            }
        }
    }
    return 0;
}

static struct resample_window window_around(const struct terrain_mosaic *m,
                                            const struct terrain_region *r)
{
    const int x0 = r->x0 > FILL_MARGIN ? r->x0 - FILL_MARGIN : 0;
    const int y0 = r->y0 > FILL_MARGIN ? r->y0 - FILL_MARGIN : 0;
    const int x1 =
        r->x1 + FILL_MARGIN < m->georef.width ? r->x1 + FILL_MARGIN : m->georef.width - 1;
    const int y1 =
        r->y1 + FILL_MARGIN < m->georef.height ? r->y1 + FILL_MARGIN : m->georef.height - 1;
    return (struct resample_window){x0, y0, x1 - x0 + 1, y1 - y0 + 1};
}

static enum terrain_filling choose_filling(const struct terrain_voids *v,
                                           const struct terrain_region *r)
{
    const bool is_small = r->pixels <= TERRAIN_SMALL_REGION;
    const bool is_at_sea = is_small ? 2 * r->rim_sea > r->rim : 10 * r->rim_sea >= 9 * r->rim;
    const bool is_unknown = !is_small && 10 * r->rim_sea > r->rim;
    if (v->are_sea || (r->rim > 0 && is_at_sea)) {
        return TERRAIN_SEA;
    }
    return r->rim == 0 || is_unknown || !r->has_values ? TERRAIN_LEFT_VOID : TERRAIN_INTERPOLATED;
}

/* Regions whose rim can be continued into them, be it only to let no cliff stand. */
static bool can_interpolate(const struct terrain_mosaic *m, const struct terrain_region *r)
{
    const struct resample_window w = window_around(m, r);
    return r->rim > 0 && (int64_t)w.width * w.height <= TERRAIN_FILL_MAX;
}

/* Keep the elevations of the region's own pixels, run after run from values[at]. */
static uint64_t keep_values(struct terrain_voids *v, uint32_t region,
                            const struct resample_window *w, const float *metres, uint64_t at)
{
    const struct terrain_region *r = &v->regions[region];
    for (size_t i = r->first_run; i < v->run_count && v->runs[i].y <= r->y1; i++) {
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

static int fill_region(struct terrain_voids *v, const struct terrain_mosaic *m, uint32_t region,
                       uint64_t *value_count)
{
    const struct resample_window w = window_around(m, &v->regions[region]);
    const size_t count = (size_t)w.width * (size_t)w.height;
    float *metres = malloc(count * sizeof *metres);
    uint8_t *mask = malloc(count);
    int result = -1;
    if (!metres || !mask) {
        hs_error(m->members[0].path, NULL, "out of memory for its voids");
    } else {
        result = terrain_mosaic_read(m, &w, metres, mask);
    }
    if (result == 0) {
        for (size_t i = 0; i < count; i++) {
            mask[i] = mask[i] == TERRAIN_MEASURED;
        }
        result = terrain_fill(w.width, w.height, metres, mask);
        if (result != 0) {
            hs_error(m->members[0].path, NULL, "out of memory for its voids");
        }
    }
    if (result == 0) {
        *value_count = keep_values(v, region, &w, metres, *value_count);
    }
    free(metres);
    free(mask);
    return result;
}

static int fill_regions(struct terrain_voids *v, const struct terrain_mosaic *m)
{
    uint64_t total = 1, count = 0;
    for (size_t i = 0; i < v->region_count; i++) {
        struct terrain_region *r = &v->regions[i];
        r->has_values = can_interpolate(m, r);
        r->filling = choose_filling(v, r);
        r->has_values = r->has_values && r->filling != TERRAIN_SEA;
        total += r->has_values ? r->pixels : 0;
    }
    v->values = malloc(total * sizeof *v->values);
    if (!v->values) {
        return hs_error(m->members[0].path, NULL, "out of memory for its voids");
    }
    for (uint32_t i = 0; i < v->region_count; i++) {
        if (v->regions[i].has_values && fill_region(v, m, i, &count) != 0) {
            return -1;
        }
    }
    v->is_filled = true;
    return 0;
}

static int search_and_fill(struct search *s)
{
    if (search_rows(s) != 0) {
        return -1;
    }
    if (s->v->run_count == 0) {
        return 0;
    }
    return make_regions(s) == 0 && measure_rims(s) == 0 && fill_regions(s->v, s->m) == 0 ? 0 : -1;
}

int terrain_voids_fill(struct terrain_voids *v, const struct terrain_mosaic *m)
{
    struct search s = {.v = v, .m = m};
    const int result = strip_open(&s.strip, m) == 0 && search_and_fill(&s) == 0 ? 0 : -1;
    strip_close(&s.strip);
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

void terrain_voids_apply(const struct terrain_voids *v, const struct resample_window *window,
                         float *metres, uint8_t *state)
{
    if (!v->is_filled) {
        return;
    }
    const int end_x = window->x + window->width;
    for (size_t i = first_run(v, window->y);
         i < v->run_count && v->runs[i].y < window->y + window->height; i++) {
        const struct terrain_run *run = &v->runs[i];
        const struct terrain_region *r = &v->regions[run->region];
        const bool is_sea = r->filling == TERRAIN_SEA;
        const int x0 = run->x0 > window->x ? run->x0 : window->x;
        const int x1 = run->x1 < end_x - 1 ? run->x1 : end_x - 1;
        for (int x = x0; (is_sea || r->has_values) && x <= x1; x++) {
            const size_t at =
                (size_t)(run->y - window->y) * (size_t)window->width + (size_t)(x - window->x);
            metres[at] =
                is_sea ? (float)v->sea_level_m : v->values[run->value + (uint64_t)(x - run->x0)];
            state[at] = r->filling == TERRAIN_LEFT_VOID ? TERRAIN_VOID : TERRAIN_FILLED;
        }
    }
}

void terrain_voids_free(struct terrain_voids *v)
{
    free(v->runs);
    free(v->regions);
    free(v->values);
    *v = (struct terrain_voids){0};
}
