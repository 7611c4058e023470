/* Surface materials: a table built in, and one in a file. */
#ifndef TRACER_MATERIALS_H
#define TRACER_MATERIALS_H

#include "tracer/records.h"
#include "tracer/reflect.h"

/* Fill law->materials for the materials of traced records: from the file when `path` is not NULL,
 * else and for what it lacks from the built-in table.
 *
 * The file is text, a surface a line, '#' begins a remark:
 *     NAME PERMITTIVITY LOSS RMS_HEIGHT_M CORRELATION_M F_S F_R F_D F_B
 * Returns 0, or -1 reported: the file is at fault, or a name is in neither table. */
int materials_for(const struct trace_records *r, const char *path, struct reflect_law *law);

/* Print the built-in table in the form of such a file. */
void materials_print(void);

#endif
