/* Report of a run as JSON, for other programs, beside the text for people. Every command has it:
 * hs/options.h reads --json and starts it, hs/menu.h or main ends it. docs/json.md describes it.
 *
 * A command that prints a figure puts it here as well. There is one report for the process, as
 * there is one standard output; without --json every call does nothing. Calls come from one thread.
 *
 * Keys are lower case with the unit at the end, cell_m, and differ within an object. Numbers are
 * not rounded for the eye. A figure that is not known is null, or its key is left out. */
#ifndef HS_REPORT_H
#define HS_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Open an object or an array under `key`, or as the next item of an array (key NULL), and close the
 * innermost. At the end of the run what is open is closed. */
void hs_report_object(const char *key);
void hs_report_array(const char *key);
void hs_report_close(void);

/* hs_report_put(key, value): a figure or a text, by its type. NULL as a text, and a number that is
 * not finite, are null. What is true or false is put by hs_report_flag, because a comparison is an
 * int; its key has `is`: is_complete. */
void hs_report_text(const char *key, const char *value);
void hs_report_text_within(const char *key, const char *value,
                           size_t room); /* at most `room` bytes,
                                            without a 0 perhaps */
void hs_report_real(const char *key, double value);
void hs_report_integer(const char *key, int64_t value);
void hs_report_count(const char *key, uint64_t value);
void hs_report_flag(const char *key, bool value);

#define hs_report_put(key, value)                                                                  \
    _Generic((value), char *                                                                       \
             : hs_report_text, const char *                                                        \
             : hs_report_text, float                                                               \
             : hs_report_real, double                                                              \
             : hs_report_real, unsigned long                                                       \
             : hs_report_count, unsigned long long                                                 \
             : hs_report_count, default                                                            \
             : hs_report_integer)(key, value)

/* Will there be one? For figures that cost work. */
bool hs_report_is_wanted(void);

/* Start the report of `command` ("" in a program without commands), which will be called `path`.
 * Both texts are kept. "-" is standard output, and what is printed there from now on goes to
 * standard error. Returns 0, or -1 with the error reported: no memory, or no standard output.
 *
 * hs_report_claim makes sure, once in a run, that it can be written, when all other outputs are
 * claimed: as hs_output_claim. On failure there will be no report.
 *
 * hs_options_read calls both. */
int hs_report_begin(const char *command, const char *path);
int hs_report_claim(void);

/* End a run with `exit_code`: put the outputs in place that wait for it (hs_outputs_together), and
 * write the report. Returns the code to end with: the same, or
 * HS_EXIT_FAILED with the error reported when either cannot be written. hs_menu_main calls it,
 * and main where there are no commands. */
int hs_report_end(int exit_code);

/* What hs/error.h and hs/atomic_file.h add by themselves: a message, of the severity "error" or
 * "warning", and a file that is in its place. */
void hs_report_message(const char *severity, const char *place, const char *cause,
                       const char *remedy);
void hs_report_file(const char *path);

#endif
