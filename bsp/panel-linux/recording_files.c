#include "recording_files.h"

#include "hs/real_time.h"
#include "report.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <time.h>
#include <unistd.h>

enum { STACK_BYTES = 128 << 10, NAME_BYTES = 48, NO_SESSION = UINT32_MAX };

static const char link_name[] = "current.log";

static uint64_t now_us(void)
{
    return (uint64_t)hs_clock_us(CLOCK_MONOTONIC);
}

static void name_part(char name[NAME_BYTES], uint32_t session, uint32_t part)
{
    snprintf(name, NAME_BYTES, "flight-%05u-%03u.log", session, part);
}

/* The session of a file's name, or NO_SESSION. */
static uint32_t session_of(const char *name)
{
    unsigned session, part;
    char again[NAME_BYTES];
    if (sscanf(name, "flight-%9u-%3u.log", &session, &part) != 2) {
        return NO_SESSION;
    }
    name_part(again, session, part);
    return strcmp(name, again) == 0 ? session : NO_SESSION;
}

/* ---- what is in the folder ---- */

struct stock {
    uint64_t bytes;          /* of all parts */
    uint32_t files;          /* parts */
    uint32_t oldest, newest; /* sessions; NO_SESSION: there is none */
};

/* The folder's entries; NULL with errno. */
static DIR *list(const struct recording_files *f)
{
    const int fd = openat(f->folder_fd, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *entries = fd >= 0 ? fdopendir(fd) : NULL;
    if (entries == NULL && fd >= 0) {
        close(fd);
    }
    return entries;
}

static struct stock take_stock(const struct recording_files *f)
{
    struct stock s = {.oldest = NO_SESSION, .newest = NO_SESSION};
    DIR *entries = list(f);
    for (const struct dirent *e; entries != NULL && (e = readdir(entries)) != NULL;) {
        struct stat about;
        const uint32_t session = session_of(e->d_name);
        if (session == NO_SESSION ||
            fstatat(f->folder_fd, e->d_name, &about, AT_SYMLINK_NOFOLLOW) != 0) {
            continue;
        }
        s.bytes += (uint64_t)about.st_size;
        s.files++;
        s.oldest = session < s.oldest ? session : s.oldest;
        s.newest = s.newest == NO_SESSION || session > s.newest ? session : s.newest;
    }
    if (entries != NULL) {
        closedir(entries);
    }
    return s;
}

/* Remove every part of a session. False if none could be. */
static bool remove_session(struct recording_files *f, uint32_t session)
{
    uint32_t removed = 0;
    DIR *entries = list(f);
    for (const struct dirent *e; entries != NULL && (e = readdir(entries)) != NULL;) {
        if (session_of(e->d_name) == session) {
            removed += unlinkat(f->folder_fd, e->d_name, 0) == 0;
        }
    }
    if (entries != NULL) {
        closedir(entries);
    }
    if (removed > 0) {
        atomic_fetch_add(&f->count.removed, 1);
        report(REPORT_INFO, "recording: session %05u removed, %u parts", session, removed);
    }
    return removed > 0;
}

static bool is_room(const struct recording_files *f, const struct stock *s, uint64_t wanted)
{
    struct statvfs about;
    const bool is_known = fstatvfs(f->folder_fd, &about) == 0;
    const uint64_t available = is_known ? (uint64_t)about.f_bavail * about.f_frsize : UINT64_MAX;
    return s->files < RECORDING_FILES_MAX && s->bytes + wanted <= f->limits.bytes &&
           f->limits.free_bytes + wanted <= available;
}

/* Remove the oldest sessions until there is room. False if the present one alone has too little. */
static bool make_room(struct recording_files *f, uint64_t wanted)
{
    for (;;) {
        const struct stock s = take_stock(f);
        if (is_room(f, &s, wanted)) {
            return true;
        }
        if (s.oldest == NO_SESSION || s.oldest == f->session || !remove_session(f, s.oldest)) {
            return false;
        }
    }
}

/* ---- parts ---- */

/* The link is exchanged in one go: whoever reads it finds the part before or this one. */
static void link_current(const struct recording_files *f, const char *name)
{
    static const char fresh[] = "current.log.new";
    (void)unlinkat(f->folder_fd, fresh, 0);
    if (symlinkat(name, f->folder_fd, fresh) == 0 &&
        renameat(f->folder_fd, fresh, f->folder_fd, link_name) == 0) {
        return;
    }
    report(REPORT_WARNING, "recording: %s/%s: %s", f->folder, link_name, strerror(errno));
}

/* Members of the panel's group may read it. Returns 0 or errno. */
static int open_part(struct recording_files *f, uint32_t part)
{
    char name[NAME_BYTES];
    name_part(name, f->session, part);
    f->fd = openat(f->folder_fd, name,
                   O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC | O_APPEND, 0640);
    if (f->fd < 0) {
        return errno;
    }
    (void)fchmod(f->fd, 0640);
    f->part = part;
    link_current(f, name);
    (void)fsync(f->folder_fd);
    return 0;
}

/* Bring to the medium what was written. Returns 0 or errno. A file system that cannot be asked for
 * it (EINVAL) does what it does. */
static int sync_part(struct recording_files *f)
{
    const uint64_t began_us = now_us();
    const int cause = f->is_dirty && fdatasync(f->fd) != 0 && errno != EINVAL ? errno : 0;
    f->is_dirty = false;
    f->synced_us = now_us();
    const unsigned took_us = (unsigned)(f->synced_us - began_us);
    if (took_us > atomic_load(&f->count.sync_max_us)) {
        atomic_store(&f->count.sync_max_us, took_us);
    }
    return cause;
}

static int next_part(struct recording_files *f)
{
    const int cause = sync_part(f);
    close(f->fd);
    f->fd = -1;
    const int next = cause == 0 ? open_part(f, f->part + 1) : cause;
    atomic_store(&f->may_go_on, make_room(f, 2 * (uint64_t)f->limits.part_bytes));
    return next;
}

/* A full disk gives up the oldest sessions. Returns 0 or errno. */
static int write_all(struct recording_files *f, const uint8_t *bytes, size_t count)
{
    while (count > 0) {
        const ssize_t wrote = write(f->fd, bytes, count);
        if (wrote >= 0) {
            f->is_dirty = true;
            bytes += wrote;
            count -= (size_t)wrote;
            continue;
        }
        const int cause = errno;
        const struct stock s = cause == ENOSPC ? take_stock(f) : (struct stock){0};
        if (cause != EINTR &&
            (cause != ENOSPC || s.oldest == f->session || !remove_session(f, s.oldest))) {
            return cause;
        }
    }
    return 0;
}

/* What waits in the ring, up to a cut. The cut is looked at after the bytes: those behind it were
 * put in after it. Returns 0 or errno. */
static int write_waiting(struct recording_files *f)
{
    const uint8_t *bytes;
    size_t count;
    while ((count = byte_ring_peek(f->ring, &bytes)) > 0) {
        const size_t cut = atomic_load(&f->cut), here = atomic_load(&f->ring->tail);
        if (cut != 0 && cut == here) {
            const int cause = next_part(f);
            if (cause != 0) {
                return cause;
            }
            atomic_store(&f->cut, 0);
        } else if (cut != 0 && count > cut - here) {
            count = cut - here;
        }
        const int cause = write_all(f, bytes, count);
        if (cause != 0) {
            return cause;
        }
        byte_ring_drop(f->ring, count);
    }
    return 0;
}

static void *run(void *argument)
{
    struct recording_files *f = argument;
    const struct timespec rest = {.tv_nsec = RECORDING_REST_US * 1000};
    for (bool is_last = false; !is_last; nanosleep(&rest, NULL)) {
        is_last = atomic_load(&f->is_closing);
        int cause = write_waiting(f);
        if (cause == 0 && (is_last || now_us() - f->synced_us >= RECORDING_SYNC_US)) {
            cause = sync_part(f);
        }
        if (cause != 0) {
            report(REPORT_ERROR,
                   "recording: %s: session %05u: %s; the recording ends here, a restart begins "
                   "another",
                   f->folder, f->session, strerror(cause));
            atomic_store(&f->is_broken, true);
            return NULL;
        }
        if (is_last) {
            return NULL;
        }
    }
    return NULL;
}

/* ---- open, start, close ---- */

int recording_files_open(struct recording_files *f, const char *folder,
                         const struct recording_limits *limits, struct byte_ring *ring)
{
    snprintf(f->folder, sizeof f->folder, "%s", folder);
    f->limits = *limits;
    f->ring = ring;
    f->session = NO_SESSION;
    if (mkdir(folder, 0750) == 0) {
        (void)chmod(folder, 0750); /* whatever the mask of the process */
    } else if (errno != EEXIST) {
        return errno;
    }
    f->folder_fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (f->folder_fd < 0) {
        return errno;
    }
    return faccessat(f->folder_fd, ".", W_OK | X_OK, 0) == 0 ? 0 : errno;
}

int recording_files_start(struct recording_files *f)
{
    const struct stock s = take_stock(f);
    f->session = s.newest == NO_SESSION ? 1 : s.newest + 1;
    if (!make_room(f, f->limits.part_bytes)) {
        return ENOSPC;
    }
    int cause = open_part(f, 0);
    if (cause != 0) {
        return cause;
    }
    atomic_store(&f->may_go_on, make_room(f, 2 * (uint64_t)f->limits.part_bytes));
    report(REPORT_NOTICE, "recording: %s/flight-%05u-000.log", f->folder, f->session);
    pthread_attr_t attributes;
    cause = pthread_attr_init(&attributes);
    if (cause == 0) {
        pthread_attr_setstacksize(&attributes, STACK_BYTES);
        cause = pthread_create(&f->thread, &attributes, run, f);
        pthread_attr_destroy(&attributes);
    }
    f->has_thread = cause == 0;
    return cause;
}

void recording_files_close(struct recording_files *f)
{
    if (f->has_thread) {
        atomic_store(&f->is_closing, true);
        pthread_join(f->thread, NULL);
        f->has_thread = false;
    }
    if (f->fd >= 0) {
        close(f->fd);
    }
    if (f->folder_fd >= 0) {
        close(f->folder_fd);
    }
    f->fd = f->folder_fd = -1;
}
