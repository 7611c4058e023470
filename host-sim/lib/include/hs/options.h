/* Command-line options: one table for each sub-command, from which they are read, checked and
 * explained, so that --help always agrees with what is accepted. */
#ifndef HS_OPTIONS_H
#define HS_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>

enum { DB_LIST_MAX = 256 };

/* A repeated or comma separated option; `items` are owned. */
struct db_list {
    char *items[DB_LIST_MAX];
    int count;
};

enum db_option_kind {
    DB_FLAG,    /* bool */
    DB_TEXT,    /* const char *, borrowed from argv */
    DB_LIST,    /* struct db_list */
    DB_INPUT,   /* const char *: a file that is read; hs/input_file.h */
    DB_INPUTS,  /* struct db_list of such */
    DB_OUTPUT,  /* const char *: a file that is written; claimed (hs/atomic_file.h) */
    DB_FOLDER,  /* const char *: a folder that is written to, and made if need be */
    DB_REAL,    /* double within low..high; NAN before: there is no default */
    DB_INTEGER, /* long within low..high */
};

struct db_option {
    const char *name; /* without the dashes */
    enum db_option_kind kind;
    void *target; /* of the type named above; holds the default before and the value after */
    double low, high;
    const char *value_name; /* "FILE", "N" */
    const char *help;       /* may hold several lines */
    bool is_required;
};

struct db_usage {
    const char *command;     /* "segment" */
    const char *summary;     /* one line */
    const char *description; /* whole paragraphs */
};

/* Read argv[1..] into the targets of the options. Lists must be freed whatever is returned. Returns
 * true when the command shall go on. Otherwise *exit_code is:
 * - HS_EXIT_OK: --help was asked for and printed,
 * - HS_EXIT_USAGE, reported: a word that is no option or an unknown one, a value too many or too
 *   few, a number outside its range, or a required option that is missing,
 * - HS_EXIT_FAILED, reported: an output cannot be written, or is an input or another output. */
bool db_options_read(const struct db_usage *usage, const struct db_option *options, size_t count,
                     int argc, char **argv, int *exit_code);

/* Free the items. Harmless on a zeroed list. */
void db_list_free(struct db_list *list);

/* Split `text` ("polygons:0.3") at the colon: copies the word before it and reads the number after
 * it. Returns 0, or -1 when there is no colon, no number, or the word does not fit. */
int db_split_word_number(const char *text, char *word, size_t word_size, double *number);

#endif
