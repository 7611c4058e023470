#include "faults_file.h"

#include "hs/durable_file.h"
#include "report.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* Whether these are lines of ours: printable, none too long, ended. The number of lines, or -1. */
static int count_lines(const char *text, size_t size)
{
    int lines = 0;
    for (size_t i = 0, length = 0; i < size; i++) {
        length = text[i] == '\n' ? 0 : length + 1;
        lines += text[i] == '\n';
        if (length >= FAULTS_LINE_BYTES || (text[i] != '\n' && (text[i] < ' ' || text[i] > '~'))) {
            return -1;
        }
    }
    return size > 0 && text[size - 1] != '\n' ? -1 : lines > FAULTS_LINES ? -1 : lines;
}

static void read_before(struct faults_file *f)
{
    char text[FAULTS_BYTES + 1];
    const int fd = open(f->path, O_RDONLY | O_CLOEXEC);
    const ssize_t size = fd >= 0 ? read(fd, text, sizeof text) : 0;
    if (fd >= 0) {
        close(fd);
    }
    const int lines = size < 0 || size > FAULTS_BYTES ? -1 : count_lines(text, (size_t)size);
    if (lines < 0) {
        report(REPORT_ERROR, "faults: %s: no list of faults, or a damaged one; it begins anew",
               f->path);
        return;
    }
    memcpy(f->text, text, (size_t)size);
    f->size = (size_t)size;
    if (lines > 0) {
        size_t last = f->size - 1;
        while (last > 0 && text[last - 1] != '\n') {
            last--;
        }
        report(REPORT_INFO, "faults: %s: %d of before; the last: %.*s", f->path, lines,
               (int)(f->size - 1 - last), text + last);
    }
}

/* Put a fault behind the others; the oldest goes where there is no room. */
static void append(struct faults_file *f, const struct lm_fault *fault, time_t rose)
{
    char line[FAULTS_LINE_BYTES], when[32] = "";
    struct tm utc;
    if (gmtime_r(&rose, &utc) != NULL) {
        strftime(when, sizeof when, "%Y-%m-%dT%H:%M:%SZ", &utc);
    }
    const int length =
        snprintf(line, sizeof line, "%.20s +%llu s %.16s\n", when,
                 (unsigned long long)(fault->time_us / 1000000), lm_flag_word(fault->flag));
    while (count_lines(f->text, f->size) >= FAULTS_LINES) {
        const char *end = memchr(f->text, '\n', f->size);
        const size_t gone = (size_t)(end - f->text) + 1;
        f->size -= gone;
        memmove(f->text, f->text + gone, f->size);
    }
    memcpy(f->text + f->size, line, (size_t)length);
    f->size += (size_t)length;
}

static void write_file(struct faults_file *f)
{
    const int cause = hs_replace_file(f->path, f->text, f->size, 0640);
    if (cause != 0 && !f->is_failing) {
        report(REPORT_ERROR, "faults: %s: %s; they are lost with the power", f->path,
               strerror(cause));
    }
    f->is_failing = cause != 0;
}

static void take(void *ctx)
{
    struct faults_file *f = ctx;
    f->taken = f->handed;
}

/* The faults that the text lacks. Of more than the log keeps at once the oldest are not known. */
static void write_news(void *ctx)
{
    struct faults_file *f = ctx;
    const struct lm_fault_log *log = &f->taken.log;
    const time_t now = time(NULL);
    uint32_t age = log->count - f->written;
    f->written = log->count;
    for (age = age < LM_FAULTS_KEPT ? age : LM_FAULTS_KEPT; age > 0; age--) {
        const struct lm_fault *fault = lm_fault_log_at(log, age - 1);
        append(f, fault, now - (time_t)((f->taken.now_us - fault->time_us) / 1000000));
    }
    write_file(f);
}

void faults_file_start(struct faults_file *f, const char *path)
{
    memset(f, 0, sizeof *f);
    f->path = path;
    if (path[0] != '\0') {
        read_before(f);
        hand_over_start(&f->writer, "faults", &(struct hand_over_work){f, take, write_news});
    }
}

void faults_file_keep(struct faults_file *f, const struct lm_fault_log *log, uint64_t now_us)
{
    if (log->count != f->told && hand_over_begin(&f->writer)) {
        f->handed = (struct faults_news){*log, now_us};
        f->told = log->count;
        hand_over_end(&f->writer);
    }
}

void faults_file_close(struct faults_file *f)
{
    hand_over_close(&f->writer);
}
