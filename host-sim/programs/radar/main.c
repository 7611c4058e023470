/* landmass-radar: the radar parameter table as text, for a radar without a compiler. */
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/menu.h"
#include "hs/options.h"
#include "hs/report.h"
#include "image/reader.h"
#include "lm/radar_record.h"
#include "lm/sensor.h"
#include "radar/text.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

/* ---- print ---- */

static int read_image(struct lm_radar *radar, const char *path)
{
    struct image image;
    if (image_open(&image, path) != 0) {
        return -1;
    }
    const bool has_radar = image.has_radar;
    *radar = image.radar;
    image_close(&image);
    return has_radar ? 0
                     : hs_error(path, "`landmass-db build --radar` puts one in",
                                "carries no radar table");
}

static bool is_text(const uint8_t *bytes, size_t count)
{
    size_t i = 0;
    while (i < count &&
           (bytes[i] >= ' ' || bytes[i] == '\n' || bytes[i] == '\r' || bytes[i] == '\t')) {
        i++;
    }
    return count > 0 && i == count;
}

/* The first bytes tell an image from a record. */
static int read_packed(struct lm_radar *radar, const char *path)
{
    uint8_t bytes[LM_RADAR_RECORD_BYTES + 1];
    FILE *file = hs_input_open(path, "rb");
    if (!file) {
        return hs_error(path, "check the name", "cannot be read: %s", strerror(errno));
    }
    const size_t count = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    if (count >= 8 && memcmp(bytes, "LANDMASS", 8) == 0) {
        return read_image(radar, path);
    }
    const int status = lm_radar_unpack(radar, bytes, (uint32_t)count);
    if (status != LM_OK && is_text(bytes, count)) {
        return hs_error(path, "check it with `landmass-radar check`, or name an image or a record",
                        "is a text already, which is what `print` makes");
    }
    return status == LM_OK ? 0
                           : hs_error(path, "write it again with `landmass-radar record`",
                                      status == LM_ERR_VERSION ? "is no record of this version"
                                      : status == LM_ERR_TABLE ? "holds a table out of its ranges"
                                                               : "is no image and no sound record");
}

static int run_print(int argc, char **argv)
{
    static const struct hs_usage usage = {
        "print", "a table as text, to begin a file of your own with",
        "Prints the table that is built into the display, or that of an image or a record. What is "
        "printed can be read back, and is then the same to the last bit."};
    const char *path = NULL;
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &path, 0, 0, NULL,
         "a database image or a record; left out: the built-in table", false},
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    struct lm_radar radar = lm_radar_default;
    if (path && read_packed(&radar, path) != 0) {
        return HS_EXIT_FAILED;
    }
    radar_text_print(stdout, &radar);
    if (fflush(stdout) != 0) {
        hs_error("standard output", "make room", "%s", strerror(errno));
        return HS_EXIT_FAILED;
    }
    return HS_EXIT_OK;
}

/* ---- check ---- */

static int run_check(int argc, char **argv)
{
    static const struct hs_usage usage = {
        "check", "check a table: every number and every rule between them",
        "By the same function as the display. The first fault is reported with its line."};
    const char *path = NULL;
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &path, 0, 0, NULL, "the table, a text", true},
    };
    struct lm_radar radar;
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    if (radar_text_read(&radar, path) != 0) {
        return HS_EXIT_FAILED;
    }
    hs_report_put("name", radar.name);
    hs_report_put("band", lm_sensor_word(radar.sensor));
    hs_report_put("scales", radar.ranges);
    printf("%s: radar %s, band %s, %u scales: no faults\n", path, radar.name,
           lm_sensor_word(radar.sensor), radar.ranges);
    return HS_EXIT_OK;
}

/* ---- record ---- */

static int write_record(const struct lm_radar *radar, const char *path)
{
    uint8_t record[LM_RADAR_RECORD_BYTES];
    struct hs_atomic_file file;
    lm_radar_pack(radar, record);
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    if (fwrite(record, 1, sizeof record, file.stream) != sizeof record) {
        hs_error(path, "make room", "cannot be written: %s", strerror(errno));
        hs_atomic_abort(&file);
        return -1;
    }
    return hs_atomic_commit(&file);
}

static int run_record(int argc, char **argv)
{
    static const struct hs_usage usage = {
        "record", "write a table as the record that a board reads",
        "For a panel's option `radar` (docs/panel.md). An image gets its own by `landmass-db build "
        "--radar`, from the text."};
    const char *text = NULL, *record = NULL;
    int exit_code;
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, &text, 0, 0, NULL, "the table, a text", true},
        {"RECORD", HS_OUTPUT_ARGUMENT, &record, 0, 0, NULL, "the record to write", true},
    };
    struct lm_radar radar;
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    return radar_text_read(&radar, text) == 0 && write_record(&radar, record) == 0 ? HS_EXIT_OK
                                                                                   : HS_EXIT_FAILED;
}

int main(int argc, char **argv)
{
    static const struct hs_command commands[] = {
        {"print", "a table as text, to begin a file of your own with", run_print},
        {"check", "check a table: every number and every rule between them", run_check},
        {"record", "write a table as the record that a board reads", run_record},
    };
    const struct hs_menu menu = {.program = "landmass-radar",
                                 .purpose = "the radar's parameter table as text",
                                 .commands = commands,
                                 .count = sizeof commands / sizeof commands[0]};
    return hs_menu_main(&menu, argc, argv);
}
