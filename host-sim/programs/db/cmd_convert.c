#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/report.h"
#include "image/reader.h"
#include "image/recode.h"
#include "image/verify.h"
#include "image/version2.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const struct hs_usage usage = {
    "convert", "make an image of version 3 from one of version 2, or store its tiles another way",
    "From version 2: keeps every cell and post, classes, targets, signatures and manifest. Fills "
    "the borders of tiles\n"
    "from their neighbours, and makes the coarser levels again, so that crests survive in them. "
    "It is printed what\n"
    "version 2 did not hold, and must be built again from the sources.\n"
    "\n"
    "From version 3, with --compress: stores the same tiles compressed or raw. The result is the "
    "image that `build` makes\n"
    "with that --compress, byte for byte. OLD must be without faults.\n"
    "\n"
    "The new image is verified. It is put in place whole or not at all; OLD stays as it is and may "
    "not be NEW."};

/* Verify an image, its faults on the standard error. 0 if it has none; -1 with the error reported.
 */
static int verify(struct image *image, const char *path, const char *remedy, uint64_t *tiles)
{
    struct image_findings findings = {stderr, 0, 10, false, NULL};
    struct image_verify_counts counts;
    const bool is_complete = image_verify(image, &findings, &counts) == 0;
    *tiles = counts.tiles;
    return is_complete && findings.count == 0
               ? 0
               : hs_error(path, remedy, "has %" PRIu64 " faults", findings.count);
}

static bool is_version3(const struct image *image)
{
    struct lm_image_header h;
    if (image->size_bytes < sizeof h) {
        return false;
    }
    memcpy(&h, image->bytes, sizeof h);
    return memcmp(h.magic, "LANDMASS", sizeof h.magic) == 0 && h.version == LM_DB_VERSION;
}

/* `how` is below 0 if it was left out. */
static int make_new(struct image *image, const char *old, int how, const char *path)
{
    uint64_t tiles;
    if (how < 0 || !is_version3(image)) {
        return image_version2_convert(image->bytes, image->size_bytes, old,
                                      how < 0 ? IMAGE_COMPRESSION_LZ4 : (enum image_compression)how,
                                      path);
    }
    return verify(image, old, "convert a sound copy of it, or build it again", &tiles) == 0
               ? image_recode(image, old, (enum image_compression)how, path)
               : -1;
}

/* The highest of the 16 heights is where version 2 ended, whatever stood there. */
static void print_missing(const struct image *image)
{
    printf(
        "to have these, build it again from its sources with `landmass-db build`:\n"
        "- structures and trees higher than %g m: the old table of heights ended there\n"
        "- heights between those of its table\n"
        "- facings of walls, gains by level, natural borders of classes\n"
        "- the spread of reflectivity as ground that is alike in every level\n"
        "- vector detail\n",
        image->db.classes.height_dm[15] / 10.0);
}

static int check_new(const char *path, bool is_of_version2)
{
    struct image image;
    uint64_t tiles;
    if (image_map(&image, path) != 0) {
        return -1;
    }
    const int result =
        verify(&image, path, "the old image has faults of its own: build it again", &tiles);
    if (result == 0) {
        hs_report_put("bytes", image.size_bytes);
        hs_report_put("tiles", tiles);
        hs_report_put("fault_count", (uint64_t)0);
        printf("%s: version 3, %" PRIu64 " bytes, %" PRIu64 " tiles, no faults\n", path,
               image.size_bytes, tiles);
    }
    if (result == 0 && is_of_version2) {
        print_missing(&image);
    }
    image_close(&image);
    return result;
}

static int convert(const char *old, int how, const char *path)
{
    struct image image;
    if (image_map(&image, old) != 0) {
        return -1;
    }
    const bool is_of_version2 = !is_version3(&image);
    const int result = make_new(&image, old, how, path);
    image_close(&image);
    return result == 0 ? check_new(path, is_of_version2) : -1;
}

int db_cmd_convert(int argc, char **argv)
{
    const char *old = NULL, *new = NULL;
    int how = -1, exit_code;
    const struct hs_option options[] = {
        {"OLD", HS_INPUT_ARGUMENT, &old, 0, 0, NULL, "the image to convert", true},
        {"NEW", HS_OUTPUT_ARGUMENT, &new, 0, 0, NULL, "the image to write", true},
        {"compress", HS_CHOICE, &how, 0, 0, IMAGE_COMPRESSION_WORDS,
         "how tiles are stored; left out: OLD is of version 2, and lz4", false},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    return convert(old, how, new) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
