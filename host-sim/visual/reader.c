#include "reader.h"

#include "hs/error.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static void set_limit(__rlimit_resource_t resource, rlim_t most)
{
    const struct rlimit limit = {most, most};
    setrlimit(resource, &limit);
}

static void enter_limits(void)
{
    set_limit(RLIMIT_AS, (rlim_t)VISUAL_READER_MIB << 20);
    set_limit(RLIMIT_FSIZE, (rlim_t)VISUAL_READER_MIB << 20);
    set_limit(RLIMIT_CPU, VISUAL_READER_SECONDS);
    set_limit(RLIMIT_CORE, 0);
}

static int judge(int status, const char *place)
{
    if (WIFEXITED(status) && WEXITSTATUS(status) == READER_DONE) {
        return 0;
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == READER_REPORTED) {
        return READER_REPORTED;
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == READER_NO_PROGRAM) {
        return hs_error(place, "install the Debian package openscenegraph",
                        "is OpenFlight, which the program osgconv reads, and that is missing");
    }
    const int by_signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (by_signal == SIGXCPU || by_signal == SIGKILL || by_signal == SIGXFSZ) {
        return hs_error(place, "reduce the model, or cut it into several",
                        "is not read within %d s and %d MiB", VISUAL_READER_SECONDS,
                        VISUAL_READER_MIB);
    }
    return hs_error(place, "open it in a modelling program and save it anew",
                    "its reader gave up (%s %d): the file is damaged, or needs more than %d MiB",
                    by_signal ? "signal" : "status", by_signal ? by_signal : WEXITSTATUS(status),
                    VISUAL_READER_MIB);
}

void reader_hold_signals(sigset_t *before)
{
    sigset_t ending;
    sigemptyset(&ending);
    sigaddset(&ending, SIGINT);
    sigaddset(&ending, SIGTERM);
    sigaddset(&ending, SIGHUP);
    sigprocmask(SIG_BLOCK, &ending, before);
}

void reader_release_signals(const sigset_t *before)
{
    sigprocmask(SIG_SETMASK, before, NULL);
}

int reader_run(int (*work)(void *), void *context, const char *place)
{
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGINT, SIG_DFL);
        signal(SIGTERM, SIG_DFL);
        signal(SIGHUP, SIG_DFL);
        sigset_t none;
        sigemptyset(&none);
        sigprocmask(SIG_SETMASK, &none, NULL);
        enter_limits();
        _exit(work(context));
    }
    int status = 0;
    bool is_gone = child < 0;
    while (!is_gone && waitpid(child, &status, 0) < 0) {
        is_gone = errno != EINTR;
    }
    return is_gone ? hs_error(place, NULL, "no process for its reader: %s", strerror(errno))
                   : judge(status, place);
}

struct osg_job {
    const char *path, *search, *out, *log;
};

static int run_osgconv(void *context)
{
    const struct osg_job *job = context;
    const int log = open(job->log, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (log < 0 || dup2(log, STDOUT_FILENO) < 0 || dup2(log, STDERR_FILENO) < 0) {
        return READER_NO_PROGRAM;
    }
    if (job->search) {
        setenv("OSG_FILE_PATH", job->search, 1);
    }
    setenv("OSG_NOTIFY_LEVEL", "WARN", 1);
    execlp("osgconv", "osgconv", job->path, job->out, (char *)NULL);
    return READER_NO_PROGRAM;
}

/* osgconv names the textures that it cannot find on lines of their own. */
static void count_lost(struct visual_model *m, const char *log)
{
    FILE *f = fopen(log, "r");
    char line[VISUAL_PATH_SIZE + 64];
    while (f && fgets(line, sizeof line, f)) {
        const char *name = strstr(line, "Can't find texture");
        name = name ? strchr(name, ')') : NULL;
        if (name && m->lost_textures++ == 0) {
            snprintf(m->lost, sizeof m->lost, "%.*s", (int)strcspn(name + 2, "\n"), name + 2);
        }
    }
    if (f) {
        fclose(f);
    }
}

int reader_osgconv(struct visual_model *m, const char *path, const char *search, const char *folder)
{
    char out[VISUAL_PATH_SIZE], log[VISUAL_PATH_SIZE];
    snprintf(out, sizeof out, "%s/model.obj", folder);
    snprintf(log, sizeof log, "%s/log", folder);
    struct osg_job job = {path, search, out, log};
    const int ending = reader_run(run_osgconv, &job, path);
    if (ending < 0) {
        return -1;
    }
    if (ending != READER_DONE || access(out, R_OK) != 0) {
        return hs_error(path, "see whether osgviewer shows it",
                        "cannot be read as OpenFlight: osgconv makes nothing of it");
    }
    count_lost(m, log);
    return 0;
}
