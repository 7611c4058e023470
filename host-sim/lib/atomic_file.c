#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/report.h"

#include <errno.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Temporary files of this process, so that they can be removed when it is stopped. A signal may
 * come at any time: a slot is written last when it is taken, and first when it is given up. */
enum { TEMPORARIES_MAX = 512 };
static char *volatile temporaries[TEMPORARIES_MAX];
static bool is_watched;

/* A rename, or with no `temporary` a removal, that waits for the end of the run. Texts are owned.
 */
struct waiting {
    char *temporary, *path;
};
static struct {
    bool is_asked;
    struct waiting items[TEMPORARIES_MAX];
    int count;
} together;

static void remove_temporaries(void)
{
    for (int i = 0; i < TEMPORARIES_MAX; i++) {
        if (temporaries[i]) {
            unlink(temporaries[i]);
        }
    }
}

/* The disposition is back at the default by then: the program ends as it would have. */
static void on_signal(int number)
{
    remove_temporaries();
    raise(number);
}

static void watch(void)
{
    static const int numbers[] = {SIGINT, SIGTERM, SIGHUP};
    if (is_watched) {
        return;
    }
    is_watched = true;
    atexit(remove_temporaries);
    for (int i = 0; i < 3; i++) {
        struct sigaction before, action = {.sa_handler = on_signal, .sa_flags = (int)SA_RESETHAND};
        if (sigaction(numbers[i], NULL, &before) == 0 && before.sa_handler == SIG_DFL) {
            sigaction(numbers[i], &action, NULL);
        }
    }
}

static int slot_of(const char *temporary)
{
    for (int i = 0; i < TEMPORARIES_MAX; i++) {
        if (temporaries[i] && strcmp(temporaries[i], temporary) == 0) {
            return i;
        }
    }
    return -1;
}

/* With all slots taken a file is not watched; nobody writes so many at a time. */
static void remember(const char *temporary)
{
    watch();
    for (int i = 0; i < TEMPORARIES_MAX && slot_of(temporary) < 0; i++) {
        if (!temporaries[i]) {
            temporaries[i] = strdup(temporary);
        }
    }
}

static void forget(const char *temporary)
{
    const int slot = slot_of(temporary);
    if (slot >= 0) {
        char *name = temporaries[slot];
        temporaries[slot] = NULL;
        free(name);
    }
}

static void drop(const char *temporary)
{
    unlink(temporary);
    forget(temporary);
}

static bool is_waiting(const char *temporary)
{
    for (int i = 0; i < together.count; i++) {
        const char *name = together.items[i].temporary;
        if (name && strcmp(name, temporary) == 0) {
            return true;
        }
    }
    return false;
}

/* One that waits has been handed over. */
void hs_atomic_drop(const char *temporary)
{
    if (!is_waiting(temporary)) {
        drop(temporary);
    }
}

/* What a process calls its file; NULL when memory ran out. */
static char *name_beside(const char *path, pid_t process)
{
    char *name = NULL;
    /* The extension stays last: some writers choose their format by it. */
    const char *slash = strrchr(path, '/');
    const int folder = slash ? (int)(slash - path) + 1 : 0;
    if (asprintf(&name, "%.*s.unfinished-%ld-%s", folder, path, (long)process, path + folder) < 0) {
        return NULL;
    }
    return name;
}

void hs_atomic_drop_of(const char *path, pid_t process)
{
    char *name = name_beside(path, process);
    if (name) {
        unlink(name);
    }
    free(name);
}

/* A device, a pipe or a folder: renaming over it would destroy it. */
static int is_special(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode);
}

static int check_place(const char *path)
{
    if (path[0] == '\0') {
        return hs_error("output", "name a file", "its name is empty");
    }
    if (is_special(path)) {
        return hs_error(path, "name an ordinary file", "exists and is no ordinary file");
    }
    return hs_input_is(path)
               ? hs_error(path, "name another file for the output",
                          "is an input, or lies in a folder that is one; it would be overwritten")
               : 0;
}

static int cannot_create(const char *path, int cause)
{
    return hs_error(path, "check that the folder exists and can be written",
                    "cannot be created: %s", strerror(cause));
}

char *hs_atomic_temporary_name(const char *path)
{
    if (check_place(path) != 0) {
        return NULL;
    }
    char *name = name_beside(path, getpid());
    if (name) {
        remember(name);
    } else {
        hs_error(path, NULL, "out of memory");
    }
    return name;
}

/* By the file, not by its name. */
static bool is_claimed(const char *temporary)
{
    struct stat wanted, status;
    if (stat(temporary, &wanted) != 0) {
        return false;
    }
    for (int i = 0; i < TEMPORARIES_MAX; i++) {
        if (temporaries[i] && stat(temporaries[i], &status) == 0 &&
            status.st_dev == wanted.st_dev && status.st_ino == wanted.st_ino) {
            return true;
        }
    }
    return false;
}

int hs_output_claim(const char *path)
{
    char *name = name_beside(path, getpid());
    if (!name) {
        return hs_error(path, NULL, "out of memory");
    }
    int result = check_place(path);
    if (result == 0 && is_claimed(name)) {
        result = hs_error(path, "name two files", "is named as two outputs");
    }
    if (result == 0) {
        remember(name); /* first: a signal may come as soon as the file is there */
        FILE *stream = fopen(name, "wb");
        result = stream && fclose(stream) == 0 ? 0 : cannot_create(path, errno);
        if (result != 0) {
            drop(name);
        }
    }
    free(name);
    return result;
}

static int put_in_place(const char *temporary, const char *path)
{
    if (rename(temporary, path) == 0) {
        forget(temporary);
        hs_report_file(path);
        return 0;
    }
    const int cause = errno;
    drop(temporary);
    return hs_error(path, "choose another output name or folder", "cannot be put in place: %s",
                    strerror(cause));
}

static void free_waiting(struct waiting *item)
{
    free(item->temporary);
    free(item->path);
    *item = (struct waiting){NULL, NULL};
}

/* The last word about a path counts. `temporary` may be NULL. */
static int wait_for_the_end(const char *temporary, const char *path)
{
    int i = 0;
    while (i < together.count && strcmp(together.items[i].path, path) != 0) {
        i++;
    }
    if (temporary) {
        remember(temporary);
    }
    /* A file that is not watched would be left by a signal. */
    if (i == TEMPORARIES_MAX || (temporary && slot_of(temporary) < 0)) {
        return hs_error(path, "ask for fewer files", "is one file too many to be kept together");
    }
    if (i < together.count) {
        free_waiting(&together.items[i]);
    } else {
        together.count++;
    }
    together.items[i] = (struct waiting){temporary ? strdup(temporary) : NULL, strdup(path)};
    if (!together.items[i].path || (temporary && !together.items[i].temporary)) {
        free_waiting(&together.items[i]);
        together.items[i] = together.items[--together.count];
        return hs_error(path, NULL, "out of memory");
    }
    return 0;
}

int hs_atomic_rename(const char *temporary, const char *path)
{
    if (check_place(path) != 0 || (together.is_asked && wait_for_the_end(temporary, path) != 0)) {
        hs_atomic_drop(temporary);
        return -1;
    }
    return together.is_asked ? 0 : put_in_place(temporary, path);
}

void hs_atomic_remove(const char *path)
{
    if (!together.is_asked) {
        unlink(path);
    } else if (access(path, F_OK) == 0) {
        wait_for_the_end(NULL, path);
    }
}

void hs_outputs_together(void)
{
    together.is_asked = true;
}

static int check_places(void)
{
    int result = 0;
    for (int i = 0; i < together.count && result == 0; i++) {
        result = check_place(together.items[i].path);
    }
    return result;
}

static int end_one(const struct waiting *item, bool is_good)
{
    if (item->temporary && is_good) {
        return put_in_place(item->temporary, item->path);
    }
    if (item->temporary) {
        drop(item->temporary);
    } else if (is_good) {
        unlink(item->path);
    }
    return 0;
}

int hs_outputs_end(bool is_good)
{
    sigset_t all, before;
    sigfillset(&all);
    sigprocmask(SIG_SETMASK, &all, &before);
    int result = is_good ? check_places() : 0;
    for (int i = 0; i < together.count; i++) {
        if (end_one(&together.items[i], is_good && result == 0) != 0) {
            result = -1;
        }
        free_waiting(&together.items[i]);
    }
    together.count = 0;
    together.is_asked = false;
    sigprocmask(SIG_SETMASK, &before, NULL);
    return result;
}

int hs_atomic_open(struct hs_atomic_file *f, const char *path)
{
    *f = (struct hs_atomic_file){NULL, NULL, NULL};
    f->temporary = hs_atomic_temporary_name(path);
    if (!f->temporary) {
        return -1;
    }
    f->path = strdup(path);
    if (!f->path) {
        hs_atomic_abort(f);
        return hs_error(path, NULL, "out of memory");
    }
    f->stream = fopen(f->temporary, "wb+");
    if (!f->stream) {
        const int cause = errno;
        hs_atomic_abort(f);
        return cannot_create(path, cause);
    }
    return 0;
}

int hs_atomic_commit(struct hs_atomic_file *f)
{
    const int flush_failed =
        fflush(f->stream) != 0 || ferror(f->stream) || fsync(fileno(f->stream)) != 0;
    const int cause = errno;
    const int close_failed = fclose(f->stream) != 0;
    f->stream = NULL;
    if (flush_failed || close_failed) {
        hs_error(f->path, "free some space and run again", "cannot be written: %s",
                 strerror(flush_failed ? cause : errno));
        hs_atomic_abort(f);
        return -1;
    }
    const int result = hs_atomic_rename(f->temporary, f->path);
    free(f->temporary);
    f->temporary = NULL;
    hs_atomic_abort(f);
    return result;
}

void hs_atomic_abort(struct hs_atomic_file *f)
{
    if (f->stream) {
        fclose(f->stream);
    }
    if (f->temporary) {
        hs_atomic_drop(f->temporary);
    }
    free(f->temporary);
    free(f->path);
    f->stream = NULL;
    f->temporary = NULL;
    f->path = NULL;
}
