#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/report.h"
#include "image/codes.h"
#include "image/verify.h"
#include "lm/sensor.h"
#include "signature.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

static const struct hs_usage usage = {
    "verify", "check every byte of a database image",
    "Checks header, sections and unused bytes, every directory entry and tile record with its "
    "checksum and its place,\n"
    "elevations along the edges that tiles share, and that each coarser level holds the mean of "
    "the finer one; and the\n"
    "signature, if there is one.\n"
    "What is wrong is printed with its offset; the exit code is then 1."};

enum { SHOWN_MAX = 100 };

static void report_counts(const struct image *image, const struct image_findings *findings,
                          const struct image_verify_counts *n, bool is_complete)
{
    hs_report_put("fault_count", findings->count);
    hs_report_flag("is_complete", is_complete);
    hs_report_put("bytes", image->size_bytes);
    hs_report_put("entries", n->entries);
    hs_report_put("tiles", n->tiles);
    hs_report_put("shared_edges", n->edges);
    hs_report_put("tiles_against_level_above", n->children);
}

static void print_radar(const struct image *image)
{
    printf("sensor: %s; radar: %s\n", lm_sensor_word(image->header.sensor),
           image->has_radar ? image->radar.name : "the display's own");
    hs_report_put("sensor", lm_sensor_word(image->header.sensor));
    hs_report_put("radar", image->has_radar ? image->radar.name : NULL);
}

int db_cmd_verify(int argc, char **argv)
{
    const char *path = NULL, *key = NULL;
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &path, 0, 0, NULL, "the database image", true},
        {"key", HS_INPUT, &key, 0, 0, "FILE",
         "the image must be signed by one of the public keys in this PEM file; left out: a "
         "signature "
         "must fit, whoever made it",
         false},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    struct image image;
    if (image_map(&image, path) != 0) {
        return HS_EXIT_FAILED;
    }
    struct image_findings findings = {stdout, 0, SHOWN_MAX, true, NULL};
    struct image_verify_counts n = {0};
    hs_report_array("faults");
    const bool is_complete = image_verify(&image, &findings, &n) == 0;
    hs_report_close();
    if (findings.count > SHOWN_MAX) {
        printf("and %" PRIu64 " more\n", findings.count - SHOWN_MAX);
    }
    printf("%s: %" PRIu64 " bytes, %" PRIu64 " entries, %" PRIu64 " tiles, %" PRIu64
           " shared edges, %" PRIu64 " tiles against the level above\n",
           path, image.size_bytes, n.entries, n.tiles, n.edges, n.children);
    report_counts(&image, &findings, &n, is_complete);
    if (is_complete) {
        char heights[160];
        image_heights_text(image.db.classes.height_dm, heights, sizeof heights);
        printf("heights of the codes, m:%s\n", heights);
        image_heights_report(image.db.classes.height_dm);
        print_radar(&image);
    }
    const int trust = db_signature_check(&image, path, key);
    image_close(&image);
    if (findings.count > 0) {
        hs_error(path, "build it again", "%" PRIu64 " faults%s", findings.count,
                 is_complete ? "" : "; the rest could not be checked");
        return HS_EXIT_FAILED;
    }
    if (trust != 0) {
        return HS_EXIT_FAILED;
    }
    printf("no faults\n");
    return HS_EXIT_OK;
}
