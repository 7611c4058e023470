#include "commands.h"

#include "hs/error.h"
#include "tracer/accumulate.h"
#include "tracer/bake_settings.h"

#include <math.h>

static const struct hs_usage usage = {
    "bake", "make the signature of a model, for the display unit",
    "Traces the model from all sides and keeps what the radar sees as chips of ground pixels, "
    "with\n"
    "the shadow, in FILE.sig, which a list of targets takes into the database: docs/targets.md.\n"
    "The cells that rays meet are a quarter of a pixel."};

/* A law, and what it was made for. */
struct law_maker {
    const struct setup *setup;
    struct reflect_law law;
    bool is_known;
};

static int draw_by_law(void *ctx, const struct trace_records *r, float *power)
{
    struct law_maker *maker = ctx;
    if (!maker->is_known && setup_law(maker->setup, r, &maker->law) != 0) {
        return -1;
    }
    maker->is_known = true;
    return accumulate(r, &maker->law, power);
}

static int run(const struct setup *setup, const struct bake_settings *settings)
{
    struct mesh m;
    struct bake_order order;
    struct law_maker maker = {.setup = setup};
    if (setup_load(setup, &m) != 0) {
        return -1;
    }
    int result = bake_plan(settings, setup, &m, &order);
    order.maker = (struct bake_maker){&maker, draw_by_law};
    if (result == 0) {
        result = bake_run(settings, &order, &m);
    }
    mesh_free(&m);
    return result;
}

int target_cmd_bake(int argc, char **argv)
{
    struct setup setup = setup_default();
    /* A matt white surface of 1 m2, seen straight on, has a cross section of 4 m2 (reflect.h). */
    struct bake_settings settings = bake_settings_default(10 * log10(4));
    enum { RAYS = BAKE_OPTIONS + SETUP_MODEL_OPTIONS, LAW = RAYS + SETUP_RAY_OPTIONS };
    struct hs_option options[LAW + SETUP_LAW_OPTIONS];
    int exit_code;
    setup_model_options(&setup, options);
    bake_options(&settings, options + SETUP_MODEL_OPTIONS);
    setup_ray_options(&setup, options + RAYS);
    setup_law_options(&setup, options + LAW);
    if (hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                        &exit_code)) {
        exit_code = run(&setup, &settings) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    bake_settings_free(&settings);
    return exit_code;
}
