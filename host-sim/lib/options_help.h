/* The texts that are made from a table of options. */
#ifndef HS_OPTIONS_HELP_H
#define HS_OPTIONS_HELP_H

#include "hs/options.h"

/* A word without dashes, told by its place. */
static inline bool db_is_argument(const struct db_option *o)
{
    return o->kind == DB_INPUT_ARGUMENT || o->kind == DB_OUTPUT_ARGUMENT;
}

/* Print what `word` asks for. "--help" or "-h": the text for a reader; "--help=man": a manual page;
 * "--help=list": a line an option, which the shell's completion reads; "--version": the program's.
 * Returns false when it asks for none of these. */
bool db_options_explain(const struct db_usage *usage, const struct db_option *options, size_t count,
                        const char *word);

#endif
