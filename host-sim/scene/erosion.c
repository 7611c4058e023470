#include "erosion.h"

#include "hs/error.h"
#include "hs/progress.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int erosion_init(struct erosion *e, int width, int height, double spacing_m)
{
    const size_t n = (size_t)width * (size_t)height;
    *e = (struct erosion){.width = width, .height = height, .spacing_m = spacing_m};
    e->z_m = calloc(n, sizeof *e->z_m);
    e->steepness = calloc(n, sizeof *e->steepness);
    e->is_base = calloc(n, sizeof *e->is_base);
    e->area_m2 = calloc(n, sizeof *e->area_m2);
    e->receiver = calloc(n, sizeof *e->receiver);
    e->order = calloc(n, sizeof *e->order);
    e->scratch = calloc(3 * n + 1, sizeof *e->scratch);
    if (!e->z_m || !e->steepness || !e->is_base || !e->area_m2 || !e->receiver || !e->order ||
        !e->scratch) {
        erosion_free(e);
        return hs_error("terrain", "make the scene smaller", "out of memory");
    }
    return 0;
}

void erosion_free(struct erosion *e)
{
    free(e->z_m);
    free(e->steepness);
    free(e->is_base);
    free(e->area_m2);
    free(e->receiver);
    free(e->order);
    free(e->scratch);
    *e = (struct erosion){0};
}

/* The neighbour down the steepest slope, or the node itself. */
static int32_t steepest(const struct erosion *e, int x, int y)
{
    const int32_t i = y * e->width + x;
    int32_t best = i;
    double best_slope = 0;
    for (int dy = -1; dy <= 1; dy++) {
        for (int dx = -1; dx <= 1; dx++) {
            const int nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= e->width || ny >= e->height) {
                continue;
            }
            const int32_t j = ny * e->width + nx;
            const double drop = e->z_m[i] - e->z_m[j];
            const double slope = dx != 0 && dy != 0 ? drop * 0.70710678118654752 : drop;
            if (slope > best_slope) {
                best_slope = slope;
                best = j;
            }
        }
    }
    return best;
}

/* Order the nodes so that each follows its receiver: counts of donors give each node a run of slots
 * for them, and a walk from the bases visits the runs. */
static void sort_downstream_first(struct erosion *e)
{
    const int32_t n = e->width * e->height;
    int32_t *first = e->scratch;
    int32_t *next = first + n + 1, *donors = next + n;
    int32_t filled = 0;
    memset(first, 0, ((size_t)n + 1) * sizeof *first);
    for (int32_t i = 0; i < n; i++) {
        first[e->receiver[i] + 1] += e->receiver[i] != i;
    }
    for (int32_t i = 0; i < n; i++) {
        first[i + 1] += first[i];
        next[i] = first[i];
    }
    for (int32_t i = 0; i < n; i++) {
        if (e->receiver[i] != i) {
            donors[next[e->receiver[i]]++] = i;
        } else {
            e->order[filled++] = i;
        }
    }
    for (int32_t k = 0; k < filled; k++) {
        for (int32_t d = first[e->order[k]]; d < first[e->order[k] + 1]; d++) {
            e->order[filled++] = donors[d];
        }
    }
}

void erosion_route(struct erosion *e)
{
    const int32_t n = e->width * e->height;
    for (int y = 0; y < e->height; y++) {
        for (int x = 0; x < e->width; x++) {
            const int32_t i = y * e->width + x;
            e->receiver[i] = e->is_base[i] ? i : steepest(e, x, y);
        }
    }
    sort_downstream_first(e);
    for (int32_t i = 0; i < n; i++) {
        e->area_m2[i] = e->spacing_m * e->spacing_m;
    }
    for (int32_t k = n - 1; k >= 0; k--) {
        const int32_t i = e->order[k];
        if (e->receiver[i] != i) {
            e->area_m2[e->receiver[i]] += e->area_m2[i];
        }
    }
}

/* A pit is lifted without being eroded until it overflows, which is how a lake would fill it. */
static void erode_once(struct erosion *e, double pace, double talus)
{
    const int32_t n = e->width * e->height;
    for (int32_t k = 0; k < n; k++) {
        const int32_t i = e->order[k], r = e->receiver[i];
        if (e->is_base[i]) {
            continue;
        }
        const double lifted = e->z_m[i] + pace * e->steepness[i];
        if (r == i) {
            e->z_m[i] = lifted;
            continue;
        }
        const int apart = abs(i % e->width - r % e->width) + abs(i / e->width - r / e->width);
        const double distance = apart == 2 ? 1.41421356237309505 * e->spacing_m : e->spacing_m;
        const double f = pace * sqrt(e->area_m2[i]) / distance;
        e->z_m[i] = fmin((lifted + f * e->z_m[r]) / (1 + f), e->z_m[r] + talus * distance);
    }
}

void erosion_run(struct erosion *e, int steps, double pace, double talus)
{
    struct hs_progress progress;
    hs_progress_begin(&progress, "eroding", (uint64_t)steps);
    for (int i = 0; i < steps; i++) {
        erosion_route(e);
        erode_once(e, pace, talus);
        hs_progress_update(&progress, (uint64_t)i + 1);
    }
    erosion_route(e);
    hs_progress_end(&progress);
}
