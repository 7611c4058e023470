#include "hs/atomic_file.h"
#include "hs/error.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

char *hs_atomic_temporary_name(const char *path)
{
    char *name = NULL;
    /* The extension stays last: some writers choose their format by it. */
    const char *slash = strrchr(path, '/');
    const int folder = slash ? (int)(slash - path) + 1 : 0;
    if (asprintf(&name, "%.*s.unfinished-%ld-%s", folder, path, (long)getpid(), path + folder) <
        0) {
        return NULL;
    }
    return name;
}

/* A device, a pipe or a folder: renaming over it would destroy it. */
static int is_special(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && !S_ISREG(status.st_mode);
}

static int refuse_special(const char *path)
{
    return hs_error(path, "name an ordinary file", "exists and is no ordinary file");
}

int hs_atomic_rename(const char *temporary, const char *path)
{
    if (is_special(path)) {
        unlink(temporary);
        return refuse_special(path);
    }
    if (rename(temporary, path) == 0) {
        return 0;
    }
    const int cause = errno;
    unlink(temporary);
    return hs_error(path, "choose another output name or folder", "cannot be put in place: %s",
                    strerror(cause));
}

int hs_atomic_open(struct hs_atomic_file *f, const char *path)
{
    *f = (struct hs_atomic_file){NULL, NULL, NULL};
    if (is_special(path)) {
        return refuse_special(path);
    }
    f->path = strdup(path);
    f->temporary = hs_atomic_temporary_name(path);
    if (!f->path || !f->temporary) {
        hs_atomic_abort(f);
        return hs_error(path, NULL, "out of memory");
    }
    f->stream = fopen(f->temporary, "wb+");
    if (!f->stream) {
        const int cause = errno;
        hs_atomic_abort(f);
        return hs_error(path, "check that the folder exists and can be written",
                        "cannot be created: %s", strerror(cause));
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
        unlink(f->temporary);
    }
    free(f->temporary);
    free(f->path);
    f->stream = NULL;
    f->temporary = NULL;
    f->path = NULL;
}
