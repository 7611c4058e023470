#include "ios/recordings.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { END_BYTES = 4096 };

static const char SUFFIX[] = ".log", CURRENT[] = "current.log";

static int open_plain(const char *folder, const char *name)
{
    char path[4096];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    return length > 0 && (size_t)length < sizeof path
               ? open(path, O_RDONLY | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK)
               : -1;
}

/* Seconds of a line "(1436509052.249713) ..."; 0: it is none. */
static double time_of(const char *line)
{
    char *end = NULL;
    const double seconds = line[0] == '(' ? strtod(line + 1, &end) : 0;
    return end != NULL && *end == ')' && seconds > 0 ? seconds : 0;
}

/* Times of the first and the last whole line. */
static void read_times(int fd, struct ios_recording *r)
{
    char text[END_BYTES + 1];
    const ssize_t head = pread(fd, text, END_BYTES, 0);
    if (head <= 0) {
        return;
    }
    text[head] = '\0';
    r->start_s = time_of(text);
    const uint64_t from = r->bytes > END_BYTES ? r->bytes - END_BYTES : 0;
    const ssize_t length = pread(fd, text, END_BYTES, (off_t)from);
    double last_s = r->start_s;
    text[length > 0 ? length : 0] = '\0';
    for (const char *at = strchr(text, '\n'); at != NULL; at = strchr(at + 1, '\n')) {
        const double seconds = time_of(at + 1);
        last_s = seconds > last_s ? seconds : last_s;
    }
    r->seconds = last_s - r->start_s;
}

static bool is_log(const char *name)
{
    const size_t length = strlen(name), suffix = sizeof SUFFIX - 1;
    return length > suffix && strcmp(name + length - suffix, SUFFIX) == 0 &&
           strcmp(name, CURRENT) != 0 && ios_name_is_plain(name, length);
}

static bool read_one(const char *folder, const char *prefix, const char *name,
                     struct ios_recording *r)
{
    *r = (struct ios_recording){0};
    const int fd = is_log(name) ? open_plain(folder, name) : -1;
    if (fd < 0) {
        return false;
    }
    struct stat status;
    const bool is_file = fstat(fd, &status) == 0 && S_ISREG(status.st_mode);
    if (is_file) {
        snprintf(r->name, sizeof r->name, "%.100s%.64s", prefix, name);
        r->bytes = (uint64_t)status.st_size;
        read_times(fd, r);
    }
    close(fd);
    return is_file;
}

static int by_name(const void *a, const void *b)
{
    const struct ios_recording *x = a, *y = b;
    return strcmp(x->name, y->name);
}

int ios_recordings(const char *folder, const char *prefix, struct ios_recording *list, int room)
{
    DIR *d = opendir(folder);
    int count = 0;
    if (d == NULL) {
        return 0;
    }
    for (const struct dirent *e = readdir(d); e != NULL && count < room; e = readdir(d)) {
        count += read_one(folder, prefix, e->d_name, &list[count]);
    }
    closedir(d);
    qsort(list, (size_t)count, sizeof *list, by_name);
    return count;
}

bool ios_recording_now(const char *folder, char name[IOS_NAME_MAX + 1])
{
    char path[4096];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, CURRENT);
    if (length < 0 || (size_t)length >= sizeof path) {
        return false;
    }
    const ssize_t bytes = readlink(path, name, IOS_NAME_MAX);
    name[bytes > 0 ? bytes : 0] = '\0';
    return bytes > 0 && is_log(name);
}

/* ---- following ---- */

static int open_part(const struct ios_follow *f, int part)
{
    char name[IOS_NAME_MAX + 24];
    snprintf(name, sizeof name, "%s-%03u%s", f->session, (unsigned)part % 1000000, SUFFIX);
    return open_plain(f->folder, name);
}

/* "flight-00042" of "flight-00042-003.log". */
static bool session_now(const char *folder, char session[IOS_NAME_MAX + 1])
{
    if (!ios_recording_now(folder, session)) {
        return false;
    }
    char *dash = strrchr(session, '-');
    if (dash == NULL || strspn(dash + 1, "0123456789") < 3 || strcspn(dash, ".") < 4) {
        return false;
    }
    *dash = '\0';
    return true;
}

bool ios_follow_open(struct ios_follow *f, const char *folder)
{
    *f = (struct ios_follow){.folder = folder, .fd = -1};
    f->fd = session_now(folder, f->session) ? open_part(f, 0) : -1;
    return f->fd >= 0;
}

void ios_follow_close(struct ios_follow *f)
{
    if (f->fd >= 0) {
        close(f->fd);
    }
    f->fd = -1;
}

/* What the part has from `at` on, up to its last line feed. */
static long read_lines(struct ios_follow *f, char *to, size_t room)
{
    ssize_t length = pread(f->fd, to, room, (off_t)f->at);
    if (length < 0) {
        return -1;
    }
    const bool is_full = (size_t)length == room;
    while (length > 0 && to[length - 1] != '\n') {
        length--;
    }
    f->at += (uint64_t)length;
    return length == 0 && is_full ? -1 : length; /* a line without an end is none of a recorder */
}

long ios_follow_take(struct ios_follow *f, char *to, size_t room)
{
    if (f->fd < 0) {
        return -1;
    }
    const int next = open_part(f, f->part + 1); /* where there is one, this part is whole */
    const long length = read_lines(f, to, room);
    if (next >= 0 && length == 0) {
        close(f->fd);
        f->fd = next;
        f->part++;
        f->at = 0;
        return read_lines(f, to, room);
    }
    if (next >= 0) {
        close(next);
    }
    char session[IOS_NAME_MAX + 1];
    const bool is_over =
        length == 0 && session_now(f->folder, session) && strcmp(session, f->session) != 0;
    return is_over ? -1 : length;
}
