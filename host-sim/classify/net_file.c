#include "classify/net_file.h"

#include "classify/samples.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/text_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const unit_names[] = {"tanh", "sigmoid"};
static const char *const loss_names[] = {"square", "cross-entropy"};

static void write_layer(FILE *out, const struct db_mlp_layer *l)
{
    for (int j = 0; j < l->to; j++) {
        fputs("unit-weights", out);
        for (int i = 0; i < l->from; i++) {
            fprintf(out, " %.9g", (double)l->weights[(size_t)j * (size_t)l->from + (size_t)i]);
        }
        fprintf(out, " %.9g\n", (double)l->bias[j]);
    }
}

static void write_head(FILE *out, const struct db_net *net)
{
    const struct db_mlp *first = &net->members[0];
    fprintf(out, "landmass-net 2\nbands %d\ncontext %d\nunit %s\nloss %s\nhidden", net->band_count,
            net->context, unit_names[first->unit], loss_names[first->loss]);
    for (int l = 0; l < first->layer_count; l++) {
        fprintf(out, " %d", first->hidden[l]);
    }
    fprintf(out, "\nmembers %d\n", net->member_count);
    for (int k = 0; k < net->output_count; k++) {
        fprintf(out, "class %s\n", net->class_names[k]);
    }
    for (int i = 0; i < net->input_count; i++) {
        fprintf(out, "input %.9g %.9g %.9g %.9g\n", (double)net->mean[i], (double)net->scale[i],
                (double)net->low[i], (double)net->high[i]);
    }
}

int db_net_write(const struct db_net *net, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    write_head(file.stream, net);
    for (int m = 0; m < net->member_count; m++) {
        const struct db_mlp *mlp = &net->members[m];
        fprintf(file.stream, "# member %d\n", m + 1);
        for (int i = 0; i <= mlp->layer_count; i++) {
            const struct db_mlp_layer l = db_mlp_layer(mlp, mlp->weights, i);
            write_layer(file.stream, &l);
        }
    }
    fputs("end\n", file.stream);
    return hs_atomic_commit(&file);
}

int db_net_alloc_inputs(struct db_net *net)
{
    const size_t count = (size_t)net->input_count;
    net->mean = calloc(count, sizeof *net->mean);
    net->scale = calloc(count, sizeof *net->scale);
    net->low = calloc(count, sizeof *net->low);
    net->high = calloc(count, sizeof *net->high);
    return net->mean && net->scale && net->low && net->high
               ? 0
               : hs_error("network", NULL, "out of memory");
}

/* Step to the next line, which must begin with `key` and a space, and give what follows. A file
 * that ends here, and any other line, is an error. */
static int next_value(struct db_text_file *f, const char *key, const char **value)
{
    const int more = db_text_next(f);
    if (more < 0) {
        return -1;
    }
    const size_t length = strlen(key);
    if (more == 0) {
        return db_text_error(f, "it was cut short; train again or copy it again",
                             "the file ends where `%s` should follow", key);
    }
    if (strncmp(f->line, key, length) != 0 || (f->line[length] != ' ' && f->line[length] != '\0')) {
        return db_text_error(f, "train again or copy the file again", "expected `%s`", key);
    }
    *value = f->line + length + (f->line[length] == ' ');
    return 0;
}

static int read_count(struct db_text_file *f, const char *key, int low, int high, int *count)
{
    const char *value = "";
    if (next_value(f, key, &value) != 0) {
        return -1;
    }
    char *end;
    const long number = strtol(value, &end, 10);
    if (end == value || *end != '\0' || number < low || number > high) {
        return db_text_error(f, "train again or copy the file again",
                             "`%s` must be %d..%d, not `%s`", key, low, high, value);
    }
    *count = (int)number;
    return 0;
}

static int read_choice(struct db_text_file *f, const char *key, const char *const names[2],
                       int *choice)
{
    const char *value = "";
    if (next_value(f, key, &value) != 0) {
        return -1;
    }
    for (*choice = 0; *choice < 2; ++*choice) {
        if (strcmp(value, names[*choice]) == 0) {
            return 0;
        }
    }
    return db_text_error(f, "train again or copy the file again", "`%s` must be %s or %s, not `%s`",
                         key, names[0], names[1], value);
}

static int parse_floats(struct db_text_file *f, const char *key, const char *value, float *numbers,
                        int count)
{
    for (int i = 0; i < count; i++) {
        char *end;
        numbers[i] = strtof(value, &end);
        if (end == value || !(fabsf(numbers[i]) <= 1e9f)) {
            return db_text_error(f, "train again or copy the file again",
                                 "number %d of %d after `%s` is missing or out of range", i + 1,
                                 count, key);
        }
        value = end;
    }
    if (*value != '\0') {
        return db_text_error(f, "train again or copy the file again", "more than %d numbers",
                             count);
    }
    return 0;
}

static int read_floats(struct db_text_file *f, const char *key, float *numbers, int count)
{
    const char *value = "";
    return next_value(f, key, &value) != 0 ? -1 : parse_floats(f, key, value, numbers, count);
}

/* Units of one layer or, from version 2 on, of several. */
static int read_hidden(struct db_text_file *f, int version, struct db_mlp *shape)
{
    const char *value = "";
    const int most = version < 2 ? 1 : DB_LAYERS_MAX;
    if (next_value(f, "hidden", &value) != 0) {
        return -1;
    }
    do {
        char *end;
        const long units = strtol(value, &end, 10);
        if (end == value || (*end != '\0' && *end != ' ') || units < 1 || units > DB_HIDDEN_MAX ||
            shape->layer_count == most) {
            return db_text_error(f, "train again or copy the file again",
                                 "`hidden` must be 1..%d numbers of 1..%d in version %d, not `%s`",
                                 most, DB_HIDDEN_MAX, version, value);
        }
        shape->hidden[shape->layer_count++] = (int)units;
        value = end;
    } while (*value != '\0');
    return 0;
}

/* The `class` lines, up to the first `input`, which is left in the file's line. */
static int read_classes(struct db_text_file *f, struct db_net *net)
{
    int more;
    while ((more = db_text_next(f)) > 0 && strncmp(f->line, "class ", 6) == 0) {
        const char *name = f->line + 6;
        if (net->output_count == DB_CLASS_MAX || strlen(name) >= DB_NAME_SIZE) {
            return db_text_error(f, "train again or copy the file again",
                                 "too many classes or too long a name");
        }
        for (int k = 0; k < net->output_count; k++) {
            if (strcmp(net->class_names[k], name) == 0) {
                return db_text_error(f, "train again", "class `%s` is here twice", name);
            }
        }
        strcpy(net->class_names[net->output_count++], name);
    }
    if (more < 0) {
        return -1;
    }
    if (net->output_count < 2) {
        return db_text_error(f, "train again or copy the file again", "fewer than two classes");
    }
    return 0;
}

/* MEAN SCALE and, from version 2 on, LOW HIGH. */
static int take_input(struct db_text_file *f, struct db_net *net, int i, const float *numbers)
{
    if (!(numbers[1] > 0)) {
        return db_text_error(f, "train again", "the scale of an input must be above 0");
    }
    net->mean[i] = numbers[0];
    net->scale[i] = numbers[1];
    if (!net->has_range) {
        return 0;
    }
    if (numbers[2] > numbers[3]) {
        return db_text_error(f, "train again", "the range of an input ends before it begins");
    }
    net->low[i] = numbers[2];
    net->high[i] = numbers[3];
    return 0;
}

/* The first `input` line has been read already, by read_classes. */
static int read_inputs(struct db_text_file *f, struct db_net *net)
{
    const int count = net->has_range ? 4 : 2;
    float numbers[4] = {0};
    if (strncmp(f->line, "input ", 6) != 0) {
        return db_text_error(f, "train again or copy the file again",
                             "expected `class NAME` or `input MEAN SCALE LOW HIGH`");
    }
    int result = parse_floats(f, "input", f->line + 6, numbers, count);
    for (int i = 0; result == 0 && i < net->input_count; i++) {
        result = i == 0 ? 0 : read_floats(f, "input", numbers, count);
        if (result == 0) {
            result = take_input(f, net, i, numbers);
        }
    }
    return result;
}

static int read_layer(struct db_text_file *f, const struct db_mlp_layer *l)
{
    float *row = malloc((size_t)(l->from + 1) * sizeof *row);
    int result = row ? 0 : hs_error(f->path, NULL, "out of memory");
    for (int j = 0; result == 0 && j < l->to; j++) {
        result = read_floats(f, "unit-weights", row, l->from + 1);
        if (result == 0) {
            memcpy(l->weights + (size_t)j * (size_t)l->from, row, (size_t)l->from * sizeof *row);
            l->bias[j] = row[l->from];
        }
    }
    free(row);
    return result;
}

static int read_member(struct db_text_file *f, struct db_mlp *mlp)
{
    mlp->weights = calloc(db_mlp_size(mlp), sizeof *mlp->weights);
    int result = mlp->weights ? 0 : hs_error(f->path, NULL, "out of memory");
    for (int i = 0; result == 0 && i <= mlp->layer_count; i++) {
        const struct db_mlp_layer l = db_mlp_layer(mlp, mlp->weights, i);
        result = read_layer(f, &l);
    }
    return result;
}

static int read_end(struct db_text_file *f)
{
    const char *rest;
    if (next_value(f, "end", &rest) != 0) {
        return -1;
    }
    const int more = db_text_next(f);
    return more == 0 ? 0
                     : db_text_error(f, "train again or copy the file again",
                                     "something follows the end");
}

static int read_net(struct db_text_file *f, struct db_net *net)
{
    struct db_mlp shape = {0};
    int version = 0, unit = 0, loss = 0;
    if (read_count(f, "landmass-net", 1, 2, &version) != 0 ||
        read_count(f, "bands", 1, DB_INPUT_MAX, &net->band_count) != 0 ||
        read_count(f, "context", 1, DB_CONTEXT_MAX, &net->context) != 0 ||
        read_choice(f, "unit", unit_names, &unit) != 0 ||
        read_choice(f, "loss", loss_names, &loss) != 0 || read_hidden(f, version, &shape) != 0 ||
        read_count(f, "members", 1, DB_MEMBERS_MAX, &net->member_count) != 0 ||
        read_classes(f, net) != 0) {
        return -1;
    }
    net->input_count = db_feature_count(net->band_count, net->context);
    if (net->input_count > DB_INPUT_MAX || net->context % 2 == 0) {
        return db_text_error(f, "train again", "bands and context do not fit");
    }
    net->has_range = version >= 2;
    if (db_net_alloc_inputs(net) != 0 || read_inputs(f, net) != 0) {
        return -1;
    }
    shape.input_count = net->input_count;
    shape.output_count = net->output_count;
    shape.unit = (enum db_unit)unit;
    shape.loss = (enum db_loss)loss;
    for (int m = 0; m < net->member_count; m++) {
        net->members[m] = shape;
        if (read_member(f, &net->members[m]) != 0) {
            return -1;
        }
    }
    return read_end(f);
}

int db_net_read(struct db_net *net, const char *path)
{
    *net = (struct db_net){0};
    struct db_text_file f;
    if (db_text_open(&f, path) != 0) {
        return -1;
    }
    const int result = read_net(&f, net);
    db_text_close(&f);
    if (result != 0) {
        db_net_free(net);
    }
    return result;
}

void db_net_free(struct db_net *net)
{
    for (int m = 0; m < DB_MEMBERS_MAX; m++) {
        db_mlp_free(&net->members[m]);
    }
    free(net->mean);
    free(net->scale);
    free(net->low);
    free(net->high);
    *net = (struct db_net){0};
}
