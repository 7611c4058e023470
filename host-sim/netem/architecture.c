#include "netem/architecture.h"

#include <stdbool.h>
#include <string.h>

const char *const nm_connection_names[NM_CONNECTIONS] = {"coefficient", "intensity"};

/* Table III gives EP1-EP4 five layers and two outputs and varies the last unit; EP5 is not in a
 * table: Fig. 18 compares it with EP2 and EP6 as the network of one output, so it has their layers.
 */
#define FIVE(more, outputs, unit)                                                                  \
    {                                                                                              \
        NM_INPUTS + (more), 5, {16, 32, 64, 32, outputs}, unit                                     \
    }

#define SIX(inputs)                                                                                \
    {                                                                                              \
        inputs, 6, {16, 32, 64, 32, 32, 1}, NM_SIGMOID                                             \
    }

/* All of them in one connection, with so many inputs more. */
#define CONNECTED(c, more)                                                                         \
    {                                                                                              \
        {"EP1", NM_TWO_OUTPUTS, c, NM_AS_NUMBER, FIVE(more, 2, NM_LINEAR)},                        \
            {"EP2", NM_TWO_OUTPUTS, c, NM_AS_NUMBER, FIVE(more, 2, NM_SIGMOID)},                   \
            {"EP3", NM_TWO_OUTPUTS, c, NM_AS_NUMBER, FIVE(more, 2, NM_TANH)},                      \
            {"EP4", NM_TWO_OUTPUTS, c, NM_AS_NUMBER, FIVE(more, 2, NM_RELU)},                      \
            {"EP5", NM_ONE_OUTPUT, c, NM_AS_NUMBER, FIVE(more, 1, NM_SIGMOID)},                    \
            {"EP6", NM_TWO_NETWORKS, c, NM_AS_NUMBER, FIVE(more, 1, NM_SIGMOID)},                  \
            {"EP7",                                                                                \
             NM_TWO_NETWORKS,                                                                      \
             c,                                                                                    \
             NM_AS_NUMBER,                                                                         \
             {NM_INPUTS + (more), 4, {32, 64, 32, 1}, NM_SIGMOID}},                                \
            {"EP8", NM_TWO_NETWORKS, c, NM_AS_NUMBER, SIX(NM_INPUTS + (more))},                    \
            {"EP9", NM_TWO_NETWORKS, c, NM_AS_NAME, SIX(NM_ANGLE_INPUTS + NM_FEW_NAMES + (more))}, \
            {"EP10", NM_TWO_NETWORKS, c, NM_AS_SURFACE,                                            \
             SIX(NM_ANGLE_INPUTS + NM_SURFACE_INPUTS + (more))},                                   \
            {"EP11", NM_TWO_NETWORKS, c, NM_AS_NAME,                                               \
             SIX(NM_ANGLE_INPUTS + NM_MANY_NAMES + (more))},                                       \
            {"EP12", NM_TWO_NETWORKS, c, NM_AS_NAME_AND_SIDE,                                      \
             SIX(NM_ANGLE_INPUTS + NM_SIDE_INPUTS + NM_MANY_NAMES + (more))},                      \
    }

const struct nm_architecture nm_architectures[NM_CONNECTIONS][NM_ARCHITECTURES] = {
    CONNECTED(NM_BY_COEFFICIENT, 0),
    CONNECTED(NM_BY_INTENSITY, 1),
};

const struct nm_architecture *nm_architecture_find(const char *name, enum nm_connection connection)
{
    for (int i = 0; i < NM_ARCHITECTURES; i++) {
        if (strcmp(nm_architectures[connection][i].name, name) == 0) {
            return &nm_architectures[connection][i];
        }
    }
    return NULL;
}

uint32_t nm_architecture_names(const struct nm_architecture *a)
{
    const int others = NM_ANGLE_INPUTS + (a->connection == NM_BY_INTENSITY ? 1 : 0) +
                       (a->material == NM_AS_NAME_AND_SIDE ? NM_SIDE_INPUTS : 0);
    const bool is_named = a->material == NM_AS_NAME || a->material == NM_AS_NAME_AND_SIDE;
    return is_named ? (uint32_t)(a->network.inputs - others) : TRACE_MATERIALS_MAX;
}

size_t nm_architecture_size(const struct nm_architecture *a)
{
    return nm_network_size(&a->network) * (a->wiring == NM_TWO_NETWORKS ? 2 : 1);
}
