#include "classify/mlp_train.h"

#include "hs/progress.h"
#include "hs/rng.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    SETTLING = 2,       /* the first cures, which slow the learning and let the weights settle */
    CLASSES = 256,      /* as many as a target can name */
    SCORE_BATCH = 1024, /* exemplars at a time when only looking */
    EPOCH_LEAST = 512,  /* presentations: a handful of exemplars would change the weights once */
};

/* An exemplar's RMS error over the outputs counts as high or low beyond these. */
static const double high_error = 0.4, low_error = 0.2;
/* Recognition of 95 % switches between the two in up to a tenth of the presentations: more is
 * Heaton's symptom. */
static const double alternating = 0.1;
/* What counts as progress: the relative fall of the error, the rise of the recognition. */
static const double error_progress = 0.01, score_progress = 0.002;

static int batch_alloc(struct db_mlp_batch *b, const struct db_mlp *net, int count)
{
    const size_t n = (size_t)count;
    const size_t hidden = (size_t)db_mlp_hidden_total(net), outputs = (size_t)net->output_count;
    float *all = malloc(n * 2 * (hidden + outputs) * sizeof *all);
    *b = (struct db_mlp_batch){.count = count, .hidden = all};
    if (!all) {
        return -1;
    }
    b->hidden_delta = b->hidden + n * hidden;
    b->outputs = b->hidden_delta + n * hidden;
    b->output_delta = b->outputs + n * outputs;
    return 0;
}

static int largest(const float *values, int count)
{
    int best = 0;
    for (int i = 1; i < count; i++) {
        best = values[i] > values[best] ? i : best;
    }
    return best;
}

static double square_error(const float *outputs, int count, int target)
{
    double sum = 0;
    for (int k = 0; k < count; k++) {
        const double error = (double)outputs[k] - (k == target);
        sum += error * error;
    }
    return sum;
}

double db_mlp_recognition(const struct db_mlp *net, const struct db_train_data *data, double *rms)
{
    struct db_mlp_batch b;
    if (data->count == 0 || batch_alloc(&b, net, SCORE_BATCH) != 0) {
        return NAN;
    }
    size_t seen[CLASSES] = {0}, right[CLASSES] = {0};
    double square = 0;
    for (size_t at = 0; at < data->count; at += SCORE_BATCH) {
        const size_t left = data->count - at;
        b.count = left < SCORE_BATCH ? (int)left : SCORE_BATCH;
        b.inputs = data->inputs + at * (size_t)net->input_count;
        db_mlp_forward(net, &b);
        for (int i = 0; i < b.count; i++) {
            const float *o = b.outputs + (size_t)i * (size_t)net->output_count;
            const uint8_t target = data->targets[at + (size_t)i];
            seen[target]++;
            right[target] += largest(o, net->output_count) == target;
            square += square_error(o, net->output_count, target);
        }
    }
    free(b.hidden);
    double sum = 0, weights = 0;
    for (int c = 0; c < CLASSES; c++) {
        if (seen[c] > 0) {
            const double weight = data->priors ? data->priors[c] : 1;
            sum += weight * (double)right[c] / (double)seen[c];
            weights += weight;
        }
    }
    if (rms) {
        *rms = sqrt(square / ((double)data->count * net->output_count));
    }
    return sum / weights;
}

/* Endless rounds through the exemplars of each class, in an order drawn anew for each round. */
struct presenter {
    uint32_t *order;           /* owned: exemplars sorted by class */
    size_t begin[CLASSES + 1]; /* of each class in `order` */
    size_t next[CLASSES];
    uint32_t *epoch;       /* owned: those of the present epoch */
    size_t count;          /* of them */
    size_t usual;          /* presentations of an epoch, give or take one a class */
    double share[CLASSES]; /* of each class in them */
    double owed[CLASSES];  /* parts of presentations carried over from epoch to epoch */
};

static void presenter_free(struct presenter *p)
{
    free(p->order);
    free(p->epoch);
}

/* The priors of the classes that have exemplars, brought to a sum of 1. */
static void find_shares(struct presenter *p, const double *priors)
{
    double sum = 0;
    for (int c = 0; c < CLASSES; c++) {
        const bool occurs = p->begin[c + 1] > p->begin[c];
        p->share[c] = occurs ? (priors ? priors[c] : 1) : 0;
        sum += p->share[c];
    }
    for (int c = 0; c < CLASSES; c++) {
        p->share[c] /= sum;
    }
}

static int presenter_init(struct presenter *p, const struct db_train_data *data)
{
    *p = (struct presenter){.usual = data->count > EPOCH_LEAST ? data->count : EPOCH_LEAST};
    p->order = malloc(data->count * sizeof *p->order);
    p->epoch = malloc((p->usual + CLASSES) * sizeof *p->epoch);
    if (!p->order || !p->epoch) {
        return -1; /* trainer_free frees either. */
    }
    size_t used = 0;
    for (int c = 0; c < CLASSES; c++) {
        p->begin[c] = used;
        for (size_t i = 0; i < data->count; i++) {
            if (data->targets[i] == c) {
                p->order[used++] = (uint32_t)i;
            }
        }
        p->next[c] = used; /* The first draw begins a round. */
    }
    p->begin[CLASSES] = used;
    find_shares(p, data->priors);
    return 0;
}

static void shuffle(uint32_t *items, size_t count, struct hs_rng *rng)
{
    for (size_t i = count; i > 1; i--) {
        const uint32_t j = hs_rng_below(rng, (uint32_t)i), t = items[j];
        items[j] = items[i - 1];
        items[i - 1] = t;
    }
}

static uint32_t present_next(struct presenter *p, int c, struct hs_rng *rng)
{
    if (p->next[c] == p->begin[c + 1]) {
        p->next[c] = p->begin[c];
        shuffle(p->order + p->begin[c], p->begin[c + 1] - p->begin[c], rng);
    }
    return p->order[p->next[c]++];
}

static void presenter_draw_epoch(struct presenter *p, struct hs_rng *rng)
{
    p->count = 0;
    for (int c = 0; c < CLASSES; c++) {
        /* Half a part in 10^9 keeps whole numbers whole. */
        p->owed[c] += p->share[c] * (double)p->usual;
        const size_t due = (size_t)(p->owed[c] + 1e-9);
        p->owed[c] -= (double)due;
        for (size_t i = 0; i < due; i++) {
            p->epoch[p->count++] = present_next(p, c, rng);
        }
    }
    shuffle(p->epoch, p->count, rng);
}

/* Everything training remembers from one epoch to the next. */
struct trainer {
    struct db_mlp *net;
    const struct db_train_options *options;
    const struct db_train_data *training, *validation;
    struct db_train_report *report;
    struct presenter presenter;
    struct db_mlp_batch batch;
    float *inputs;    /* owned: the batch with its noise */
    uint8_t *targets; /* owned */
    /* Owned, laid out as the weights. `mean` is that of the weights over the present epoch. */
    float *gradient, *velocity, *best, *mean;
    struct hs_rng rng;
    double rate, momentum, noise; /* as they are by now */
    double decay;
    double best_score, best_rms; /* of the weights in `best` */
    double mark_score, mark_rms; /* where progress was last made */
    int score_epoch, rms_epoch;  /* when */
    int actions;                 /* cures tried on these weights */
    int redraws_left;
    bool was_high; /* the error of the exemplar presented last */
};

static void trainer_free(struct trainer *t)
{
    presenter_free(&t->presenter);
    free(t->batch.hidden);
    free(t->inputs);
    free(t->targets);
    free(t->gradient);
    free(t->velocity);
    free(t->best);
    free(t->mean);
}

static int trainer_init(struct trainer *t)
{
    const size_t size = db_mlp_size(t->net), batch = (size_t)t->options->batch;
    t->rate = t->options->rate;
    t->momentum = t->options->momentum;
    t->noise = t->options->noise;
    t->decay =
        isnan(t->options->decay) ? db_default_decay(size, t->training->count) : t->options->decay;
    t->report->decay = t->decay;
    t->best_score = t->mark_score = -1;
    t->best_rms = t->mark_rms = INFINITY;
    t->redraws_left = t->options->redraws;
    hs_rng_seed(&t->rng, t->options->seed ^ 0x7261696e);
    t->inputs = malloc(batch * (size_t)t->net->input_count * sizeof *t->inputs);
    t->targets = malloc(batch);
    t->gradient = calloc(size, sizeof *t->gradient);
    t->velocity = calloc(size, sizeof *t->velocity);
    t->best = calloc(size, sizeof *t->best);
    t->mean = calloc(size, sizeof *t->mean);
    t->report->epochs = calloc((size_t)t->options->epochs, sizeof *t->report->epochs);
    if (!t->inputs || !t->targets || !t->gradient || !t->velocity || !t->best || !t->mean ||
        !t->report->epochs || presenter_init(&t->presenter, t->training) != 0 ||
        batch_alloc(&t->batch, t->net, t->options->batch) != 0) {
        return -1;
    }
    memcpy(t->best, t->net->weights, size * sizeof *t->best);
    t->batch.inputs = t->inputs;
    t->batch.targets = t->targets;
    return 0;
}

static void fill_batch(struct trainer *t, size_t at, int count)
{
    const size_t inputs = (size_t)t->net->input_count;
    t->batch.count = count;
    for (size_t i = 0; i < (size_t)count; i++) {
        const uint32_t from = t->presenter.epoch[at + i];
        t->targets[i] = t->training->targets[from];
        for (size_t f = 0; f < inputs; f++) {
            const double noise = t->noise > 0 ? t->noise * hs_rng_normal(&t->rng) : 0;
            t->inputs[i * inputs + f] =
                t->training->inputs[(size_t)from * inputs + f] + (float)noise;
        }
    }
}

double db_default_decay(size_t weights, size_t exemplars)
{
    const double none = 0.3, full = 0.6; /* weights for each exemplar */
    const double part = ((double)weights / (double)exemplars - none) / (full - none);
    return DB_DECAY_MOST * fmax(0, fmin(1, part));
}

static void change_weights(struct trainer *t)
{
    const size_t size = db_mlp_size(t->net);
    const float rate = (float)t->rate, momentum = (float)t->momentum;
    const float decay = (float)t->decay;
    for (size_t i = 0; i < size; i++) {
        t->velocity[i] =
            momentum * t->velocity[i] - rate * (t->gradient[i] + decay * t->net->weights[i]);
        t->net->weights[i] += t->velocity[i];
    }
}

/* Watch for the symptom while the exemplars are presented. */
static size_t count_alternations(struct trainer *t)
{
    const int outputs = t->net->output_count;
    size_t count = 0;
    for (int i = 0; i < t->batch.count; i++) {
        const float *o = t->batch.outputs + (size_t)i * (size_t)outputs;
        const double error = sqrt(square_error(o, outputs, t->targets[i]) / outputs);
        if (t->was_high ? error < low_error : error > high_error) {
            t->was_high = !t->was_high;
            count++;
        }
    }
    return count;
}

static void add_to_mean(struct trainer *t, size_t count)
{
    const size_t size = db_mlp_size(t->net);
    const float share = 1.0f / (float)count;
    for (size_t i = 0; i < size; i++) {
        t->mean[i] += share * (t->net->weights[i] - t->mean[i]);
    }
}

/* The weights sway about their goal at a fixed rate, and their mean over an epoch lies nearer to it
 * (Polyak and Juditsky, SIAM Journal on Control and Optimization 30, 1992, p. 838): it is what is
 * judged and kept. */
static void score_epoch(const struct trainer *t, struct db_epoch *epoch)
{
    struct db_mlp mean = *t->net;
    mean.weights = t->mean;
    epoch->recognition = db_mlp_recognition(&mean, t->training, &epoch->rms);
    epoch->validation = db_mlp_recognition(&mean, t->validation, NULL);
}

static void run_epoch(struct trainer *t, struct db_epoch *epoch)
{
    size_t alternations = 0, batches = 0;
    presenter_draw_epoch(&t->presenter, &t->rng);
    for (size_t at = 0; at < t->presenter.count; at += (size_t)t->options->batch) {
        const size_t left = t->presenter.count - at;
        fill_batch(t, at, left < (size_t)t->options->batch ? (int)left : t->options->batch);
        db_mlp_forward(t->net, &t->batch);
        alternations += count_alternations(t);
        db_mlp_backward(t->net, &t->batch, t->gradient);
        change_weights(t);
        add_to_mean(t, ++batches);
    }
    epoch->alternation = (double)alternations / (double)t->presenter.count;
    score_epoch(t, epoch);
}

static double score_of(const struct db_epoch *epoch)
{
    return isnan(epoch->validation) ? epoch->recognition : epoch->validation;
}

static void keep_if_better(struct trainer *t, const struct db_epoch *epoch, int number)
{
    const double score = score_of(epoch);
    if (score > t->best_score || (score == t->best_score && epoch->rms < t->best_rms)) {
        t->best_score = score;
        t->best_rms = epoch->rms;
        t->report->best_epoch = number;
        memcpy(t->best, t->mean, db_mlp_size(t->net) * sizeof *t->best);
    }
}

/* Any fall of the error, however small, is a better result but no progress: on the flat ground of a
 * local minimum it goes on for ever. */
static void note_progress(struct trainer *t, const struct db_epoch *epoch, int number)
{
    if (score_of(epoch) >= t->mark_score + score_progress) {
        t->mark_score = score_of(epoch);
        t->score_epoch = number;
    }
    if (epoch->rms <= t->mark_rms * (1 - error_progress)) {
        t->mark_rms = epoch->rms;
        t->rms_epoch = number;
    }
}

static void record(struct trainer *t, int epoch, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void record(struct trainer *t, int epoch, const char *format, ...)
{
    if (t->report->event_count == DB_EVENTS_MAX) {
        return;
    }
    struct db_train_event *event = &t->report->events[t->report->event_count++];
    event->epoch = epoch;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(event->text, sizeof event->text, format, arguments);
    va_end(arguments);
}

static int draw_new_weights(struct trainer *t)
{
    struct db_mlp fresh = *t->net;
    if (db_mlp_init(&fresh, hs_rng_u64(&t->rng)) != 0) {
        return -1;
    }
    db_mlp_free(t->net);
    t->net->weights = fresh.weights;
    t->rate = t->options->rate;
    t->momentum = t->options->momentum;
    t->noise = t->options->noise;
    t->mark_score = -1;
    t->mark_rms = INFINITY;
    t->actions = 0;
    t->redraws_left--;
    return 0;
}

static bool has_goal(const struct trainer *t)
{
    return t->report->epochs[t->report->best_epoch - 1].recognition >= t->options->goal;
}

/* The next cure; returns false when there is none left. */
static bool act_on_minimum(struct trainer *t, int epoch, double alternation)
{
    char met[64];
    snprintf(met, sizeof met, "%s (%.0f %% alternating)",
             has_goal(t)                 ? "the goal is reached"
             : alternation < alternating ? "plateau below the goal"
                                         : "local minimum",
             100 * alternation);
    memset(t->velocity, 0, db_mlp_size(t->net) * sizeof *t->velocity);
    switch (t->actions++) {
    case 0:
        t->rate *= 0.5;
        record(t, epoch, "%s: rate halved to %g", met, t->rate);
        return true;
    case 1:
        t->rate *= 0.5;
        t->momentum *= 0.8;
        record(t, epoch, "%s: rate %g, momentum %g", met, t->rate, t->momentum);
        return true;
    case 2:
        t->noise = t->noise > 0 ? 2 * t->noise : 0.05;
        record(t, epoch, "%s: noise raised to %g", met, t->noise);
        return true;
    default:
        if (t->redraws_left == 0) {
            return false;
        }
        record(t, epoch, "%s: weights drawn anew", met);
        return draw_new_weights(t) == 0;
    }
}

/* Once the goal is reached, and with validation, a falling error alone is no progress. */
static bool is_plateau(const struct trainer *t, const struct db_epoch *epoch, int number)
{
    const bool error_counts = isnan(epoch->validation) && !has_goal(t);
    const int last = error_counts && t->rms_epoch > t->score_epoch ? t->rms_epoch : t->score_epoch;
    return number - last >= t->options->patience;
}

/* Returns true when training is over. */
static bool is_over(struct trainer *t, const struct db_epoch *epoch, int number)
{
    t->report->stop = DB_STOP_EPOCHS;
    if (!is_plateau(t, epoch, number)) {
        return false;
    }
    const bool error_falls =
        number - t->rms_epoch < t->options->patience && !isnan(epoch->validation);
    if (has_goal(t) && t->actions >= SETTLING) {
        t->report->stop = DB_STOP_GOAL;
        return true;
    }
    t->score_epoch = t->rms_epoch = number;
    if (error_falls || !act_on_minimum(t, number, epoch->alternation)) {
        t->report->stop = DB_STOP_PLATEAU;
        return true;
    }
    return false;
}

int db_mlp_train(struct db_mlp *net, const struct db_train_options *options,
                 const struct db_train_data *training, const struct db_train_data *validation,
                 struct db_train_report *report)
{
    *report = (struct db_train_report){0};
    struct trainer t = {.net = net,
                        .options = options,
                        .training = training,
                        .validation = validation,
                        .report = report};
    if (trainer_init(&t) != 0) {
        trainer_free(&t);
        return -1;
    }
    struct hs_progress progress = {0}; /* which shows nothing */
    if (!options->is_quiet) {
        hs_progress_begin(&progress, "training", (uint64_t)options->epochs);
    }
    for (bool over = false; !over && report->epoch_count < options->epochs;) {
        struct db_epoch *epoch = &report->epochs[report->epoch_count++];
        run_epoch(&t, epoch);
        keep_if_better(&t, epoch, report->epoch_count);
        note_progress(&t, epoch, report->epoch_count);
        over = is_over(&t, epoch, report->epoch_count);
        hs_progress_update(&progress, (uint64_t)report->epoch_count);
    }
    hs_progress_end(&progress);
    memcpy(net->weights, t.best, db_mlp_size(net) * sizeof *net->weights);
    trainer_free(&t);
    return 0;
}

void db_train_report_free(struct db_train_report *report)
{
    free(report->epochs);
    *report = (struct db_train_report){0};
}
