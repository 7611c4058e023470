#include "bus/decode.h"

#include "bus/control_rows.h"
#include "bus/words.h"
#include "drv/can_log.h"
#include "hs/error.h"
#include "hs/progress.h"
#include "hs/report.h"
#include "lm/bus.h"
#include "lm/bus_filters.h"
#include "lm/canas_control.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>

static const char *const outcome_words[LM_BUS_OUTCOMES] = {
    [LM_BUS_VALUE] = "values",
    [LM_BUS_HALF] = "part of a double or of a fast packet",
    [LM_BUS_NOT_DATA] = "no data frame",
    [LM_BUS_FOREIGN] = "foreign identifier",
    [LM_BUS_OTHER_CHANNEL] = "redundancy channel not used",
    [LM_BUS_SERVICE] = "node service",
    [LM_BUS_UNUSED] = "not used",
    [LM_BUS_NODE_REFUSED] = "node not on the list",
    [LM_BUS_BAD_LENGTH] = "refused: length",
    [LM_BUS_BAD_NODE] = "refused: node 0",
    [LM_BUS_BAD_TYPE] = "refused: data type",
    [LM_BUS_NO_DATA] = "sender has no value",
    [LM_BUS_NOT_A_NUMBER] = "refused: not a number",
    [LM_BUS_OUT_OF_RANGE] = "refused: out of range",
};

static const char *const service_names[] = {"IDS", "NSS", "DDS", "DUS", "SCS", "TIS", "FPS", "STS",
                                            "FSS", "TCS", "BSS", "NIS", "MIS", "MCS", "CSS", "DSS"};

static const char *const outcome_keys[LM_BUS_OUTCOMES] = {
    [LM_BUS_VALUE] = "values",
    [LM_BUS_HALF] = "half_of_a_double",
    [LM_BUS_NOT_DATA] = "no_data_frame",
    [LM_BUS_FOREIGN] = "foreign_identifier",
    [LM_BUS_OTHER_CHANNEL] = "channel_not_used",
    [LM_BUS_SERVICE] = "node_service",
    [LM_BUS_UNUSED] = "not_used",
    [LM_BUS_NODE_REFUSED] = "node_not_on_the_list",
    [LM_BUS_BAD_LENGTH] = "refused_length",
    [LM_BUS_BAD_NODE] = "refused_node",
    [LM_BUS_BAD_TYPE] = "refused_type",
    [LM_BUS_NO_DATA] = "sender_has_no_value",
    [LM_BUS_NOT_A_NUMBER] = "refused_not_a_number",
    [LM_BUS_OUT_OF_RANGE] = "refused_range",
};

struct decoder {
    FILE *out;
    const char *path;
    struct lm_bus bus;
};

static void report_line(void *ctx, uint32_t line, const char *cause)
{
    const struct decoder *d = ctx;
    char place[512];
    snprintf(place, sizeof place, "%s line %u", d->path, line);
    hs_warn(place, "the line is skipped", "%s", cause);
}

static uint32_t element_at(const uint8_t *data, unsigned index, unsigned bytes)
{
    uint32_t word = 0;
    for (unsigned i = 0; i < bytes; i++) {
        word = word << 8 | data[index * bytes + i];
    }
    return word;
}

static void print_element(FILE *out, const struct lm_canas_type *t, uint32_t word)
{
    const unsigned bits = 8u * t->element_bytes;
    float number;
    switch ((enum lm_canas_kind)t->kind) {
    case LM_CANAS_KIND_FLOAT:
        memcpy(&number, &word, sizeof number);
        fprintf(out, " %.9g", (double)number);
        break;
    case LM_CANAS_KIND_SIGNED:
        fprintf(out, " %d", bits == 32 ? (int32_t)word : bits == 16 ? (int16_t)word : (int8_t)word);
        break;
    case LM_CANAS_KIND_UNSIGNED:
        fprintf(out, " %u", word);
        break;
    case LM_CANAS_KIND_TEXT:
        fprintf(out, word >= ' ' && word < 0x7f ? " '%c'" : " %02X", (int)word);
        break;
    case LM_CANAS_KIND_BITS:
    case LM_CANAS_KIND_HALF:
    case LM_CANAS_KIND_NONE:
        fprintf(out, " %0*X", (int)bits / 4, word);
        break;
    }
}

/* Header and data of any frame of CANaerospace, by its own data type. */
static void print_canas(FILE *out, const struct lm_can_frame *f)
{
    if (f->length < 4 || f->length > 8) {
        return;
    }
    fprintf(out, " node %u service %u code %u", f->data[0], f->data[2], f->data[3]);
    const uint8_t type = f->data[1];
    if (type >= LM_CANAS_TYPES) {
        fprintf(out, " type %u", type);
        return;
    }
    const struct lm_canas_type *t = &lm_canas_types[type];
    fprintf(out, " %s", t->name);
    if (f->length == 4 + t->element_bytes * t->elements) {
        for (unsigned i = 0; i < t->elements; i++) {
            print_element(out, t, element_at(f->data + 4, i, t->element_bytes));
        }
    }
}

/* The numbers of a word, each by its name. Such a row has one type. */
static void print_word(FILE *out, const struct lm_bus_row *row, const struct bus_word_part *parts,
                       uint32_t word)
{
    const struct lm_canas_type *t = &lm_canas_types[__builtin_ctz(row->types)];
    for (unsigned i = 0; i < t->elements && i < BUS_WORD_PARTS && parts[i].name != NULL; i++) {
        fprintf(out, "%s %s %g%s%s", i == 0 ? "" : ",", parts[i].name,
                bus_word_number(t, word, i) * parts[i].scale, parts[i].unit[0] == 0 ? "" : " ",
                parts[i].unit);
    }
}

static void print_event(FILE *out, const struct lm_bus_profile *profile,
                        const struct lm_bus_event *e)
{
    const struct lm_bus_row *row = &profile->rows[e->row];
    const struct lm_bus_scale *s = lm_bus_scale_of((enum lm_bus_field)row->field);
    const struct bus_word_part *parts = bus_word_parts(row->field);
    const double counts = ldexp(s->multiplier, s->frac_bits) / s->divisor;
    fprintf(out, " = %s", lm_bus_fields[row->field].name);
    if (parts != NULL) {
        print_word(out, row, parts, (uint32_t)e->value);
    } else {
        fprintf(out, " %.*f %s", counts > 1000 ? 7 : 3, e->value / counts, s->bus_unit);
    }
    if ((row->field >= LM_BUS_NAV_FIELDS && row->field < LM_BUS_WEATHER_CLEAR) ||
        lm_bus_is_live(row->field)) {
        fprintf(out, " (number %u, set %u)", e->service, e->code);
    }
    if (e->channel != 0) {
        fprintf(out, " (channel %u)", e->channel);
    }
}

/* The display's own frame of this identifier, or a control: true with its row. */
static bool find_report(const struct lm_can_frame *f, struct lm_report_row *row)
{
    for (int i = 0; i < LM_REPORT_ITEMS && !f->is_extended; i++) {
        if (lm_report_rows[i].id == f->id) {
            *row = lm_report_rows[i];
            return true;
        }
    }
    const bool is_control =
        !f->is_extended && f->id >= LM_CONTROL_ID && f->id < LM_CONTROL_ID + LM_CONTROL_ITEMS;
    const bool is_swap = !f->is_extended && f->id == LM_BUS_SWAP_ID;
    if (is_control || is_swap) {
        *row = is_swap ? bus_swap_row() : bus_control_row((int)(f->id - LM_CONTROL_ID));
    }
    return is_control || is_swap;
}

/* What a frame of the display says, when it is well formed and has a value. */
static void print_report(FILE *out, const struct lm_report_row *row, const struct lm_can_frame *f)
{
    const struct lm_canas_type *t = &lm_canas_types[row->type];
    if (f->length < 4 || f->data[1] != row->type ||
        f->length != 4 + t->element_bytes * t->elements) {
        return;
    }
    const char *name = row->unit;
    for (unsigned i = 0; t->elements > 1 && i < t->elements; i++) {
        const int length = (int)strcspn(name, " ");
        fprintf(out, "%s%.*s %u", i == 0 ? " = " : ", ", length, name,
                element_at(f->data + 4, i, t->element_bytes));
        name += length + (name[length] == ' ');
    }
    if (t->elements == 1) {
        const uint32_t word = element_at(f->data + 4, 0, t->element_bytes);
        const int32_t number = t->element_bytes == 1 ? (int8_t)word : (int32_t)word;
        const bool is_unsigned = t->kind == LM_CANAS_KIND_UNSIGNED;
        fprintf(out, " = %.*f %s", row->per_unit > 1000 ? 7 : 3,
                (is_unsigned ? word : (double)number) / row->per_unit, row->unit);
    }
}

static const char *name_of(const struct lm_bus_profile *profile, const struct lm_can_frame *f)
{
    for (int i = 0; i < profile->row_count; i++) {
        const struct lm_bus_row *row = &profile->rows[i];
        const uint32_t mask = profile->framing == LM_BUS_PACKED ? row->packing.mask : 0xffff;
        if ((f->id & mask) == row->id && !f->is_error) {
            return row->name;
        }
    }
    return NULL;
}

/* The one outcome that is news since `before`; the first where there are more. */
static const char *news(const struct lm_bus *before, const struct lm_bus *now)
{
    for (int i = 0; i < LM_BUS_OUTCOMES; i++) {
        if (now->count.outcome[i] != before->count.outcome[i]) {
            return outcome_words[i];
        }
    }
    return "not used";
}

static void print_frame(struct decoder *d, const struct lm_can_frame *f)
{
    const struct lm_bus_profile *profile = d->bus.profile;
    struct lm_bus_event events[LM_BUS_EVENTS];
    const struct lm_bus before = d->bus;
    const uint32_t count = lm_bus_take(&d->bus, f, events);
    fprintf(d->out, "%12.6f ", (double)f->time_us * 1e-6);
    fprintf(d->out, f->is_extended || f->is_error ? "%08X" : "     %03X", f->id);
    const char *name = name_of(profile, f);
    const bool is_canas = profile->framing == LM_BUS_CANAEROSPACE && !f->is_error && !f->is_remote;
    struct lm_report_row report;
    const bool is_report = is_canas && name == NULL && find_report(f, &report);
    if (is_report) {
        name = report.name;
    }
    if (name != NULL) {
        fprintf(d->out, " %s:", name);
    }
    if (is_canas) {
        print_canas(d->out, f);
    }
    for (uint32_t i = 0; i < count; i++) {
        print_event(d->out, profile, &events[i]);
    }
    if (is_report) {
        print_report(d->out, &report, f);
    }
    if (count == 0 && !is_report) {
        fprintf(d->out, " [%s]", f->is_error ? "report of the controller" : news(&before, &d->bus));
    }
    if (is_canas && f->length >= 4 &&
        d->bus.count.outcome[LM_BUS_SERVICE] != before.count.outcome[LM_BUS_SERVICE] &&
        f->data[2] < sizeof service_names / sizeof *service_names) {
        fprintf(d->out, " %s %s", service_names[f->data[2]], f->id & 1 ? "response" : "request");
    }
    fprintf(d->out, "\n");
}

static void print_summary(const struct decoder *d, const struct drv_can_log *log)
{
    fprintf(d->out, "# %u frames, %u lines not read\n", d->bus.count.frames, log->count.malformed);
    for (int i = 0; i < LM_BUS_OUTCOMES; i++) {
        if (d->bus.count.outcome[i] != 0) {
            fprintf(d->out, "# %s: %u\n", outcome_words[i], d->bus.count.outcome[i]);
        }
    }
    if (d->bus.profile->framing == LM_BUS_CANAEROSPACE) {
        fprintf(d->out,
                "# halves without a mate: %u; message codes out of sequence: %u, "
                "standing still: %u\n",
                d->bus.canas.count.torn_pairs, d->bus.canas.count.sequence_breaks,
                d->bus.canas.count.stuck);
    }
    const struct lm_fast_packet *fast = &d->bus.fast;
    if (fast->count.whole + fast->count.torn + fast->count.stray != 0) {
        fprintf(d->out, "# fast packets: %u whole, %u torn; frames of none: %u\n",
                fast->count.whole, fast->count.torn, fast->count.stray);
    }
}

static void report(const struct decoder *d, const struct drv_can_log *log)
{
    hs_report_put("frames", d->bus.count.frames);
    hs_report_put("malformed", log->count.malformed);
    for (int i = 0; i < LM_BUS_OUTCOMES; i++) {
        hs_report_put(outcome_keys[i], d->bus.count.outcome[i]);
    }
    hs_report_put("torn_pairs", d->bus.canas.count.torn_pairs);
    hs_report_put("sequence_breaks", d->bus.canas.count.sequence_breaks);
    hs_report_put("stuck", d->bus.canas.count.stuck);
    hs_report_object("fast_packets");
    hs_report_put("whole", d->bus.fast.count.whole);
    hs_report_put("torn", d->bus.fast.count.torn);
    hs_report_put("stray", d->bus.fast.count.stray);
    hs_report_close();
}

/* 0 when that is not known: of a pipe. */
static uint64_t bytes_of(FILE *in)
{
    struct stat status;
    return fstat(fileno(in), &status) == 0 && S_ISREG(status.st_mode) ? (uint64_t)status.st_size
                                                                      : 0;
}

/* Where a file stands is a system call: not at every frame. */
static void show_place(struct hs_progress *progress, FILE *in, uint32_t frames)
{
    const long place = frames % 1024 == 0 ? ftell(in) : -1;
    if (place >= 0) {
        hs_progress_update(progress, (uint64_t)place);
    }
}

int bus_decode(FILE *out, FILE *in, const char *path, const struct lm_bus_profile *profile)
{
    struct decoder d = {.out = out, .path = path};
    struct drv_can_log log;
    lm_bus_init(&d.bus, profile);
    drv_can_log_init(&log, in, report_line, &d);
    drv_can_log_set_now(&log, UINT64_MAX);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame frame;
    int status;
    struct hs_progress progress;
    hs_progress_begin_beside(&progress, out, "decoding", bytes_of(in));
    while ((status = port.receive(port.ctx, &frame)) == 1) {
        print_frame(&d, &frame);
        show_place(&progress, in, d.bus.count.frames);
    }
    hs_progress_end(&progress);
    if (status < 0) {
        return hs_error(path, NULL, "cannot be read: %s", strerror(errno));
    }
    print_summary(&d, &log);
    report(&d, &log);
    return 0;
}
