#include "recording.h"

#include "report.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

const struct recording_limits recording_usual = {.bytes = UINT64_C(4) << 30,
                                                 .free_bytes = 64 << 20,
                                                 .part_bytes = 16 << 20,
                                                 .ring_bytes = RECORDING_RING_BYTES,
                                                 .check_every = 30};

/* A line fits as a whole, or is lost with all that come after it. */
static void put_line(void *ctx, const char *line, size_t bytes)
{
    struct recording *r = ctx;
    if (r->is_over) {
        return;
    }
    if (r->is_behind || !byte_ring_put(&r->ring, line, bytes)) {
        r->is_behind = true;
        r->count.lines_lost++;
    }
}

static void give_up(struct recording *r, const char *trouble)
{
    r->is_over = true;
    r->trouble = trouble;
}

static uint64_t utc_us(void)
{
    struct timespec t;
    clock_gettime(CLOCK_REALTIME, &t);
    return (uint64_t)t.tv_sec * 1000000u + (uint64_t)t.tv_nsec / 1000u;
}

void recording_open(struct recording *r, const char *folder, const struct recording_limits *limits)
{
    memset(r, 0, sizeof *r);
    r->files.folder_fd = r->files.fd = -1;
    if (folder[0] == '\0') {
        return;
    }
    const int cause = recording_files_open(&r->files, folder, limits, &r->ring);
    r->ring.bytes = calloc(1, limits->ring_bytes);
    r->ring.size = limits->ring_bytes;
    r->is_on = cause == 0 && r->ring.bytes != NULL;
    if (!r->is_on) {
        r->trouble = "not recorded: the folder";
        report(REPORT_ERROR,
               "recording: %s: %s; the flight is not recorded. Make the folder for user "
               "landmass-panel, or set record = none",
               folder, cause != 0 ? strerror(cause) : "out of memory");
    }
}

void recording_begin(struct recording *r, struct lm_board *board, uint64_t now_us)
{
    if (!r->is_on) {
        return;
    }
    if (r->recorder.can != NULL) { /* again: its ports as they were */
        if (board->flash == &r->recorder.flash_of_unit) {
            board->flash = r->recorder.flash;
        }
        board->can = r->recorder.can;
        board->can_2 = r->recorder.can_2;
        board->controls = r->recorder.controls;
        board->display = r->recorder.display;
    }
    atomic_store(&r->ring.head, 0);
    r->is_behind = false;
    const struct record_sink sink = {r, put_line};
    record_begin(&r->recorder, &sink, board, utc_us() - now_us, r->files.limits.check_every);
}

void recording_start(struct recording *r, const char *restart)
{
    if (!r->is_on) {
        return;
    }
    if (restart != NULL) {
        record_restart(&r->recorder, restart);
    }
    const int cause = recording_files_start(&r->files);
    if (cause != 0) {
        give_up(r, "not recorded: the folder");
        report(REPORT_ERROR, "recording: %s: %s; the flight is not recorded", r->files.folder,
               strerror(cause));
    }
}

/* After a loss the lines that wait go first; then there is room for the word that ends it. */
static void end_after_loss(struct recording *r)
{
    if (byte_ring_room(&r->ring) < (size_t)4 * RECORD_LINE_MAX) {
        return;
    }
    r->is_behind = false;
    record_cease(&r->recorder, RECORD_BEHIND, r->count.lines_lost);
    give_up(r, "recording ended: storage too slow");
    report(REPORT_ERROR,
           "recording: %s: %u lines lost, the storage was too slow; the recording ends here, a "
           "restart begins another",
           r->files.folder, r->count.lines_lost);
}

static void begin_part(struct recording *r)
{
    record_flush(&r->recorder);
    const size_t here = atomic_load(&r->ring.head);
    if (!atomic_load(&r->files.may_go_on) || r->part + 1 == RECORDING_PARTS_MAX) {
        record_cease(&r->recorder, RECORD_FULL, 0);
        give_up(r, "recording ended: full");
        report(REPORT_ERROR,
               "recording: %s: this session alone is as long as there is room; the recording ends "
               "here. Raise record.size or free storage; a restart begins another",
               r->files.folder);
        return;
    }
    r->part++;
    r->part_began = here;
    atomic_store(&r->files.cut, here);
    record_part(&r->recorder, r->part);
}

void recording_step(struct recording *r, uint64_t now_us)
{
    if (!r->is_on) {
        return;
    }
    const size_t head = atomic_load(&r->ring.head);
    const size_t waiting = head - atomic_load(&r->ring.tail);
    if (waiting > r->count.waiting_max) {
        r->count.waiting_max = waiting;
    }
    if (!r->is_over && atomic_load(&r->files.is_broken)) {
        give_up(r, "recording ended: storage failed"); /* the thread has reported why */
    }
    if (!r->is_over && r->is_behind) {
        end_after_loss(r);
    } else if (!r->is_over && head - r->part_began >= r->files.limits.part_bytes &&
               atomic_load(&r->files.cut) == 0) {
        begin_part(r);
    }
    record_step(&r->recorder, now_us);
}

void recording_report(const struct recording *r)
{
    if (r->is_on) {
        report(REPORT_INFO,
               "recording: session %u, part %u%s; %u lines lost, most waiting %u KiB, longest sync "
               "%u ms, %u sessions removed",
               r->files.session, r->part, r->is_over ? ", ended" : "", r->count.lines_lost,
               (unsigned)(r->count.waiting_max >> 10),
               atomic_load(&r->files.count.sync_max_us) / 1000,
               atomic_load(&r->files.count.removed));
    }
}

void recording_close(struct recording *r)
{
    if (r->is_on && !r->is_over) {
        record_end(&r->recorder);
    }
    recording_files_close(&r->files);
    free(r->ring.bytes);
    r->ring.bytes = NULL;
    r->is_on = false;
}
