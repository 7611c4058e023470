#include "netem/model_file.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/text_file.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NUMBERS_A_LINE = 8 };

/* Forms of the file: the first that is read, and later ones by what they brought. */
enum { NAMING = 2, CONNECTING = 3, AVERAGING = 4 };

static const char remedy[] = "train again or copy the file again";
static const char *const loss_names[2] = {"mse", "mae"};
static const char *const method_names[2] = {"adam", "sgd"};
_Static_assert((int)NM_CONNECTIONS == 2, "read_choice takes one of two");

static void write_array(FILE *out, const char *name, const double *numbers, size_t count)
{
    fprintf(out, "%s %zu\n", name, count);
    for (size_t i = 0; i < count; i++) {
        const int is_last = i % NUMBERS_A_LINE == NUMBERS_A_LINE - 1 || i + 1 == count;
        fprintf(out, "%a%c", numbers[i], is_last ? '\n' : ' ');
    }
}

static void write_plan(FILE *out, const struct nm_plan *p)
{
    fprintf(out, "loss %s\nmethod %s\n", loss_names[p->loss], method_names[p->method]);
    fprintf(out, "rate %a\npix-rate %a\nmomentum %a\n", p->rate, p->pix_rate, p->momentum);
    fprintf(out, "batch %d\nreach %d\nseed %" PRIu64 "\n", p->batch, p->reach_px, p->seed);
    fprintf(out, "plan %d %d %d\naverage %a\n", p->epochs[0], p->epochs[1], p->epochs[2],
            p->average);
}

int nm_model_write(const struct nm_training *t, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    FILE *out = file.stream;
    const struct nm_model *m = &t->model;
    fprintf(out, "landmass-netem 4\narchitecture %s\nconnection %s\nmaterials",
            m->architecture->name, nm_connection_names[m->architecture->connection]);
    for (uint32_t i = 0; i < t->materials.count; i++) {
        fprintf(out, " %s", t->materials.names[i]);
    }
    fputc('\n', out);
    for (uint32_t i = 0; m->architecture->material == NM_AS_SURFACE && i < t->materials.count;
         i++) {
        const struct nm_surface *s = &t->materials.surfaces[i];
        fprintf(out, "surface %a %a %a %a\n", s->permittivity, s->loss, s->rms_height_m,
                s->correlation_m);
    }
    write_plan(out, &t->plan);
    fprintf(out, "random %" PRIx64 " %" PRIx64 " %" PRIx64 " %" PRIx64 "\n", t->rng.s[0],
            t->rng.s[1], t->rng.s[2], t->rng.s[3]);
    fprintf(out, "steps %ld\naveraged %d\nepochs %d\n", t->optimizer.steps, t->average.count,
            t->epoch_count);
    for (int i = 0; i < t->epoch_count; i++) {
        const struct nm_epoch *e = &t->epochs[i];
        fprintf(out, "%d %a %a\n", (int)e->phase, e->training, e->validation);
    }
    write_array(out, "kernel", m->kernel, NM_LARGE * NM_LARGE);
    write_array(out, "values", m->values, m->size);
    write_array(out, "mean", t->optimizer.mean, m->size);
    write_array(out, "square", t->optimizer.square, m->size);
    if (t->average.count > 0) {
        write_array(out, "averages", t->average.mean, m->size);
    }
    fputs("end\n", out);
    return hs_atomic_commit(&file);
}

/* The next line, which must begin with `key`; what follows it. */
static int next_value(struct db_text_file *f, const char *key, const char **value)
{
    const int more = db_text_next(f);
    const size_t length = strlen(key);
    if (more < 0) {
        return -1;
    }
    if (more == 0 || strncmp(f->line, key, length) != 0 ||
        (f->line[length] != ' ' && f->line[length] != '\0')) {
        return db_text_error(f, remedy, "expected `%s`", key);
    }
    *value = f->line + length;
    return 0;
}

/* `count` finite numbers and nothing else in `text`. */
static int take_numbers(struct db_text_file *f, const char *text, double *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char *end;
        numbers[i] = strtod(text, &end);
        if (end == text || !(fabs(numbers[i]) <= 1e100)) {
            return db_text_error(f, remedy, "number %zu of %zu is missing or out of range", i + 1,
                                 count);
        }
        text = end;
    }
    return text[strspn(text, " ")] == '\0' ? 0 : db_text_error(f, remedy, "more than expected");
}

static int read_numbers(struct db_text_file *f, const char *key, double *numbers, size_t count)
{
    const char *text = "";
    return next_value(f, key, &text) == 0 ? take_numbers(f, text, numbers, count) : -1;
}

static int read_number(struct db_text_file *f, const char *key, double low, double high, double *x)
{
    if (read_numbers(f, key, x, 1) != 0) {
        return -1;
    }
    return *x >= low && *x <= high
               ? 0
               : db_text_error(f, remedy, "`%s` must be %g to %g", key, low, high);
}

static int read_count(struct db_text_file *f, const char *key, int low, int high, int *count)
{
    double x;
    if (read_number(f, key, low, high, &x) != 0) {
        return -1;
    }
    *count = (int)x;
    return x == *count ? 0 : db_text_error(f, remedy, "`%s` must be whole", key);
}

static int read_choice(struct db_text_file *f, const char *key, const char *const names[2],
                       int *choice)
{
    const char *text = "";
    if (next_value(f, key, &text) != 0) {
        return -1;
    }
    for (*choice = 0; *choice < 2; ++*choice) {
        if (*text == ' ' && strcmp(text + 1, names[*choice]) == 0) {
            return 0;
        }
    }
    return db_text_error(f, remedy, "`%s` must be %s or %s", key, names[0], names[1]);
}

static int read_seed(struct db_text_file *f, uint64_t *seed)
{
    const char *text = "";
    int used = 0;
    if (next_value(f, "seed", &text) != 0) {
        return -1;
    }
    return sscanf(text, "%" SCNu64 "%n", seed, &used) == 1 && text[used] == '\0'
               ? 0
               : db_text_error(f, remedy, "`seed` must be a whole number");
}

/* Printable names with a blank before each, none of them twice. */
static int read_materials(struct db_text_file *f, struct nm_materials *m)
{
    const char *text = "";
    if (next_value(f, "materials", &text) != 0) {
        return -1;
    }
    for (m->count = 0; *text != '\0'; m->count++) {
        const size_t length = strcspn(text + 1, " ");
        if (length == 0 || length >= TRACE_NAME_SIZE || m->count == TRACE_MATERIALS_MAX) {
            return db_text_error(f, remedy, "`materials` needs up to %d names of up to %d letters",
                                 TRACE_MATERIALS_MAX, TRACE_NAME_SIZE - 1);
        }
        memcpy(m->names[m->count], text + 1, length);
        m->names[m->count][length] = '\0';
        for (uint32_t i = 0; i < m->count; i++) {
            if (strcmp(m->names[i], m->names[m->count]) == 0) {
                return db_text_error(f, remedy, "the material %s is there twice", m->names[i]);
            }
        }
        text += 1 + length;
    }
    return 0;
}

/* A line for each material, within what a file for --materials may say. */
static int read_surfaces(struct db_text_file *f, struct nm_materials *m)
{
    for (uint32_t i = 0; i < m->count; i++) {
        double x[4] = {0};
        if (read_numbers(f, "surface", x, 4) != 0) {
            return -1;
        }
        if (!(x[0] >= 1 && x[0] <= 1e9 && x[1] >= 0 && x[1] <= 1e9 && x[2] >= 0 && x[2] <= 1 &&
              x[3] >= 0 && x[3] <= 1e3)) {
            return db_text_error(f, remedy, "the surface of %s is none that can be", m->names[i]);
        }
        m->surfaces[i] = (struct nm_surface){x[0], x[1], x[2], x[3]};
    }
    return 0;
}

static int read_plan(struct db_text_file *f, int version, struct nm_plan *p)
{
    int loss, method;
    double epochs[NM_PHASES];
    if (read_choice(f, "loss", loss_names, &loss) != 0 ||
        read_choice(f, "method", method_names, &method) != 0 ||
        read_number(f, "rate", 1e-12, 1e6, &p->rate) != 0 ||
        read_number(f, "pix-rate", 1e-12, 1e6, &p->pix_rate) != 0 ||
        read_number(f, "momentum", 0, 1, &p->momentum) != 0 ||
        read_count(f, "batch", 1, 1 << 20, &p->batch) != 0 ||
        read_count(f, "reach", 0, NM_PICTURE_SIDE_MAX, &p->reach_px) != 0 ||
        read_seed(f, &p->seed) != 0 || read_numbers(f, "plan", epochs, NM_PHASES) != 0) {
        return -1;
    }
    p->average = 0;
    if (version >= AVERAGING && read_number(f, "average", 0, 1, &p->average) != 0) {
        return -1;
    }
    p->loss = (enum nm_loss_kind)loss;
    p->method = (enum nm_method)method;
    for (int i = 0; i < NM_PHASES; i++) {
        if (!(epochs[i] >= 0 && epochs[i] <= NM_EPOCHS_MAX / NM_PHASES)) {
            return db_text_error(f, remedy, "the plan has too many epochs");
        }
        p->epochs[i] = (int)epochs[i];
    }
    return 0;
}

static int read_random(struct db_text_file *f, struct hs_rng *rng)
{
    const char *text = "";
    int used = 0;
    if (next_value(f, "random", &text) != 0) {
        return -1;
    }
    const int count = sscanf(text, "%" SCNx64 "%" SCNx64 "%" SCNx64 "%" SCNx64 "%n", &rng->s[0],
                             &rng->s[1], &rng->s[2], &rng->s[3], &used);
    const uint64_t any = rng->s[0] | rng->s[1] | rng->s[2] | rng->s[3];
    return count == 4 && text[used] == '\0' && any != 0
               ? 0
               : db_text_error(f, remedy, "`random` needs four words, not all zero");
}

/* A validation without chips is written as NaN. */
static int read_epoch(struct db_text_file *f, struct nm_epoch *e)
{
    char *end[3];
    if (db_text_next(f) <= 0) {
        return db_text_error(f, remedy, "an epoch is missing");
    }
    const long phase = strtol(f->line, &end[0], 10);
    e->training = strtod(end[0], &end[1]);
    e->validation = strtod(end[1], &end[2]);
    if (end[0] == f->line || end[1] == end[0] || end[2] == end[1] || *end[2] != '\0' || phase < 0 ||
        phase >= NM_PHASES || !isfinite(e->training) || isinf(e->validation)) {
        return db_text_error(f, remedy, "an epoch must be its phase and two losses");
    }
    e->phase = (enum nm_phase)phase;
    return 0;
}

static int read_epochs(struct db_text_file *f, struct nm_training *t)
{
    int count;
    const int most = t->plan.epochs[0] + t->plan.epochs[1] + t->plan.epochs[2];
    if (read_count(f, "epochs", 0, most, &count) != 0) {
        return -1;
    }
    for (int i = 0; i < count; i++) {
        if (read_epoch(f, &t->epochs[i]) != 0) {
            return -1;
        }
    }
    t->epoch_count = count;
    return 0;
}

static int read_array(struct db_text_file *f, const char *name, double *numbers, size_t count)
{
    double written;
    if (read_numbers(f, name, &written, 1) != 0) {
        return -1;
    }
    if (written != (double)count) {
        return db_text_error(f, remedy, "`%s` must have %zu numbers", name, count);
    }
    for (size_t i = 0; i < count; i += NUMBERS_A_LINE) {
        const size_t left = count - i;
        const int more = db_text_next(f);
        if (more <= 0) {
            return more < 0 ? -1 : db_text_error(f, remedy, "`%s` was cut short", name);
        }
        if (take_numbers(f, f->line, numbers + i, left < NUMBERS_A_LINE ? left : NUMBERS_A_LINE)) {
            return -1;
        }
    }
    return 0;
}

static int read_state(struct db_text_file *f, int version, struct nm_training *t)
{
    struct nm_model *m = &t->model;
    double steps;
    int averaged = 0;
    const char *rest;
    if (read_random(f, &t->rng) != 0 || read_number(f, "steps", 0, 1e15, &steps) != 0 ||
        (version >= AVERAGING && read_count(f, "averaged", 0, 1 << 30, &averaged) != 0) ||
        read_epochs(f, t) != 0 || read_array(f, "kernel", m->kernel, NM_LARGE * NM_LARGE) != 0 ||
        read_array(f, "values", m->values, m->size) != 0 ||
        read_array(f, "mean", t->optimizer.mean, m->size) != 0 ||
        read_array(f, "square", t->optimizer.square, m->size) != 0 ||
        (averaged > 0 && read_array(f, "averages", t->average.mean, m->size) != 0) ||
        next_value(f, "end", &rest) != 0) {
        return -1;
    }
    t->optimizer.steps = (long)steps;
    t->average.count = averaged;
    const enum nm_phase phase =
        t->epoch_count > 0 ? t->epochs[t->epoch_count - 1].phase : NM_PRETRAINING;
    m->is_pix_trainable = phase == NM_PIXELS;
    t->optimizer.rate = phase == NM_PIXELS ? t->plan.pix_rate : t->plan.rate;
    return 0;
}

/* Files of version 2 are from before there was a choice. NULL with the error reported. */
static const struct nm_architecture *read_architecture(struct db_text_file *f, int version)
{
    char name[8];
    const char *text = "";
    int connection = NM_BY_COEFFICIENT;
    if (next_value(f, "architecture", &text) != 0) {
        return NULL;
    }
    snprintf(name, sizeof name, "%s", *text == ' ' ? text + 1 : text);
    const bool is_known = nm_architecture_find(name, NM_BY_COEFFICIENT);
    if (!is_known) {
        db_text_error(f, remedy, "there is no architecture `%s`", name);
        return NULL;
    }
    if (version >= CONNECTING &&
        read_choice(f, "connection", nm_connection_names, &connection) != 0) {
        return NULL;
    }
    return nm_architecture_find(name, (enum nm_connection)connection);
}

static int read_head(struct db_text_file *f, int *version,
                     const struct nm_architecture **architecture, struct nm_materials *materials,
                     struct nm_plan *plan)
{
    if (read_count(f, "landmass-netem", 1, AVERAGING, version) != 0) {
        return -1;
    }
    if (*version < NAMING) {
        return db_text_error(f, "train again", "a file without the names of its materials");
    }
    *architecture = read_architecture(f, *version);
    if (!*architecture || read_materials(f, materials) != 0 ||
        ((*architecture)->material == NM_AS_SURFACE && read_surfaces(f, materials) != 0)) {
        return -1;
    }
    if (materials->count > nm_architecture_names(*architecture)) {
        return db_text_error(f, remedy, "`materials` has more names than %s knows",
                             (*architecture)->name);
    }
    return read_plan(f, *version, plan);
}

int nm_model_read(struct nm_training *t, const char *path, int cells)
{
    static const double no_kernel[NM_LARGE * NM_LARGE];
    const struct nm_architecture *architecture = NULL;
    struct nm_materials materials = {.count = 0};
    struct nm_plan plan;
    struct db_text_file f;
    if (db_text_open(&f, path) != 0) {
        return -1;
    }
    int version, result = read_head(&f, &version, &architecture, &materials, &plan);
    result = result == 0 ? nm_training_open(t, &plan, architecture, no_kernel, cells) : result;
    if (result == 0) {
        t->materials = materials;
        result = read_state(&f, version, t);
        if (result != 0) {
            nm_training_close(t);
        }
    }
    db_text_close(&f);
    return result;
}
