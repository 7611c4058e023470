#include "hs/options.h"
#include "hs/number.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/output_path.h"
#include "hs/report.h"
#include "options_help.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A command line on its way into the table. */
struct reader {
    const struct hs_usage *usage;
    const struct hs_option *options;
    size_t count;
    int argc;
    char **argv;
    int next;           /* word of argv */
    size_t next_option; /* where to look for the next argument that is no option */
    const char *json;   /* where the report goes, or NULL */
    struct hs_option json_option;
    bool is_given[HS_OPTIONS_MAX]; /* by the command line, which a default is not */
};

static int usage_error(const struct hs_usage *usage, const char *option, const char *cause)
{
    char place[128], remedy[128];
    const char *blank = *usage->command ? " " : "";
    snprintf(place, sizeof place, "%s%s%s", usage->command, blank, option);
    snprintf(remedy, sizeof remedy, "see %s%s%s --help", hs_program(), blank, usage->command);
    return hs_error(place, remedy, "%s", cause);
}

int hs_options_wrong(const struct hs_usage *usage, const char *option, const char *cause)
{
    usage_error(usage, option, cause);
    return HS_EXIT_USAGE;
}

static int add_items(struct hs_list *list, const char *text)
{
    while (*text) {
        const size_t length = strcspn(text, ",");
        if (length > 0) {
            if (list->count == HS_LIST_MAX) {
                return -1;
            }
            list->items[list->count] = strndup(text, length);
            if (!list->items[list->count]) {
                return -1;
            }
            list->count++;
        }
        text += length + (text[length] == ',');
    }
    return 0;
}

/* Which of the words between the bars, or -1. */
static int choice_of(const char *words, const char *text)
{
    for (int i = 0; *words; i++) {
        const size_t length = strcspn(words, "|");
        if (strlen(text) == length && strncmp(words, text, length) == 0) {
            return i;
        }
        words += length + (words[length] == '|');
    }
    return -1;
}

/* The last refusal, which names the range or the words; it is reported before the next. */
static char refusal[256];

static const char *store_number(const struct hs_option *o, const char *text)
{
    double number = 0;
    const bool is_whole = o->kind == HS_INTEGER;
    if (!hs_number_within(text, o->low, o->high, &number) ||
        (is_whole && number != (double)(long)number)) {
        snprintf(refusal, sizeof refusal, "needs a %snumber from %.12g to %.12g",
                 is_whole ? "whole " : "", o->low, o->high);
        return refusal;
    }
    if (is_whole) {
        *(long *)o->target = (long)number;
    } else {
        *(double *)o->target = number;
    }
    return NULL;
}

/* "tanh or sigmoid". An argument, in capitals, has no dashes. */
static void append_words(char *text, size_t size, const char *words, const char *dashes)
{
    while (*words) {
        const size_t length = strcspn(words, "|"), used = strlen(text);
        const char *rest = words + length + (words[length] == '|');
        const bool is_argument = *words >= 'A' && *words <= 'Z';
        snprintf(text + used, size - used, "%s%.*s%s", is_argument ? "" : dashes, (int)length,
                 words,
                 *rest == '\0'       ? ""
                 : strchr(rest, '|') ? ", "
                                     : " or ");
        words = rest;
    }
}

const char *hs_options_words(const char *words)
{
    snprintf(refusal, sizeof refusal, "needs ");
    append_words(refusal, sizeof refusal, words, "");
    return refusal;
}

/* "map|method=adjust": "needs --map or --method adjust" */
void hs_options_row_text(const struct hs_option *row, char *text, size_t size)
{
    const bool needs = row->kind == HS_NEEDS;
    snprintf(text, size, "%s ", needs ? "needs" : "cannot be given together with");
    append_words(text, size, row->value_name, "--");
    for (char *c = text; *c; c++) {
        *c = *c == '=' ? ' ' : *c;
    }
}

static const char *store_choice(const struct hs_option *o, const char *text)
{
    const int choice = choice_of(o->value_name, text);
    if (choice < 0) {
        return hs_options_words(o->value_name);
    }
    if (o->kind == HS_WORD) {
        *(const char **)o->target = text;
    } else {
        *(int *)o->target = choice;
    }
    return NULL;
}

/* NULL, or what is wrong with the value. */
static const char *store(const struct hs_option *o, const char *text)
{
    switch (o->kind) {
    case HS_FLAG:
        *(bool *)o->target = true;
        return NULL;
    case HS_TEXT:
    case HS_INPUT:
    case HS_INPUT_ARGUMENT:
    case HS_OUTPUT:
    case HS_OUTPUT_ARGUMENT:
    case HS_FOLDER:
        *(const char **)o->target = text;
        return NULL;
    case HS_LIST:
    case HS_INPUTS:
        return add_items(o->target, text) == 0 ? NULL : "too many values";
    case HS_REAL:
    case HS_INTEGER:
        return store_number(o, text);
    case HS_CHOICE:
    case HS_WORD:
        return store_choice(o, text);
    case HS_TAKER: {
        const struct hs_taker *taker = o->target;
        return taker->take(taker->context, text);
    }
    case HS_HEADING:
    case HS_NEEDS:
    case HS_CLASHES:
        break;
    }
    return "is not understood";
}

static bool is_option(const struct hs_option *o)
{
    return !hs_is_argument(o) && !hs_is_remark(o);
}

static const struct hs_option *find(const struct reader *r, const char *name, size_t length)
{
    for (size_t i = 0; i < r->count; i++) {
        const struct hs_option *o = &r->options[i];
        if (is_option(o) && strlen(o->name) == length && strncmp(o->name, name, length) == 0) {
            return o;
        }
    }
    const char *json = r->json_option.name;
    return strlen(json) == length && strncmp(json, name, length) == 0 ? &r->json_option : NULL;
}

static int store_or_report(struct reader *r, const struct hs_option *o, const char *text)
{
    const char *wrong = store(o, text);
    if (o != &r->json_option) {
        r->is_given[o - r->options] = true;
    }
    if (!wrong) {
        return 0;
    }
    char place[128];
    snprintf(place, sizeof place, "--%s %s", o->name, text);
    return usage_error(r->usage, place, wrong);
}

static int read_argument(struct reader *r, const char *word)
{
    while (r->next_option < r->count) {
        const struct hs_option *o = &r->options[r->next_option++];
        if (hs_is_argument(o)) {
            return store_or_report(r, o, word);
        }
    }
    return usage_error(r->usage, word, "is a word too many, and no option");
}

/* Read the next word and its value, if any, and step over both. */
static int read_one(struct reader *r)
{
    const char *word = r->argv[r->next++];
    if (word[0] != '-' || word[1] == '\0') {
        return read_argument(r, word);
    }
    const char *name = word + 2;
    const size_t length = strncmp(word, "--", 2) == 0 ? strcspn(name, "=") : 0;
    const struct hs_option *o = find(r, name, length);
    if (!o) {
        return usage_error(r->usage, word, "is not an option of this command");
    }
    const char *value = name[length] == '=' ? name + length + 1 : NULL;
    if (o->kind == HS_FLAG && value) {
        return usage_error(r->usage, word, "takes no value");
    }
    if (o->kind != HS_FLAG && !value) {
        if (r->next >= r->argc) {
            return usage_error(r->usage, word, "needs a value");
        }
        value = r->argv[r->next++];
    }
    return store_or_report(r, o, value);
}

static bool is_given(const struct hs_option *o)
{
    return o->kind == HS_LIST || o->kind == HS_INPUTS
               ? ((const struct hs_list *)o->target)->count > 0
               : *(const char **)o->target != NULL;
}

static void note_inputs(const struct hs_option *o)
{
    if ((o->kind == HS_INPUT || o->kind == HS_INPUT_ARGUMENT) && is_given(o)) {
        hs_input_note(*(const char **)o->target);
    }
    const struct hs_list *list = o->kind == HS_INPUTS ? o->target : NULL;
    for (int i = 0; list && i < list->count; i++) {
        hs_input_note(list->items[i]);
    }
}

/* All inputs first: an option's place in the table must not matter. */
static int claim_outputs(const struct reader *r)
{
    for (size_t i = 0; i < r->count; i++) {
        note_inputs(&r->options[i]);
    }
    for (size_t i = 0; i < r->count; i++) {
        const struct hs_option *o = &r->options[i];
        const bool is_output = o->kind == HS_OUTPUT || o->kind == HS_OUTPUT_ARGUMENT;
        if ((is_output && is_given(o) && hs_output_claim(*(const char **)o->target) != 0) ||
            (o->kind == HS_FOLDER && is_given(o) &&
             hs_output_folder_check(*(const char **)o->target) != 0)) {
            return -1;
        }
    }
    return 0;
}

/* The report's own file is claimed last: a report that says why an output was refused must not be
 * written in that output's place. */
static int begin_report(const struct reader *r)
{
    if (r->json && hs_report_begin(r->usage->command, r->json) != 0) {
        return -1;
    }
    const int claimed = claim_outputs(r);
    return hs_report_claim() == 0 ? claimed : -1;
}

static int check_required(const struct reader *r)
{
    for (size_t i = 0; i < r->count; i++) {
        const struct hs_option *o = &r->options[i];
        if (!hs_is_remark(o) && o->is_required && !is_given(o)) {
            char name[64];
            snprintf(name, sizeof name, "%s%s", is_option(o) ? "--" : "", o->name);
            return usage_error(r->usage, name, "is required");
        }
    }
    return 0;
}

static const struct hs_option *named(const struct reader *r, const char *name, size_t length)
{
    for (size_t i = 0; i < r->count; i++) {
        const struct hs_option *o = &r->options[i];
        if (!hs_is_remark(o) && strlen(o->name) == length && strncmp(o->name, name, length) == 0) {
            return o;
        }
    }
    return NULL;
}

static bool has_word(const struct hs_option *o, const char *word)
{
    const char *text = o->kind == HS_WORD ? *(const char **)o->target : NULL;
    return o->kind == HS_WORD ? text && strcmp(text, word) == 0
                              : choice_of(o->value_name, word) == *(const int *)o->target;
}

/* Whether one of `others` (HS_NEEDS_ROW) is so. */
static bool is_any(const struct reader *r, const char *others)
{
    while (*others) {
        const size_t length = strcspn(others, "|"), name = strcspn(others, "|=");
        const struct hs_option *o = named(r, others, name);
        if (!o) {
            abort(); /* a row that names no option of its table */
        }
        char word[32];
        snprintf(word, sizeof word, "%.*s", (int)(length - name), others + name);
        if (length == name ? r->is_given[o - r->options] : has_word(o, word + 1)) {
            return true;
        }
        others += length + (others[length] == '|');
    }
    return false;
}

static int check_row(const struct reader *r, const struct hs_option *row)
{
    const struct hs_option *o = named(r, row->name, strlen(row->name));
    if (!o) {
        abort(); /* likewise */
    }
    const bool is_met = is_any(r, row->value_name) == (row->kind == HS_NEEDS);
    if (is_met || !r->is_given[o - r->options]) {
        return 0;
    }
    char place[64], cause[256];
    snprintf(place, sizeof place, "%s%s", is_option(o) ? "--" : "", o->name);
    hs_options_row_text(row, cause, sizeof cause);
    return usage_error(r->usage, place, cause);
}

/* Options that would have no effect, or opposite ones. */
static int check_rows(const struct reader *r)
{
    for (size_t i = 0; i < r->count; i++) {
        const struct hs_option *row = &r->options[i];
        if ((row->kind == HS_NEEDS || row->kind == HS_CLASHES) && check_row(r, row) != 0) {
            return -1;
        }
    }
    return 0;
}

bool hs_options_read(const struct hs_usage *usage, const struct hs_option *options, size_t count,
                     int argc, char **argv, int *exit_code)
{
    for (int i = 1; i < argc; i++) {
        if (hs_options_explain(usage, options, count, argv[i])) {
            *exit_code = HS_EXIT_OK;
            return false;
        }
    }
    if (count > HS_OPTIONS_MAX) {
        abort();
    }
    struct reader r = {
        .usage = usage, .options = options, .count = count, .argc = argc, .argv = argv, .next = 1};
    r.json_option = hs_json_option(&r.json);
    *exit_code = HS_EXIT_USAGE;
    while (r.next < argc) {
        if (read_one(&r) != 0) {
            return false;
        }
    }
    if (check_required(&r) != 0 || check_rows(&r) != 0) {
        return false;
    }
    *exit_code = HS_EXIT_FAILED;
    return begin_report(&r) == 0;
}

void hs_list_free(struct hs_list *list)
{
    for (int i = 0; i < list->count; i++) {
        free(list->items[i]);
    }
    list->count = 0;
}

int hs_split_word_number(const char *text, char *word, size_t word_size, double *number)
{
    const size_t length = strcspn(text, ":");
    if (text[length] != ':' || length >= word_size || !hs_number(text + length + 1, number)) {
        return -1;
    }
    memcpy(word, text, length);
    word[length] = '\0';
    return 0;
}
