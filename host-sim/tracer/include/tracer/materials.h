/* Surface materials of a model: from a table built in (surfaces.h), and one in a file. */
#ifndef TRACER_MATERIALS_H
#define TRACER_MATERIALS_H

#include "tracer/records.h"
#include "tracer/reflect.h"

/* Fill law->materials for the materials of traced records: from the file when `path` is not NULL,
 * else and for what it lacks from the built-in table, at law->wavelength_m. The material "ground"
 * is taken as the one called `ground`, unless that is NULL. A name that neither table has counts up
 * to its first point: `metal.213` of a zone (mesh_zones.h) is metal.
 *
 * The file is text, a surface a line, '#' begins a remark; the last two may be missing:
 *     NAME PERMITTIVITY LOSS RMS_HEIGHT_M CORRELATION_M F_S F_R F_D F_B SPECTRUM COAT_M
 * Returns 0, or -1 reported: the file is at fault, or a name is in neither table. A warning says
 * what is too rough for small perturbation, or beyond the frequencies that a source covers. */
int materials_for(const struct trace_records *r, const char *path, const char *ground,
                  struct reflect_law *law);

#endif
