/* golden_flash: the images of the golden countries, one behind the other (golden_flash.h).
 * Usage: golden_flash OUT */
#include "golden_flash.h"

#include "hs/atomic_file.h"
#include "hs/error.h"

#include <stdio.h>

static int write_image(FILE *stream, struct golden_flash *flash, enum golden_place place,
                       uint64_t offset)
{
    struct tiny_image image;
    if (golden_image(place, &image) != 0) {
        return hs_error(golden_place_name(place), NULL, "the image cannot be made");
    }
    snprintf(flash->places[place].name, sizeof flash->places[place].name, "%s",
             golden_place_name(place));
    flash->places[place].centre = golden_centre(place);
    flash->places[place].offset = offset;
    flash->places[place].size = image.size;
    fseek(stream, (long)offset, SEEK_SET);
    fwrite(image.bytes, 1, image.size, stream);
    tiny_image_free(&image);
    return 0;
}

int main(int argc, char **argv)
{
    struct hs_atomic_file f;
    struct golden_flash flash = {.magic = GOLDEN_FLASH_MAGIC};
    hs_set_program("golden_flash");
    if (argc != 2) {
        hs_error("command line", NULL, "expected OUT");
        return HS_EXIT_USAGE;
    }
    if (hs_atomic_open(&f, argv[1]) != 0) {
        return HS_EXIT_FAILED;
    }
    uint64_t offset = sizeof flash + 1; /* odd: the board's driver must cope */
    for (int place = 0; place < GOLDEN_PLACES; place++) {
        if (write_image(f.stream, &flash, (enum golden_place)place, offset) != 0) {
            hs_atomic_abort(&f);
            return HS_EXIT_FAILED;
        }
        offset += flash.places[place].size + 1;
    }
    fseek(f.stream, 0, SEEK_SET);
    fwrite(&flash, sizeof flash, 1, f.stream);
    return hs_atomic_commit(&f) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
