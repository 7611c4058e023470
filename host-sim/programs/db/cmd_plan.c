#include "build_job.h"
#include "commands.h"

#include "build/work_sources.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/report.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int find_sources(struct build_work *work, const struct build_context *b,
                        const struct build_settings *s, const struct build_extras *extras)
{
    const bool is_raster = s->geoid_grid && strcmp(s->geoid_grid, "egm96") != 0;
    const struct build_plain_file files[] = {
        {"classes", s->classes},     {"map", s->map},
        {"detail", s->detail},       {"radar", s->radar},
        {"bus-table", s->bus_table}, {"geoid-grid", is_raster ? s->geoid_grid : NULL},
        {"targets", s->targets},
    };
    int result = build_work_find_sources(work, b, files, sizeof files / sizeof files[0]);
    const struct build_signatures *signatures = &extras->targets.signatures;
    for (uint32_t i = 0; s->targets && i < signatures->count && result == 0; i++) {
        const struct build_plain_file file = {"signature", signatures->paths[i]};
        const struct build_context none = {.seed = 0};
        result = build_work_find_sources(work, &none, &file, 1);
    }
    return result;
}

/* The text of choices that count for every tile. */
static void choices_of(const struct build_context *b, const struct build_settings *s, char *text,
                       size_t room)
{
    const struct build_rule *r = &b->rule;
    snprintf(text, room,
             "sensor %d seed %" PRIu32
             " rule %d %d %d %.17g %.17g voids %d flat %d names %d "
             "unknown %s\n",
             (int)b->sensor, b->seed, r->land, r->water, r->steep, r->sea_level_m, r->steep_tangent,
             s->voids_are_sea, s->is_flat, s->ignores_names,
             s->unknown_codes ? s->unknown_codes : "refused");
}

int build_job_plan(struct build_work *work, const struct build_context *b,
                   const struct build_settings *s, const struct build_extras *extras, int shards,
                   uint32_t memory_mib)
{
    char choices[1024];
    build_work_grid(&b->plan, work->grid_sha256);
    memcpy(work->heights_dm, b->classes.height_dm, sizeof work->heights_dm);
    work->manifest = build_job_manifest(b, s, &extras->targets.signatures);
    if (!work->manifest || find_sources(work, b, s, extras) != 0) {
        return -1;
    }
    choices_of(b, s, choices, sizeof choices);
    return build_work_cut(work, b, shards, memory_mib, choices);
}

int build_job_write_plan(const struct build_work *work, const char *path)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    const int result = build_work_write(work, file.stream) == 0 ? hs_atomic_commit(&file) : -1;
    hs_atomic_abort(&file);
    return result;
}

static void print_shards(const struct build_work *work)
{
    uint64_t tiles = 0;
    uint32_t most_mib = 0;
    hs_report_array("shards");
    for (int i = 0; i < work->shard_count; i++) {
        const struct build_work_shard *s = &work->shards[i];
        printf("shard %d  at most %" PRIu64 " tiles, %" PRIu32 " MiB  %.12s\n", i, s->tiles,
               s->memory_mib, s->key);
        hs_report_object(NULL);
        hs_report_integer("shard", i);
        hs_report_count("tiles_at_most", s->tiles);
        hs_report_count("memory_mib", s->memory_mib);
        hs_report_text("key", s->key);
        hs_report_close();
        tiles += s->tiles;
        most_mib = s->memory_mib > most_mib ? s->memory_mib : most_mib;
    }
    hs_report_close();
    hs_report_count("tiles_at_most", tiles);
    hs_report_integer("sources", work->source_count);
    printf("%d shards of %d sources, together at most %" PRIu64
           " tiles; the largest needs up to "
           "%" PRIu32 " MiB\n",
           work->shard_count, work->source_count, tiles, most_mib);
}

static int make_plan(struct build_context *b, const struct build_settings *s,
                     struct build_work *work)
{
    struct build_extras extras;
    int result = build_job_extras(&extras, s) == 0 ? build_job_open(b, s, NULL, NULL) : -1;
    if (result == 0) {
        result = build_job_plan(work, b, s, &extras, (int)s->shards, (uint32_t)s->memory_mib);
    }
    build_job_free_extras(&extras);
    return result == 0 ? build_job_write_plan(work, s->out) : -1;
}

int db_cmd_plan(int argc, char **argv)
{
    struct build_settings s = build_job_defaults();
    static struct build_work work;
    int exit_code;
    if (build_job_read(&s, BUILD_PLAN, &work, argc, argv, &exit_code)) {
        struct build_context *b = calloc(1, sizeof *b);
        exit_code = !b                             ? HS_EXIT_FAILED
                    : build_job_check(&s) != 0     ? HS_EXIT_USAGE
                    : make_plan(b, &s, &work) != 0 ? HS_EXIT_FAILED
                                                   : HS_EXIT_OK;
        if (exit_code == HS_EXIT_OK) {
            print_shards(&work);
        }
        if (b) {
            build_job_close(b);
        }
        free(b);
    }
    build_work_free(&work);
    hs_list_free(&s.terrain);
    return exit_code;
}
