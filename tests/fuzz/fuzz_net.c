/* A trained network: what is accepted is finite, and its parts fit together. */
#include "classify/mlp_apply.h"
#include "classify/net_file.h"
#include "fuzz.h"

#include <math.h>

const uint32_t fuzz_mutations = 15000;

/* What is accepted can be used. */
static void apply_net(const struct db_net *net)
{
    static const float planes[1024];
    uint8_t winner;
    float margin;
    struct db_applied applied;
    if (db_apply_init(&applied, net) == 0) {
        db_apply(&applied, planes, 1, 1, &winner, &margin);
        FUZZ_ASSERT(winner < net->output_count);
        db_apply_free(&applied);
    }
}

static void check_net(const struct db_net *net)
{
    FUZZ_ASSERT(net->band_count >= 1 && net->band_count <= 1024);
    FUZZ_ASSERT(net->context >= 1 && net->context <= 31 && net->context % 2 == 1);
    FUZZ_ASSERT(net->output_count >= 2 && net->output_count <= DB_CLASS_MAX);
    FUZZ_ASSERT(net->member_count >= 1 && net->member_count <= DB_MEMBERS_MAX);
    for (int i = 0; i < net->input_count; i++) {
        FUZZ_ASSERT(isfinite(net->mean[i]) && isfinite(net->scale[i]) && net->scale[i] > 0);
        FUZZ_ASSERT(!net->has_range || net->low[i] <= net->high[i]);
    }
    for (int i = 0; i < net->member_count; i++) {
        FUZZ_ASSERT(net->members[i].input_count == net->input_count);
        FUZZ_ASSERT(net->members[i].output_count == net->output_count);
        FUZZ_ASSERT(net->members[i].layer_count >= 1 &&
                    net->members[i].layer_count <= DB_LAYERS_MAX);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct db_net *net = calloc(1, sizeof *net);
    FUZZ_ASSERT(net);
    fuzz_file_open(&file, data, size);
    if (db_net_read(net, file.path) == 0) {
        check_net(net);
        apply_net(net);
        db_net_free(net);
    }
    fuzz_file_close(&file);
    free(net);
    return 0;
}
