/* Job of building an image: what the commands build, plan and join have in common. */
#ifndef DB_BUILD_JOB_H
#define DB_BUILD_JOB_H

#include "build/pyramid.h"
#include "build/targets.h"
#include "build/work.h"
#include "hs/options.h"
#include "lm/bus_record.h"

struct build_settings {
    const char *classes, *radar, *bus_table, *class_raster, *reflectivity, *heights, *targets,
        *detail;
    const char *map, *unknown_codes, *terrain_unit, *terrain_datum, *geoid_grid;
    const char *beside; /* an image that is flown together with this one */
    struct hs_list terrain;
    double cell_m;
    long shift0, seed;
    const char *centre, *title, *out;
    const char *plan;        /* text of a work plan that a shard is taken from */
    long shard;              /* its number; -1: none */
    long shards, memory_mib; /* for the command plan */
    long jobs;               /* processes that make tiles; 0: one for each processor */
    int compression;         /* enum image_compression */
    int sensor;              /* enum hs_sensor; -1: as the reflectivity says, or X */
    uint32_t centre_bam[2];  /* latitude, longitude; when `centre` is given */
    const char *land_class, *water_class, *steep_class;
    double sea_level_m, steep_degrees, geoid_m;
    bool is_flat, voids_are_sea, may_cut_heights, ignores_names, trusts_inputs;
};

/* Specific targets and their signatures, with the sections made of them; all zero without any. */
struct build_extras {
    struct build_targets targets;           /* owned */
    void *targets_bytes, *signatures_bytes; /* owned */
    size_t targets_size, signatures_size;
    uint8_t bus[LM_BUS_RECORD_BYTES_MAX]; /* record of the bus table */
    size_t bus_bytes;                     /* 0: there is none */
};

struct build_report {
    struct build_level_counts levels;
    uint64_t image_bytes, entry_count, record_count;
    int32_t mean_elevation_q6;
};

enum build_command { BUILD_WHOLE, BUILD_PLAN, BUILD_FROM_PLAN };

/* Read a command line, or the options of a work plan (BUILD_FROM_PLAN; no outputs). `work` takes
 * note of the options that a plan keeps; it may be NULL. As hs_options_read. */
bool build_job_read(struct build_settings *s, enum build_command command, struct build_work *work,
                    int argc, char **argv, int *exit_code);
/* The defaults that the options change. */
struct build_settings build_job_defaults(void);
/* Returns 0, or -1 with the error reported. */
int build_job_check(struct build_settings *s);

/* Open all inputs. `work` is the plan that they were judged for, or NULL: then they are judged, and
 * tables chosen. `shard` is what shall be made of them: its facings are surveyed. NULL: the caller
 * does so if it makes tiles of the finest level. Returns 0, or -1 with the error reported; close
 * either way. */
int build_job_open(struct build_context *b, const struct build_settings *s,
                   const struct build_work *work, const struct build_shard *shard);
void build_job_close(struct build_context *b);

/* Read what goes beside the tiles; free either way. */
int build_job_extras(struct build_extras *e, const struct build_settings *s);
void build_job_free_extras(struct build_extras *e);

/* The manifest's text; the caller frees it. NULL with the error reported. */
char *build_job_manifest(const struct build_context *b, const struct build_settings *s,
                         const struct build_signatures *signatures);

/* Write the image, with tiles that are made already unless `made` is NULL. */
int build_job_write(struct build_context *b, const struct build_settings *s,
                    const struct build_made *made, const char *manifest,
                    const struct build_extras *extras, struct build_report *report);
void build_job_print(const struct build_context *b, const struct build_settings *s,
                     const struct build_extras *extras, const struct build_report *report,
                     double seconds);

/* Plan what is open, in at least `shards` shards of at most `memory_mib`, into `work`, which has
 * the options. Returns 0, or -1 with the error reported. */
int build_job_plan(struct build_work *work, const struct build_context *b,
                   const struct build_settings *s, const struct build_extras *extras, int shards,
                   uint32_t memory_mib);

/* Write a plan in one piece. Returns 0, or -1 with the error reported. */
int build_job_write_plan(const struct build_work *work, const char *path);

/* Make one shard of s->plan. */
int build_job_shard(const struct build_settings *given);
/* Read a plan and its options, which stay in `work`. */
int build_job_read_plan(struct build_work *work, struct build_settings *s, const char *path);

#endif
