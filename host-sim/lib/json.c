#include "hs/json.h"

#include <assert.h>
#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Bytes of the UTF-8 character at `text` (RFC 3629), or 0 when it is none. The terminating 0 is no
 * continuation byte, so that nothing is read behind it. */
static int character_bytes(const unsigned char *text)
{
    const unsigned char first = text[0];
    const int bytes = first < 0x80   ? 1
                      : first < 0xc2 ? 0
                      : first < 0xe0 ? 2
                      : first < 0xf0 ? 3
                      : first < 0xf5 ? 4
                                     : 0;
    for (int i = 1; i < bytes; i++) {
        if ((text[i] & 0xc0) != 0x80) {
            return 0;
        }
    }
    const bool is_overlong = (first == 0xe0 && text[1] < 0xa0) || (first == 0xf0 && text[1] < 0x90);
    const bool is_surrogate = first == 0xed && text[1] >= 0xa0;
    const bool is_beyond = first == 0xf4 && text[1] >= 0x90;
    return is_overlong || is_surrogate || is_beyond ? 0 : bytes;
}

static void write_text(FILE *out, const char *value)
{
    const unsigned char *text = (const unsigned char *)value;
    fputc('"', out);
    while (*text) {
        const int bytes = character_bytes(text);
        if (bytes == 0) {
            fputs("\\ufffd", out);
        } else if (*text < 0x20 || *text == 0x7f) {
            fprintf(out, "\\u%04x", *text);
        } else {
            fprintf(out, "%s%.*s", *text == '"' || *text == '\\' ? "\\" : "", bytes,
                    (const char *)text);
        }
        text += bytes > 0 ? bytes : 1;
    }
    fputc('"', out);
}

static void new_line(const struct hs_json *j)
{
    fprintf(j->out, "\n%*s", 2 * j->depth, "");
}

static void begin_member(struct hs_json *j, const char *key)
{
    const int top = j->depth - 1;
    if (j->level[top].has_members) {
        fputc(',', j->out);
    }
    j->level[top].has_members = true;
    new_line(j);
    if (!j->level[top].is_array) {
        write_text(j->out, key);
        fputs(": ", j->out);
    }
}

static void push(struct hs_json *j, bool is_array)
{
    assert(j->depth < HS_JSON_DEPTH_MAX);
    j->level[j->depth].is_array = is_array;
    j->level[j->depth].has_members = false;
    j->depth++;
    fputc(is_array ? '[' : '{', j->out);
}

static void pop(struct hs_json *j)
{
    j->depth--;
    if (j->level[j->depth].has_members) {
        new_line(j);
    }
    fputc(j->level[j->depth].is_array ? ']' : '}', j->out);
}

void hs_json_begin(struct hs_json *j, FILE *out)
{
    j->out = out;
    j->depth = 0;
    push(j, false);
}

void hs_json_end(struct hs_json *j)
{
    while (j->depth > 0) {
        pop(j);
    }
    fputc('\n', j->out);
}

void hs_json_object(struct hs_json *j, const char *key)
{
    begin_member(j, key);
    push(j, false);
}

void hs_json_array(struct hs_json *j, const char *key)
{
    begin_member(j, key);
    push(j, true);
}

void hs_json_close(struct hs_json *j)
{
    assert(j->depth > 1);
    pop(j);
}

void hs_json_text(struct hs_json *j, const char *key, const char *value)
{
    begin_member(j, key);
    if (value) {
        write_text(j->out, value);
    } else {
        fputs("null", j->out);
    }
}

void hs_json_real(struct hs_json *j, const char *key, double value)
{
    begin_member(j, key);
    if (isfinite(value)) {
        fprintf(j->out, "%.12g", value);
    } else {
        fputs("null", j->out);
    }
}

void hs_json_integer(struct hs_json *j, const char *key, int64_t value)
{
    begin_member(j, key);
    fprintf(j->out, "%" PRId64, value);
}

void hs_json_count(struct hs_json *j, const char *key, uint64_t value)
{
    begin_member(j, key);
    fprintf(j->out, "%" PRIu64, value);
}

void hs_json_flag(struct hs_json *j, const char *key, bool value)
{
    begin_member(j, key);
    fputs(value ? "true" : "false", j->out);
}
