/* Command-line options: one table for each program or sub-command. The command line is read and
 * checked by it, and --help, the manual page and the shell's completion are made from it, so that
 * they always agree with what is accepted. */
#ifndef HS_OPTIONS_H
#define HS_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

enum { HS_LIST_MAX = 256, HS_OPTIONS_MAX = 128 };

/* A repeated or comma separated option; `items` are owned. */
struct hs_list {
    char *items[HS_LIST_MAX];
    int count;
};

/* A value with a form of its own, such as LAT,LON. `take` returns NULL, or why it refuses `text` as
 * what the option does: "needs two numbers". It is called once for each time the option is given.
 */
struct hs_taker {
    const char *(*take)(void *context, const char *text);
    void *context;
};

enum hs_option_kind {
    HS_FLAG,    /* bool */
    HS_TEXT,    /* const char *, borrowed from argv */
    HS_LIST,    /* struct hs_list */
    HS_INPUT,   /* const char *: a file that is read; hs/input_file.h */
    HS_INPUTS,  /* struct hs_list of such */
    HS_OUTPUT,  /* const char *: a file that is written; claimed (hs/atomic_file.h) */
    HS_FOLDER,  /* const char *: a folder that is written to, and made if need be */
    HS_REAL,    /* double within low..high; NAN or below low before: there is no default */
    HS_INTEGER, /* long within low..high; below low before: there is no default */
    HS_CHOICE,  /* int: which of the words in value_name, "csv|gpx|igc", counted from 0; -1 before:
                   there is no default */
    HS_WORD,    /* const char *, borrowed from argv: one of the words in value_name */
    HS_TAKER,   /* struct hs_taker */
    HS_INPUT_ARGUMENT, /* const char *: the next word that is no option, a file that is read. "-" is
                          such a word. name: its place holder, "TRACK" */
    HS_OUTPUT_ARGUMENT, /* likewise a file that is written */
    HS_HEADING, /* no option: a heading (name, or NULL for none) of what follows in the help, and
                   lines of text below it (help) */
    HS_NEEDS,   /* no option: HS_NEEDS_ROW */
    HS_CLASHES, /* no option: HS_CLASHES_ROW */
};

/* Rows of a table that say which options go together; the help says it below the option `name`.
 * `others` are names between bars, each perhaps with a word of a choice: "map|method=adjust". The
 * first asks that one of them is given, or that the choice has that word, be it by default; the
 * second that none is. An option that would be ignored without a word needs such a row. */
#define HS_NEEDS_ROW(name, others)                                                                 \
    {                                                                                              \
        name, HS_NEEDS, NULL, 0, 0, others, NULL, false                                            \
    }
#define HS_CLASHES_ROW(name, others)                                                               \
    {                                                                                              \
        name, HS_CLASHES, NULL, 0, 0, others, NULL, false                                          \
    }

struct hs_option {
    const char *name; /* without the dashes */
    enum hs_option_kind kind;
    void *target; /* of the type named above; holds the default before and the value after */
    double low, high;
    const char *value_name; /* "FILE", "N"; words in small letters between bars are offered by the
                               shell: "exemplars|equal|NAME=SHARE" */
    const char *help;       /* may hold several lines */
    bool is_required;       /* a text, a list or an argument */
};

struct hs_usage {
    const char *command;     /* "segment"; "" where the program has no sub-commands */
    const char *summary;     /* one line */
    const char *description; /* whole paragraphs */
};

/* Read argv[1..] into the targets of the options. Lists must be freed whatever is returned. Returns
 * true when the command shall go on. Otherwise *exit_code is:
 * - HS_EXIT_OK: --help, -h, --version, --help=man or --help=list was asked for and printed,
 * - HS_EXIT_USAGE, reported: a word too many or an unknown option, a value too many or too few, a
 *   number outside its range, a word that is no choice, a required option that is missing, or
 *   options that do not go together,
 * - HS_EXIT_FAILED, reported: an output cannot be written, or is an input or another output. */
bool hs_options_read(const struct hs_usage *usage, const struct hs_option *options, size_t count,
                     int argc, char **argv, int *exit_code);

/* Report what is wrong with `option` ("--bus") where each option alone makes sense and they do not
 * together. Returns HS_EXIT_USAGE. */
int hs_options_wrong(const struct hs_usage *usage, const char *option, const char *cause);

/* For a struct hs_taker: "needs whole, heading or strobe", of words between bars. Borrowed until
 * the next refusal. */
const char *hs_options_words(const char *words);

/* Free the items. Harmless on a zeroed list. */
void hs_list_free(struct hs_list *list);

/* Split `text` ("polygons:0.3") at the colon: copies the word before it and reads the number after
 * it. Returns 0, or -1 when there is no colon, no number, or the word does not fit. */
int hs_split_word_number(const char *text, char *word, size_t word_size, double *number);

#endif
