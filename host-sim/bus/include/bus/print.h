/* Printers of a bus profile: the same profile in the forms that other tools read. */
#ifndef BUS_PRINT_H
#define BUS_PRINT_H

#include "lm/bus_profile.h"

#include <stdio.h>

/* The kernel's filters, in the form that candump takes behind an interface's name, one a line. */
void bus_print_filters(FILE *out, const struct lm_bus_profile *profile);

/* The profile as a table of Markdown, as docs/bus.md has it. */
void bus_print_table(FILE *out, const struct lm_bus_profile *profile);

/* The profile as a .dbc file. A type that an identifier of CANaerospace may have is a value of the
 * multiplexor data_type. Of redundancy channels and wild-cards of an identifier only one is there.
 */
void bus_print_dbc(FILE *out, const struct lm_bus_profile *profile);

/* The profile as a C source that defines lm_bus_generic (print_c.c). */
void bus_print_c(FILE *out, const struct lm_bus_profile *profile);

/* What the display tells unasked (lm/canas_report.h), as a table of Markdown. */
void bus_print_reports(FILE *out);

/* What the operator does, told and obeyed (lm/canas_control.h), as a table of Markdown. */
void bus_print_controls(FILE *out);

/* The names that a text table may say for a field, and their units. */
void bus_print_fields(FILE *out);

#endif
