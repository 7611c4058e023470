/* A chip as a table of numbers. */
#include "fuzz.h"
#include "netem/chip.h"

const uint32_t fuzz_mutations = 40000;

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct nm_chip chip = {.name = "chip"};
    char *text = malloc(size + 1);
    FUZZ_ASSERT(text);
    memcpy(text, data, size);
    text[size] = '\0';
    if (nm_chip_parse_csv(&chip, "chip", text, size) == 0) {
        FUZZ_ASSERT(chip.picture.width >= 1 && chip.picture.height >= 1);
        for (int i = 0; i < chip.picture.width * chip.picture.height; i++) {
            FUZZ_ASSERT(chip.picture.pixels[i] >= 0 && chip.picture.pixels[i] <= 1e9);
        }
        nm_picture_close(&chip.picture);
    }
    free(text);
    return 0;
}
