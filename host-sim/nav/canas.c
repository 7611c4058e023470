#include "nav/canas.h"

#include <math.h>
#include <string.h>

static struct canas_frame begin(struct canas_codes *codes, uint16_t id, uint8_t node,
                                enum canas_type type, uint8_t length)
{
    struct canas_frame f = {.id = id, .length = length};
    f.data[0] = node;
    f.data[1] = (uint8_t)type;
    f.data[2] = 0; /* service code: unused by normal operation data */
    f.data[3] = codes->next[id]++;
    return f;
}

static void put_u32(struct canas_frame *f, uint32_t value)
{
    f->data[4] = (uint8_t)(value >> 24);
    f->data[5] = (uint8_t)(value >> 16);
    f->data[6] = (uint8_t)(value >> 8);
    f->data[7] = (uint8_t)value;
}

struct canas_frame canas_float(struct canas_codes *codes, uint16_t id, uint8_t node, double value)
{
    struct canas_frame f = begin(codes, id, node, CANAS_FLOAT, 8);
    const float narrow = (float)value;
    uint32_t bits;
    memcpy(&bits, &narrow, sizeof bits);
    put_u32(&f, bits);
    return f;
}

struct canas_frame canas_long(struct canas_codes *codes, uint16_t id, uint8_t node, int32_t value)
{
    struct canas_frame f = begin(codes, id, node, CANAS_LONG, 8);
    put_u32(&f, (uint32_t)value);
    return f;
}

struct canas_frame canas_uchar(struct canas_codes *codes, uint16_t id, uint8_t node, uint8_t value)
{
    struct canas_frame f = begin(codes, id, node, CANAS_UCHAR, 5);
    f.data[4] = value;
    return f;
}

struct canas_frame canas_char4(struct canas_codes *codes, uint16_t id, uint8_t node,
                               const uint8_t value[4])
{
    struct canas_frame f = begin(codes, id, node, CANAS_CHAR4, 8);
    memcpy(f.data + 4, value, 4);
    return f;
}

struct canas_frame canas_short2(struct canas_codes *codes, uint16_t id, uint8_t node, double value,
                                int16_t full_scale)
{
    struct canas_frame f = begin(codes, id, node, CANAS_SHORT2, 8);
    const double share = fmax(-1.0, fmin(1.0, value / full_scale));
    const int16_t count = (int16_t)lround(share * 32767.0);
    put_u32(&f, (uint32_t)(uint16_t)count << 16 | (uint16_t)full_scale);
    return f;
}

void canas_double(struct canas_codes *codes, uint16_t id, uint8_t node, double value,
                  struct canas_frame pair[2])
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    pair[0] = begin(codes, id, node, CANAS_DOUBLEH, 8);
    put_u32(&pair[0], (uint32_t)(bits >> 32));
    pair[1] = begin(codes, id, node, CANAS_DOUBLEL, 8);
    put_u32(&pair[1], (uint32_t)bits);
}

/* Write `value` in decimal, at least `min_digits` of them; returns the end. */
static char *put_decimal(char *out, uint64_t value, int min_digits)
{
    char digits[20];
    int n = 0;
    do {
        digits[n++] = (char)('0' + value % 10);
        value /= 10;
    } while (value > 0 || n < min_digits);
    while (n > 0) {
        *out++ = digits[--n];
    }
    return out;
}

static char *put_hex(char *out, uint32_t value, int digits)
{
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) {
        *out++ = "0123456789ABCDEF"[value >> shift & 15u];
    }
    return out;
}

/* Written by hand because a flight of hours is millions of lines and printf would take most of the
 * time. */
size_t canas_candump_line(char *out, const struct canas_frame *f, int64_t time_us,
                          const char *interface)
{
    char *p = out;
    *p++ = '(';
    p = put_decimal(p, (uint64_t)(time_us / 1000000), 1);
    *p++ = '.';
    p = put_decimal(p, (uint64_t)(time_us % 1000000), 6);
    *p++ = ')';
    *p++ = ' ';
    const size_t name = strlen(interface);
    memcpy(p, interface, name);
    p += name;
    *p++ = ' ';
    p = put_hex(p, f->id, 3);
    *p++ = '#';
    for (int i = 0; i < f->length; i++) {
        p = put_hex(p, f->data[i], 2);
    }
    *p = '\0';
    return (size_t)(p - out);
}
