#include "classify/learn.h"

#include "classify/mlp_apply.h"
#include "classify/split.h"
#include "hs/error.h"
#include "hs/report.h"

#include <cblas.h>
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void use_one_thread(void)
{
    openblas_set_num_threads(
        1); /* The order of sums, and so the last bit, depends on the threads. */
}

/* Mean, standard deviation and range of one input over the training samples; a constant input gets
 * a scale of 1. Returns whether it varies. */
static bool measure_input(struct db_net *net, const struct db_samples *s, size_t f)
{
    const size_t inputs = (size_t)s->input_count;
    double sum = 0, square = 0, count = 0, low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < s->count; i++) {
        if (s->items[i].part == DB_PART_TRAIN) {
            const double v = (double)s->inputs[i * inputs + f];
            sum += v;
            low = fmin(low, v);
            high = fmax(high, v);
            count++;
        }
    }
    const double mean = sum / count;
    for (size_t i = 0; i < s->count; i++) {
        if (s->items[i].part == DB_PART_TRAIN) {
            const double d = (double)s->inputs[i * inputs + f] - mean;
            square += d * d;
        }
    }
    const double deviation = sqrt(square / count);
    const bool varies = deviation > 1e-6 * fabs(mean) && deviation > 1e-30;
    net->mean[f] = (float)mean;
    net->scale[f] = varies ? (float)deviation : 1;
    net->low[f] = (float)low;
    net->high[f] = (float)high;
    return varies;
}

/* A band that holds one value tells nothing; an image of such bands is the wrong file. */
static int find_normalisation(struct db_net *net, const struct db_samples *s)
{
    int constant = 0;
    if (db_net_alloc_inputs(net) != 0) {
        return -1;
    }
    for (int f = 0; f < s->input_count; f++) {
        if (!measure_input(net, s, (size_t)f)) {
            constant++;
            if (f < net->band_count) {
                char place[24];
                snprintf(place, sizeof place, "band %d", f + 1);
                hs_warn(place, "check the image, or leave the band out",
                        "holds %g at every exemplar and tells nothing", (double)net->mean[f]);
            }
        }
    }
    if (constant == s->input_count) {
        return hs_error("training", "check the image: it may be empty, or scaled to nothing",
                        "every exemplar looks the same");
    }
    return 0;
}

int db_priors_find(double priors[DB_CLASS_MAX], const struct db_samples *samples,
                   const struct db_class_table *table, const struct db_learn_options *options)
{
    double drawn[DB_CLASS_MAX] = {0}, trained[DB_CLASS_MAX] = {0}, sum = 0;
    for (size_t i = 0; i < samples->count; i++) {
        drawn[samples->items[i].class_index]++;
        trained[samples->items[i].class_index] += samples->items[i].part == DB_PART_TRAIN;
    }
    for (int c = 0; c < DB_CLASS_MAX; c++) {
        priors[c] = 0;
        if (trained[c] > 0) {
            priors[c] = options->priors == DB_PRIORS_EQUAL ? 1
                        : options->priors == DB_PRIORS_GIVEN
                            ? options->prior[c]
                            : (double)options->available[c] * trained[c] / drawn[c];
            if (!(priors[c] > 0)) {
                return hs_error("--priors", "give each class that has exemplars a share above 0",
                                "leave out class `%s`", table->items[c].name);
            }
            sum += priors[c];
        }
    }
    for (int c = 0; c < DB_CLASS_MAX; c++) {
        priors[c] /= sum > 0 ? sum : 1;
    }
    return 0;
}

/* One output a class that has a training sample. */
static int choose_outputs(struct db_net *net, const struct db_samples *s,
                          const struct db_class_table *table, uint8_t *output_of_class)
{
    bool has[DB_CLASS_MAX] = {false};
    for (size_t i = 0; i < s->count; i++) {
        has[s->items[i].class_index] |= s->items[i].part == DB_PART_TRAIN;
    }
    for (int c = 0; c < table->count; c++) {
        output_of_class[c] = DB_CLASS_NODATA;
        if (has[c]) {
            output_of_class[c] = (uint8_t)net->output_count;
            memcpy(net->class_names[net->output_count++], table->items[c].name, DB_NAME_SIZE);
        }
    }
    if (net->output_count < 2) {
        return hs_error("training", "draw more exemplars, or hold out less",
                        "fewer than two classes have exemplars with data to train on");
    }
    return 0;
}

/* The samples of one part, normalised. */
struct part_data {
    float *inputs;    /* owned */
    uint8_t *targets; /* owned */
    size_t count;
};

static void part_free(struct part_data *d)
{
    free(d->inputs);
    free(d->targets);
    *d = (struct part_data){0};
}

static int part_gather(struct part_data *d, const struct db_samples *s, const struct db_net *net,
                       const uint8_t *output_of_class, enum db_part part)
{
    const size_t inputs = (size_t)s->input_count;
    *d = (struct part_data){0};
    for (size_t i = 0; i < s->count; i++) {
        d->count += s->items[i].part == part;
    }
    d->inputs = malloc((d->count + 1) * inputs * sizeof *d->inputs);
    d->targets = malloc(d->count + 1);
    if (!d->inputs || !d->targets) {
        part_free(d);
        return -1;
    }
    size_t used = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (s->items[i].part != part) {
            continue;
        }
        for (size_t f = 0; f < inputs; f++) {
            d->inputs[used * inputs + f] =
                (s->inputs[i * inputs + f] - net->mean[f]) / net->scale[f];
        }
        d->targets[used++] = output_of_class[s->items[i].class_index];
    }
    return 0;
}

/* What all members share. */
struct task {
    struct db_net *net;
    struct db_samples *samples;
    const struct db_class_table *table;
    const struct db_learn_options *options;
    size_t region_count;
    uint8_t output_of_class[DB_CLASS_MAX];
    double priors[DB_CLASS_MAX]; /* of each output */
};

static void shape_member(struct db_mlp *mlp, const struct task *t)
{
    *mlp = (struct db_mlp){.input_count = t->net->input_count,
                           .output_count = t->net->output_count,
                           .unit = t->options->unit,
                           .loss = t->options->loss,
                           .layer_count = t->options->layer_count};
    memcpy(mlp->hidden, t->options->hidden, sizeof mlp->hidden);
    if (mlp->layer_count == 0) {
        mlp->layer_count = 1;
        mlp->hidden[0] = db_mlp_default_hidden(mlp->input_count, mlp->output_count, NULL);
    }
}

/* A member on its way. Which regions it learns from is chosen before, one member after the other;
 * training waits for no other member. */
struct pupil {
    const struct task *task;
    struct db_mlp *net;
    struct db_train_options train;
    struct part_data training, validation; /* owned */
    struct db_train_report *report;
    pthread_t thread;
    bool has_thread;
    int status;
};

static void pupil_free(struct pupil *p)
{
    part_free(&p->validation);
    part_free(&p->training);
}

static int pupil_init(struct pupil *p, const struct task *t, int m, struct db_train_report *report)
{
    *p = (struct pupil){.task = t,
                        .net = &t->net->members[m],
                        .train = t->options->train,
                        .report = report,
                        .status = -1};
    p->train.seed += (uint64_t)m;
    shape_member(p->net, t);
    return part_gather(&p->training, t->samples, t->net, t->output_of_class, DB_PART_TRAIN) != 0 ||
                   part_gather(&p->validation, t->samples, t->net, t->output_of_class,
                               DB_PART_VALIDATE) != 0 ||
                   db_mlp_init(p->net, p->train.seed) != 0
               ? -1
               : 0;
}

static void *teach(void *pupil)
{
    struct pupil *p = pupil;
    const double *priors = p->task->priors;
    const struct db_train_data a = {p->training.inputs, p->training.targets, p->training.count,
                                    priors};
    const struct db_train_data b = {p->validation.inputs, p->validation.targets,
                                    p->validation.count, priors};
    p->status = db_mlp_train(p->net, &p->train, &a, &b, p->report);
    return NULL;
}

/* Side by side; a thread that is refused is done without. The first, which is this thread's, shows
 * how far it is. */
static int teach_all(struct pupil *pupils, int count)
{
    int status = 0;
    for (int i = 1; i < count; i++) {
        pupils[i].train.is_quiet = true;
        pupils[i].has_thread = pthread_create(&pupils[i].thread, NULL, teach, &pupils[i]) == 0;
    }
    for (int i = 0; i < count; i++) {
        if (pupils[i].has_thread) {
            pthread_join(pupils[i].thread, NULL);
        } else {
            teach(&pupils[i]);
        }
        status |= pupils[i].status;
    }
    return status;
}

static void take_back(struct db_samples *s)
{
    for (size_t i = 0; i < s->count; i++) {
        if (s->items[i].part == DB_PART_VALIDATE) {
            s->items[i].part = DB_PART_TRAIN;
        }
    }
}

/* Set other regions aside for each member, so that together they have learnt from all. */
static int set_aside(const struct task *t, int member)
{
    take_back(t->samples);
    if (t->options->validate <= 0) {
        return 0;
    }
    const uint64_t seed = t->options->train.seed * 1000 + (uint64_t)member + 1;
    return db_split(t->samples, t->region_count, t->table, true, t->options->validate, seed,
                    DB_PART_VALIDATE, true);
}

/* The priors are those of the samples before thinning. */
static int find_output_priors(struct task *t)
{
    double priors[DB_CLASS_MAX] = {0};
    if (db_priors_find(priors, t->samples, t->table, t->options) != 0) {
        return -1;
    }
    for (int c = 0; c < t->table->count; c++) {
        if (t->output_of_class[c] != DB_CLASS_NODATA) {
            t->priors[t->output_of_class[c]] = priors[c];
        }
    }
    return 0;
}

static void count_training(const struct db_samples *s, size_t counts[DB_CLASS_MAX])
{
    memset(counts, 0, DB_CLASS_MAX * sizeof *counts);
    for (size_t i = 0; i < s->count; i++) {
        counts[s->items[i].class_index] += s->items[i].part == DB_PART_TRAIN;
    }
}

/* What thinning leaves is no longer distributed as the class is: say where little is left. */
static int thin(struct task *t)
{
    size_t before[DB_CLASS_MAX], after[DB_CLASS_MAX];
    count_training(t->samples, before);
    const long thinned = db_thin(t->samples, t->net->scale, t->options->thin);
    if (thinned < 0) {
        return -1;
    }
    count_training(t->samples, after);
    if (t->options->thin_is_loud) {
        hs_report_put("thinned", thinned);
        printf("nearly identical exemplars dropped: %ld\n", thinned);
    }
    for (int c = 0; c < t->table->count; c++) {
        if (2 * after[c] < before[c] && t->options->thin_is_loud) {
            hs_warn(t->table->items[c].name, "lower --thin",
                    "keeps only %zu of %zu exemplars after thinning", after[c], before[c]);
        }
    }
    return 0;
}

/* So many members at a time: as many copies of the samples are in memory. */
enum { CLASS_SIZE = 4 };

static int train_members(struct task *t, int first, int count, struct db_train_report *reports)
{
    struct pupil pupils[CLASS_SIZE] = {{0}};
    int status = 0;
    for (int i = 0; i < count && status == 0; i++) {
        const int m = first + i;
        if (set_aside(t, m) != 0) {
            status = -1;
        } else if (pupil_init(&pupils[i], t, m, &reports[m]) != 0) {
            status = hs_error("training", "lower --per-class", "out of memory");
        }
        t->net->member_count = m + 1;
    }
    if (status == 0 && teach_all(pupils, count) != 0) {
        status = hs_error("training", "lower --per-class or --hidden", "out of memory");
    }
    for (int i = 0; i < count; i++) {
        pupil_free(&pupils[i]);
    }
    return status;
}

static int learn(struct task *t, struct db_train_report *reports)
{
    const struct db_learn_options *o = t->options;
    if (choose_outputs(t->net, t->samples, t->table, t->output_of_class) != 0 ||
        find_normalisation(t->net, t->samples) != 0 || find_output_priors(t) != 0) {
        return -1;
    }
    if (o->thin > 0 && thin(t) != 0) {
        return -1;
    }
    for (int m = 0; m < o->members; m += CLASS_SIZE) {
        const int left = o->members - m;
        if (train_members(t, m, left < CLASS_SIZE ? left : CLASS_SIZE, reports) != 0) {
            return -1;
        }
    }
    take_back(t->samples);
    return 0;
}

int db_learn(struct db_net *net, struct db_samples *samples, size_t region_count,
             const struct db_class_table *table, int band_count, int context,
             const struct db_learn_options *options, struct db_train_report *reports)
{
    struct task t = {.net = net,
                     .samples = samples,
                     .table = table,
                     .options = options,
                     .region_count = region_count};
    *net = (struct db_net){.band_count = band_count,
                           .context = context,
                           .input_count = samples->input_count,
                           .has_range = true};
    memset(reports, 0, (size_t)options->members * sizeof *reports);
    use_one_thread();
    if (learn(&t, reports) != 0) {
        for (int m = 0; m < options->members; m++) {
            db_train_report_free(&reports[m]);
        }
        db_net_free(net);
        return -1;
    }
    return 0;
}

int db_net_classes(const struct db_net *net, const struct db_class_table *table,
                   const char *net_path, uint8_t *class_of_output)
{
    for (int k = 0; k < net->output_count; k++) {
        const int c = db_class_find(table, net->class_names[k]);
        if (c < 0) {
            return hs_error(net_path, "use the class table it was trained with",
                            "knows a class `%s` that the class table lacks", net->class_names[k]);
        }
        class_of_output[k] = (uint8_t)c;
    }
    return 0;
}

/* Through the very code that classifies whole images. */
int db_classify_samples(const struct db_net *net, const struct db_class_table *table,
                        const struct db_samples *samples, uint8_t *given)
{
    enum { BLOCK = 4096 };
    uint8_t class_of_output[DB_CLASS_MAX];
    struct db_applied applied;
    if (db_net_classes(net, table, "network", class_of_output) != 0 ||
        db_apply_init(&applied, net) != 0) {
        return -1;
    }
    const size_t inputs = (size_t)samples->input_count;
    float *planes = malloc(inputs * BLOCK * sizeof *planes);
    for (size_t at = 0; planes && at < samples->count; at += BLOCK) {
        const size_t count = samples->count - at < BLOCK ? samples->count - at : BLOCK;
        for (size_t i = 0; i < count; i++) {
            for (size_t f = 0; f < inputs; f++) {
                planes[f * BLOCK + i] = samples->inputs[(at + i) * inputs + f];
            }
        }
        db_apply(&applied, planes, BLOCK, count, given + at, NULL);
        for (size_t i = 0; i < count; i++) {
            given[at + i] = class_of_output[given[at + i]];
        }
    }
    db_apply_free(&applied);
    const int result = planes ? 0 : hs_error("network", NULL, "out of memory");
    free(planes);
    return result;
}

void db_confusion_count(struct db_confusion *c, const struct db_samples *samples,
                        const uint8_t *given, enum db_part part)
{
    for (size_t i = 0; i < samples->count; i++) {
        if (samples->items[i].part == part && given[i] < DB_CLASS_MAX) {
            c->counts[samples->items[i].class_index][given[i]]++;
        }
    }
}
