/* landmass-db train: exemplars and an image in, a network and a report on it out. */
#include "commands.h"
#include "source_options.h"

#include "classify/error_regions.h"
#include "classify/learn.h"
#include "classify/plot.h"
#include "classify/split.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/number.h"
#include "hs/report.h"
#include "hs/text_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {
    .command = "train",
    .summary = "learn the classes of an image from exemplar pixels",
    .description =
        "Trains a feed-forward, back-propagation network (Heaton) to tell the class of a pixel "
        "from its\n"
        "bands. Exemplars are polygons with a class label, or a raster of label numbers; --map "
        "says which\n"
        "label stands for which class of the class table. Judge the result by held-out polygons\n"
        "(--hold-out polygons:0.3): neighbouring pixels are nearly copies of each other, so pixels "
        "held out\n"
        "from polygons that were also trained on flatter the network.\n\n"
        "Training stops on a plateau once the goal is reached, or at --epochs; the best weights "
        "met are\n"
        "kept. With the same inputs, options and seed the network file comes out the same, byte "
        "for byte.\n\n"
        "Example:\n"
        "  landmass-db train --image scene.tif --classes heaton6.classes --exemplars fields.gpkg "
        "\\\n"
        "      --hold-out polygons:0.3 --net scene.net --report scene-report",
};

struct options {
    struct db_image_options image;
    struct db_exemplar_options known;
    const char *classes, *net, *report, *split_out, *hold_out;
    int loss, unit; /* enum db_loss, db_unit */
    struct hs_list hidden, priors;
    long context, per_class, members, epochs, patience, redraws, batch, seed;
    double rate, momentum, decay, noise, goal, validate, thin;
};

static const struct options defaults = {
    .known = {.field = "class"},
    .loss = DB_LOSS_SQUARE,
    .unit = DB_UNIT_TANH,
    .context = 1,
    .per_class = 4000,
    .members = 3,
    .epochs = 300,
    .patience = 15,
    .redraws = 3,
    .batch = 32,
    .seed = 1,
    .rate = 0.1,
    .momentum = 0.9,
    .noise = 0.005,
    .decay = NAN,
    .goal = 0.99,
};

static bool read_options(struct options *o, int argc, char **argv, int *exit_code)
{
    const struct hs_option table[] = {
        DB_IMAGE_OPTIONS(&o->image),
        DB_CLASSES_OPTION(o->classes),
        {"net", HS_OUTPUT, &o->net, 0, 0, "FILE", "Where the trained network goes.", true},
        DB_EXEMPLAR_OPTIONS(&o->known),
        {"hold-out", HS_TEXT, &o->hold_out, 0, 0, "HOW:PART",
         "Keep exemplars to judge by: `polygons:0.3` whole polygons of each class, "
         "`pixels:0.3` pixels\n"
         "at random (only for comparison with others: it flatters).",
         false},
        {"report", HS_FOLDER, &o->report, 0, 0, "FOLDER",
         "Write confusion matrices, recognition by polygon and by square, and the error curve "
         "there.",
         false},
        {"split-out", HS_OUTPUT, &o->split_out, 0, 0, "FILE",
         "Write each exemplar with its part (train or held-out) and inputs as CSV, for other "
         "programs.",
         false},
        {"per-class", HS_INTEGER, &o->per_class, 10, 1e7, "N",
         "Exemplars of each class at most, drawn evenly from all its pixels.", false},
        {"context", HS_INTEGER, &o->context, 1, DB_CONTEXT_MAX, "N",
         "Odd side of a window whose mean and standard deviation of each band are further "
         "inputs;\n"
         "1 for the pixel's own bands only, as in Heaton.",
         false},
        {"hidden", HS_LIST, &o->hidden, 0, 0, "N,..",
         "Units of each hidden layer, 1 to 4 layers. Default: one layer of inputs x outputs, more "
         "than\n"
         "three times the inputs, 8..128.",
         false},
        {"priors", HS_LIST, &o->priors, 0, 0, "exemplars|equal|NAME=SHARE,..",
         "How often the network is to expect each class: `exemplars`, as often as it has exemplar "
         "pixels\n"
         "(default with --labels); `equal` (default with --exemplars); or shares, NAME=SHARE,.. "
         "of every class.",
         false},
        {"unit", HS_CHOICE, &o->unit, 0, 0, "tanh|sigmoid", "Of the hidden layers.", false},
        {"loss", HS_CHOICE, &o->loss, 0, 0, "square|cross-entropy",
         "square: mean-square error, as in Heaton.", false},
        {"committee", HS_INTEGER, &o->members, 1, DB_MEMBERS_MAX, "N",
         "Networks trained from different seeds whose outputs are added; segmenting slows "
         "as much.",
         false},
        {"goal", HS_REAL, &o->goal, 0, 1.01, "X",
         "Part of the exemplars, by the priors, that must be recognised: a plateau below it is "
         "taken\n"
         "for a local minimum.",
         false},
        {"epochs", HS_INTEGER, &o->epochs, 1, DB_EPOCHS_MAX, "N", "Stop after so many rounds.",
         false},
        {"patience", HS_INTEGER, &o->patience, 1, DB_EPOCHS_MAX, "N",
         "Epochs without progress that make a plateau.", false},
        {"redraws", HS_INTEGER, &o->redraws, 0, DB_EPOCHS_MAX, "N",
         "How often new random weights are tried to leave a local minimum.", false},
        {"validate", HS_REAL, &o->validate, 0, 0.9, "X",
         "Part of the training polygons set aside to choose the best weights by.", false},
        {"noise", HS_REAL, &o->noise, 0, 10, "X",
         "Standard deviation of the noise on the exemplars, in deviations of each input.", false},
        {"rate", HS_REAL, &o->rate, 1e-6, 10, "X", "Learning rate.", false},
        {"momentum", HS_REAL, &o->momentum, 0, 0.999, "X",
         "Part of a change of weights that is carried on.", false},
        {"decay", HS_REAL, &o->decay, 0, 1, "X",
         "Pull of the weights towards zero. Left out: 0 for few weights, up to 0.00005 where there "
         "are "
         "about as many as exemplars.",
         false},
        {"batch", HS_INTEGER, &o->batch, 1, 65536, "N", "Exemplars between two changes of weights.",
         false},
        {"thin", HS_REAL, &o->thin, 0, 10, "X",
         "Keep one of the exemplars of a class that share a cell of so many deviations in each "
         "input;\n"
         "0 (default) keeps all. It flattens what is frequent: of one band only its values are "
         "left.",
         false},
        {"seed", HS_INTEGER, &o->seed, 0, 2147483647, "N", "Seed of everything random.", false},
        HS_CLASHES_ROW("exemplars", "labels"),
        HS_NEEDS_ROW("field", "exemplars"),
        HS_NEEDS_ROW("labels", "map"),
    };
    return hs_options_read(&usage, table, sizeof table / sizeof table[0], argc, argv, exit_code);
}

/* What the text options mean. */
struct choices {
    bool holds_out, by_regions;
    double held_out;
    enum db_loss loss;
    enum db_unit unit;
    int layer_count, hidden[DB_LAYERS_MAX];
    enum db_priors priors;
};

static int usage_error(const char *option, const char *cause)
{
    return hs_error(option, "see landmass-db train --help", "%s", cause);
}

static int read_hold_out(const struct options *o, struct choices *c)
{
    char word[16];
    if (!o->hold_out) {
        return 0;
    }
    if (hs_split_word_number(o->hold_out, word, sizeof word, &c->held_out) != 0 ||
        !(c->held_out > 0 && c->held_out < 1) ||
        (strcmp(word, "polygons") != 0 && strcmp(word, "pixels") != 0)) {
        return usage_error("--hold-out", "needs polygons:PART or pixels:PART with PART in 0..1");
    }
    c->holds_out = true;
    c->by_regions = strcmp(word, "polygons") == 0;
    return 0;
}

static int read_hidden(const struct options *o, struct choices *c)
{
    if (o->hidden.count > DB_LAYERS_MAX) {
        return usage_error("--hidden", "takes at most 4 layers");
    }
    for (c->layer_count = 0; c->layer_count < o->hidden.count; c->layer_count++) {
        char *end;
        const long units = strtol(o->hidden.items[c->layer_count], &end, 10);
        if (*end != '\0' || units < 1 || units > DB_HIDDEN_MAX) {
            return usage_error("--hidden", "needs 1 to 1024 units in each layer");
        }
        c->hidden[c->layer_count] = (int)units;
    }
    return 0;
}

static void read_priors_kind(const struct options *o, struct choices *c)
{
    const char *word = o->priors.count == 1 ? o->priors.items[0] : NULL;
    if (o->priors.count == 0) {
        /* A label raster is a map, so its shares are those of the ground. How much of a class was
         * drawn by hand says nothing of how much there is. */
        c->priors = o->known.labels ? DB_PRIORS_EXEMPLARS : DB_PRIORS_EQUAL;
        return;
    }
    c->priors = word && strcmp(word, "exemplars") == 0 ? DB_PRIORS_EXEMPLARS
                : word && strcmp(word, "equal") == 0   ? DB_PRIORS_EQUAL
                                                       : DB_PRIORS_GIVEN;
}

static int choose(const struct options *o, struct choices *c)
{
    *c = (struct choices){0};
    read_priors_kind(o, c);
    if (!o->known.polygons == !o->known.labels) {
        return usage_error("--exemplars", "give either --exemplars or --labels");
    }
    if (o->known.labels && !o->known.map) {
        return usage_error("--map", "is needed to say which class a label number stands for");
    }
    if (o->context % 2 == 0) {
        return usage_error("--context", "needs an odd number");
    }
    c->loss = (enum db_loss)o->loss;
    c->unit = (enum db_unit)o->unit;
    return read_hidden(o, c) != 0 ? -1 : read_hold_out(o, c);
}

/* Everything the command works on. */
struct work {
    const struct options *options;
    struct choices choices;
    struct db_class_table table;
    struct db_label_map map;
    struct db_raster image;
    struct db_exemplars exemplars;
    struct db_samples samples;
    struct db_net net;
    struct db_train_report reports[DB_MEMBERS_MAX];
};

static int gather(struct work *w)
{
    const struct options *o = w->options;
    const struct db_exemplar_source source = {
        .polygons_path = o->known.polygons,
        .field = o->known.field,
        .labels_path = o->known.labels,
        .map = &w->map,
        .table = &w->table,
        .per_class = o->per_class,
        .seed = (uint64_t)o->seed,
    };
    if (db_feature_count(w->image.band_count, (int)o->context) > DB_INPUT_MAX) {
        return hs_error(w->image.name, "leave bands out, or --context", "gives more than %d inputs",
                        DB_INPUT_MAX);
    }
    if (db_exemplars_find(&w->exemplars, &source, &w->image.grid) != 0 ||
        db_samples_read(&w->samples, &w->image, (int)o->context, &w->exemplars) != 0) {
        return -1;
    }
    if (w->samples.without_data > 0) {
        printf("exemplar pixels without data: %llu left out\n",
               (unsigned long long)w->samples.without_data);
    }
    hs_report_put("exemplars_without_data", (uint64_t)w->samples.without_data);
    if (!w->choices.holds_out) {
        return 0;
    }
    return db_split(&w->samples, w->exemplars.region_count, &w->table, w->choices.by_regions,
                    w->choices.held_out, (uint64_t)o->seed, DB_PART_HELD_OUT, false);
}

static void report_exemplars(const struct work *w, int c, const size_t parts[3])
{
    hs_report_object(NULL);
    hs_report_put("name", w->table.items[c].name);
    hs_report_put("pixels", (uint64_t)w->exemplars.available[c]);
    hs_report_put("to_train_on", parts[DB_PART_TRAIN]);
    hs_report_put("held_out", parts[DB_PART_HELD_OUT]);
    hs_report_close();
}

static void print_counts(const struct work *w)
{
    hs_report_array("exemplars");
    for (int c = 0; c < w->table.count; c++) {
        size_t parts[3] = {0};
        for (size_t i = 0; i < w->samples.count; i++) {
            parts[w->samples.items[i].part] += w->samples.items[i].class_index == c;
        }
        report_exemplars(w, c, parts);
        if (w->exemplars.available[c] > 0) {
            printf("%-16s %10llu pixels, %8zu to train on, %8zu held out\n", w->table.items[c].name,
                   (unsigned long long)w->exemplars.available[c], parts[DB_PART_TRAIN],
                   parts[DB_PART_HELD_OUT]);
        } else if (w->map.is_default) {
            hs_warn(w->table.items[c].name, "draw some, or take it out of the class table",
                    "has no exemplar, so no pixel will be given this class");
        }
    }
    hs_report_close();
}

static int write_split(const struct work *w)
{
    struct hs_atomic_file file;
    if (!w->options->split_out) {
        return 0;
    }
    if (hs_atomic_open(&file, w->options->split_out) != 0) {
        return -1;
    }
    const struct db_samples *s = &w->samples;
    fputs("x,y,class,region,part", file.stream);
    for (int f = 0; f < s->input_count; f++) {
        fprintf(file.stream, ",input%d", f + 1);
    }
    fputc('\n', file.stream);
    for (size_t i = 0; i < s->count; i++) {
        const struct db_exemplar *e = &s->items[i];
        fprintf(file.stream, "%d,%d,%s,%ld,%s", e->x, e->y, w->table.items[e->class_index].name,
                w->exemplars.regions[e->region].id,
                e->part == DB_PART_HELD_OUT ? "held-out" : "train");
        for (int f = 0; f < s->input_count; f++) {
            fprintf(file.stream, ",%.9g",
                    (double)s->inputs[i * (size_t)s->input_count + (size_t)f]);
        }
        fputc('\n', file.stream);
    }
    return hs_atomic_commit(&file);
}

/* "NAME=SHARE" of each class. */
static int read_priors(const struct work *w, double *prior)
{
    const struct hs_list *list = &w->options->priors;
    if (w->choices.priors != DB_PRIORS_GIVEN) {
        return 0;
    }
    for (int i = 0; i < list->count; i++) {
        char word[DB_NAME_SIZE];
        const char *equals = strchr(list->items[i], '=');
        const size_t length = equals ? (size_t)(equals - list->items[i]) : DB_NAME_SIZE;
        if (length >= sizeof word) {
            return usage_error("--priors", "needs `exemplars`, `equal` or NAME=SHARE,..");
        }
        memcpy(word, list->items[i], length);
        word[length] = '\0';
        const int c = db_class_find(&w->table, word);
        if (c < 0) {
            char names[DB_CLASS_MAX * DB_NAME_SIZE];
            db_class_names(&w->table, names, sizeof names);
            return hs_error("--priors", "name classes of the class table",
                            "there is no class `%s`; there are %s", word, names);
        }
        if (!hs_number_within(equals + 1, 0, 1e9, &prior[c])) {
            return hs_error("--priors", "give a number of 0 or more", "`%s` is no share",
                            equals + 1);
        }
    }
    return 0;
}

static int learn(struct work *w)
{
    const struct options *o = w->options;
    struct db_learn_options options = {
        .train = {.rate = o->rate,
                  .momentum = o->momentum,
                  .decay = o->decay,
                  .noise = o->noise,
                  .goal = o->goal,
                  .batch = (int)o->batch,
                  .epochs = (int)o->epochs,
                  .patience = (int)o->patience,
                  .redraws = (int)o->redraws,
                  .seed = (uint64_t)o->seed},
        .layer_count = w->choices.layer_count,
        .priors = w->choices.priors,
        .available = w->exemplars.available,
        .unit = w->choices.unit,
        .loss = w->choices.loss,
        .members = (int)o->members,
        .validate = o->validate,
        .thin = o->thin,
        .thin_is_loud = true,
    };
    memcpy(options.hidden, w->choices.hidden, sizeof options.hidden);
    if (read_priors(w, options.prior) != 0) {
        return -1;
    }
    return db_learn(&w->net, &w->samples, w->exemplars.region_count, &w->table, w->image.band_count,
                    (int)o->context, &options, w->reports);
}

static void report_network(const struct work *w, const struct db_mlp *mlp)
{
    hs_report_object("network");
    hs_report_put("inputs", mlp->input_count);
    hs_report_array("hidden");
    for (int l = 0; l < mlp->layer_count; l++) {
        hs_report_put(NULL, mlp->hidden[l]);
    }
    hs_report_close();
    hs_report_put("outputs", mlp->output_count);
    hs_report_put("decay", w->reports[0].decay);
    hs_report_close();
}

static void report_member(const struct db_train_report *r, const char *stop)
{
    const struct db_epoch *best = &r->epochs[r->best_epoch - 1];
    hs_report_object(NULL);
    hs_report_put("epochs", r->epoch_count);
    hs_report_put("stop", stop);
    hs_report_put("kept_epoch", r->best_epoch);
    hs_report_put("rms_error", best->rms);
    hs_report_put("recognition", best->recognition);
    hs_report_put("validation", best->validation);
    hs_report_close();
}

static void print_training(const struct work *w)
{
    static const char *const stops[] = {"the goal is reached", "all epochs are spent",
                                        "no further progress"};
    const struct db_mlp *mlp = &w->net.members[0];
    printf("network: %d inputs, ", mlp->input_count);
    for (int l = 0; l < mlp->layer_count; l++) {
        printf("%d ", mlp->hidden[l]);
    }
    printf("hidden, %d outputs; decay of weights %g\n", mlp->output_count, w->reports[0].decay);
    long wanted;
    const int taken = db_mlp_default_hidden(mlp->input_count, mlp->output_count, &wanted);
    if (w->choices.layer_count == 0 && taken < wanted) {
        printf(
            "The rule asks for %ld hidden units; more than %d gained nothing where it was "
            "measured (--hidden).\n",
            wanted, taken);
    }
    report_network(w, mlp);
    hs_report_array("members");
    for (int m = 0; m < w->net.member_count; m++) {
        const struct db_train_report *r = &w->reports[m];
        report_member(r, stops[r->stop]);
        const struct db_epoch *best = &r->epochs[r->best_epoch - 1];
        for (int i = 0; i < r->event_count; i++) {
            printf("epoch %d: %s\n", r->events[i].epoch, r->events[i].text);
        }
        printf("trained %d epochs, %s; kept epoch %d: RMS error %.4f, recognition %.1f %%",
               r->epoch_count, stops[r->stop], r->best_epoch, best->rms, 100 * best->recognition);
        if (!isnan(best->validation)) {
            printf(", validation %.1f %%", 100 * best->validation);
        }
        putchar('\n');
    }
    hs_report_close();
}

/* Say plainly when the bands do not separate the classes. */
static void print_verdict(const struct work *w, const struct db_confusion *trained)
{
    const double recognition = db_confusion_mean_recall(trained);
    hs_report_put("goal", w->options->goal);
    hs_report_flag("goal_is_reached", recognition >= w->options->goal);
    if (recognition >= w->options->goal) {
        return;
    }
    int t_worst = 0, p_worst = 1;
    double worst = -1;
    for (int t = 0; t < w->table.count; t++) {
        for (int p = 0; p < w->table.count; p++) {
            uint64_t all = 0;
            for (int i = 0; i < w->table.count; i++) {
                all += trained->counts[t][i];
            }
            const double part = all ? (double)trained->counts[t][p] / (double)all : 0;
            if (p != t && part > worst) {
                worst = part;
                t_worst = t;
                p_worst = p;
            }
        }
    }
    printf(
        "The goal of %.1f %% was not reached: %.1f %%. The commonest mistake is %s taken for %s "
        "(%.1f %%).\n"
        "Where many of their pixels have equal values no training can tell them apart: more "
        "bands,\n"
        "--context, or `landmass-db correct` can.\n",
        100 * w->options->goal, 100 * recognition, w->table.items[t_worst].name,
        w->table.items[p_worst].name, 100 * worst);
}

static int write_curve(const char *path, const struct db_train_report *r)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs("epoch,rms_error,recognition,validation,alternation\n", file.stream);
    for (int i = 0; i < r->epoch_count; i++) {
        const struct db_epoch *e = &r->epochs[i];
        fprintf(file.stream, "%d,%.6f,%.6f,%.6f,%.6f\n", i + 1, e->rms, e->recognition,
                e->validation, e->alternation);
    }
    return hs_atomic_commit(&file);
}

static int write_report(const struct work *w, const uint8_t *given,
                        const struct db_confusion *trained, const struct db_confusion *held_out)
{
    enum { SIDE = 64 };
    const char *folder = w->options->report;
    char path[1024];
    if (!folder) {
        return 0;
    }
    if (db_report_path(path, sizeof path, folder, "error_curve.png") != 0 ||
        db_plot_training(path, &w->reports[0]) != 0 ||
        db_report_path(path, sizeof path, folder, "error_curve.csv") != 0 ||
        write_curve(path, &w->reports[0]) != 0 ||
        db_report_path(path, sizeof path, folder, "confusion_train.csv") != 0 ||
        db_confusion_write(path, trained, &w->table) != 0) {
        return -1;
    }
    if (w->choices.holds_out &&
        (db_report_path(path, sizeof path, folder, "confusion_held_out.csv") != 0 ||
         db_confusion_write(path, held_out, &w->table) != 0)) {
        return -1;
    }
    return db_error_regions_write(folder, w->samples.items, given, w->samples.count,
                                  w->exemplars.regions, w->exemplars.region_count, SIDE,
                                  &w->image.grid, &w->table);
}

static int evaluate(const struct work *w)
{
    struct db_confusion trained = {0}, held_out = {0};
    uint8_t *given = malloc(w->samples.count + 1);
    if (!given) {
        return hs_error("report", NULL, "out of memory");
    }
    int result = db_classify_samples(&w->net, &w->table, &w->samples, given);
    if (result == 0) {
        db_confusion_count(&trained, &w->samples, given, DB_PART_TRAIN);
        db_confusion_count(&held_out, &w->samples, given, DB_PART_HELD_OUT);
        printf("\nExemplars trained on:\n");
        db_confusion_print(stdout, &trained, &w->table);
        db_confusion_report("trained_on", &trained, &w->table);
        if (w->choices.holds_out) {
            printf("\nExemplars held out (%s):\n",
                   w->choices.by_regions ? "whole polygons"
                                         : "pixels at random: flattering, their neighbours were "
                                           "trained on");
            db_confusion_print(stdout, &held_out, &w->table);
            db_confusion_report("held_out", &held_out, &w->table);
        }
        print_verdict(w, &trained);
        result = write_report(w, given, &trained, &held_out);
    }
    free(given);
    return result;
}

static int run(struct work *w)
{
    if (db_class_table_read(&w->table, w->options->classes) != 0 ||
        db_exemplar_map_read(&w->map, &w->options->known, &w->table) != 0 ||
        db_image_open(&w->image, &w->options->image) != 0 || gather(w) != 0) {
        return HS_EXIT_FAILED;
    }
    print_counts(w);
    if (write_split(w) != 0 || learn(w) != 0) {
        return HS_EXIT_FAILED;
    }
    print_training(w);
    if (evaluate(w) != 0 || db_net_write(&w->net, w->options->net) != 0) {
        return HS_EXIT_FAILED;
    }
    return HS_EXIT_OK;
}

int db_cmd_train(int argc, char **argv)
{
    struct options options = defaults;
    int exit_code;
    struct work *w = calloc(1, sizeof *w);
    if (!w) {
        hs_error("train", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    w->options = &options;
    if (read_options(&options, argc, argv, &exit_code)) {
        exit_code = choose(&options, &w->choices) != 0 ? HS_EXIT_USAGE : run(w);
    }
    for (int m = 0; m < DB_MEMBERS_MAX; m++) {
        db_train_report_free(&w->reports[m]);
    }
    db_net_free(&w->net);
    db_samples_free(&w->samples);
    db_exemplars_free(&w->exemplars);
    db_raster_close(&w->image);
    hs_list_free(&options.image.paths);
    hs_list_free(&options.known.ignore);
    hs_list_free(&options.hidden);
    hs_list_free(&options.priors);
    free(w);
    return exit_code;
}
