/* A trained network: what is accepted is finite, and its parts fit together. */
#include "classify/net_file.h"
#include "fuzz.h"

#include <math.h>

const uint32_t fuzz_mutations = 15000;

static void check_net(const struct db_net *net)
{
    FUZZ_ASSERT(net->band_count >= 1 && net->band_count <= 1024);
    FUZZ_ASSERT(net->context >= 1 && net->context <= 31 && net->context % 2 == 1);
    FUZZ_ASSERT(net->output_count >= 2 && net->output_count <= DB_CLASS_MAX);
    FUZZ_ASSERT(net->member_count >= 1 && net->member_count <= DB_MEMBERS_MAX);
    for (int i = 0; i < net->input_count; i++) {
        FUZZ_ASSERT(isfinite(net->mean[i]) && isfinite(net->scale[i]) && net->scale[i] > 0);
    }
    for (int i = 0; i < net->member_count; i++) {
        FUZZ_ASSERT(net->members[i].input_count == net->input_count);
        FUZZ_ASSERT(net->members[i].output_count == net->output_count);
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
        db_net_free(net);
    }
    fuzz_file_close(&file);
    free(net);
    return 0;
}
