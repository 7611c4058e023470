#include "build_job.h"
#include "build_parts.h"
#include "commands.h"
#include "cost.h"

#include "hs/error.h"
#include "hs/report.h"

#include <gdal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static const struct hs_usage usage = {
    "join", "make an image of the shards of a plan",
    "PLAN is what `landmass-db plan` wrote, and parts are what `landmass-db build --plan --shard` "
    "made of it, all of them\n"
    "in any order. The image is the one that `landmass-db build` makes in one go, byte for byte.\n"
    "\n"
    "Every byte of the parts is checked. One that is missing, given twice, of another plan or "
    "damaged is refused by its name."};

struct join {
    struct build_work work;
    struct build_settings settings;
    struct build_parts parts;
    char **names; /* owned, as are these: of parts in a folder */
    struct build_context *b;
};

/* The parts of a folder, by the keys of the plan. */
static int add_folder(struct join *j, const char *folder)
{
    for (int i = 0; i < j->work.shard_count; i++) {
        char *path = NULL;
        if (asprintf(&path, "%s/%s.part", folder, j->work.shards[i].key) < 0) {
            return hs_error(folder, NULL, "out of memory");
        }
        j->names[i] = path;
        if (access(path, F_OK) != 0) {
            return hs_error(path, "make it with `landmass-db build --shard`", "shard %d is missing",
                            i);
        }
        if (build_parts_add(&j->parts, path) != 0) {
            return hs_error(path, "make it again", "is shard %d", i);
        }
    }
    return 0;
}

static int add_parts(struct join *j, const char *folder, const struct hs_list *paths)
{
    j->names = calloc((size_t)j->work.shard_count, sizeof *j->names);
    if (!j->names) {
        return hs_error("parts", NULL, "out of memory");
    }
    if (build_parts_begin(&j->parts, &j->work, j->settings.plan, j->b) != 0 ||
        (folder && add_folder(j, folder) != 0)) {
        return -1;
    }
    for (int i = 0; i < paths->count; i++) {
        if (build_parts_add(&j->parts, paths->items[i]) != 0) {
            return -1;
        }
    }
    return 0;
}

static int make_image(struct join *j, const char *folder, const struct hs_list *paths)
{
    const double start = db_cost_seconds();
    struct build_extras extras;
    struct build_report report = {0};
    struct build_made made;
    int result = build_job_extras(&extras, &j->settings);
    if (result == 0) {
        result = build_job_open(j->b, &j->settings, &j->work, NULL) == 0 &&
                         build_work_check_sources(&j->work, NULL) == 0 &&
                         add_parts(j, folder, paths) == 0
                     ? build_parts_join(&j->parts, &made)
                     : -1;
    }
    if (result == 0) {
        result = build_job_write(j->b, &j->settings, &made, j->work.manifest, &extras, &report);
    }
    if (result == 0) {
        build_job_print(j->b, &j->settings, &extras, &report, db_cost_seconds() - start);
        db_cost_report(db_cost_seconds() - start);
    }
    build_job_free_extras(&extras);
    return result;
}

static int join(const char *plan, const char *folder, const struct hs_list *paths, const char *out)
{
    struct join *j = calloc(1, sizeof *j);
    if (!j || !(j->b = calloc(1, sizeof *j->b))) {
        free(j);
        return hs_error(out, NULL, "out of memory");
    }
    GDALSetCacheMax64((int64_t)256 << 20);
    j->settings = build_job_defaults();
    int result = build_job_read_plan(&j->work, &j->settings, plan);
    if (result == 0) {
        j->settings.plan = plan;
        j->settings.out = out;
        result = make_image(j, folder, paths);
    }
    build_parts_end(&j->parts);
    for (int i = 0; j->names && i < j->work.shard_count; i++) {
        free(j->names[i]);
    }
    build_job_close(j->b);
    build_work_free(&j->work);
    hs_list_free(&j->settings.terrain);
    free(j->names);
    free(j->b);
    free(j);
    return result;
}

int db_cmd_join(int argc, char **argv)
{
    const char *plan = NULL, *folder = NULL, *out = NULL;
    static struct hs_list parts;
    int exit_code;
    const struct hs_option options[] = {
        {"PLAN", HS_INPUT_ARGUMENT, &plan, 0, 0, NULL, "the plan", true},
        {"parts", HS_TEXT, &folder, 0, 0, "DIR",
         "folder of all parts, each named by the key of its shard: KEY.part", false},
        {"part", HS_INPUTS, &parts, 0, 0, "FILE", "a part; may be given again", false},
        HS_CLASHES_ROW("part", "parts"),
        {"out", HS_OUTPUT, &out, 0, 0, "FILE.lmdb", "the image to write", true},
    };
    if (hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                        &exit_code)) {
        exit_code = join(plan, folder, &parts, out) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    hs_list_free(&parts);
    return exit_code;
}
