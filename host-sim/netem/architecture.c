#include "netem/architecture.h"

#include <string.h>

/* Table III gives EP1-EP4 five layers and two outputs and varies the last unit; EP5 is not in a
 * table: Fig. 18 compares it with EP2 and EP6 as the network of one output, so it has their layers.
 */
#define FIVE(outputs, unit)                                                                        \
    {                                                                                              \
        NM_INPUTS, 5, {16, 32, 64, 32, outputs}, unit                                              \
    }

const struct nm_architecture nm_architectures[NM_ARCHITECTURES] = {
    {"EP1", NM_TWO_OUTPUTS, FIVE(2, NM_LINEAR)},
    {"EP2", NM_TWO_OUTPUTS, FIVE(2, NM_SIGMOID)},
    {"EP3", NM_TWO_OUTPUTS, FIVE(2, NM_TANH)},
    {"EP4", NM_TWO_OUTPUTS, FIVE(2, NM_RELU)},
    {"EP5", NM_ONE_OUTPUT, FIVE(1, NM_SIGMOID)},
    {"EP6", NM_TWO_NETWORKS, FIVE(1, NM_SIGMOID)},
    {"EP7", NM_TWO_NETWORKS, {NM_INPUTS, 4, {32, 64, 32, 1}, NM_SIGMOID}},
    {"EP8", NM_TWO_NETWORKS, {NM_INPUTS, 6, {16, 32, 64, 32, 32, 1}, NM_SIGMOID}},
    {"EP9", NM_TWO_NETWORKS, {NM_INPUTS_MAX, 6, {16, 32, 64, 32, 32, 1}, NM_SIGMOID}},
};

const struct nm_architecture *nm_architecture_find(const char *name)
{
    for (int i = 0; i < NM_ARCHITECTURES; i++) {
        if (strcmp(nm_architectures[i].name, name) == 0) {
            return &nm_architectures[i];
        }
    }
    return NULL;
}

size_t nm_architecture_size(const struct nm_architecture *a)
{
    return nm_network_size(&a->network) * (a->wiring == NM_TWO_NETWORKS ? 2 : 1);
}
