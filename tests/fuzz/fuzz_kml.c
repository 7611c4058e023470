/* A track as KML or KMZ: whatever the file holds, fixes come out in order and within the Earth, or
 * none. */
#include "track.h"

const uint32_t fuzz_mutations = 8000;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_track(data, size, NAV_FORMAT_KML);
}
