/* Workers: processes of this program that make the shards of a plan, several at a time. GDAL and a
 * build's context are for one thread, and a shard is a command already. */
#ifndef DB_BUILD_WORKERS_H
#define DB_BUILD_WORKERS_H

#include "build_job.h"

/* In how many shards `jobs` processes best make the tiles of so many directory entries: a few for
 * each, so that they end at about the same time, and none so small that its beginning, a quarter
 * of a second, is much of it. 1: make them here. */
int build_workers_shards(uint32_t entries, int jobs);

/* The image of what is open in `b`, its tiles made by up to `jobs` processes in at least `shards`
 * shards. `work` has the options and gets the plan. Plan and parts lie beside the image until it is
 * whole: as much as its tiles unpacked. Returns 0, or -1 with the error reported, nothing left
 * behind and no worker running. What a worker says is passed on where it fails, and left out
 * otherwise, for what it warns of was said when the inputs were opened. A worker ends when this
 * process does. */
int build_workers_image(struct build_context *b, const struct build_settings *s, int shards,
                        int jobs, struct build_work *work, const struct build_extras *extras,
                        struct build_report *report);

#endif
