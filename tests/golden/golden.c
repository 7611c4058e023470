/* Print "name radar glass" for every golden picture, the checksums of golden_flight.h, and
 * "image-name checksum" for every country. Usage: golden [--png FOLDER [NAME...]]: write the
 * pictures, or only those named, as PNG files too. */
#include "golden_flight.h"
#include "golden_scene.h"

#include "fx/crc32c.h"
#include "hs/error.h"
#include "hs/png.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static bool is_wanted(const char *name, int count, char **names)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(name, names[i]) == 0) {
            return true;
        }
    }
    return count == 0;
}

static int write_png(const struct golden_rig *rig, const char *folder)
{
    char path[1024];
    const struct lm_display *d = &rig->board.display;
    snprintf(path, sizeof path, "%s/%s.png", folder, rig->picture->name);
    return hs_png_write_xrgb(path, rig->glass, d->width_px, d->height_px, d->width_px);
}

static int fly_over(enum golden_place place, struct golden_rig *rig, const char *folder, int count,
                    char **names)
{
    struct tiny_image image;
    if (golden_image(place, &image) != 0) {
        return hs_error(golden_place_name(place), NULL, "the image cannot be made");
    }
    printf("image-%s %08x\n", golden_place_name(place), fx_crc32c(0, image.bytes, image.size));
    const struct golden_country country = {
        .centre = golden_centre(place), .image = image.bytes, .image_bytes = image.size};
    int status = 0;
    for (uint32_t i = 0; status == 0 && i < golden_picture_count; i++) {
        const struct golden_picture *p = &golden_pictures[i];
        if (p->place != place) {
            continue;
        }
        if (golden_fly(rig, p, &country) != LM_OK) {
            status = hs_error(p->name, NULL, "the unit does not start");
        } else {
            printf("%s %08x %08x\n", p->name, golden_radar_checksum(rig),
                   golden_glass_checksum(rig));
            if (folder && is_wanted(p->name, count, names)) {
                status = write_png(rig, folder);
            }
        }
    }
    tiny_image_free(&image);
    return status;
}

int main(int argc, char **argv)
{
    hs_set_program("golden");
    const char *folder = argc > 2 && strcmp(argv[1], "--png") == 0 ? argv[2] : NULL;
    if (argc > 1 && !folder) {
        hs_error("command line", NULL, "expected nothing, or --png FOLDER [NAME...]");
        return HS_EXIT_USAGE;
    }
    if (folder) {
        mkdir(folder, 0777);
    }
    struct golden_rig *rig = malloc(sizeof *rig);
    if (!rig) {
        hs_error("start", NULL, "out of memory");
        return HS_EXIT_FAILED;
    }
    int status = 0;
    for (int place = 0; status == 0 && place < GOLDEN_PLACES; place++) {
        status = fly_over((enum golden_place)place, rig, folder, argc > 3 ? argc - 3 : 0, argv + 3);
    }
    free(rig);
    return status == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
