#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/report.h"
#include "image/reader.h"
#include "image/verify.h"
#include "image/version2.h"

#include <inttypes.h>
#include <stdio.h>

static const struct hs_usage usage = {
    "convert", "make an image of version 3 from one of version 2",
    "Keeps every cell and post, classes, targets, signatures and manifest. Fills the borders of "
    "tiles "
    "from their\n"
    "neighbours, and makes the coarser levels again, so that crests survive in them. The new image "
    "is "
    "verified.\n"
    "It is put in place whole or not at all; OLD stays as it is and may not be NEW.\n"
    "\n"
    "What version 2 did not hold cannot be made of it. It is printed what must be built again from "
    "the sources\n"
    "to have it."};

static int read_bytes(const char *old, const char *path)
{
    struct image image;
    if (image_map(&image, old) != 0) {
        return -1;
    }
    const int result = image_version2_convert(image.bytes, image.size_bytes, old, path);
    image_close(&image);
    return result;
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

static int check_new(const char *path)
{
    struct image image;
    struct image_findings findings = {stderr, 0, 10, false};
    struct image_verify_counts counts;
    if (image_map(&image, path) != 0) {
        return -1;
    }
    const bool is_complete = image_verify(&image, &findings, &counts) == 0;
    if (is_complete && findings.count == 0) {
        hs_report_put("bytes", image.size_bytes);
        hs_report_put("tiles", counts.tiles);
        hs_report_put("fault_count", findings.count);
        printf("%s: version 3, %" PRIu64 " bytes, %" PRIu64 " tiles, no faults\n", path,
               image.size_bytes, counts.tiles);
        print_missing(&image);
    }
    image_close(&image);
    return is_complete && findings.count == 0
               ? 0
               : hs_error(path, "the old image has faults of its own: build it again",
                          "has %" PRIu64 " faults", findings.count);
}

int db_cmd_convert(int argc, char **argv)
{
    const char *old = NULL, *new = NULL;
    int exit_code;
    const struct hs_option options[] = {
        {"OLD", HS_INPUT_ARGUMENT, &old, 0, 0, NULL, "the image of version 2", true},
        {"NEW", HS_OUTPUT_ARGUMENT, &new, 0, 0, NULL, "the image to write", true},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    return read_bytes(old, new) == 0 && check_new(new) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
