/* Freestanding: a replay reads such lines where there is no C library. */
#include "drv/can_line.h"

#include <stddef.h>

static const char *skip_spaces(const char *c)
{
    while (*c == ' ' || *c == '\t') {
        c++;
    }
    return c;
}

static int digit_value(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : -1;
}

static int hex_value(char c)
{
    return c >= 'A' && c <= 'F'   ? c - 'A' + 10
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                  : digit_value(c);
}

/* "(seconds.decimals)" at *text, which moves past it. Up to 12 digits of seconds, so that
 * microseconds fit. */
static bool parse_time(const char **text, uint64_t *time_us)
{
    const char *c = *text;
    uint64_t us = 0;
    int digits = 0, decimals = 0;
    if (*c++ != '(') {
        return false;
    }
    for (; digit_value(*c) >= 0; c++, digits++) {
        us = us * 10 + (uint64_t)digit_value(*c);
        if (digits >= 12) {
            return false;
        }
    }
    if (digits == 0 || *c++ != '.') {
        return false;
    }
    for (; digit_value(*c) >= 0; c++, decimals++) {
        if (decimals < 6) {
            us = us * 10 + (uint64_t)digit_value(*c);
        }
    }
    if (decimals < 6 || *c++ != ')') {
        return false;
    }
    *time_us = us;
    *text = c;
    return true;
}

/* The identifier before '#', which *text moves to. */
static const char *parse_identifier(const char **text, struct lm_can_frame *frame)
{
    const char *c = *text;
    uint32_t id = 0;
    int digits = 0;
    for (; hex_value(*c) >= 0 && digits <= 8; c++, digits++) {
        id = id << 4 | (uint32_t)hex_value(*c);
    }
    if (*c != '#' || (digits != 3 && digits != 8)) {
        return "the identifier is not 3 or 8 hexadecimal digits before a '#'";
    }
    frame->is_error = digits == 8 && (id & 0x20000000u) != 0;
    frame->is_extended = digits == 8 && !frame->is_error;
    frame->id = frame->is_error ? id & 0x1fffffffu : id;
    if (frame->id > (digits == 3 ? 0x7ffu : 0x1fffffffu)) {
        return "the identifier has more than 11 or 29 bits";
    }
    *text = c;
    return NULL;
}

/* What follows '#'. */
static const char *parse_data(const char **text, struct lm_can_frame *frame)
{
    const char *c = *text;
    if (*c == '#') {
        return "a CAN FD frame; only classic frames are understood";
    }
    if (*c == 'R') {
        frame->is_remote = true;
        c++;
        if (digit_value(*c) >= 0 && digit_value(*c) <= 8) {
            frame->length = (uint8_t)digit_value(*c++);
        }
        *text = c;
        return NULL;
    }
    for (; hex_value(c[0]) >= 0 && hex_value(c[1]) >= 0; c += 2) {
        if (frame->length == 8) {
            return "more than 8 data bytes";
        }
        frame->data[frame->length++] = (uint8_t)(hex_value(c[0]) << 4 | hex_value(c[1]));
    }
    if (hex_value(c[0]) >= 0) {
        return "half a data byte";
    }
    *text = c;
    return NULL;
}

/* Spaces, and the end of a line from another system. */
static const char *skip_ends(const char *c)
{
    while (*c == ' ' || *c == '\t' || *c == '\r') {
        c++;
    }
    return c;
}

/* Nothing but spaces and perhaps the direction. */
static bool is_end(const char *c)
{
    c = skip_ends(c);
    if (*c == 'R' || *c == 'T') {
        c++;
    }
    return *skip_ends(c) == '\0';
}

const char *drv_can_log_parse(const char *line, struct lm_can_frame *frame)
{
    *frame = (struct lm_can_frame){0};
    const char *c = skip_spaces(line);
    if (!parse_time(&c, &frame->time_us)) {
        return "no time stamp such as (1436509052.249713); written by candump without -L?";
    }
    const char *name = skip_spaces(c), *end = name;
    while (*end != '\0' && *end != ' ' && *end != '\t' && *end != '\r' && *end != '#') {
        end++;
    }
    const bool has_name = name != c && end != name && skip_spaces(end) != end;
    c = skip_spaces(end);
    if (!has_name) {
        return "no interface name between the time and the frame";
    }
    const char *cause = parse_identifier(&c, frame);
    if (cause != NULL) {
        return cause;
    }
    c++;
    cause = parse_data(&c, frame);
    if (cause != NULL) {
        return cause;
    }
    return is_end(c) ? NULL : "something follows the frame";
}
