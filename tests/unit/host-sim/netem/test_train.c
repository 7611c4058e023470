/* Training: a reflection law that only the pictures know is found again, on aspects never shown; a
 * killed training goes on to the same bits. */
#include "check.h"
#include "facets.h"
#include "netem/model_file.h"
#include "netem/null_model.h"
#include "netem/surfaces.h"
#include "support.h"

#include <cblas.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { CELLS = 32, SIDE = 16, RAYS = 20, TRAINING = 12, CHIPS = 16 };

/* Those of facets_make: the second absorbs, the third is metal. */
static const struct nm_materials surfaces = {
    3,
    {"metal", "ground", "rubber"},
    {{4, 0, 1e-3, 0.02}, {12, 0, 1e-3, 0.02}, {1e9, 0, 1e-3, 0.02}},
};

/* Fresnel power at vertical polarisation, eq. (6) squared. */
static double hidden_law(const struct nm_reflection *r)
{
    const double e = r->surface.permittivity, c = cos(r->incidence_rad);
    const double s = sin(r->incidence_rad), root = sqrt(e - s * s);
    const double amplitude = (e * c - root) / (e * c + root);
    return amplitude * amplitude;
}

/* Echoes fall off to the sides as well. */
static double hidden_echo(const struct nm_reflection *r)
{
    return hidden_law(r) * cos(r->leaving_rad);
}

/* What roughness leaves of a mirror's power, as Ament has it. */
static double smooth_share(const struct nm_reflection *r)
{
    const double turns = 2 * r->surface.rms_height_m * cos(r->incidence_rad) / 0.03125;
    return exp(-pow(2 * acos(-1) * turns, 2));
}

static double rough_law(const struct nm_reflection *r)
{
    return hidden_law(r) * smooth_share(r);
}

/* What is not mirrored goes to all sides, and half of it back. */
static double rough_echo(const struct nm_reflection *r)
{
    return hidden_law(r) * (1 - smooth_share(r)) * cos(r->leaving_rad) / 2;
}

/* A law that training is not told, by direction, and what it is a law of. */
struct law {
    const struct nm_materials *surfaces;
    double (*of[NM_DIRECTIONS])(const struct nm_reflection *r);
};

static const struct law fresnel = {&surfaces, {[NM_BK] = hidden_echo, [NM_SP] = hidden_law}};

/* Metal in three heights of roughness. */
static const struct nm_materials metals = {
    3,
    {"metal", "ground", "rubber"},
    {{1e9, 0, 1e-3, 0.02}, {1e9, 0, 3e-3, 0.02}, {1e9, 0, 8e-3, 0.02}},
};
static const struct law roughness = {&metals, {[NM_BK] = rough_echo, [NM_SP] = rough_law}};

static double plain_law(const struct nm_reflection *r)
{
    (void)r;
    return 0.5;
}

static void coefficients_of(const struct nm_paths *p, const struct law *law, double *values[2])
{
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        values[d] = malloc((size_t)(p->rows[d] + 1) * sizeof **values);
        for (int r = 0; r < p->rows[d]; r++) {
            values[d][r] = law->of[d](&p->table[d][r]);
        }
    }
}

struct world {
    const struct law *law;
    double *kernel;
    struct nm_training *training;
    struct nm_sample samples[CHIPS];
};

static void make_kernel(double *kernel)
{
    for (int i = 0; i < NM_LARGE * NM_LARGE; i++) {
        const double y = i / NM_LARGE - NM_LARGE / 2, x = i % NM_LARGE - NM_LARGE / 2;
        kernel[i] = 0.5 * exp(-(x * x + y * y) / 3);
    }
}

/* The real chip: the hidden law, moved by a hidden translation, with speckle of `looks` looks. */
static void make_chip(struct world *w, struct nm_sample *s, uint64_t aspect, int shift, int looks)
{
    static const struct law plain = {NULL, {plain_law, plain_law}};
    struct trace_records records;
    struct hs_rng rng;
    double *values[2], far[CELLS * CELLS];
    struct nm_simulator *simulator = &w->training->simulator;
    *s = (struct nm_sample){0};
    facets_make(&records, 100 + aspect, RAYS, CELLS);
    assert_int_equal(nm_paths_build(&s->paths, &records, w->law->surfaces,
                                    w->training->model.architecture->connection),
                     0);
    trace_records_free(&records);
    coefficients_of(&s->paths, &plain, values);
    s->own = malloc(sizeof far);
    nm_paths_render(&s->paths,
                    &(struct nm_coefficients){values[0], values[1], NM_SP, NM_BY_COEFFICIENT},
                    s->own);
    free(values[0]);
    free(values[1]);
    coefficients_of(&s->paths, w->law, values);
    nm_simulate_with(simulator, &w->training->model, &s->paths,
                     &(struct nm_coefficients){values[0], values[1], NM_SP, NM_BY_COEFFICIENT});
    free(values[0]);
    free(values[1]);
    hs_rng_seed(&rng, 7 + aspect);
    const int x0 = (int)hs_rng_below(&rng, (uint32_t)(2 * shift + 1));
    const int y0 = (int)hs_rng_below(&rng, (uint32_t)(2 * shift + 1));
    assert_int_equal(nm_picture_open(&s->real, SIDE + 2 * shift, SIDE + 2 * shift), 0);
    for (int i = 0; i < SIDE * SIDE; i++) {
        double power = looks > 0 ? 0 : 1;
        for (int l = 0; l < looks; l++) {
            power -= log(1 - hs_rng_uniform(&rng)) / looks;
        }
        const int at = (y0 + i / SIDE) * s->real.width + x0 + i % SIDE;
        s->real.pixels[at] = tanh(atanh(simulator->pixels[i]) * sqrt(power));
    }
    s->origin = nm_picture_middle(&s->real, SIDE);
    snprintf(s->name, sizeof s->name, "aspect %d", (int)aspect);
}

static void open_by_law(struct world *w, const struct law *law, const struct nm_plan *plan,
                        const struct nm_architecture *architecture, int looks)
{
    w->law = law;
    w->kernel = calloc(NM_LARGE * NM_LARGE, sizeof *w->kernel);
    w->training = malloc(sizeof *w->training);
    make_kernel(w->kernel);
    assert_int_equal(nm_training_open(w->training, plan, architecture, w->kernel, CELLS), 0);
    w->training->materials = *law->surfaces;
    for (int i = 0; i < CHIPS; i++) {
        make_chip(w, &w->samples[i], (uint64_t)i, plan->reach_px, looks);
    }
}

static void open_connected(struct world *w, const struct nm_plan *plan,
                           const struct nm_architecture *architecture, int looks)
{
    open_by_law(w, &fresnel, plan, architecture, looks);
}

static void open_world(struct world *w, const struct nm_plan *plan, const char *name, int looks)
{
    open_connected(w, plan, nm_architecture_find(name, NM_BY_COEFFICIENT), looks);
}

static void close_world(struct world *w)
{
    for (int i = 0; i < CHIPS; i++) {
        nm_sample_free(&w->samples[i]);
    }
    nm_training_close(w->training);
    free(w->training);
    free(w->kernel);
}

static void run(struct world *w, struct nm_training *t, int epochs)
{
    const struct nm_samples training = {w->samples, TRAINING};
    const struct nm_samples others = {w->samples + TRAINING, CHIPS - TRAINING};
    for (int i = 0; i < epochs && nm_training_phase(t) != NM_PHASES; i++) {
        assert_int_equal(nm_training_epoch(t, &training, &others), 0);
    }
}

static const struct nm_plan short_plan = {
    .rate = 3e-3,
    .pix_rate = 3e-5,
    .momentum = 0.9,
    .batch = 2,
    .epochs = {5, 60, 5},
    .reach_px = 2,
    .seed = 1,
};

static double error_at(const struct world *w, const struct nm_reflection *asked,
                       const struct nm_reflection *true_one, enum nm_direction direction)
{
    const struct nm_model *m = &w->training->model;
    return fabs(nm_netem_ask(m->architecture, m->values, asked, direction, 1) -
                w->law->of[direction](true_one));
}

/* The mean error of the law in one direction over angles, for one material taken for another. */
static double error_as(const struct world *w, enum nm_direction direction, int material,
                       const struct nm_surface *asked, const struct nm_surface *true_one)
{
    double sum = 0;
    int count = 0;
    for (double angle = 0.1; angle < 1.4; angle += 0.1, count++) {
        const double turn = direction == NM_BK ? 0 : 2 * angle;
        const struct nm_reflection r = {angle, angle, turn, material, *asked, 0};
        const struct nm_reflection truth = {angle, angle, turn, material, *true_one, 0};
        sum += error_at(w, &r, &truth, direction);
    }
    return sum / count;
}

/* The mean over the materials, met by everything. */
static double law_error(const struct world *w, enum nm_direction direction)
{
    double sum = 0;
    for (int m = 0; m < 3; m++) {
        const struct nm_surface *own = &w->law->surfaces->surfaces[m];
        sum += error_as(w, direction, m, own, own);
    }
    return sum / 3;
}

/* 0.003253 is what the paper reaches on real chips of SLICY (Fig. 23). */
TEST(a_hidden_law_is_found_and_holds_on_aspects_never_shown)
{
    struct world w;
    open_world(&w, &short_plan, "EP8", 0);
    run(&w, w.training, 200);
    const struct nm_epoch *e = w.training->epochs;
    const double first = e[0].validation, last = e[w.training->epoch_count - 1].validation;
    const double bk = law_error(&w, NM_BK), sp = law_error(&w, NM_SP);
    print_message("# validation %g -> %g, mean error of the law %.3f back, %.3f specular\n", first,
                  last, bk, sp);
    assert_true(last < 0.003253 && last < 0.1 * first);
    assert_true(bk < 0.03 && sp < 0.06);
    close_world(&w);
}

/* Fig. 10. The picture is found, from any start: without what holds intensities (netem.h), these
 * four stay at twice the loss and more. What is handed on is not found: no pixel shows it, and any
 * code that the next network can read makes the same picture (docs/netem.md). */
TEST(networks_that_hand_intensities_on_learn_the_picture)
{
    static const uint64_t seeds[] = {2, 5, 7, 8};
    for (size_t i = 0; i < sizeof seeds / sizeof seeds[0]; i++) {
        struct world w;
        struct nm_plan plan = short_plan;
        plan.rate = 1e-3;
        plan.seed = seeds[i];
        open_connected(&w, &plan, nm_architecture_find("EP8", NM_BY_INTENSITY), 0);
        run(&w, w.training, 200);
        const struct nm_epoch *e = w.training->epochs;
        const double first = e[0].validation, last = e[w.training->epoch_count - 1].validation;
        const double bk = law_error(&w, NM_BK), sp = law_error(&w, NM_SP);
        print_message(
            "# seed %d: validation %g -> %g, mean error of the law %.3f back, %.3f "
            "specular\n",
            (int)seeds[i], first, last, bk, sp);
        assert_true(last < 0.003253 && last < 0.1 * first);
        assert_true(bk < 0.03);
        close_world(&w);
    }
}

/* A surface that no chip has is known by what it is made of: better than taken for either of its
 * neighbours, the training's materials 0 and 1. */
static void know_between(const struct law *law, const struct nm_surface *between)
{
    struct world w;
    const struct nm_surface *known = law->surfaces->surfaces;
    open_by_law(&w, law, &short_plan, nm_architecture_find("EP10", NM_BY_COEFFICIENT), 0);
    run(&w, w.training, 200);
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        const enum nm_direction direction = (enum nm_direction)d;
        const double own = error_as(&w, direction, 0, between, between);
        const double low = error_as(&w, direction, 0, &known[0], between);
        const double high = error_as(&w, direction, 1, &known[1], between);
        print_message(
            "# %s: error of the law %.4f; taken for the lower %.4f, for the higher %.4f\n",
            d == NM_BK ? "back" : "specular", own, low, high);
        assert_true(own < 0.7 * fmin(low, high));
    }
    close_world(&w);
}

TEST(a_permittivity_between_two_is_known_better_than_as_either)
{
    static const struct nm_surface between = {7, 0, 1e-3, 0.02};
    know_between(&fresnel, &between);
}

TEST(a_roughness_between_two_is_known_better_than_as_either)
{
    static const struct nm_surface between = {1e9, 0, 1.8e-3, 0.02};
    know_between(&roughness, &between);
}

TEST(the_phases_follow_the_plan_and_the_pixels_come_last)
{
    struct world w;
    struct nm_plan plan = short_plan;
    plan.epochs[NM_REAL_CHIPS] = 2;
    plan.epochs[NM_PIXELS] = 3;
    open_world(&w, &plan, "EP8", 0);
    const size_t weights = nm_architecture_size(w.training->model.architecture);
    double *kept = malloc(weights * sizeof *kept);
    run(&w, w.training, 7);
    memcpy(kept, w.training->model.values, weights * sizeof *kept);
    const int middle = NM_LARGE * NM_LARGE / 2;
    const double before = nm_model_pix(&w.training->model, w.training->model.values)->large[middle];
    run(&w, w.training, 1);
    assert_int_equal(w.training->optimizer.steps, TRAINING / plan.batch); /* averages begin anew */
    run(&w, w.training, 10);
    assert_int_equal(w.training->epoch_count, 10);
    for (int i = 0; i < 10; i++) {
        assert_int_equal(w.training->epochs[i].phase, i < 5 ? 0 : i < 7 ? 1 : 2);
    }
    assert_memory_equal(kept, w.training->model.values, weights * sizeof *kept);
    assert_true(before !=
                nm_model_pix(&w.training->model, w.training->model.values)->large[middle]);
    assert_true(w.training->epochs[9].validation < w.training->epochs[6].validation);
    free(kept);
    close_world(&w);
}

/* With one change an epoch, the values after each are those between which the mean is taken. */
static void end_on_mean(enum nm_phase phase)
{
    struct world plain, averaged;
    struct nm_plan plan = short_plan;
    plan.batch = TRAINING;
    memcpy(plan.epochs, (int[NM_PHASES]){1, 0, 0}, sizeof plan.epochs);
    plan.epochs[phase] = 4;
    open_world(&plain, &plan, "EP8", 4);
    plan.average = 0.5;
    open_world(&averaged, &plan, "EP8", 4);
    const size_t size = plain.training->model.size;
    double *sum = calloc(size, sizeof *sum);
    run(&plain, plain.training, 3);
    run(&averaged, averaged.training, 4);
    for (int last = 0; last < 2; last++) {
        run(&plain, plain.training, 1);
        for (size_t i = 0; i < size; i++) {
            sum[i] += plain.training->model.values[i];
        }
        assert_int_equal(memcmp(plain.training->model.values, averaged.training->model.values,
                                size * sizeof *sum) == 0,
                         last == 0); /* until the end of the phase nothing is changed */
        run(&averaged, averaged.training, 1);
    }
    for (size_t i = 0; i < size; i++) {
        assert_true(fabs(sum[i] / 2 - averaged.training->model.values[i]) < 1e-14);
    }
    assert_int_equal(averaged.training->average.count, 0); /* the next phase has its own mean */
    const struct nm_samples others = {averaged.samples + TRAINING, CHIPS - TRAINING};
    assert_true(averaged.training->epochs[4].validation ==
                nm_training_validate(averaged.training, &others));
    free(sum);
    close_world(&plain);
    close_world(&averaged);
}

TEST(a_phase_ends_on_the_mean_of_its_last_epochs)
{
    end_on_mean(NM_REAL_CHIPS);
    end_on_mean(NM_PIXELS);
}

/* A kernel free to change everywhere learns the target, which stands about each bright point. No
 * value may move by more than Adam's longest steps in proportion to the response there. */
TEST(the_kernel_learns_nothing_where_the_radar_has_no_response)
{
    struct world w;
    struct nm_plan plan = short_plan;
    plan.epochs[NM_REAL_CHIPS] = 1;
    plan.epochs[NM_PIXELS] = 4;
    open_world(&w, &plan, "EP8", 4);
    run(&w, w.training, 10);
    const double *learned = nm_model_pix(&w.training->model, w.training->model.values)->large;
    const double most = 4 * plan.pix_rate * (double)w.training->optimizer.steps;
    const double peak = w.kernel[NM_LARGE * NM_LARGE / 2];
    assert_true(fabs(learned[NM_LARGE * NM_LARGE / 2] - peak) > plan.pix_rate);
    for (int i = 0; i < NM_LARGE * NM_LARGE; i++) {
        assert_true(fabs(learned[i] - w.kernel[i]) <= most * w.kernel[i] / peak + 1e-15);
    }
    close_world(&w);
}

/* With two, sums of matrices come in another order. */
TEST(a_simulator_has_one_thread_for_its_matrices)
{
    struct nm_simulator s;
    openblas_set_num_threads(2);
    assert_int_equal(nm_simulator_open(&s, nm_architectures[0], 16), 0);
    assert_int_equal(openblas_get_num_threads(), 1);
    nm_simulator_close(&s);
}

TEST(a_training_that_was_killed_goes_on_to_the_same_bits)
{
    char path[] = "/tmp/landmass-netem-XXXXXX";
    struct nm_plan plan = short_plan;
    plan.epochs[NM_REAL_CHIPS] = 3;
    plan.epochs[NM_PIXELS] = 2;
    plan.average = 0.7; /* the killing after epoch 7 falls into the two that are averaged */
    for (int stop = 1; stop < 10; stop += 3) {
        struct world w;
        struct nm_training *again = malloc(sizeof *again);
        const int fd = mkstemp(path);
        open_world(&w, &plan, "EP8", 4);
        run(&w, w.training, stop);
        assert_int_equal(nm_model_write(w.training, path), 0);
        run(&w, w.training, 100);
        assert_int_equal(nm_model_read(again, path, CELLS), 0);
        assert_int_equal(again->epoch_count, stop);
        run(&w, again, 100);
        assert_int_equal(again->epoch_count, 10);
        assert_memory_equal(again->epochs, w.training->epochs, 10 * sizeof *again->epochs);
        assert_memory_equal(again->model.values, w.training->model.values,
                            again->model.size * sizeof(double));
        nm_training_close(again);
        free(again);
        close_world(&w);
        close(fd);
        unlink(path);
        strcpy(path, "/tmp/landmass-netem-XXXXXX");
    }
}

/* The file `path` with the first `old` in it replaced. */
static void edit(const char *path, const char *old, const char *new)
{
    assert_int_equal(
        support_run("grep -q '^%s$' %s && sed -i 's/^%s$/%s/' %s", old, path, old, new, path), 0);
}

TEST(a_file_says_how_its_networks_are_connected)
{
    struct world w;
    char path[] = "/tmp/landmass-netem-XXXXXX";
    const int fd = mkstemp(path);
    struct nm_training *again = malloc(sizeof *again);
    struct nm_plan plan = short_plan;
    plan.epochs[NM_REAL_CHIPS] = 2;
    plan.epochs[NM_PIXELS] = 0;
    open_connected(&w, &plan, nm_architecture_find("EP9", NM_BY_INTENSITY), 4);
    run(&w, w.training, 3);
    assert_int_equal(nm_model_write(w.training, path), 0);
    run(&w, w.training, 100);
    assert_int_equal(nm_model_read(again, path, CELLS), 0);
    assert_int_equal(again->model.architecture->connection, NM_BY_INTENSITY);
    run(&w, again, 100);
    assert_memory_equal(again->model.values, w.training->model.values,
                        again->model.size * sizeof(double));
    nm_training_close(again);
    edit(path, "connection intensity", "connection sideways");
    assert_int_equal(nm_model_read(again, path, CELLS), -1);
    edit(path, "connection sideways", "connection coefficient"); /* one input less */
    assert_int_equal(nm_model_read(again, path, CELLS), -1);
    edit(path, "landmass-netem 4", "landmass-netem 5");
    assert_int_equal(nm_model_read(again, path, CELLS), -1);
    free(again);
    close_world(&w);
    close(fd);
    unlink(path);
}

/* Form 3 had no averages, form 2 no connection either. */
TEST(a_file_of_an_older_form_says_what_it_said)
{
    struct world w;
    char path[] = "/tmp/landmass-netem-XXXXXX";
    const int fd = mkstemp(path);
    struct nm_training *again = malloc(sizeof *again);
    open_world(&w, &short_plan, "EP7", 0);
    assert_int_equal(nm_model_write(w.training, path), 0);
    for (int form = 3; form >= 2; form--) {
        const char *newer = form == 3 ? "average" : "connection";
        assert_int_equal(support_run("sed -i '1s/.*/landmass-netem %d/' %s", form, path), 0);
        assert_int_equal(nm_model_read(again, path, CELLS), -1);
        assert_int_equal(support_run("sed -i '/^%s/d' %s", newer, path), 0);
        assert_int_equal(nm_model_read(again, path, CELLS), 0);
        assert_ptr_equal(again->model.architecture, nm_architecture_find("EP7", NM_BY_COEFFICIENT));
        assert_true(again->plan.average == 0 && again->average.count == 0);
        assert_memory_equal(again->model.values, w.training->model.values,
                            again->model.size * sizeof(double));
        nm_training_close(again);
    }
    free(again);
    close_world(&w);
    close(fd);
    unlink(path);
}

TEST(a_file_holds_what_its_materials_are_made_of)
{
    struct world w;
    char path[] = "/tmp/landmass-netem-XXXXXX";
    const int fd = mkstemp(path);
    struct nm_training *again = malloc(sizeof *again);
    open_world(&w, &short_plan, "EP10", 0);
    assert_int_equal(nm_model_write(w.training, path), 0);
    assert_int_equal(nm_model_read(again, path, CELLS), 0);
    assert_memory_equal(&again->materials, &surfaces, sizeof surfaces);
    nm_training_close(again);
    static const char *const hostile[] = {"surface 0 0 0 0",   "surface 4 -1 0 0",
                                          "surface 4 0 0",     "surface nan 0 0 0",
                                          "surface 4 0 0 0 0", "surface 4 0 9 0"};
    for (size_t i = 0; i < sizeof hostile / sizeof hostile[0]; i++) {
        assert_int_equal(support_run("sed '5s/.*/%s/' %s > %s.bad", hostile[i], path, path), 0);
        char bad[64];
        snprintf(bad, sizeof bad, "%s.bad", path);
        assert_int_equal(nm_model_read(again, bad, CELLS), -1);
        unlink(bad);
    }
    assert_int_equal(support_run("sed -i '5s/.*/surface 4 0 0 0/' %s", path), 0);
    assert_int_equal(nm_model_read(again, path, CELLS), 0);
    nm_training_close(again);
    assert_int_equal(support_run("sed -i 5d %s", path), 0);
    assert_int_equal(nm_model_read(again, path, CELLS), -1);
    free(again);
    close_world(&w);
    close(fd);
    unlink(path);
}

static struct nm_materials one_material(const char *name, double permittivity)
{
    struct nm_materials m = {.count = 1};
    strcpy(m.names[0], name);
    m.surfaces[0] = (struct nm_surface){permittivity, 0, 1e-3, 0.02};
    return m;
}

TEST(a_new_material_is_met_between_those_of_the_training_and_nowhere_else)
{
    struct nm_materials known = surfaces;
    const struct nm_materials between = one_material("mud", 7), below = one_material("foam", 3.9);
    const struct nm_materials above = one_material("mirror", 1.1e9);
    const struct nm_materials same = one_material("ground", 5);
    assert_int_equal(nm_surfaces_meet(&known, &below, false), -1);
    assert_int_equal(nm_surfaces_meet(&known, &above, false), -1);
    assert_memory_equal(&known, &surfaces, sizeof known);
    assert_int_equal(nm_surfaces_meet(&known, &between, false), 0);
    assert_int_equal(known.count, 4);
    assert_string_equal(known.names[3], "mud");
    assert_true(known.surfaces[3].permittivity == 7);
    assert_int_equal(nm_surfaces_meet(&known, &same, false), 0);
    assert_true(known.surfaces[1].permittivity == 12); /* as the training has it */
    assert_int_equal(nm_surfaces_meet(&known, &same, true), 0);
    assert_true(known.count == 4 && known.surfaces[1].permittivity == 5);
    for (int i = 0; known.count < TRACE_MATERIALS_MAX; i++) {
        char name[16];
        snprintf(name, sizeof name, "mud.%d", i);
        const struct nm_materials more = one_material(name, 8);
        assert_int_equal(nm_surfaces_meet(&known, &more, false), 0);
    }
    const struct nm_materials last = one_material("slush", 8);
    assert_int_equal(nm_surfaces_meet(&known, &last, false), -1);
}

TEST(descent_without_adam_learns_too_and_so_does_the_absolute_error)
{
    struct nm_plan plan = short_plan;
    plan.method = NM_SGD;
    plan.loss = NM_MAE;
    plan.rate = 0.02;
    plan.epochs[NM_PIXELS] = 0;
    plan.epochs[NM_REAL_CHIPS] = 30;
    struct world w;
    open_world(&w, &plan, "EP6", 0);
    run(&w, w.training, 100);
    assert_true(w.training->epochs[34].validation < 0.6 * w.training->epochs[4].validation);
    close_world(&w);
}

TEST(phase_correlation_finds_every_shift_within_reach)
{
    enum { SQUARE = 54, REACH = 6 };
    struct nm_registrar r;
    struct nm_picture real;
    struct hs_rng rng;
    static double simulated[SQUARE * SQUARE];
    hs_rng_seed(&rng, 2);
    assert_int_equal(nm_registrar_open(&r, SQUARE), 0);
    assert_int_equal(nm_picture_open(&real, SQUARE, SQUARE), 0);
    for (int i = 0; i < 30; i++) {
        const int row = 20 + (int)hs_rng_below(&rng, 15), column = 20 + (int)hs_rng_below(&rng, 15);
        simulated[row * SQUARE + column] = 0.3 + 0.7 * hs_rng_uniform(&rng);
    }
    for (int shift = 0; shift < (2 * REACH + 1) * (2 * REACH + 1); shift++) {
        const int dx = shift % (2 * REACH + 1) - REACH, dy = shift / (2 * REACH + 1) - REACH;
        for (int i = 0; i < SQUARE * SQUARE; i++) {
            const int x = i % SQUARE - dx, y = i / SQUARE - dy;
            const int is_inside = x >= 0 && x < SQUARE && y >= 0 && y < SQUARE;
            real.pixels[i] =
                0.1 * hs_rng_uniform(&rng) + (is_inside ? 0.9 * simulated[y * SQUARE + x] : 0);
        }
        double sharpness;
        const struct nm_origin o =
            nm_register(&r, simulated, &real, (struct nm_origin){0, 0}, REACH, &sharpness);
        assert_int_equal(o.x, dx);
        assert_int_equal(o.y, dy);
        assert_true(sharpness > 0.1);
    }
    nm_registrar_close(&r);
    nm_picture_close(&real);
}

TEST(a_model_file_cut_short_is_refused)
{
    struct world w;
    char path[] = "/tmp/landmass-netem-XXXXXX";
    const int fd = mkstemp(path);
    struct nm_plan plan = short_plan;
    open_world(&w, &plan, "EP7", 0);
    assert_int_equal(nm_model_write(w.training, path), 0);
    FILE *f = fopen(path, "rb");
    fseek(f, 0, SEEK_END);
    const size_t size = (size_t)ftell(f);
    char *whole = malloc(size);
    rewind(f);
    assert_int_equal(fread(whole, 1, size, f), size);
    fclose(f);
    for (size_t cut = 0; cut < size; cut += size / 7 - 3) {
        f = fopen(path, "wb");
        fwrite(whole, 1, cut, f);
        fclose(f);
        struct nm_training *t = malloc(sizeof *t);
        assert_int_equal(nm_model_read(t, path, CELLS), -1);
        free(t);
    }
    free(whole);
    close(fd);
    unlink(path);
    close_world(&w);
}

/* Chips of one grey each, at 0, 16 and 180 degrees: one at 4 degrees sees those two by their
 * distance, and itself, if it is one of them, never. */
TEST(smoothed_chips_are_the_mean_about_the_azimuth)
{
    struct world w;
    struct nm_score scores[NM_NULLS];
    struct nm_plan plan = short_plan;
    plan.reach_px = 0;
    open_world(&w, &plan, "EP8", 0);
    static const double azimuths[] = {0, 16, 180, 4}, greys[] = {0.2, 0.5, 0.9, 0.4};
    for (int i = 0; i < 4; i++) {
        w.samples[i].azimuth_deg = azimuths[i];
        for (int k = 0; k < SIDE * SIDE; k++) {
            w.samples[i].real.pixels[k] = greys[i];
        }
    }
    const double near = exp(-0.125), far = exp(-1.125);
    const double expected = (near * 0.2 + far * 0.5) / (near + far) - 0.4;
    const struct nm_samples chip = {w.samples + 3, 1};
    for (int with_itself = 0; with_itself < 2; with_itself++) {
        const struct nm_samples training = {w.samples, 3 + with_itself};
        assert_int_equal(nm_null_scores(w.training, &training, &chip, scores, NULL), 0);
        assert_true(fabs(scores[NM_NULL_SMOOTHED].mse - expected * expected) < 1e-12);
    }
    close_world(&w);
}
