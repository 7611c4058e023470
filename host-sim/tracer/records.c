#include "tracer/records.h"

#include "hs/error.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

static const float pi_f = 3.14159274f; /* the float above pi: a rounded angle may reach it */

int32_t trace_cell(const struct trace_grid *grid, float across_m, float range_m)
{
    const double column = floor((double)across_m / grid->cell_m + grid->cells_across / 2.0);
    const double row = floor((double)range_m / grid->cell_m + grid->cells_range / 2.0);
    if (!(column >= 0 && column < grid->cells_across && row >= 0 && row < grid->cells_range)) {
        return -1;
    }
    return (int32_t)(row * grid->cells_across + column);
}

static float channel_of(const struct trace_record *t, enum trace_channel channel)
{
    switch (channel) {
    case TRACE_IS_BLOCKED:
        return (float)(t->flags & TRACE_BLOCKED);
    case TRACE_MATERIAL:
        return (float)t->material;
    case TRACE_INCIDENCE:
        return t->incidence_rad;
    case TRACE_ECHO:
        return t->echo_rad;
    case TRACE_TURN:
        return t->turn_rad;
    case TRACE_PHASE:
        return t->phase_rad;
    case TRACE_ACROSS:
        return t->across_m;
    case TRACE_RANGE:
        return t->range_m;
    case TRACE_CHANNELS:
        break;
    }
    return NAN;
}

void trace_image(const struct trace_records *r, uint32_t bounce, enum trace_channel channel,
                 float *image)
{
    const size_t rays = (size_t)r->sensor.columns * r->sensor.rows;
    for (size_t i = 0; i < rays; i++) {
        image[i] = NAN;
    }
    const struct trace_bounce *b = &r->bounces[bounce];
    for (uint32_t i = 0; i < b->count; i++) {
        image[b->records[i].ray] = channel_of(&b->records[i], channel);
    }
}

/* Both false for a NaN. */
static bool is_within(double x, double low, double high)
{
    return x >= low && x <= high;
}

static bool is_length(float x)
{
    return is_within((double)x, -1e6, 1e6);
}

static const char *record_fault(const struct trace_records *r, const struct trace_record *t)
{
    const float *n = t->normal;
    if (t->ray >= r->sensor.columns * r->sensor.rows) {
        return "its ray is outside the sensor plane";
    }
    if (t->material >= r->material_count) {
        return "its material is not in the list";
    }
    if ((t->flags & ~(TRACE_BLOCKED | TRACE_GOES_ON)) != 0 || t->reserved != 0) {
        return "it has unknown flags";
    }
    if (!is_length(t->across_m) || !is_length(t->range_m) || !is_length(t->hop_m)) {
        return "a length is out of range";
    }
    if (!(fabsf(t->phase_rad) <= pi_f) || !is_within((double)t->turn_rad, 0, (double)pi_f) ||
        !is_within((double)t->incidence_rad, 0, (double)pi_f / 2) ||
        !is_within((double)t->echo_rad, 0, (double)pi_f)) {
        return "an angle is out of range";
    }
    if (t->echo_rad > pi_f / 2 && !(t->flags & TRACE_BLOCKED)) {
        return "its surface faces away from the radar and is not blocked";
    }
    if (!(fabsf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2] - 1) < 1e-3f)) {
        return "its normal is no unit vector";
    }
    return NULL;
}

/* What record i of bounce b has to do with its neighbours. */
static const char *order_fault(const struct trace_records *r, uint32_t b, uint32_t i)
{
    const struct trace_record *t = &r->bounces[b].records[i];
    if (i > 0 && t[-1].ray >= t->ray) {
        return "it is out of order";
    }
    if (b == 0) {
        return t->parent == 0 ? NULL : "a first reflection has no parent";
    }
    const struct trace_bounce *before = &r->bounces[b - 1];
    if (t->parent >= before->count || before->records[t->parent].ray != t->ray ||
        !(before->records[t->parent].flags & TRACE_GOES_ON)) {
        return "its parent is another ray's";
    }
    return NULL;
}

static int check_bounce(const struct trace_records *r, uint32_t b, const char *place)
{
    const struct trace_bounce *bounce = &r->bounces[b];
    uint32_t go_on = 0;
    for (uint32_t i = 0; i < bounce->count; i++) {
        const char *fault = record_fault(r, &bounce->records[i]);
        fault = fault ? fault : order_fault(r, b, i);
        if (fault) {
            return hs_error(place, "trace the target again", "record %u of bounce %u: %s", i, b + 1,
                            fault);
        }
        go_on += (bounce->records[i].flags & TRACE_GOES_ON) != 0;
    }
    const uint32_t next = b + 1 < r->bounce_count ? r->bounces[b + 1].count : 0;
    return go_on == next ? 0
                         : hs_error(place, "trace the target again",
                                    "%u rays go on after bounce %u, but %u meet something", go_on,
                                    b + 1, next);
}

/* Printable, and ended within its field. */
static bool is_name(const char *name)
{
    size_t length = 0;
    while (length < TRACE_NAME_SIZE && name[length] > ' ' && name[length] < 127) {
        length++;
    }
    return length > 0 && length < TRACE_NAME_SIZE && name[length] == '\0';
}

static bool is_distance(double x)
{
    return x == 0 || is_within(x, 0.01, 1e7);
}

static bool are_ends_sound(const struct trace_ends *e)
{
    if (!e->is_apart) {
        return is_distance(e->distance_m) && e->receiver_azimuth_deg == 0 &&
               e->receiver_depression_deg == 0 && e->receiver_distance_m == 0;
    }
    return is_distance(e->distance_m) && is_distance(e->receiver_distance_m) &&
           is_within(e->receiver_azimuth_deg, 0, nextafter(360, 0)) &&
           is_within(e->receiver_depression_deg, 1e-3, 90 - 1e-3);
}

static const char *head_fault(const struct trace_records *r)
{
    const struct trace_look *look = &r->look;
    const struct trace_grid *grid = &r->grid;
    const struct trace_sensor *s = &r->sensor;
    if (!is_within(look->azimuth_deg, 0, nextafter(360, 0)) ||
        !is_within(look->depression_deg, 1e-3, 90 - 1e-3) ||
        !is_within(look->wavelength_m, 1e-3, 10)) {
        return "the look is out of range";
    }
    if (!are_ends_sound(&r->ends)) {
        return "where transmitter and receiver stand is out of range";
    }
    if (grid->cells_across - 1 >= TRACE_CELLS_MAX || grid->cells_range - 1 >= TRACE_CELLS_MAX ||
        !is_within(grid->cell_m, 1e-3, 1000)) {
        return "the grid of cells is out of range";
    }
    if (s->columns == 0 || s->rows == 0 || s->columns > TRACE_RAYS_MAX / s->rows ||
        !is_within(s->step_across_m, 1e-6, 1000) || !is_within(s->step_up_m, 1e-6, 1000) ||
        !is_within(s->low_across_m, -1e6, 1e6) || !is_within(s->low_up_m, -1e6, 1e6)) {
        return "the sensor plane is out of range";
    }
    if (r->material_count - 1 >= TRACE_MATERIALS_MAX || r->bounce_count - 1 >= TRACE_BOUNCES_MAX) {
        return "the number of materials or bounces is out of range";
    }
    for (uint32_t m = 0; m < r->material_count; m++) {
        if (!is_name(r->materials[m])) {
            return "the name of a material is empty, too long or not printable";
        }
    }
    return NULL;
}

int trace_records_check(const struct trace_records *r, const char *place)
{
    const char *fault = head_fault(r);
    if (fault) {
        return hs_error(place, "trace the target again", "%s", fault);
    }
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        if (check_bounce(r, b, place) != 0) {
            return -1;
        }
    }
    return 0;
}

void trace_records_free(struct trace_records *r)
{
    for (int b = 0; b < TRACE_BOUNCES_MAX; b++) {
        free(r->bounces[b].records);
    }
    *r = (struct trace_records){0};
}
