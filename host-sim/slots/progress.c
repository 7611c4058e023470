#include "slots/progress.h"

#include "hs/durable_file.h"
#include "hs/real_time.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

enum { LINE_BYTES = 33, FILE_MODE = 0644 };

static const char *const words[LM_LOADS] = {[LM_LOAD_NONE] = "none",
                                            [LM_LOAD_RUNS] = "runs",
                                            [LM_LOAD_DONE] = "done",
                                            [LM_LOAD_FAILED] = "fail"};

static uint64_t monotonic_ms(void)
{
    return (uint64_t)hs_clock_us(CLOCK_MONOTONIC) / 1000u;
}

/* The line is as long as the one before, so that one write replaces it. */
static void tell(const struct slot_teller *t, enum lm_load load, int32_t percent)
{
    char line[64];
    const int length = snprintf(line, sizeof line, "LMLOAD %s %03" PRId32 " %016" PRIu64 "\n",
                                words[load], percent, monotonic_ms());
    if (t->fd >= 0 && length == LINE_BYTES) {
        (void)!pwrite(t->fd, line, LINE_BYTES, 0); /* the load does not depend on it */
    }
}

void slot_teller_open(struct slot_teller *t, const char *path)
{
    struct stat about;
    *t = (struct slot_teller){.fd = -1, .percent = -1};
    if (path[0] == '\0') {
        return;
    }
    t->fd = open(path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, FILE_MODE);
    if (t->fd >= 0 && (fstat(t->fd, &about) != 0 || !S_ISREG(about.st_mode) ||
                       about.st_nlink != 1 || flock(t->fd, LOCK_EX | LOCK_NB) != 0)) {
        close(t->fd);
        t->fd = -1;
    }
    if (t->fd >= 0) {
        hs_give_to_owner(t->fd, path, FILE_MODE); /* the panel's user may tell the next load */
        (void)!ftruncate(t->fd, 0);
    }
    slot_teller_run(t, 0);
}

void slot_teller_run(struct slot_teller *t, int32_t percent)
{
    if (percent != t->percent && percent >= 0 && percent <= 100) {
        tell(t, LM_LOAD_RUNS, percent);
        t->percent = percent;
    }
}

void slot_teller_end(struct slot_teller *t, enum lm_load how)
{
    if (t->fd >= 0) {
        tell(t, how, t->percent);
        close(t->fd);
        t->fd = -1;
    }
}

struct line {
    enum lm_load load;
    int32_t percent;
    uint64_t time_ms;
};

static bool read_number(const char *digits, uint32_t count, uint64_t *value)
{
    *value = 0;
    for (uint32_t i = 0; i < count; i++) {
        if (digits[i] < '0' || digits[i] > '9') {
            return false;
        }
        *value = *value * 10 + (uint64_t)(digits[i] - '0');
    }
    return true;
}

static bool read_line(struct line *l, const char text[LINE_BYTES])
{
    uint64_t percent;
    if (memcmp(text, "LMLOAD ", 7) != 0 || text[11] != ' ' || text[15] != ' ' ||
        text[LINE_BYTES - 1] != '\n' || !read_number(text + 12, 3, &percent) || percent > 100 ||
        !read_number(text + 16, 16, &l->time_ms)) {
        return false;
    }
    l->percent = (int32_t)percent;
    for (int i = LM_LOAD_RUNS; i < LM_LOADS; i++) {
        if (memcmp(text + 7, words[i], 4) == 0) {
            l->load = (enum lm_load)i;
            return true;
        }
    }
    return false;
}

/* Before the line is read: a loader that ends between the two has said how. */
static bool has_loader(int fd)
{
    const bool is_free = flock(fd, LOCK_SH | LOCK_NB) == 0;
    if (is_free) {
        (void)flock(fd, LOCK_UN);
    }
    return !is_free;
}

static void take(struct lm_slots_state *state, const struct line *l, bool is_alive,
                 uint64_t since_ms)
{
    const bool is_cut = l->load == LM_LOAD_RUNS && !is_alive;
    const bool is_old = !is_alive && l->time_ms < since_ms;
    if (is_old) {
        state->load = LM_LOAD_NONE;
    } else {
        state->load = (int32_t)(is_cut ? LM_LOAD_FAILED : l->load);
    }
    state->percent = is_old ? 0 : l->percent;
}

bool slot_progress_read(const char *path, uint64_t since_ms, struct lm_slots_state *state)
{
    char text[LINE_BYTES];
    struct line line;
    struct stat about;
    const int fd =
        path[0] == '\0' ? -1 : open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
    if (fd < 0) {
        const bool is_none = path[0] == '\0' || errno == ENOENT;
        if (is_none) {
            state->load = LM_LOAD_NONE;
            state->percent = 0;
        }
        return is_none;
    }
    bool is_told = fstat(fd, &about) == 0 && S_ISREG(about.st_mode);
    const bool is_alive = is_told && has_loader(fd);
    is_told = is_told && pread(fd, text, sizeof text, 0) == LINE_BYTES && read_line(&line, text);
    close(fd);
    if (is_told) {
        take(state, &line, is_alive, since_ms);
    }
    return is_told;
}
