#include "classify/learn.h"

#include "classify/mlp_apply.h"
#include "classify/split.h"
#include "hs/error.h"

#include <cblas.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static void use_one_thread(void)
{
    openblas_set_num_threads(
        1); /* The order of sums, and so the last bit, depends on the threads. */
}

/* Mean and standard deviation of each input over the training samples; a constant input gets a
 * scale of 1. */
static int find_normalisation(struct db_net *net, const struct db_samples *s)
{
    const size_t inputs = (size_t)s->input_count;
    net->mean = calloc(inputs, sizeof *net->mean);
    net->scale = calloc(inputs, sizeof *net->scale);
    if (!net->mean || !net->scale) {
        return hs_error("training", NULL, "out of memory");
    }
    for (size_t f = 0; f < inputs; f++) {
        double sum = 0, square = 0, count = 0;
        for (size_t i = 0; i < s->count; i++) {
            if (s->items[i].part == DB_PART_TRAIN) {
                sum += (double)s->inputs[i * inputs + f];
                count++;
            }
        }
        const double mean = count > 0 ? sum / count : 0;
        for (size_t i = 0; i < s->count; i++) {
            if (s->items[i].part == DB_PART_TRAIN) {
                const double d = (double)s->inputs[i * inputs + f] - mean;
                square += d * d;
            }
        }
        const double deviation = count > 0 ? sqrt(square / count) : 0;
        net->mean[f] = (float)mean;
        net->scale[f] = deviation > 1e-6 * fabs(mean) && deviation > 1e-30 ? (float)deviation : 1;
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

static int train_member(struct db_net *net, int m, const struct db_samples *s,
                        const uint8_t *output_of_class, const struct db_learn_options *options,
                        struct db_train_report *report)
{
    struct db_mlp *mlp = &net->members[m];
    *mlp = (struct db_mlp){.input_count = net->input_count,
                           .output_count = net->output_count,
                           .unit = options->unit,
                           .loss = options->loss};
    mlp->hidden_count = options->hidden > 0
                            ? options->hidden
                            : db_mlp_default_hidden(net->input_count, net->output_count);
    struct db_train_options train = options->train;
    train.seed += (uint64_t)m;
    struct part_data training, validation = {0};
    if (part_gather(&training, s, net, output_of_class, DB_PART_TRAIN) != 0) {
        return hs_error("training", "lower --per-class", "out of memory");
    }
    int result = -1;
    if (part_gather(&validation, s, net, output_of_class, DB_PART_VALIDATE) != 0 ||
        db_mlp_init(mlp, train.seed) != 0) {
        hs_error("training", "lower --per-class", "out of memory");
    } else {
        const struct db_train_data a = {training.inputs, training.targets, training.count};
        const struct db_train_data b = {validation.inputs, validation.targets, validation.count};
        result = db_mlp_train(mlp, &train, &a, &b, report);
    }
    part_free(&validation);
    part_free(&training);
    return result;
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
static int set_aside(struct db_samples *s, size_t region_count, const struct db_class_table *table,
                     const struct db_learn_options *options, int member)
{
    take_back(s);
    if (options->validate <= 0) {
        return 0;
    }
    const uint64_t seed = options->train.seed * 1000 + (uint64_t)member + 1;
    return db_split(s, region_count, table, true, options->validate, seed, DB_PART_VALIDATE, true);
}

static int learn(struct db_net *net, struct db_samples *s, size_t region_count,
                 const struct db_class_table *table, const struct db_learn_options *options,
                 struct db_train_report *reports)
{
    uint8_t output_of_class[DB_CLASS_MAX];
    if (find_normalisation(net, s) != 0 || choose_outputs(net, s, table, output_of_class) != 0) {
        return -1;
    }
    const long thinned = options->thin > 0 ? db_thin(s, net->scale, options->thin) : 0;
    if (thinned < 0) {
        return -1;
    }
    if (options->thin > 0 && options->thin_is_loud) {
        printf("nearly identical exemplars dropped: %ld\n", thinned);
    }
    for (int m = 0; m < options->members; m++) {
        if (set_aside(s, region_count, table, options, m) != 0 ||
            train_member(net, m, s, output_of_class, options, &reports[m]) != 0) {
            return -1;
        }
        net->member_count = m + 1;
    }
    take_back(s);
    return 0;
}

int db_learn(struct db_net *net, struct db_samples *samples, size_t region_count,
             const struct db_class_table *table, int band_count, int context,
             const struct db_learn_options *options, struct db_train_report *reports)
{
    *net = (struct db_net){
        .band_count = band_count, .context = context, .input_count = samples->input_count};
    memset(reports, 0, (size_t)options->members * sizeof *reports);
    use_one_thread();
    if (learn(net, samples, region_count, table, options, reports) != 0) {
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
        db_apply(&applied, planes, BLOCK, count, given + at);
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
