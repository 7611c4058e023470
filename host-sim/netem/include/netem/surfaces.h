/* What the materials of a model are made of, for networks that are told so (NM_AS_SURFACE). */
#ifndef NETEM_SURFACES_H
#define NETEM_SURFACES_H

#include "netem/paths.h"
#include "tracer/setup.h"

/* The materials of these names, as the table of the set-up's --materials and the built-in one have
 * them; `names` as in trace_records. Returns 0, or -1 with the error reported. */
int nm_surfaces_of(const struct setup *setup, const char names[][TRACE_NAME_SIZE], uint32_t count,
                   struct nm_materials *materials);

/* Makes `known`, of a training, know a model's materials: a name that it lacks comes to it, and
 * with `is_given` a name that it has gets the model's surface. Each surface must lie between those
 * of the training in all four numbers, because beyond them nothing was learned. Returns 0, or -1
 * with the error reported. */
int nm_surfaces_meet(struct nm_materials *known, const struct nm_materials *model, bool is_given);

/* Both: `known` meets the model's materials of these names, as given where --materials is. */
int nm_surfaces_introduce(struct nm_materials *known, const struct setup *setup,
                          const char names[][TRACE_NAME_SIZE], uint32_t count);

/* Whether --materials means anything to networks of the architecture. Returns 0, or -1 with the
 * error reported: they are told of names alone. */
int nm_surfaces_allow(const struct setup *setup, const struct nm_architecture *architecture);

/* The same option for programs that simulate with a training. */
struct hs_option nm_surfaces_option(struct setup *setup);

#endif
