#include "tracer/accumulate.h"

#include "hs/error.h"
#include "tracer/ends.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* To the law, rays that meet the same facet from the same side are alike, and they mostly follow
 * one another. */
static bool is_alike(const struct trace_record *a, const struct trace_record *b)
{
    return a->incidence_rad == b->incidence_rad && a->echo_rad == b->echo_rad &&
           a->turn_rad == b->turn_rad && a->material == b->material;
}

/* Go through one bounce. `in` are the intensities that went on from the bounce before, by record of
 * that bounce, or NULL before the first; `out` gets those that go on from this one. */
static void add_bounce(const struct trace_records *r, const struct reflect_law *law, uint32_t b,
                       const float *in, float *out, float *picture)
{
    const float area_m2 = (float)(r->sensor.step_across_m * r->sensor.step_up_m);
    const bool is_plain = ends_are_plain(&r->ends);
    const struct trace_bounce *bounce = &r->bounces[b];
    struct reflect_shares s = {0, 0};
    for (uint32_t i = 0; i < bounce->count; i++) {
        const struct trace_record *t = &bounce->records[i];
        s = i > 0 && is_alike(t, t - 1) ? s : reflect_record(law, t);
        const float arriving = in ? in[t->parent] : 1;
        out[i] = arriving * s.specular;
        const int32_t cell =
            t->flags & TRACE_BLOCKED ? -1 : trace_cell(&r->grid, t->across_m, t->range_m);
        if (cell >= 0) {
            const float own_m2 = is_plain ? area_m2 : (float)ends_echo_m2(r, b, t);
            picture[cell] += arriving * s.back * own_m2;
        }
    }
}

int accumulate(const struct trace_records *r, const struct reflect_law *law, float *picture)
{
    memset(picture, 0, (size_t)r->grid.cells_across * r->grid.cells_range * sizeof *picture);
    float *in = NULL;
    for (uint32_t b = 0; b < r->bounce_count; b++) {
        float *out = malloc((r->bounces[b].count + 1) * sizeof *out);
        if (!out) {
            free(in);
            return hs_error("picture", NULL, "out of memory");
        }
        add_bounce(r, law, b, in, out, picture);
        free(in);
        in = out;
    }
    free(in);
    return 0;
}
