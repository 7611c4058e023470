/* scenario: a bus log and a script of the bench as a flight for the board (scenario.h).
 * Usage: scenario LOG SCRIPT SECONDS OUT [step|display|bus HANG_SECONDS]; "-" for no log or script.
 */
#include "scenario.h"

#include "drv/can_log.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "sim/script.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

struct tables {
    struct scenario_header header;
    struct lm_can_frame *frames;
    struct scenario_control *controls;
    struct scenario_picture pictures[SCENARIO_PICTURES_MAX];
};

static void report(void *ctx, uint32_t line, const char *cause)
{
    char place[512];
    snprintf(place, sizeof place, "%s line %u", (const char *)ctx, line);
    hs_warn(place, "the line is skipped", "%s", cause);
}

static int read_log(struct tables *t, char *path)
{
    if (strcmp(path, "-") == 0) {
        return 0;
    }
    FILE *file = fopen(path, "r");
    if (!file) {
        return hs_error(path, NULL, "cannot be opened: %s", strerror(errno));
    }
    struct drv_can_log log;
    drv_can_log_init(&log, file, report, path);
    drv_can_log_set_now(&log, t->header.end_us);
    const struct lm_can port = drv_can_log_port(&log);
    const uint32_t most = SCENARIO_BYTES_MAX / sizeof(struct lm_can_frame);
    t->frames = calloc(most, sizeof *t->frames);
    while (t->frames && t->header.frames < most &&
           port.receive(port.ctx, &t->frames[t->header.frames]) == 1) {
        t->header.frames++;
    }
    fclose(file);
    return t->frames && t->header.frames < most ? 0 : hs_error(path, NULL, "is too long");
}

static int read_script(struct tables *t, const char *path)
{
    struct script script;
    if (script_read(&script, strcmp(path, "-") == 0 ? NULL : path, &lm_radar_default) != 0) {
        return -1;
    }
    if (script.exercise.has_clock || script.exercise.malfunction_count > 0) {
        script_free(&script);
        return hs_error(path, "tell them by the log",
                        "`clock` and `break` are of landmass-sim alone");
    }
    t->controls = calloc((size_t)script.count + 1, sizeof *t->controls);
    for (int i = 0; t->controls && i < script.count; i++) {
        const struct script_event *e = &script.events[i];
        if (!e->is_picture) {
            t->controls[t->header.controls++] = (struct scenario_control){e->time_us, e->control};
        } else if (t->header.pictures == SCENARIO_PICTURES_MAX) {
            return hs_error(path, NULL, "has more than %d pictures", SCENARIO_PICTURES_MAX);
        } else {
            struct scenario_picture *p = &t->pictures[t->header.pictures++];
            p->time_us = e->time_us;
            snprintf(p->name, sizeof p->name, "%s", e->picture);
        }
    }
    script_free(&script);
    return t->controls ? 0 : hs_error(path, NULL, "out of memory");
}

static int write_tables(const struct tables *t, const char *path)
{
    struct hs_atomic_file f;
    if (hs_atomic_open(&f, path) != 0) {
        return -1;
    }
    fwrite(&t->header, sizeof t->header, 1, f.stream);
    if (t->header.frames > 0) {
        fwrite(t->frames, sizeof *t->frames, t->header.frames, f.stream);
    }
    fwrite(t->controls, sizeof *t->controls, t->header.controls, f.stream);
    fwrite(t->pictures, sizeof *t->pictures, t->header.pictures, f.stream);
    return hs_atomic_commit(&f);
}

static void read_hang(struct tables *t, int argc, char **argv)
{
    static const char *const names[] = {"fine", "step", "display", "bus"};
    for (uint32_t i = 0; argc == 7 && i < sizeof names / sizeof names[0]; i++) {
        if (strcmp(argv[5], names[i]) == 0) {
            t->header.hang = i;
            t->header.hang_us = (uint64_t)(strtod(argv[6], NULL) * 1e6);
        }
    }
}

int main(int argc, char **argv)
{
    static struct tables t; /* large */
    hs_set_program("scenario");
    if (argc != 5 && argc != 7) {
        hs_error("command line", NULL, "expected LOG SCRIPT SECONDS OUT [WHAT HANG_SECONDS]");
        return HS_EXIT_USAGE;
    }
    t.header.magic = SCENARIO_MAGIC;
    t.header.end_us = (uint64_t)(strtod(argv[3], NULL) * 1e6);
    read_hang(&t, argc, argv);
    int status = read_log(&t, argv[1]);
    status = status == 0 ? read_script(&t, argv[2]) : status;
    status = status == 0 ? write_tables(&t, argv[4]) : status;
    free(t.frames);
    free(t.controls);
    return status == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
