#include "options_help.h"

#include "hs/error.h"
#include "lm/version.h"
#include "manual.h"

#include <stdio.h>
#include <string.h>

struct table {
    const struct hs_usage *usage;
    const struct hs_option *options;
    size_t count;
};

static const char help_help[] =
    "Print this text; `man`: as a manual page; `list`: a line an option.";
static const char version_help[] = "Print the version.";

enum { WIDTH = 79 };

struct hs_option hs_json_option(const char **path)
{
    return (struct hs_option){
        "json",
        HS_OUTPUT,
        path,
        0,
        0,
        "FILE",
        "Write the report as JSON too; `-`: to standard output, the text to standard error.",
        false};
}

/* The words of one line, wrapped at WIDTH. Returns the column behind them. */
static int print_words(const char *text, size_t length, int indent, int column)
{
    for (size_t i = 0; i < length;) {
        const size_t blanks = strspn(text + i, " ");
        const size_t word = strcspn(text + i + blanks, " \n");
        const bool wraps = column + (int)(1 + word) > WIDTH && column > indent;
        if (wraps) {
            printf("\n");
        }
        if (wraps || column == 0) {
            printf("%*s", indent, "");
            column = indent;
        } else if (word > 0) {
            printf(" ");
            column++;
        }
        printf("%.*s", (int)word, text + i + blanks);
        column += (int)word;
        i += blanks + word;
    }
    return column;
}

/* Paragraphs filled anew. An empty line, or one that begins with a blank, ends a paragraph. */
static void print_paragraphs(const char *text, int indent)
{
    int column = 0;
    while (*text) {
        const size_t length = strcspn(text, "\n");
        if (length > 0 && *text != ' ') {
            column = print_words(text, length, indent, column);
        } else {
            printf("%s%*s%.*s\n", column > 0 ? "\n" : "", length > 0 ? indent : 0, "", (int)length,
                   text);
            column = 0;
        }
        text += length + (text[length] == '\n');
    }
    printf("%s", column > 0 ? "\n" : "");
}

static bool is_in_synopsis(const struct hs_option *o)
{
    return hs_is_argument(o) || (o->is_required && !hs_is_remark(o));
}

/* "landmass-db segment --classes FILE IMAGE [options]", each word framed by what the form wants. */
static void print_synopsis(const struct table *t, void (*print)(const char *))
{
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < t->count; i++) {
            const struct hs_option *o = &t->options[i];
            if (!is_in_synopsis(o) || hs_is_argument(o) != (pass == 1)) {
                continue;
            }
            print(o->is_required ? " " : " [");
            if (hs_is_argument(o)) {
                print(o->name);
            } else {
                print("--");
                print(o->name);
                print(" ");
                print(o->value_name);
            }
            print(o->is_required ? "" : "]");
        }
    }
    print(" [options]");
}

static void print_plain(const char *text)
{
    fputs(text, stdout);
}

/* What the rows that follow say of an option: "Needs --map." */
static void print_rows(const struct table *t, const struct hs_option *o, const char *indent)
{
    for (size_t i = 0; i < t->count; i++) {
        const struct hs_option *row = &t->options[i];
        if ((row->kind == HS_NEEDS || row->kind == HS_CLASHES) && strcmp(row->name, o->name) == 0) {
            char text[256];
            hs_options_row_text(row, text, sizeof text);
            printf("%s%c%s.\n", indent, text[0] - 'a' + 'A', text + 1);
        }
    }
}

/* "Range 1 to 89; default 25." in one line, or nothing. */
static void print_range(const struct hs_option *o, const char *indent)
{
    if (o->kind == HS_REAL && !(*(double *)o->target >= o->low)) {
        printf("%sRange %g to %g.\n", indent, o->low, o->high);
    } else if (o->kind == HS_REAL) {
        printf("%sRange %g to %g; default %g.\n", indent, o->low, o->high, *(double *)o->target);
    } else if (o->kind == HS_INTEGER && (double)*(long *)o->target < o->low) {
        printf("%sRange %.0f to %.0f.\n", indent, o->low, o->high);
    } else if (o->kind == HS_INTEGER) {
        printf("%sRange %.0f to %.0f; default %ld.\n", indent, o->low, o->high, *(long *)o->target);
    } else if (o->kind == HS_CHOICE && o->value_name && *(int *)o->target >= 0) {
        const char *word = o->value_name;
        for (int i = *(int *)o->target; i > 0; i--) {
            word += strcspn(word, "|") + 1;
        }
        printf("%sDefault %.*s.\n", indent, (int)strcspn(word, "|"), word);
    } else if (o->kind == HS_WORD && *(const char **)o->target) {
        printf("%sDefault %s.\n", indent, *(const char **)o->target);
    }
}

static void print_option(const struct table *t, const struct hs_option *o)
{
    if (o->kind == HS_NEEDS || o->kind == HS_CLASHES) {
        return;
    }
    if (o->kind == HS_HEADING) {
        printf("\n%s%s", o->name ? o->name : "", o->name ? ":\n" : "");
        print_paragraphs(o->help, 0);
        return;
    }
    const bool has_value = !hs_is_argument(o) && o->value_name;
    printf("  %s%s%s%s%s\n", hs_is_argument(o) ? "" : "--", o->name, has_value ? " " : "",
           has_value ? o->value_name : "", o->is_required ? "  (required)" : "");
    print_paragraphs(o->help, 6);
    print_range(o, "      ");
    print_rows(t, o, "      ");
}

static void print_help(const struct table *t)
{
    const char *blank = *t->usage->command ? " " : "";
    printf("%s%s%s: %s\n\nUsage: %s%s%s", hs_program(), blank, t->usage->command, t->usage->summary,
           hs_program(), blank, t->usage->command);
    print_synopsis(t, print_plain);
    printf("\n\n");
    print_paragraphs(t->usage->description, 0);
    printf("\nOptions:\n");
    for (size_t i = 0; i < t->count; i++) {
        print_option(t, &t->options[i]);
    }
    printf("%s", t->count > 0 && t->options[t->count - 1].kind == HS_HEADING ? "\n" : "");
    const struct hs_option json = hs_json_option(NULL);
    print_option(t, &json);
    printf("  -h, --help[=man|list]\n      %s\n  --version\n      %s\n", help_help, version_help);
}

static void print_manual_option(const struct table *t, const struct hs_option *o)
{
    if (o->kind == HS_NEEDS || o->kind == HS_CLASHES) {
        return;
    }
    if (o->kind == HS_HEADING) {
        printf(".SS ");
        manual_text(o->name ? o->name : "Remarks");
        printf("\n");
        manual_paragraphs(o->help);
        return;
    }
    printf(".TP\n\\fB%s", hs_is_argument(o) ? "" : "\\-\\-");
    manual_text(o->name);
    printf("\\fR");
    if (!hs_is_argument(o) && o->value_name) {
        printf(" \\fI");
        manual_text(o->value_name);
        printf("\\fR");
    }
    printf("\n");
    manual_filled(o->help);
    print_range(o, "");
    print_rows(t, o, "");
}

static void print_manual(const struct table *t)
{
    manual_begin(t->usage->command, t->usage->summary);
    printf(".SH SYNOPSIS\n\\fB");
    manual_text(hs_program());
    manual_text(*t->usage->command ? " " : "");
    manual_text(t->usage->command);
    printf("\\fR");
    print_synopsis(t, manual_text);
    printf("\n.SH DESCRIPTION\n");
    manual_paragraphs(t->usage->description);
    printf(".SH OPTIONS\n");
    for (size_t i = 0; i < t->count; i++) {
        print_manual_option(t, &t->options[i]);
    }
    const struct hs_option json = hs_json_option(NULL);
    print_manual_option(t, &json);
    printf(".TP\n\\fB\\-h\\fR, \\fB\\-\\-help\\fR[=\\fIman|list\\fR]\n");
    manual_filled(help_help);
    printf(".TP\n\\fB\\-\\-version\\fR\n");
    manual_filled(version_help);
    manual_exit_status();
}

/* Of words between bars those in small letters, which are not place holders; "" for none. Borrowed
 * until the next call. */
static const char *small_words(const char *value)
{
    static char words[256];
    words[0] = '\0';
    for (const char *word = value; word && *word;) {
        const size_t length = strcspn(word, "|"), used = strlen(words);
        if (strspn(word, "abcdefghijklmnopqrstuvwxyz0123456789-") == length) {
            snprintf(words + used, sizeof words - used, "%s%.*s", used > 0 ? "|" : "", (int)length,
                     word);
        }
        word += length + (word[length] == '|');
    }
    return words;
}

/* What the shell may complete a value from. */
static const char *source_of(const struct hs_option *o)
{
    switch (o->kind) {
    case HS_INPUT:
    case HS_INPUTS:
    case HS_INPUT_ARGUMENT:
    case HS_OUTPUT:
    case HS_OUTPUT_ARGUMENT:
        return "file";
    case HS_FOLDER:
        return "folder";
    case HS_FLAG:
        return "";
    default:
        return small_words(o->value_name);
    }
}

static void print_list_line(const struct hs_option *o)
{
    printf("--%s\t%s\t%s\n", o->name, o->value_name ? o->value_name : "", source_of(o));
}

/* A line an option: its name, its value and what that may be completed from (file, folder, or words
 * between bars), with tabs between. An argument has no name, and a flag no value. */
static void print_list(const struct table *t)
{
    for (size_t i = 0; i < t->count; i++) {
        const struct hs_option *o = &t->options[i];
        if (hs_is_argument(o)) {
            printf("\t%s\t%s\n", o->name, source_of(o));
        } else if (!hs_is_remark(o)) {
            print_list_line(o);
        }
    }
    const struct hs_option json = hs_json_option(NULL);
    print_list_line(&json);
    printf("--help\t\t\n--version\t\t\n");
}

bool hs_options_explain(const struct hs_usage *usage, const struct hs_option *options, size_t count,
                        const char *word)
{
    const struct table t = {usage, options, count};
    if (strcmp(word, "--help") == 0 || strcmp(word, "-h") == 0) {
        print_help(&t);
    } else if (strcmp(word, "--help=man") == 0) {
        print_manual(&t);
    } else if (strcmp(word, "--help=list") == 0) {
        print_list(&t);
    } else if (strcmp(word, "--version") == 0) {
        printf("%s %s\n", hs_program(), LM_VERSION);
    } else {
        return false;
    }
    return true;
}
