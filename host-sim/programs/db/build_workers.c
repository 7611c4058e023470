#include "build_workers.h"

#include "build_parts.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/progress.h"

#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

enum { NO_PROGRAM = 127 }; /* exit code, as shells have it */

struct worker {
    pid_t process; /* 0: none */
    int shard;
    FILE *said; /* owned */
};

struct workers {
    const struct build_work *work;
    const char *out;        /* the image, by whose name errors are told */
    char *plan, **paths;    /* owned, as are these: of the plan and of the part of each shard */
    struct worker *workers; /* owned; `jobs` of them */
    int jobs;
    struct hs_progress progress;
    uint64_t tiles_done;
};

static void run_shard(const struct workers *w, const struct worker *worker, pid_t parent)
{
    char number[16];
    snprintf(number, sizeof number, "%d", worker->shard);
    const int said = fileno(worker->said);
    (void)prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() == parent && dup2(said, STDOUT_FILENO) >= 0 && dup2(said, STDERR_FILENO) >= 0) {
        execl("/proc/self/exe", hs_program(), "build", "--plan", w->plan, "--shard", number,
              "--out", w->paths[worker->shard], (char *)NULL);
    }
    _exit(NO_PROGRAM);
}

static int start(struct workers *w, struct worker *worker, int shard)
{
    const pid_t parent = getpid();
    *worker = (struct worker){.shard = shard, .said = tmpfile()};
    if (!worker->said) {
        return hs_error(w->out, "free some space and run again",
                        "no file for what a worker says: %s", strerror(errno));
    }
    fflush(NULL);
    worker->process = fork();
    if (worker->process == 0) {
        run_shard(w, worker, parent);
    }
    if (worker->process < 0) {
        worker->process = 0;
        return hs_error(w->out, "give --jobs 1", "no process for shard %d: %s", shard,
                        strerror(errno));
    }
    return 0;
}

static void pass_on(FILE *said)
{
    char text[4096];
    size_t bytes;
    rewind(said);
    fflush(stdout);
    while ((bytes = fread(text, 1, sizeof text, said)) > 0) {
        fwrite(text, 1, bytes, stderr);
    }
}

static int judge(const struct workers *w, const struct worker *worker, pid_t process, int status)
{
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) {
        return 0;
    }
    pass_on(worker->said);
    hs_atomic_drop_of(w->paths[worker->shard], process);
    return WIFSIGNALED(status)
               ? hs_error(w->out, "give fewer --jobs if memory is short",
                          "shard %d was ended by signal %d", worker->shard, WTERMSIG(status))
               : hs_error(w->out, "see the line before", "shard %d could not be made",
                          worker->shard);
}

/* Wait for any worker, and let it go. Returns 0 when it made its shard. */
static int finish_one(struct workers *w)
{
    int status;
    const pid_t process = waitpid(-1, &status, 0);
    for (int i = 0; i < w->jobs; i++) {
        struct worker *worker = &w->workers[i];
        if (process > 0 && worker->process == process) {
            worker->process = 0;
            const int result = judge(w, worker, process, status);
            fclose(worker->said);
            worker->said = NULL;
            w->tiles_done += w->work->shards[worker->shard].tiles;
            hs_progress_update(&w->progress, w->tiles_done);
            return result;
        }
    }
    return process > 0 || errno == EINTR ? 0 : hs_error(w->out, NULL, "lost its workers");
}

static int running(const struct workers *w, int *free_place)
{
    int count = 0;
    for (int i = w->jobs - 1; i >= 0; i--) {
        count += w->workers[i].process != 0;
        *free_place = w->workers[i].process ? *free_place : i;
    }
    return count;
}

static int run_all(struct workers *w)
{
    int next = 0, place = 0, count;
    while ((count = running(w, &place)) > 0 || next < w->work->shard_count) {
        const bool may_start = count < w->jobs && next < w->work->shard_count;
        const int result = may_start ? start(w, &w->workers[place], next++) : finish_one(w);
        if (result != 0) {
            return -1;
        }
    }
    return 0;
}

static void stop_all(struct workers *w)
{
    for (int i = 0; i < w->jobs; i++) {
        struct worker *worker = &w->workers[i];
        if (worker->process) {
            kill(worker->process, SIGTERM);
            while (waitpid(worker->process, NULL, 0) < 0 && errno == EINTR) {
            }
        }
        if (worker->said) {
            fclose(worker->said);
        }
    }
}

static int make_parts(struct workers *w)
{
    uint64_t tiles = 0;
    for (int i = 0; i < w->work->shard_count; i++) {
        tiles += w->work->shards[i].tiles;
    }
    hs_progress_begin(&w->progress, "building", tiles);
    const int result = run_all(w);
    hs_progress_end(&w->progress);
    stop_all(w);
    return result;
}

/* Names beside the image, which are removed when this process ends. */
static int name_files(struct workers *w)
{
    char name[PATH_MAX];
    w->workers = calloc((size_t)w->jobs, sizeof *w->workers);
    w->paths = calloc((size_t)w->work->shard_count, sizeof *w->paths);
    if (!w->workers || !w->paths) {
        return hs_error(w->out, NULL, "out of memory");
    }
    for (int i = -1; i < w->work->shard_count; i++) {
        const int length = i < 0 ? snprintf(name, sizeof name, "%s.plan", w->out)
                                 : snprintf(name, sizeof name, "%s.%d.part", w->out, i);
        if (length >= (int)sizeof name) {
            return hs_error(w->out, "shorten it", "is too long a name");
        }
        char **path = i < 0 ? &w->plan : &w->paths[i];
        *path = hs_atomic_temporary_name(name);
        if (!*path) {
            return -1;
        }
    }
    return 0;
}

static int join(const struct workers *w, struct build_context *b, const struct build_settings *s,
                const struct build_extras *extras, struct build_report *report)
{
    struct build_parts parts;
    struct build_made made;
    int result = build_parts_begin(&parts, w->work, w->out, b);
    for (int i = 0; i < w->work->shard_count && result == 0; i++) {
        result = build_parts_add(&parts, w->paths[i]);
    }
    if (result == 0) {
        result = build_parts_join(&parts, &made);
    }
    if (result == 0) {
        result = build_job_write(b, s, &made, w->work->manifest, extras, report);
    }
    build_parts_end(&parts);
    return result;
}

static void remove_file(char *path)
{
    if (path) {
        hs_atomic_drop(path);
    }
    free(path);
}

static void end(struct workers *w)
{
    for (int i = 0; w->paths && i < w->work->shard_count; i++) {
        remove_file(w->paths[i]);
    }
    remove_file(w->plan);
    free(w->paths);
    free(w->workers);
}

int build_workers_shards(uint32_t entries, int jobs)
{
    enum { EACH = 4, ENTRIES_LEAST = 512 };
    const int most = jobs > 1 ? EACH * jobs : 1, wanted = (int)(entries / ENTRIES_LEAST);
    return wanted < 1 ? 1 : wanted < most ? wanted : most;
}

int build_workers_image(struct build_context *b, const struct build_settings *s, int shards,
                        int jobs, struct build_work *work, const struct build_extras *extras,
                        struct build_report *report)
{
    struct workers w = {.work = work, .out = s->out, .jobs = jobs};
    if (build_job_plan(work, b, s, extras, shards, UINT32_MAX) != 0) {
        return -1;
    }
    const int result =
        name_files(&w) == 0 && build_job_write_plan(work, w.plan) == 0 && make_parts(&w) == 0
            ? join(&w, b, s, extras, report)
            : -1;
    end(&w);
    return result;
}
