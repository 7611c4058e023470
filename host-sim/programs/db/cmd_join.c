#include "build_job.h"
#include "commands.h"
#include "cost.h"

#include "build/part.h"
#include "hs/error.h"
#include "hs/report.h"

#include <gdal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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
    struct build_part *parts; /* owned; by shard */
    char **names;             /* owned, as are these: of parts in a folder */
    struct build_context *b;
    int last;       /* where the last tile was found */
    uint32_t taken; /* tiles since the parts' memory was given back */
};

enum { RELEASE_TILES = 512 }; /* at most 58 MB of the parts, as the tile above needs 95 kB of one */

/* Is this part the one of its shard in the plan? */
static int check_part(const struct build_work *work, const struct build_part *p)
{
    const struct build_part_head *h = &p->head;
    const uint32_t count = (uint32_t)work->shard_count;
    if (h->number >= count || h->shard_count != count) {
        return hs_error(p->path, "give the parts of this plan",
                        "is shard %u of %u, and the plan has %u", (unsigned)h->number,
                        (unsigned)h->shard_count, (unsigned)count);
    }
    const struct build_work_shard *s = &work->shards[h->number];
    if (memcmp(h->key, s->key, sizeof h->key) != 0 || h->level != s->place.level ||
        h->zone != s->place.zone || h->row0 != s->place.row0 || h->rows != s->place.rows ||
        h->column0 != s->place.column0 || h->columns != s->place.columns) {
        return hs_error(p->path, "make this shard again",
                        "is shard %u of another plan, or of other sources", (unsigned)h->number);
    }
    return 0;
}

static int open_part(struct join *j, const char *path)
{
    struct build_part part;
    if (build_part_open(&part, path) != 0) {
        return -1;
    }
    int result = check_part(&j->work, &part);
    if (result == 0 && j->parts[part.head.number].bytes) {
        result = hs_error(path, "leave one of them out", "is shard %u, and so is %s",
                          (unsigned)part.head.number, j->parts[part.head.number].path);
    }
    if (result != 0) {
        build_part_close(&part);
        return -1;
    }
    j->parts[part.head.number] = part;
    return 0;
}

/* The parts of a folder, by the keys of the plan. */
static int open_folder(struct join *j, const char *folder)
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
        if (open_part(j, path) != 0) {
            return hs_error(path, "make it again", "is shard %d", i);
        }
    }
    return 0;
}

static int open_parts(struct join *j, const char *folder, const struct hs_list *paths)
{
    j->parts = calloc((size_t)j->work.shard_count, sizeof *j->parts);
    j->names = calloc((size_t)j->work.shard_count, sizeof *j->names);
    if (!j->parts || !j->names) {
        return hs_error("parts", NULL, "out of memory");
    }
    if (folder && open_folder(j, folder) != 0) {
        return -1;
    }
    for (int i = 0; i < paths->count; i++) {
        if (open_part(j, paths->items[i]) != 0) {
            return -1;
        }
    }
    for (int i = 0; i < j->work.shard_count; i++) {
        if (!j->parts[i].bytes) {
            return hs_error(j->settings.plan, "make it with `landmass-db build --shard`",
                            "shard %d is missing", i);
        }
    }
    return 0;
}

static void release_parts(struct join *j)
{
    for (int i = 0; i < j->work.shard_count; i++) {
        build_part_release(&j->parts[i]);
    }
    j->taken = 0;
}

/* As struct build_made has it. */
static int take(void *ctx, int level, uint32_t row, uint32_t column, struct lm_tile *record,
                struct build_tile *tile)
{
    struct join *j = ctx;
    const struct build_plan *plan = &j->b->plan;
    if (++j->taken == RELEASE_TILES) {
        release_parts(j);
    }
    const struct lm_band *band = build_plan_band(plan, level, row);
    const uint8_t shift = (uint8_t)(plan->shift0 + (unsigned)level);
    for (int i = 0; i < j->work.shard_count; i++) {
        const int k = (j->last + i) % j->work.shard_count;
        const struct build_shard *s = &j->work.shards[k].place;
        if (build_shard_holds(plan, s, level, row, column) && band->zone == s->zone) {
            const struct image_frame f = image_frame_of(shift, band->zone, row, column);
            const uint32_t mask = image_columns_round(shift, band->zone) - 1;
            const uint32_t entry = band->entry0 + (row - band->row0) * band->columns +
                                   ((column - band->column0) & mask);
            j->last = k;
            return build_part_take(&j->parts[k], entry, &f, level, record, tile);
        }
    }
    return hs_error(j->settings.plan, "make it again with `landmass-db plan`",
                    "no shard has row %u, column %u of level %d", (unsigned)row, (unsigned)column,
                    level);
}

/* What the parts counted, to what is counted here. */
static void add_sums(struct build_context *b, const struct build_part_head *h)
{
    struct build_counts *n = &b->counts;
    for (int k = 0; k < LM_DB_CLASSES; k++) {
        n->cells[k] += h->counts.cells[k];
        build_sum_join(&n->area_m2[k], &h->counts.area_m2[k]);
    }
    n->cells_by_rule += h->counts.cells_by_rule;
    n->cells_beyond_terrain += h->counts.cells_beyond_terrain;
    n->heights_cut += h->counts.heights_cut;
    build_sum_join(&n->land_area_m2, &h->counts.land_area_m2);
    build_sum_join(&n->land_metres_m2, &h->counts.land_metres_m2);
    build_towns_join(&b->towns, &h->towns);
}

static int make_image(struct join *j, const char *folder, const struct hs_list *paths)
{
    const double start = db_cost_seconds();
    struct build_extras extras;
    struct build_report report = {0};
    const struct build_made made = {j, j->work.shards[0].place.level, take};
    int result = build_job_extras(&extras, &j->settings);
    if (result == 0) {
        result = build_job_open(j->b, &j->settings, &j->work, NULL, false) == 0 &&
                         build_work_check_sources(&j->work, NULL) == 0
                     ? open_parts(j, folder, paths)
                     : -1;
    }
    for (int i = 0; result == 0 && i < j->work.shard_count; i++) {
        add_sums(j->b, &j->parts[i].head);
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
    for (int i = 0; j->parts && i < j->work.shard_count; i++) {
        build_part_close(&j->parts[i]);
        free(j->names ? j->names[i] : NULL);
    }
    build_job_close(j->b);
    build_work_free(&j->work);
    hs_list_free(&j->settings.terrain);
    free(j->parts);
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
