#include "drv/can_log.h"

#include <inttypes.h>
#include <string.h>

/* The longest line that candump writes is 72 characters for classic CAN; FD's are refused anyway.
 */
enum { LINE_BYTES = 256 };

/* Read a line of any length; what does not fit is dropped and *is_whole is false, as it is when the
 * line holds a NUL. Returns false at the end of the file. */
static bool read_line(FILE *lines, char text[LINE_BYTES], bool *is_whole)
{
    size_t length = 0;
    int c = getc(lines);
    if (c == EOF) {
        return false;
    }
    *is_whole = true;
    for (; c != EOF && c != '\n'; c = getc(lines)) {
        if (c == '\0' || length == LINE_BYTES - 1) {
            *is_whole = false;
        } else {
            text[length++] = (char)c;
        }
    }
    text[length] = '\0';
    return true;
}

static void refuse(struct drv_can_log *log, const char *cause)
{
    log->count.malformed++;
    if (log->report != NULL) {
        log->report(log->report_ctx, log->count.lines, cause);
    }
}

/* The log's clock becomes the flight's, which starts at 0 and never goes back. */
static void stamp(struct drv_can_log *log, struct lm_can_frame *frame)
{
    if (!log->has_origin) {
        log->origin_us = frame->time_us;
        log->has_origin = true;
    }
    const uint64_t last_us = log->next.time_us; /* 0 before the first frame */
    if (frame->time_us < log->origin_us + last_us) {
        frame->time_us = last_us;
        log->count.backward++;
    } else {
        frame->time_us -= log->origin_us;
    }
}

/* Fill `next`, or set is_over. */
static int read_next(struct drv_can_log *log)
{
    char text[LINE_BYTES];
    bool is_whole;
    while (read_line(log->lines, text, &is_whole)) {
        struct lm_can_frame frame;
        log->count.lines++;
        const bool is_empty = text[strspn(text, " \t\r")] == '\0';
        if (is_empty && is_whole) {
            continue;
        }
        const char *cause =
            is_whole ? drv_can_log_parse(text, &frame) : "the line is too long, or not text";
        if (cause != NULL) {
            refuse(log, cause);
            continue;
        }
        stamp(log, &frame);
        log->next = frame;
        log->has_next = true;
        return LM_OK;
    }
    log->is_over = true;
    return ferror(log->lines) ? LM_ERR_IO : LM_OK;
}

int drv_can_log_skip(struct drv_can_log *log, uint64_t skip_us)
{
    while (skip_us > 0 && !log->is_over) {
        const int status = read_next(log);
        if (status != LM_OK) {
            return status;
        }
        if (log->has_next && log->next.time_us >= skip_us) {
            log->origin_us += skip_us;
            log->next.time_us -= skip_us;
            return LM_OK;
        }
        log->has_next = false;
    }
    return LM_OK;
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct drv_can_log *log = ctx;
    if (!log->has_next && !log->is_over) {
        const int status = read_next(log);
        if (status != LM_OK) {
            return status;
        }
    }
    if (!log->has_next || log->next.time_us > log->now_us) {
        return 0;
    }
    *frame = log->next;
    log->has_next = false;
    log->count.frames++;
    return 1;
}

void drv_can_log_init(struct drv_can_log *log, FILE *lines, drv_can_log_report *report, void *ctx)
{
    *log = (struct drv_can_log){.lines = lines, .report = report, .report_ctx = ctx};
}

void drv_can_log_set_now(struct drv_can_log *log, uint64_t now_us)
{
    log->now_us = now_us;
}

struct lm_can drv_can_log_port(struct drv_can_log *log)
{
    return (struct lm_can){.ctx = log, .receive = receive};
}

bool drv_can_log_is_over(const struct drv_can_log *log)
{
    return log->is_over;
}

int drv_can_log_write(FILE *out, const char *interface, uint64_t time_us,
                      const struct lm_can_frame *frame)
{
    fprintf(out, "(%" PRIu64 ".%06u) %s %0*" PRIX32 "#", time_us / 1000000,
            (unsigned)(time_us % 1000000), interface, frame->is_extended ? 8 : 3, frame->id);
    for (uint32_t i = 0; i < frame->length; i++) {
        fprintf(out, "%02X", frame->data[i]);
    }
    fputc('\n', out);
    return ferror(out) ? LM_ERR_IO : LM_OK;
}
