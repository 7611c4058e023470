#include "hs/options.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/output_path.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void print_lines(const char *text, int indent)
{
    while (*text) {
        const size_t length = strcspn(text, "\n");
        printf("%*s%.*s\n", indent, "", (int)length, text);
        text += length + (text[length] == '\n');
    }
}

static void print_help(const struct db_usage *usage, const struct db_option *options, size_t count)
{
    printf("%s %s: %s\n\nUsage: %s %s", hs_program(), usage->command, usage->summary, hs_program(),
           usage->command);
    for (size_t i = 0; i < count; i++) {
        if (options[i].is_required) {
            printf(" --%s %s", options[i].name, options[i].value_name);
        }
    }
    printf(" [options]\n\n");
    print_lines(usage->description, 0);
    printf("\nOptions:\n");
    for (size_t i = 0; i < count; i++) {
        const struct db_option *o = &options[i];
        printf("  --%s%s%s%s\n", o->name, o->value_name ? " " : "",
               o->value_name ? o->value_name : "", o->is_required ? "  (required)" : "");
        print_lines(o->help, 6);
        if (o->kind == DB_REAL && isnan(*(double *)o->target)) {
            printf("      Range %g to %g.\n", o->low, o->high);
        } else if (o->kind == DB_REAL) {
            printf("      Range %g to %g; default %g.\n", o->low, o->high, *(double *)o->target);
        } else if (o->kind == DB_INTEGER) {
            printf("      Range %.0f to %.0f; default %ld.\n", o->low, o->high, *(long *)o->target);
        }
    }
    printf("  --help\n      Print this text.\n");
}

static int usage_error(const struct db_usage *usage, const char *option, const char *cause)
{
    char place[128], remedy[128];
    snprintf(place, sizeof place, "%s %s", usage->command, option);
    snprintf(remedy, sizeof remedy, "see %s %s --help", hs_program(), usage->command);
    return hs_error(place, remedy, "%s", cause);
}

static int add_items(struct db_list *list, const char *text)
{
    while (*text) {
        const size_t length = strcspn(text, ",");
        if (length > 0) {
            if (list->count == DB_LIST_MAX) {
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

static bool parse_number(const char *text, double *number)
{
    char *end;
    errno = 0;
    *number = strtod(text, &end);
    return errno == 0 && end != text && *end == '\0';
}

/* Also false when the number is a NaN. */
static bool is_within(double number, const struct db_option *o)
{
    return number >= o->low && number <= o->high;
}

static const char *store(const struct db_option *o, const char *text)
{
    double number = 0;
    switch (o->kind) {
    case DB_FLAG:
        *(bool *)o->target = true;
        return NULL;
    case DB_TEXT:
    case DB_INPUT:
    case DB_OUTPUT:
    case DB_FOLDER:
        *(const char **)o->target = text;
        return NULL;
    case DB_LIST:
    case DB_INPUTS:
        return add_items(o->target, text) == 0 ? NULL : "too many values";
    case DB_REAL:
        if (!parse_number(text, &number) || !is_within(number, o)) {
            return "needs a number within its range";
        }
        *(double *)o->target = number;
        return NULL;
    case DB_INTEGER:
        if (!parse_number(text, &number) || !is_within(number, o) ||
            number != (double)(long)number) {
            return "needs a whole number within its range";
        }
        *(long *)o->target = (long)number;
        return NULL;
    }
    return "is not understood";
}

static const struct db_option *find(const struct db_option *options, size_t count, const char *name,
                                    size_t length)
{
    for (size_t i = 0; i < count; i++) {
        if (strlen(options[i].name) == length && strncmp(options[i].name, name, length) == 0) {
            return &options[i];
        }
    }
    return NULL;
}

/* Read the option at argv[*i] and its value, if any, and step over both. */
static int read_one(const struct db_usage *usage, const struct db_option *options, size_t count,
                    int argc, char **argv, int *i)
{
    const char *argument = argv[*i];
    if (strncmp(argument, "--", 2) != 0 || argument[2] == '\0') {
        return usage_error(usage, argument, "is not an option");
    }
    const char *name = argument + 2;
    const size_t length = strcspn(name, "=");
    const struct db_option *o = find(options, count, name, length);
    if (!o) {
        return usage_error(usage, argument, "is not an option of this command");
    }
    const char *value = name[length] == '=' ? name + length + 1 : NULL;
    if (o->kind == DB_FLAG && value) {
        return usage_error(usage, argument, "takes no value");
    }
    if (o->kind != DB_FLAG && !value) {
        if (*i + 1 >= argc) {
            return usage_error(usage, argument, "needs a value");
        }
        value = argv[++*i];
    }
    const char *wrong = store(o, value);
    return wrong ? usage_error(usage, argument, wrong) : 0;
}

static bool is_given(const struct db_option *o)
{
    return o->kind == DB_LIST || o->kind == DB_INPUTS
               ? ((const struct db_list *)o->target)->count > 0
               : *(const char **)o->target != NULL;
}

static void note_inputs(const struct db_option *o)
{
    if (o->kind == DB_INPUT && is_given(o)) {
        hs_input_note(*(const char **)o->target);
    }
    const struct db_list *list = o->kind == DB_INPUTS ? o->target : NULL;
    for (int i = 0; list && i < list->count; i++) {
        hs_input_note(list->items[i]);
    }
}

/* All inputs first: an option's place in the table must not matter. */
static int claim_outputs(const struct db_option *options, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        note_inputs(&options[i]);
    }
    for (size_t i = 0; i < count; i++) {
        const struct db_option *o = &options[i];
        if ((o->kind == DB_OUTPUT && is_given(o) &&
             hs_output_claim(*(const char **)o->target) != 0) ||
            (o->kind == DB_FOLDER && is_given(o) &&
             hs_output_folder_check(*(const char **)o->target) != 0)) {
            return -1;
        }
    }
    return 0;
}

bool db_options_read(const struct db_usage *usage, const struct db_option *options, size_t count,
                     int argc, char **argv, int *exit_code)
{
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--help") == 0) {
            print_help(usage, options, count);
            *exit_code = HS_EXIT_OK;
            return false;
        }
    }
    *exit_code = HS_EXIT_USAGE;
    for (int i = 1; i < argc; i++) {
        if (read_one(usage, options, count, argc, argv, &i) != 0) {
            return false;
        }
    }
    for (size_t i = 0; i < count; i++) {
        if (options[i].is_required && !is_given(&options[i])) {
            char name[64];
            snprintf(name, sizeof name, "--%s", options[i].name);
            usage_error(usage, name, "is required");
            return false;
        }
    }
    *exit_code = HS_EXIT_FAILED;
    return claim_outputs(options, count) == 0;
}

void db_list_free(struct db_list *list)
{
    for (int i = 0; i < list->count; i++) {
        free(list->items[i]);
    }
    list->count = 0;
}

int db_split_word_number(const char *text, char *word, size_t word_size, double *number)
{
    const size_t length = strcspn(text, ":");
    if (text[length] != ':' || length >= word_size || !parse_number(text + length + 1, number)) {
        return -1;
    }
    memcpy(word, text, length);
    word[length] = '\0';
    return 0;
}
