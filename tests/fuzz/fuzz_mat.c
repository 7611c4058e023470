/* A phase history in a MATLAB file: what is accepted has finite values and a flight that a picture
 * can be made of. */
#include "fuzz.h"
#include "realradar/phase_history.h"

#include <complex.h>
#include <math.h>

const uint32_t fuzz_mutations = 15000;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct rr_phase_history history;
    fuzz_file_open(&file, data, size);
    if (rr_phase_history_read(&history, file.path) == 0) {
        const struct rr_resolution r = rr_resolution_of(&history);
        const size_t count = (size_t)history.pulses * (size_t)history.frequencies;
        FUZZ_ASSERT(history.pulses > 0 && history.frequencies > 0);
        FUZZ_ASSERT(isfinite(r.range_m) && r.range_m > 0 && isfinite(r.cross_m) && r.cross_m > 0);
        for (size_t i = 0; i < count; i++) {
            FUZZ_ASSERT(isfinite(cabs(history.echo[i])));
        }
        rr_phase_history_free(&history);
    }
    fuzz_file_close(&file);
    return 0;
}
