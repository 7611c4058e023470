#include "commands.h"

#include "hs/error.h"
#include "netem/model_file.h"
#include "netem/settings.h"
#include "netem/surfaces.h"
#include "tracer/bake_settings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    "bake", "the signature of what was learned, for the display unit",
    "Traces the model from all sides, lets the learned networks say what each reflection returns,\n"
    "and keeps it as chips of ground pixels, with the shadow, in FILE.sig: docs/targets.md. Cells\n"
    "are 0.1 m, as in training. Without the learned pixels: the display has its own."};

enum { CELLS_MIN = 64, CELLS_MAX = 1024, MIDDLE = NM_LARGE / 2 };

/* The networks, and the response under which their amplitudes mean something. */
struct net_maker {
    struct nm_training *training; /* owned */
    const struct setup *setup;
    bool has_met; /* the model's materials */
    double kernel[NM_LARGE * NM_LARGE];
    double lobe; /* sum of its squares over the middle's: cells of full amplitude */
};

/* ---- power ---- */

/* The fixed kernel's main lobe: the display has side lobes of its own. */
static void take_lobe(struct net_maker *maker)
{
    const double *middle = maker->training->model.kernel + MIDDLE * NM_LARGE + MIDDLE;
    int reach = 1;
    while (reach < MIDDLE && middle[reach + 1] < middle[reach]) {
        reach++;
    }
    for (int i = 0; i < NM_LARGE * NM_LARGE; i++) {
        const int row = abs(i / NM_LARGE - MIDDLE), column = abs(i % NM_LARGE - MIDDLE);
        const bool is_in = row <= reach && column <= reach;
        maker->kernel[i] = is_in ? maker->training->model.kernel[i] : 0;
        maker->lobe += maker->kernel[i] * maker->kernel[i] / (*middle * *middle);
    }
}

/* Once: the records of all looks have the same materials. */
static int meet(struct net_maker *maker, const struct trace_records *r)
{
    if (maker->has_met || maker->training->model.architecture->material != NM_AS_SURFACE) {
        return 0;
    }
    maker->has_met = true;
    return nm_surfaces_introduce(&maker->training->materials, maker->setup, r->materials,
                                 r->material_count);
}

/* A calibrated chip's amplitude is the root of a cross section at the peak of a response
 * (nm_kernel_gain); as power that is shared by the cells under the lobe. */
static int draw_by_networks(void *ctx, const struct trace_records *r, float *power)
{
    struct net_maker *maker = ctx;
    struct nm_simulator *s = &maker->training->simulator;
    struct nm_paths paths;
    if (meet(maker, r) != 0 ||
        nm_paths_build(&paths, r, &maker->training->materials,
                       maker->training->model.architecture->connection) != 0) {
        return -1;
    }
    const int result = nm_simulate_picture(s, &maker->training->model, &paths);
    nm_paths_free(&paths);
    if (result != 0) {
        return -1;
    }
    nm_netpix_fixed(&s->pix, maker->kernel, s->picture, s->pixels);
    for (uint32_t i = 0; i < r->grid.cells_across * r->grid.cells_range; i++) {
        power[i] = (float)(s->pix.cells[i] * s->pix.cells[i] / maker->lobe);
    }
    return 0;
}

/* ---- cells ---- */

/* The networks' pictures are square, and of one size. */
static int choose_cells(struct bake_order *o, double cell_m)
{
    const struct trace_grid g = bake_grid(&o->layout, cell_m, o->looks.depression_deg[0]);
    const uint32_t larger = g.cells_across > g.cells_range ? g.cells_across : g.cells_range;
    const uint32_t cells = larger > CELLS_MIN ? larger : CELLS_MIN;
    o->grid = (struct trace_grid){cells, cells, cell_m};
    return cells <= CELLS_MAX
               ? 0
               : hs_error(o->place, "give --depressions without the flattest",
                          "needs %u cells of %g m, more than %d", cells, cell_m, CELLS_MAX);
}

static int open_networks(struct net_maker *maker, const char *path, uint32_t cells)
{
    maker->training = calloc(1, sizeof *maker->training);
    if (!maker->training) {
        return hs_error(path, NULL, "out of memory");
    }
    if (nm_model_read(maker->training, path, (int)cells) != 0) {
        free(maker->training);
        maker->training = NULL;
        return -1;
    }
    take_lobe(maker);
    return nm_surfaces_allow(maker->setup, maker->training->model.architecture);
}

static int bake_mesh(const struct setup *setup, const struct bake_settings *settings,
                     const char *training, const struct mesh *m)
{
    struct bake_order order;
    struct net_maker maker = {.setup = setup};
    if (bake_plan(settings, setup, m, &order) != 0 || choose_cells(&order, setup->cell_m) != 0) {
        return -1;
    }
    int result = open_networks(&maker, training, order.grid.cells_across);
    if (result == 0) {
        order.maker = (struct bake_maker){&maker, draw_by_networks};
        result = bake_run(settings, &order, m);
    }
    if (maker.training) {
        nm_training_close(maker.training);
    }
    free(maker.training);
    return result;
}

int nm_cmd_bake(int argc, char **argv)
{
    struct setup setup = setup_default();
    struct bake_settings settings = bake_settings_default(0);
    const char *training = NULL;
    enum { BAKE = 2 + SETUP_MODEL_OPTIONS, RAYS = BAKE + BAKE_OPTIONS };
    struct hs_option options[RAYS + SETUP_RAY_OPTIONS] = {
        {"training", HS_INPUT, &training, 0, 0, "FILE", "that `train` left", true},
        nm_surfaces_option(&setup)};
    int exit_code;
    setup_model_options(&setup, options + 2);
    bake_options(&settings, options + BAKE);
    setup_ray_options(&setup, options + RAYS);
    if (hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                        &exit_code)) {
        struct mesh m;
        exit_code = HS_EXIT_FAILED;
        if (setup_load(&setup, &m) == 0) {
            exit_code =
                bake_mesh(&setup, &settings, training, &m) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
            mesh_free(&m);
        }
    }
    bake_settings_free(&settings);
    return exit_code;
}
