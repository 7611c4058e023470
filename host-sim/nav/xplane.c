/* Datagrams of X-Plane, all little-endian, as Laminar's "Exchanging Data with X-Plane" describes
 * them. Laid out from three independent readers: the dissector of Avacee for Wireshark (lengths),
 * XPPython3's documentation (RPOS) and the public clients of RREF. */
#include "nav/simulator.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    HEAD = 5,      /* four letters and a byte that differs from version to version */
    ROW = 4 + 32,  /* DATA: a number and eight floats */
    VALUE = 4 + 4, /* RREF: a number and a float */
    RPOS = HEAD + 3 * 8 + 10 * 4,
    ASK_RREF = HEAD + 4 + 4 + 400,
    FLOATS = 8
};

/* What RREF is asked for. Other programs' numbers are not ours. */
enum { REF_PAUSED = 0x4c4d0001, REF_MAGNETIC, REF_END };
static const char *const refs[] = {"sim/time/paused", "sim/flightmodel/position/mag_psi"};

static const double degree = 57.29577951308232;

static uint32_t word_at(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static double float_at(const uint8_t *p)
{
    const uint32_t bits = word_at(p);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}

static double double_at(const uint8_t *p)
{
    const uint64_t bits = (uint64_t)word_at(p + 4) << 32 | word_at(p);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void put_word(uint8_t *p, uint32_t value)
{
    for (int i = 0; i < 4; i++) {
        p[i] = (uint8_t)(value >> 8 * i);
    }
}

/* Rows of DATA: 17 pitch, roll, true and magnetic heading; 20 latitude, longitude, feet above mean
 * sea level; 21 x, y, z and the velocities along them: east, up and south. */
static void take_row(uint32_t row, const double v[FLOATS], struct nav_told *t, unsigned *seen)
{
    if (row == 17) {
        *seen |= 1;
        t->pitch_deg = v[0];
        t->roll_deg = v[1];
        t->heading_deg = v[2];
        t->magnetic_deg = v[3] >= -360 && v[3] <= 360 ? v[3] : NAN; /* -999: no value */
    } else if (row == 20) {
        *seen |= 2;
        t->latitude_deg = v[0];
        t->longitude_deg = v[1];
        t->height_m = v[2] * 0.3048;
    } else if (row == 21) {
        *seen |= 4;
        t->east_ms = v[3];
        t->up_ms = v[4];
        t->north_ms = -v[5];
    }
}

static enum nav_told_fault read_data(const uint8_t *bytes, size_t length, struct nav_told *t)
{
    unsigned seen = 0;
    if (length == HEAD || (length - HEAD) % ROW != 0) {
        return NAV_TOLD_MALFORMED;
    }
    for (size_t at = HEAD; at < length; at += ROW) {
        double v[FLOATS];
        for (int i = 0; i < FLOATS; i++) {
            v[i] = float_at(bytes + at + 4 + 4 * i);
        }
        take_row(word_at(bytes + at), v, t, &seen);
    }
    return seen != 7 ? NAV_TOLD_INCOMPLETE : nav_told_judge(t);
}

static enum nav_told_fault read_rpos(const uint8_t *bytes, size_t length, struct nav_told *t)
{
    if (length != RPOS) {
        return NAV_TOLD_MALFORMED;
    }
    const uint8_t *p = bytes + HEAD, *f = p + 24;
    t->longitude_deg = double_at(p);
    t->latitude_deg = double_at(p + 8);
    t->height_m = double_at(p + 16);
    t->pitch_deg = float_at(f + 4); /* behind the height above ground */
    t->heading_deg = float_at(f + 8);
    t->roll_deg = float_at(f + 12);
    t->east_ms = float_at(f + 16);
    t->up_ms = float_at(f + 20);
    t->north_ms = -float_at(f + 24);
    t->roll_rate = float_at(f + 28) * degree;
    t->pitch_rate = float_at(f + 32) * degree;
    t->yaw_rate = float_at(f + 36) * degree;
    if (!isfinite(t->roll_rate) || !isfinite(t->pitch_rate) || !isfinite(t->yaw_rate)) {
        return NAV_TOLD_RANGE;
    }
    return nav_told_judge(t);
}

static enum nav_told_fault read_rref(const uint8_t *bytes, size_t length, struct nav_told *t)
{
    bool is_ours = false;
    if (length == HEAD || (length - HEAD) % VALUE != 0) {
        return NAV_TOLD_MALFORMED;
    }
    for (size_t at = HEAD; at < length; at += VALUE) {
        const uint32_t which = word_at(bytes + at);
        const double value = float_at(bytes + at + 4);
        if (which != REF_PAUSED && which != REF_MAGNETIC) {
            continue;
        }
        if (!(fabs(value) <= 360)) {
            return NAV_TOLD_RANGE;
        }
        is_ours = true;
        if (which == REF_PAUSED) {
            t->paused = value != 0;
        } else {
            t->magnetic_deg = value > 180 ? value - 360 : value < -180 ? value + 360 : value;
        }
    }
    return is_ours ? NAV_TOLD_OK : NAV_TOLD_FOREIGN;
}

enum nav_told_fault nav_xplane_read(const uint8_t *bytes, size_t length, struct nav_told *t)
{
    nav_told_blank(t);
    if (length < HEAD) {
        return NAV_TOLD_FOREIGN;
    }
    if (length > NAV_TOLD_BYTES) {
        return NAV_TOLD_MALFORMED;
    }
    return memcmp(bytes, "DATA", 4) == 0   ? read_data(bytes, length, t)
           : memcmp(bytes, "RPOS", 4) == 0 ? read_rpos(bytes, length, t)
           : memcmp(bytes, "RREF", 4) == 0 ? read_rref(bytes, length, t)
                                           : NAV_TOLD_FOREIGN;
}

size_t nav_xplane_ask(int index, bool stop, uint8_t bytes[NAV_TOLD_BYTES])
{
    memset(bytes, 0, ASK_RREF);
    if (index == 0) { /* the frequency is text here */
        return (size_t)snprintf((char *)bytes, ASK_RREF, "RPOS%c%s", 0, stop ? "0" : "60") + 1;
    }
    if (index > REF_END - REF_PAUSED) {
        return 0;
    }
    strcpy((char *)bytes, "RREF");
    put_word(bytes + HEAD, stop ? 0 : 10);
    put_word(bytes + HEAD + 4, (uint32_t)(REF_PAUSED + index - 1));
    strcpy((char *)bytes + HEAD + 8, refs[index - 1]);
    return ASK_RREF;
}
