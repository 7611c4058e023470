/* A raw MSTAR chip: what is accepted is a picture of amplitudes at a known or unknown angle. */
#include "fuzz.h"
#include "netem/chip.h"

#include <math.h>

const uint32_t fuzz_mutations = 40000;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct nm_chip chip = {.name = "chip"};
    if (nm_chip_parse_mstar(&chip, "chip", data, size) == 0) {
        FUZZ_ASSERT(chip.picture.width >= 1 && chip.picture.height >= 1);
        for (int i = 0; i < chip.picture.width * chip.picture.height; i++) {
            FUZZ_ASSERT(chip.picture.pixels[i] >= 0 && chip.picture.pixels[i] <= 1e9);
        }
        FUZZ_ASSERT(isnan(chip.azimuth_deg) || (chip.azimuth_deg >= 0 && chip.azimuth_deg <= 360));
        FUZZ_ASSERT(isnan(chip.depression_deg) || chip.depression_deg > 0);
        nm_picture_close(&chip.picture);
    }
    return 0;
}
