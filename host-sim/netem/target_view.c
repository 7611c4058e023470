#include "netem/target_view.h"

#include "hs/error.h"
#include "netem/netpix.h"

#include <math.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

int nm_target_view_open(struct nm_target_view *v, const struct setup *setup,
                        double lowest_depression_deg)
{
    *v = (struct nm_target_view){.setup = *setup};
    if (setup->cells % NM_CELLS_PER_PIXEL != 0) {
        return hs_error("--cells", NULL, "must be even: a pixel is %d cells wide",
                        NM_CELLS_PER_PIXEL);
    }
    if (pix_resolution_check(setup->resolution_m, setup->cell_m) != 0) {
        return -1;
    }
    v->setup.depression_deg = lowest_depression_deg;
    return setup_scene(&v->setup, &v->scene);
}

void nm_target_view_close(struct nm_target_view *v)
{
    scene_close(&v->scene);
}

/* The law by the numbers that the paths have. */
static int take_law(const struct nm_target_view *v, const struct trace_records *records,
                    struct reflect_law *law)
{
    struct reflect_law by_record;
    uint8_t number[TRACE_MATERIALS_MAX];
    if (setup_law(&v->setup, records, &by_record) != 0 ||
        nm_materials_match(v->known, records, number) != 0) {
        return -1;
    }
    *law = by_record;
    for (uint32_t i = 0; i < records->material_count; i++) {
        law->materials[number[i]] = by_record.materials[i];
    }
    return 0;
}

int nm_target_view_paths(const struct nm_target_view *v, double azimuth_deg, double depression_deg,
                         struct nm_paths *paths, struct reflect_law *law)
{
    struct trace_order order = setup_order(&v->setup, azimuth_deg);
    struct trace_records records;
    order.look.depression_deg = depression_deg;
    if (trace_run(&v->scene, &order, v->setup.model, &records, NULL) != 0) {
        return -1;
    }
    int result = law ? take_law(v, &records, law) : 0;
    result = result == 0 ? nm_paths_build(paths, &records, v->known, v->connection) : -1;
    trace_records_free(&records);
    return result;
}

double nm_law_ask(const struct reflect_law *law, const struct nm_reflection *r,
                  enum nm_direction direction)
{
    const struct trace_record record = {
        .incidence_rad = (float)r->incidence_rad,
        .echo_rad = (float)r->leaving_rad,
        .turn_rad = (float)r->turn_rad,
        .material = (uint8_t)r->material,
    };
    const struct reflect_shares shares = reflect_record(law, &record);
    return (double)(direction == NM_BK ? shares.back : shares.specular);
}

int nm_draw_by_law(const struct nm_paths *paths, const struct reflect_law *law, double *picture)
{
    double *values[NM_DIRECTIONS];
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        values[d] = malloc(((size_t)paths->rows[d] + 1) * sizeof **values);
        for (int r = 0; values[d] && r < paths->rows[d]; r++) {
            values[d][r] = nm_law_ask(law, &paths->table[d][r], (enum nm_direction)d);
        }
    }
    const struct nm_coefficients c = {values[NM_BK], values[NM_SP], NM_SP, NM_BY_COEFFICIENT};
    const int is_whole = values[NM_BK] && values[NM_SP];
    if (is_whole) {
        nm_paths_render(paths, &c, picture);
    }
    free(values[NM_BK]);
    free(values[NM_SP]);
    return is_whole ? 0 : hs_error("picture", NULL, "out of memory");
}

int nm_law_amplitudes(const struct setup *setup, const double *picture, double *amplitudes)
{
    const int cells = (int)setup->cells, side = cells / NM_CELLS_PER_PIXEL;
    const int aperture = pix_aperture(setup->resolution_m, setup->cell_m);
    float *power = malloc((size_t)cells * (size_t)cells * sizeof *power);
    if (!power) {
        return hs_error("picture", "give fewer --cells", "out of memory");
    }
    for (int i = 0; i < cells * cells; i++) {
        power[i] = (float)(picture[i] * setup->cell_m * setup->cell_m);
    }
    const int result = pix_spread(power, cells, cells, aperture);
    if (result == 0) {
        pix_coarsen(power, cells, cells, NM_CELLS_PER_PIXEL, power);
    }
    for (int i = 0; i < side * side && result == 0; i++) {
        amplitudes[i] = sqrt((double)power[i]);
    }
    free(power);
    return result;
}

void nm_kernel_make(double resolution_m, double cell_m, double gain, double *kernel)
{
    double line[PIX_KERNEL_SIDE];
    _Static_assert((int)PIX_KERNEL_SIDE == (int)NM_LARGE, "one kernel in both");
    pix_taylor(pix_aperture(resolution_m, cell_m), line);
    for (int i = 0; i < NM_LARGE * NM_LARGE; i++) {
        kernel[i] = gain * line[i / NM_LARGE] * line[i % NM_LARGE];
    }
}

double nm_kernel_gain(double cell_m, double wavelength_m)
{
    return sqrt(4 * pi) * cell_m * cell_m / wavelength_m;
}
