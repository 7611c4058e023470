#include "netem/paths.h"

#include "bounce_order.h"
#include "hs/error.h"

#include <complex.h>
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Different reflections found so far: open addressing on their rounded geometry. */
struct table {
    struct nm_reflection *rows; /* becomes the owner's */
    struct nm_from *from;       /* likewise; NULL: equal geometry is all that counts */
    int count, capacity;
    int32_t *slots; /* -1 is free */
    uint32_t slot_count;
};

static uint64_t key_of(const struct nm_reflection *r)
{
    const uint64_t i = (uint64_t)lround(r->incidence_rad / NM_ANGLE_STEP_RAD);
    const uint64_t l = (uint64_t)lround(r->leaving_rad / NM_ANGLE_STEP_RAD);
    const uint64_t t = (uint64_t)lround(r->turn_rad / NM_ANGLE_STEP_RAD);
    return i | l << 16 | t << 32 | (uint64_t)r->material << 48;
}

static uint32_t slot_of(uint64_t key, const struct nm_from *from, uint32_t slot_count)
{
    const uint64_t before = (uint64_t)(uint32_t)from->row[NM_BK] << 32 | (uint32_t)from->row[NM_SP];
    const uint64_t mixed = key ^ before * 0xd6e8feb86659fd93u;
    return (uint32_t)((mixed * 0x9e3779b97f4a7c15u) >> 32) & (slot_count - 1);
}

static int table_open(struct table *t, uint32_t most, enum nm_connection connection)
{
    uint32_t slots = 64;
    while (slots / 2 < most) {
        slots *= 2;
    }
    const bool is_chained = connection == NM_BY_INTENSITY;
    *t = (struct table){calloc(most, sizeof *t->rows),
                        is_chained ? malloc((size_t)most * sizeof *t->from) : NULL,
                        0,
                        (int)most,
                        malloc(slots * sizeof *t->slots),
                        slots};
    if (!t->rows || !t->slots || (is_chained && !t->from)) {
        free(t->rows);
        free(t->from);
        free(t->slots);
        *t = (struct table){0};
        return hs_error("paths", "trace with fewer rays", "out of memory");
    }
    memset(t->slots, 0xff, slots * sizeof *t->slots);
    return 0;
}

static bool is_from(const struct table *t, int32_t row, const struct nm_from *from)
{
    return !t->from || (t->from[row].row[NM_BK] == from->row[NM_BK] &&
                        t->from[row].row[NM_SP] == from->row[NM_SP]);
}

static int32_t table_find(struct table *t, const struct nm_reflection *r,
                          const struct nm_from *from)
{
    static const struct nm_from any = {{-1, -1}};
    const uint64_t key = key_of(r);
    uint32_t slot = slot_of(key, t->from ? from : &any, t->slot_count);
    while (t->slots[slot] >= 0) {
        const int32_t row = t->slots[slot];
        if (key_of(&t->rows[row]) == key && is_from(t, row, from)) {
            return row;
        }
        slot = (slot + 1) & (t->slot_count - 1);
    }
    t->slots[slot] = t->count;
    t->rows[t->count] = *r;
    if (t->from) {
        t->from[t->count] = *from;
    }
    return t->count++;
}

/* The angle between the normal and the bisector of the way in and the way out: both ways have
 * length 1, so their sum has 2 cos(turn / 2). 0 where they oppose each other: a mirror, grazed. */
static double bisector_rad(const struct nm_reflection *r)
{
    const double both = 2 * cos(r->turn_rad / 2);
    const double along = cos(r->incidence_rad) + cos(r->leaving_rad);
    return both > 1e-9 ? acos(fmax(fmin(along / both, 1), -1)) : 0;
}

/* Each of them -1..1 for whatever may be: power that a smooth face reflects square on, angle of the
 * permittivity in its plane, and the heights' two lengths beside what is rough to an X band radar.
 */
static void surface_features(const struct nm_surface *s, double features[NM_SURFACE_INPUTS])
{
    static const double rough_m = 1e-3, wide_m = 0.02;
    const double complex e = s->permittivity - s->loss * I;
    const double reflected = cabs((csqrt(e) - 1) / (csqrt(e) + 1));
    features[0] = 2 * reflected * reflected - 1;
    features[1] = 4 * atan2(s->loss, s->permittivity) / pi - 1;
    features[2] = 2 * s->rms_height_m / (s->rms_height_m + rough_m) - 1;
    features[3] = 2 * s->correlation_m / (s->correlation_m + wide_m) - 1;
}

static void own_features(const struct nm_architecture *a, const struct nm_reflection *r,
                         double *features)
{
    static const double near_rad = 0.1, one = 4;
    const double off = bisector_rad(r);
    features[3] = 4 * off / pi - 1;
    features[4] = exp(-off / near_rad);
    features += NM_ANGLE_INPUTS;
    if (a->material == NM_AS_SURFACE) {
        surface_features(&r->surface, features);
        return;
    }
    if (a->material == NM_AS_NAME_AND_SIDE) {
        static const double wide = 2;
        *features++ = wide * sin(r->side_rad);
        *features++ = wide * cos(r->side_rad);
    }
    memset(features, 0, nm_architecture_names(a) * sizeof *features);
    features[r->material] = one;
}

void nm_features_of(const struct nm_architecture *a, const struct nm_reflection *r,
                    double intensity, double features[NM_INPUTS_MAX])
{
    double *angles = features;
    if (a->connection == NM_BY_INTENSITY) {
        features[a->network.inputs - 1] = NM_INTENSITY_SLOPE * intensity - 1;
    }
    if (a->material == NM_AS_NUMBER) {
        *angles++ = r->material - 1.0;
    }
    angles[0] = 4 * r->incidence_rad / pi - 1;
    angles[1] = 2 * r->leaving_rad / pi - 1;
    angles[2] = 2 * r->turn_rad / pi - 1;
    if (a->material != NM_AS_NUMBER) {
        own_features(a, r, features);
    }
}

int nm_materials_match(const struct nm_materials *known, const struct trace_records *records,
                       uint8_t number[TRACE_MATERIALS_MAX])
{
    for (uint32_t i = 0; i < records->material_count; i++) {
        uint32_t k = known ? 0 : i;
        while (known && k < known->count && strcmp(known->names[k], records->materials[i]) != 0) {
            k++;
        }
        if (known && k == known->count) {
            return hs_error(records->materials[i], "train on a model that has it, or rename it",
                            "a material of the model that the training does not know");
        }
        number[i] = (uint8_t)k;
    }
    return 0;
}

/* Where the records of the bounces stand while one ray after the other is followed. */
struct cursor {
    const struct trace_records *records;
    uint32_t at[TRACE_BOUNCES_MAX];
};

/* The records of the next ray, in order of bounces; returns how many, 0 at the end. */
static int next_ray(struct cursor *c, const struct trace_record *way[TRACE_BOUNCES_MAX])
{
    const struct trace_bounce *bounces = c->records->bounces;
    if (c->at[0] == bounces[0].count) {
        return 0;
    }
    way[0] = &bounces[0].records[c->at[0]++];
    int count = 1;
    for (; count < (int)c->records->bounce_count; count++) {
        const uint32_t at = c->at[count];
        if (at == bounces[count].count || bounces[count].records[at].ray != way[0]->ray) {
            break;
        }
        way[count] = &bounces[count].records[c->at[count]++];
    }
    return count;
}

static int32_t cell_of(const struct trace_grid *grid, const struct trace_record *r)
{
    return r->flags & TRACE_BLOCKED ? -1 : trace_cell(grid, r->across_m, r->range_m);
}

/* By a record's material; and from where all of them are seen. */
struct numbered {
    double side_rad;
    uint8_t number[TRACE_MATERIALS_MAX];
    struct nm_surface surface[TRACE_MATERIALS_MAX];
};

/* The ray's steps up to its last echo in the picture; returns their number. */
static int take_ray(const struct trace_grid *grid, const struct trace_record *const *way, int count,
                    const struct numbered *materials, struct table tables[NM_DIRECTIONS],
                    struct nm_step *steps)
{
    struct nm_from from = {{-1, -1}};
    while (count > 0 && cell_of(grid, way[count - 1]) < 0) {
        count--;
    }
    for (int b = 0; b < count; b++) {
        const double incidence = (double)way[b]->incidence_rad;
        const uint8_t material = way[b]->material;
        const int number = materials->number[material];
        const struct nm_surface surface = materials->surface[material];
        const struct nm_reflection bk = {
            incidence, (double)way[b]->echo_rad, (double)way[b]->turn_rad, number,
            surface,   materials->side_rad};
        const struct nm_reflection sp = {incidence, incidence, 2 * incidence,
                                         number,    surface,   materials->side_rad};
        steps[b] = (struct nm_step){.cell = cell_of(grid, way[b])};
        steps[b].row[NM_BK] = table_find(&tables[NM_BK], &bk, &from);
        steps[b].row[NM_SP] = b + 1 < count ? table_find(&tables[NM_SP], &sp, &from) : -1;
        from = (struct nm_from){{steps[b].row[NM_BK], steps[b].row[NM_SP]}};
    }
    return count;
}

static void take_rays(struct nm_paths *p, const struct trace_records *records,
                      const struct numbered *materials, struct table tables[NM_DIRECTIONS])
{
    struct cursor cursor = {records, {0}};
    const struct trace_record *way[TRACE_BOUNCES_MAX];
    int32_t used = 0;
    for (int count; (count = next_ray(&cursor, way)) > 0;) {
        count = take_ray(&records->grid, way, count, materials, tables, p->steps + used);
        if (count > 0) {
            p->first[p->ray_count++] = used;
            used += count;
        }
    }
    p->first[p->ray_count] = used;
}

int nm_paths_build(struct nm_paths *p, const struct trace_records *records,
                   const struct nm_materials *known, enum nm_connection connection)
{
    struct numbered materials = {.side_rad = records->look.azimuth_deg * pi / 180};
    uint32_t total = 0;
    *p = (struct nm_paths){0};
    if (nm_materials_match(known, records, materials.number) != 0) {
        return -1;
    }
    for (uint32_t i = 0; known && i < records->material_count; i++) {
        materials.surface[i] = known->surfaces[materials.number[i]];
    }
    for (uint32_t b = 0; b < records->bounce_count; b++) {
        total += records->bounces[b].count;
    }
    const struct trace_sensor *sensor = &records->sensor;
    const struct trace_grid *grid = &records->grid;
    *p = (struct nm_paths){
        .connection = connection,
        .cells_across = (int)grid->cells_across,
        .cells_range = (int)grid->cells_range,
        .ray_weight = sensor->step_across_m * sensor->step_up_m / (grid->cell_m * grid->cell_m),
        .first = malloc(((size_t)records->bounces[0].count + 1) * sizeof *p->first),
        .steps = malloc(((size_t)total + 1) * sizeof *p->steps),
    };
    struct table tables[NM_DIRECTIONS] = {{0}};
    int result = p->first && p->steps ? 0 : hs_error("paths", NULL, "out of memory");
    for (int d = 0; d < NM_DIRECTIONS && result == 0; d++) {
        result = table_open(&tables[d], total + 1, connection);
    }
    if (result == 0) {
        take_rays(p, records, &materials, tables);
    }
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        p->table[d] = tables[d].rows;
        p->from[d] = tables[d].from;
        p->rows[d] = tables[d].count;
        free(tables[d].slots);
    }
    if (result == 0 && connection == NM_BY_INTENSITY) {
        result = nm_paths_order(p);
    }
    if (result != 0) {
        nm_paths_free(p);
    }
    return result;
}

void nm_paths_free(struct nm_paths *p)
{
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        free(p->table[d]);
        free(p->from[d]);
    }
    free(p->first);
    free(p->steps);
    *p = (struct nm_paths){0};
}

void nm_paths_render(const struct nm_paths *p, const struct nm_coefficients *c, double *image)
{
    memset(image, 0, (size_t)p->cells_across * (size_t)p->cells_range * sizeof *image);
    for (int i = 0; i < p->ray_count; i++) {
        double power = p->ray_weight;
        for (int32_t s = p->first[i]; s < p->first[i + 1]; s++) {
            const struct nm_step *step = &p->steps[s];
            if (step->cell >= 0) {
                image[step->cell] += power * c->bk[step->row[NM_BK]];
            }
            if (step->row[NM_SP] >= 0 && c->connection == NM_BY_COEFFICIENT) {
                power *= c->sp[step->row[c->sp_by]];
            }
        }
    }
}

/* For one ray: `powers` before each step, and from the last step back, `worth`, the derivative of
 * the loss by the power that arrives. */
static void ray_backward(const struct nm_step *steps, int count, double weight,
                         const struct nm_coefficients *c, const double *d_image, double *bk,
                         double *sp)
{
    double powers[TRACE_BOUNCES_MAX] = {weight}, worth = 0;
    for (int s = 1; s < count; s++) {
        powers[s] = powers[s - 1] * c->sp[steps[s - 1].row[c->sp_by]];
    }
    for (int s = count - 1; s >= 0; s--) {
        const struct nm_step *step = &steps[s];
        if (step->row[NM_SP] >= 0) {
            const int32_t row = step->row[c->sp_by];
            sp[row] += powers[s] * worth;
            worth *= c->sp[row];
        }
        if (step->cell >= 0) {
            bk[step->row[NM_BK]] += powers[s] * d_image[step->cell];
            worth += c->bk[step->row[NM_BK]] * d_image[step->cell];
        }
    }
}

/* Intensities are added as they are; what went on is the next network's business (netem.h). */
static void intensities_backward(const struct nm_paths *p, const double *d_image, double *bk)
{
    for (int32_t s = 0; s < p->first[p->ray_count]; s++) {
        if (p->steps[s].cell >= 0) {
            bk[p->steps[s].row[NM_BK]] += p->ray_weight * d_image[p->steps[s].cell];
        }
    }
}

void nm_paths_backward(const struct nm_paths *p, const struct nm_coefficients *c,
                       const double *d_image, double *bk, double *sp)
{
    if (c->connection == NM_BY_INTENSITY) {
        intensities_backward(p, d_image, bk);
        return;
    }
    for (int i = 0; i < p->ray_count; i++) {
        ray_backward(p->steps + p->first[i], p->first[i + 1] - p->first[i], p->ray_weight, c,
                     d_image, bk, sp);
    }
}
