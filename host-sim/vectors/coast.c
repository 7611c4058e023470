#include "coast.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Cells this near to a line are on the side that the line says; the others, on that of their
 * neighbours. The band is closed: no step along rows and columns leads through it. */
static const double band_cells = 1.6;

struct sides {
    int width, height;
    int8_t *side;      /* 1 land, -1 sea, 0 not known */
    float *distance;   /* of the band, to the nearest line, cells */
    float *lean;       /* how far beside that line: decides between two that share a vertex */
    uint32_t *waiting; /* cells whose neighbours are to be asked */
    size_t ready, end;
};

struct corner {
    double x, y; /* cells, rows downwards */
};

static void judge_cell(struct sides *s, int column, int row, struct corner a, struct corner b)
{
    const double du = b.x - a.x, dv = b.y - a.y, length = hypot(du, dv);
    const double u = column + 0.5 - a.x, v = row + 0.5 - a.y;
    const double along = fmin(1, fmax(0, (u * du + v * dv) / (length * length)));
    const double distance = hypot(u - along * du, v - along * dv);
    const double left = (u * dv - v * du) / length; /* rows run downwards */
    const size_t at = (size_t)row * (size_t)s->width + (size_t)column;
    const double slack = 1e-4;
    if (distance > band_cells || distance > s->distance[at] + slack) {
        return;
    }
    if (distance < s->distance[at] - slack || fabs(left) > s->lean[at]) {
        s->distance[at] = (float)distance;
        s->lean[at] = (float)fabs(left);
        s->side[at] = left >= 0 ? 1 : -1;
    }
}

static int clamp(double value, int end)
{
    return (int)fmin(end, fmax(0, value));
}

static void judge_segment(struct sides *s, struct corner a, struct corner b)
{
    if (a.x == b.x && a.y == b.y) {
        return;
    }
    const int top = clamp(floor(fmin(a.y, b.y) - 2), s->height),
              bottom = clamp(ceil(fmax(a.y, b.y) + 2), s->height);
    for (int row = top; row < bottom; row++) {
        /* The part of the segment that is near this row. */
        const double slope = b.y == a.y ? 0 : (b.x - a.x) / (b.y - a.y);
        double from = a.x, to = b.x;
        if (b.y != a.y) {
            const double low = fmin(a.y, b.y), high = fmax(a.y, b.y);
            from = a.x + (fmin(high, fmax(low, row - 2.0)) - a.y) * slope;
            to = a.x + (fmin(high, fmax(low, row + 3.0)) - a.y) * slope;
        }
        const int left = clamp(floor(fmin(from, to) - 2), s->width),
                  right = clamp(ceil(fmax(from, to) + 2), s->width);
        for (int column = left; column < right; column++) {
            judge_cell(s, column, row, a, b);
        }
    }
}

static void judge_line(struct sides *s, const double *transform, OGRGeometryH line)
{
    for (int i = 0; i < OGR_G_GetGeometryCount(line); i++) {
        judge_line(s, transform, OGR_G_GetGeometryRef(line, i));
    }
    struct corner before = {0};
    for (int i = 0; i < OGR_G_GetPointCount(line); i++) {
        const struct corner here = {(OGR_G_GetX(line, i) - transform[0]) / transform[1],
                                    (OGR_G_GetY(line, i) - transform[3]) / transform[5]};
        if (i > 0) {
            judge_segment(s, before, here);
        }
        before = here;
    }
}

static const int steps[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

/* The neighbour of a cell in a direction; false at the edge of the map. */
static bool neighbour(const struct sides *s, size_t at, int direction, size_t *next)
{
    const int column = (int)(at % (size_t)s->width) + steps[direction][0],
              row = (int)(at / (size_t)s->width) + steps[direction][1];
    *next = (size_t)row * (size_t)s->width + (size_t)column;
    return column >= 0 && row >= 0 && column < s->width && row < s->height;
}

/* From the band outwards, a cell at a time: the nearest side wins. */
static void spread(struct sides *s)
{
    const size_t cells = (size_t)s->width * (size_t)s->height;
    for (size_t i = 0; i < cells; i++) {
        if (s->side[i] != 0) {
            s->waiting[s->end++] = (uint32_t)i;
        }
    }
    while (s->ready < s->end) {
        const size_t at = s->waiting[s->ready++];
        for (int k = 0; k < 4; k++) {
            size_t next;
            if (neighbour(s, at, k, &next) && s->side[next] == 0) {
                s->side[next] = s->side[at];
                s->waiting[s->end++] = (uint32_t)next;
            }
        }
    }
}

/* Borders between sea and land that no line draws: both cells lie outside the band. */
static size_t count_guessed(const struct sides *s, size_t *where)
{
    const size_t cells = (size_t)s->width * (size_t)s->height;
    size_t count = 0;
    for (size_t i = 0; i < cells; i++) {
        for (int k = 0; k < 4; k += 2) { /* east and south */
            size_t next;
            if (neighbour(s, i, k, &next) && s->side[i] != s->side[next] && isinf(s->distance[i]) &&
                isinf(s->distance[next])) {
                count++;
                *where = i;
            }
        }
    }
    return count;
}

static void warn_guessed(const struct vector_map *map, const struct sides *s)
{
    size_t where = 0;
    const size_t guessed = count_guessed(s, &where);
    if (guessed > 0) {
        const double *t = map->grid.geotransform;
        hs_warn("coast", "get the whole coastline, or choose an --area that its gap is not in",
                "it is open: %.0f m of border between sea and land are guessed, some of it at "
                "easting %.0f, northing %.0f",
                (double)guessed * map->cell_m, t[0] + (double)(where % (size_t)s->width) * t[1],
                t[3] + (double)(where / (size_t)s->width) * t[5]);
    }
}

static void burn_sides(struct vector_map *map, const struct sides *s,
                       const struct vector_rule *rule)
{
    const size_t cells = (size_t)s->width * (size_t)s->height;
    for (size_t i = 0; i < cells; i++) {
        if (s->side[i] < 0) {
            map->classes[i] = (uint8_t)rule->class_index;
        } else if (s->side[i] > 0 && map->classes[i] == DB_CLASS_NODATA) {
            map->classes[i] = (uint8_t)rule->land_index;
        }
    }
}

static int burn(struct vector_map *map, struct sides *s, const struct vector_rule *rule)
{
    const size_t cells = (size_t)s->width * (size_t)s->height;
    if (!s->side || !s->distance || !s->lean || !s->waiting) {
        return hs_error("coast", "choose a smaller --area, or larger cells", "out of memory");
    }
    for (size_t i = 0; i < cells; i++) {
        s->distance[i] = INFINITY;
    }
    for (size_t i = 0; i < map->item_count; i++) {
        if (map->items[i].rule->detail == VECTOR_COAST) {
            judge_line(s, map->grid.geotransform, map->items[i].geometry);
        }
    }
    spread(s);
    warn_guessed(map, s);
    burn_sides(map, s, rule);
    return 0;
}

int coast_burn(struct vector_map *map)
{
    const struct vector_rule *rule = NULL;
    for (size_t i = 0; i < map->item_count; i++) {
        if (map->items[i].rule->detail == VECTOR_COAST) {
            rule = map->items[i].rule;
        }
    }
    if (!rule) {
        return 0;
    }
    const size_t cells = (size_t)map->grid.width * (size_t)map->grid.height;
    struct sides s = {.width = map->grid.width,
                      .height = map->grid.height,
                      .side = calloc(cells, 1),
                      .distance = malloc(cells * sizeof *s.distance),
                      .lean = calloc(cells, sizeof *s.lean),
                      .waiting = malloc(cells * sizeof *s.waiting)};
    const int result = burn(map, &s, rule);
    free(s.side);
    free(s.distance);
    free(s.lean);
    free(s.waiting);
    return result;
}
