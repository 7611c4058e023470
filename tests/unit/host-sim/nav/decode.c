#include "decode.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

static int hex_value(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

static bool read_digits(const char **p, int least, int most, int64_t *value)
{
    int n = 0;
    for (*value = 0; n < most && isdigit((unsigned char)**p); n++, (*p)++) {
        *value = 10 * *value + (**p - '0');
    }
    return n >= least;
}

static bool read_data(const char *p, struct decoded_frame *f)
{
    for (f->length = 0; p[0] != '\0' && p[0] != '\n'; p += 2, f->length++) {
        if (f->length == 8 || hex_value(p[0]) < 0 || hex_value(p[1]) < 0) {
            return false;
        }
        f->data[f->length] = (uint8_t)(16 * hex_value(p[0]) + hex_value(p[1]));
    }
    return true;
}

bool decode_line(const char *line, struct decoded_frame *f)
{
    int64_t seconds, micros;
    const char *p = line;
    if (*p++ != '(' || !read_digits(&p, 1, 12, &seconds) || *p++ != '.' ||
        !read_digits(&p, 6, 6, &micros) || *p++ != ')' || *p++ != ' ') {
        return false;
    }
    f->time_us = seconds * 1000000 + micros;
    const size_t name = strcspn(p, " ");
    if (name == 0 || name > 15 || p[name] != ' ') {
        return false;
    }
    memcpy(f->interface, p, name);
    f->interface[name] = '\0';
    p += name + 1;
    const size_t digits = strcspn(p, "#");
    if (digits != 3 && digits != 8) {
        return false;
    }
    f->is_extended = digits == 8;
    f->id = 0;
    for (size_t i = 0; i < digits; i++) {
        if (hex_value(p[i]) < 0) {
            return false;
        }
        f->id = 16 * f->id + (uint32_t)hex_value(p[i]);
    }
    return p[digits] == '#' && read_data(p + digits + 1, f);
}

uint32_t decode_word(const struct decoded_frame *f)
{
    return (uint32_t)f->data[4] << 24 | (uint32_t)f->data[5] << 16 | (uint32_t)f->data[6] << 8 |
           f->data[7];
}

bool decode_float(const struct decoded_frame *f, double *value)
{
    const uint32_t bits = decode_word(f);
    float narrow;
    memcpy(&narrow, &bits, sizeof narrow);
    *value = (double)narrow;
    return f->length == 8 && f->data[1] == 2;
}

bool decode_long(const struct decoded_frame *f, int32_t *value)
{
    const uint32_t bits = decode_word(f);
    memcpy(value, &bits, sizeof *value);
    return f->length == 8 && f->data[1] == 3;
}

bool decode_pair(const struct decoded_frame *high, const struct decoded_frame *low, double *value)
{
    const uint64_t bits = (uint64_t)decode_word(high) << 32 | decode_word(low);
    memcpy(value, &bits, sizeof *value);
    return high->length == 8 && low->length == 8 && high->data[1] == 30 && low->data[1] == 31 &&
           high->id == low->id && low->data[3] == (uint8_t)(high->data[3] + 1);
}

bool decode_log(FILE *in, struct decoded_log *log)
{
    char line[128];
    int capacity = 0;
    *log = (struct decoded_log){0};
    while (fgets(line, sizeof line, in)) {
        if (log->count == capacity) {
            capacity = capacity ? 2 * capacity : 4096;
            log->frame = realloc(log->frame, (size_t)capacity * sizeof *log->frame);
        }
        if (!log->frame || !decode_line(line, &log->frame[log->count])) {
            fprintf(stderr, "not a line of candump -L: %s", line);
            return false;
        }
        log->count++;
    }
    return true;
}

void decode_free(struct decoded_log *log)
{
    free(log->frame);
    *log = (struct decoded_log){0};
}
