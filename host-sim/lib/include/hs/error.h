/* Error messages of all host programs: what is wrong, where, why, and what to do about it. */
#ifndef HS_ERROR_H
#define HS_ERROR_H

#include <stdbool.h>

/* Exit codes of all landmass programs. */
enum hs_exit {
    HS_EXIT_OK = 0,
    HS_EXIT_FAILED = 1, /* the work could not be done: bad input, full disk */
    HS_EXIT_USAGE = 2   /* the command line makes no sense */
};

/* Print "<program>: <place>: <cause>; <remedy>" on standard error as one line.
 * `place` is a file, option or record ("lake.tif", "exemplars.tsv line 12"); `remedy` may be NULL.
 * `cause` and its arguments are as for printf. Returns -1, so that a caller can `return
 * hs_error(...)`. */
int hs_error(const char *place, const char *remedy, const char *cause, ...)
    __attribute__((format(printf, 3, 4)));

/* The same line with "warning: " before the cause; returns 0. */
int hs_warn(const char *place, const char *remedy, const char *cause, ...)
    __attribute__((format(printf, 3, 4)));

/* Something that looks like a mistake of the user's. `is_trusted`: he said --trust-inputs, so that
 * it is a warning and 0 is returned. Otherwise it is an error, whose remedy names that option too;
 * -1.
 */
int hs_doubt(bool is_trusted, const char *place, const char *remedy, const char *cause, ...)
    __attribute__((format(printf, 4, 5)));

/* Tell errors, not warnings, to a listener as well: for a program that works for another one. NULL:
 * to nobody any more. There is one for the process. */
typedef void hs_error_listener(void *ctx, const char *place, const char *cause, const char *remedy);
void hs_error_listen(hs_error_listener *listener, void *ctx);

/* Name the program in the messages, and guard its inputs from here on (hs/input_file.h); call once
 * at the start of main. Keeps the pointer. */
void hs_set_program(const char *name);
const char *hs_program(void);

#endif
