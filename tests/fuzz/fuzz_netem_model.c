/* The file of a training of reflection networks. */
#include "fuzz.h"
#include "netem/model_file.h"

#include <math.h>

const uint32_t fuzz_mutations = 300;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct nm_training *t = calloc(1, sizeof *t);
    FUZZ_ASSERT(t);
    fuzz_file_open(&file, data, size);
    if (nm_model_read(t, file.path, 8) == 0) {
        FUZZ_ASSERT(t->epoch_count >= 0 && t->epoch_count <= NM_EPOCHS_MAX);
        for (size_t i = 0; i < t->model.size; i++) {
            FUZZ_ASSERT(isfinite(t->model.values[i]));
        }
        nm_training_close(t);
    }
    fuzz_file_close(&file);
    free(t);
    return 0;
}
