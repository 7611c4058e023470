/* ppm_checksum: the golden checksum of a screen dump: "WIDTHxHEIGHT CRC-32C" of its pixels as the
 * firmware draws them, 0x00RRGGBB. Usage: ppm_checksum FILE.ppm */
#include "fx/crc32c.h"
#include "hs/error.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    unsigned width, height;
    hs_set_program("ppm_checksum");
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (!file || fscanf(file, "P6 %u %u 255", &width, &height) != 2 || getc(file) == EOF) {
        hs_error(argc > 1 ? argv[1] : "command line", NULL, "expected a PPM file of 8 bits");
        return HS_EXIT_USAGE;
    }
    uint32_t checksum = 0;
    uint8_t rgb[3];
    for (uint64_t i = 0; i < (uint64_t)width * height; i++) {
        if (fread(rgb, 1, 3, file) != 3) {
            hs_error(argv[1], NULL, "the file is too short");
            return HS_EXIT_FAILED;
        }
        const uint8_t pixel[4] = {rgb[2], rgb[1], rgb[0], 0};
        checksum = fx_crc32c(checksum, pixel, sizeof pixel);
    }
    printf("%ux%u %08x\n", width, height, checksum);
    fclose(file);
    return HS_EXIT_OK;
}
