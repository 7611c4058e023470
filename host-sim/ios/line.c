#include "ios/line.h"

#include "drv/can_log.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

enum {
    CONTROL_FIRST = 1530,
    CONTROL_LAST = 1549,
    EXERCISE_FIRST = 1800,
    EXERCISE_LAST = 1829,
    CONTROLS = CONTROL_LAST - CONTROL_FIRST + 1,
    CANAS_HEAD_BYTES = 4
};
_Static_assert(CONTROLS + EXERCISE_LAST - EXERCISE_FIRST + 1 == IOS_INSTRUCTOR_IDS,
               "a slot for each identifier");

int ios_instructor_slot(const struct lm_can_frame *frame)
{
    const uint32_t id = frame->id;
    if (frame->is_extended || frame->is_remote || frame->is_error) {
        return -1;
    }
    if (id >= CONTROL_FIRST && id <= CONTROL_LAST) {
        return (int)id - CONTROL_FIRST;
    }
    return id >= EXERCISE_FIRST && id <= EXERCISE_LAST ? CONTROLS + (int)id - EXERCISE_FIRST : -1;
}

const char *ios_line_read(const char *line, size_t length, struct lm_can_frame *frame)
{
    char text[IOS_LINE_MAX];
    if (length >= sizeof text) {
        return "a line is longer than a frame";
    }
    memcpy(text, line, length);
    text[length] = '\0';
    if (strlen(text) != length) {
        return "a line has a zero byte";
    }
    const char *cause = drv_can_log_parse(text, frame);
    if (cause != NULL) {
        return cause;
    }
    if (frame->is_remote || frame->is_error) {
        return "is no data frame";
    }
    if (frame->length < CANAS_HEAD_BYTES) {
        return "is shorter than the head of a CANaerospace frame";
    }
    frame->time_us = 0;
    return NULL;
}

size_t ios_line_write(char line[IOS_LINE_MAX], const char *iface, uint64_t time_us,
                      const struct lm_can_frame *frame)
{
    static const char digit[] = "0123456789ABCDEF";
    const int head = snprintf(line, IOS_LINE_MAX, "(%" PRIu64 ".%06u) %.*s %0*" PRIX32 "#",
                              time_us / 1000000, (unsigned)(time_us % 1000000), IOS_IFACE_MAX,
                              iface, frame->is_extended || frame->is_error ? 8 : 3,
                              frame->id | (frame->is_error ? UINT32_C(0x20000000) : 0));
    /* At most 14 + 8 + 4 digits and signs, the name, 9 of the identifier, and then 16 + 2. */
    char *at = line + head;
    if (frame->is_remote) {
        *at++ = 'R';
    }
    for (unsigned i = 0; i < frame->length && i < 8 && !frame->is_remote; i++) {
        *at++ = digit[frame->data[i] >> 4];
        *at++ = digit[frame->data[i] & 15];
    }
    *at++ = '\n';
    *at = '\0';
    return (size_t)(at - line);
}
