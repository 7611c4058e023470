/* The texts that are made from a table of options. */
#ifndef HS_OPTIONS_HELP_H
#define HS_OPTIONS_HELP_H

#include "hs/options.h"

/* A word without dashes, told by its place. */
static inline bool hs_is_argument(const struct hs_option *o)
{
    return o->kind == HS_INPUT_ARGUMENT || o->kind == HS_OUTPUT_ARGUMENT;
}

/* A row that is no option and no argument. */
static inline bool hs_is_remark(const struct hs_option *o)
{
    return o->kind == HS_HEADING || o->kind == HS_NEEDS || o->kind == HS_CLASHES;
}

/* What a row of HS_NEEDS or HS_CLASHES asks: "needs --map". */
void hs_options_row_text(const struct hs_option *row, char *text, size_t size);

/* The option that every command has besides its own: the file of its report (hs/report.h). */
struct hs_option hs_json_option(const char **path);

/* Print what `word` asks for. "--help" or "-h": the text for a reader; "--help=man": a manual page;
 * "--help=list": a line an option, which the shell's completion reads; "--version": the program's.
 * Returns false when it asks for none of these. */
bool hs_options_explain(const struct hs_usage *usage, const struct hs_option *options, size_t count,
                        const char *word);

#endif
