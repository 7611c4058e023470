#include "known_records.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* A plane that is `across_m` by `up_m` around the origin, and empty lists for all its rays. */
static void start(struct trace_records *r, double across_m, double up_m, double reach_m,
                  double depression_deg, uint32_t rays)
{
    const double cell_m = 0.1;
    *r = (struct trace_records){
        .look = {0, depression_deg, 0.03125},
        .grid = {2 * (uint32_t)ceil(across_m / 2 / cell_m + 1),
                 2 * (uint32_t)ceil(reach_m / cell_m + 1), cell_m},
        .sensor = {rays, rays, across_m / rays, up_m / rays, -across_m / 2, -up_m / 2},
    };
}

static void add_bounce(struct trace_records *r)
{
    const uint32_t count = r->sensor.columns * r->sensor.rows;
    r->bounces[r->bounce_count++] = (struct trace_bounce){calloc(count, TRACE_RECORD_BYTES), count};
}

static double ray_across_m(const struct trace_records *r, uint32_t ray)
{
    return r->sensor.low_across_m + (ray % r->sensor.columns + 0.5) * r->sensor.step_across_m;
}

static double ray_up_m(const struct trace_records *r, uint32_t ray)
{
    return r->sensor.low_up_m + (ray / r->sensor.columns + 0.5) * r->sensor.step_up_m;
}

/* A record on a surface with material `material`, the radar at `theta` from its normal. */
static struct trace_record record(const struct trace_records *r, uint32_t ray, double range_m,
                                  double theta, int is_wall)
{
    return (struct trace_record){
        .ray = ray,
        .across_m = (float)ray_across_m(r, ray),
        .range_m = (float)range_m,
        .phase_rad = (float)remainder(-4 * pi * range_m / r->look.wavelength_m, 2 * pi),
        .hop_m = (float)range_m,
        .incidence_rad = (float)theta,
        .echo_rad = (float)theta,
        .normal = {0, is_wall ? -1 : 0, is_wall ? 0 : 1},
    };
}

void known_plate(struct trace_records *r, double side_m, double depression_deg, uint32_t rays)
{
    const double psi = depression_deg * pi / 180;
    start(r, side_m, side_m * sin(psi), side_m * cos(psi) / 2, depression_deg, rays);
    r->material_count = 1;
    strcpy(r->materials[0], "metal");
    add_bounce(r);
    for (uint32_t i = 0; i < r->bounces[0].count; i++) {
        r->bounces[0].records[i] = record(r, i, ray_up_m(r, i) / tan(psi), pi / 2 - psi, 0);
    }
}

void known_dihedral(struct trace_records *r, double side_m, double height_m, double depression_deg,
                    uint32_t rays)
{
    const double psi = depression_deg * pi / 180;
    start(r, side_m, 2 * height_m * cos(psi), height_m / tan(psi) * cos(psi), depression_deg, rays);
    r->material_count = 2;
    strcpy(r->materials[0], "metal");
    strcpy(r->materials[1], "floor");
    add_bounce(r);
    add_bounce(r);
    for (uint32_t i = 0; i < r->bounces[0].count; i++) {
        const double up_m = ray_up_m(r, i); /* on the plane: height * cos psi, or away * sin psi */
        const int is_wall = up_m > 0;
        const double wall = psi, floor = pi / 2 - psi;
        struct trace_record *first = &r->bounces[0].records[i];
        struct trace_record *second = &r->bounces[1].records[i];
        *first = record(r, i, is_wall ? -up_m * tan(psi) : up_m / tan(psi), is_wall ? wall : floor,
                        is_wall);
        first->material = is_wall ? 0 : 1;
        first->flags = TRACE_GOES_ON;
        *second = record(r, i, 0, is_wall ? floor : wall, !is_wall);
        second->parent = i;
        second->material = is_wall ? 1 : 0;
        second->hop_m = (float)(is_wall ? up_m / cos(psi) / sin(psi) : -up_m / sin(psi) / cos(psi));
        second->turn_rad = 2 * second->incidence_rad;
    }
}
