#include "hs/error.h"
#include "netem/chip.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { HEADER_MAX = 1 << 16, LINE_SIZE = 128 };

static const char remedy[] = "copy the chip again";

/* What the header says; NaN where it says nothing. */
struct header {
    double length, native_length, columns, rows, azimuth, desired, measured;
    int is_ended;
};

static void take_field(struct header *h, const char *line)
{
    const struct {
        const char *key;
        double *value;
    } fields[] = {
        {"PhoenixHeaderLength=", &h->length},
        {"native_header_length=", &h->native_length},
        {"NumberOfColumns=", &h->columns},
        {"NumberOfRows=", &h->rows},
        {"TargetAz=", &h->azimuth},
        {"DesiredDepression=", &h->desired},
        {"MeasuredDepression=", &h->measured},
    };
    for (size_t i = 0; i < sizeof fields / sizeof fields[0]; i++) {
        const size_t length = strlen(fields[i].key);
        if (strncmp(line, fields[i].key, length) == 0) {
            char *end;
            const double value = strtod(line + length, &end);
            *fields[i].value = end != line + length && isfinite(value) ? value : NAN;
        }
    }
    h->is_ended = h->is_ended || strncmp(line, "[EndofPhoenixHeader]", 20) == 0;
}

/* The lines from the start to the end mark, or as far as a header may reach. */
static struct header read_header(const unsigned char *bytes, size_t size)
{
    struct header h = {NAN, 0, NAN, NAN, NAN, NAN, NAN, 0};
    size = size < HEADER_MAX ? size : HEADER_MAX;
    for (size_t at = 0; at < size && !h.is_ended;) {
        char line[LINE_SIZE];
        size_t length = 0;
        for (; at < size && bytes[at] != '\n'; at++) {
            if (length < LINE_SIZE - 1 && bytes[at] != ' ' && bytes[at] != '\t') {
                line[length++] = (char)bytes[at];
            }
        }
        line[length] = '\0';
        at++;
        take_field(&h, line);
    }
    return h;
}

/* Whole and within the limits; false for a NaN. */
static int is_count(double x, double low, double high)
{
    return x >= low && x <= high && x == floor(x);
}

static int check_header(const char *path, const struct header *h, size_t size)
{
    if (!h->is_ended || !is_count(h->length, 1, HEADER_MAX)) {
        return hs_error(path, remedy, "its header has no end or no PhoenixHeaderLength");
    }
    if (h->native_length != 0) {
        return hs_error(path, "give chips", "is no chip but a whole scene");
    }
    if (!is_count(h->columns, 1, NM_PICTURE_SIDE_MAX) ||
        !is_count(h->rows, 1, NM_PICTURE_SIDE_MAX)) {
        return hs_error(path, remedy, "NumberOfColumns and NumberOfRows must be 1..%d",
                        NM_PICTURE_SIDE_MAX);
    }
    const double need = h->length + 4 * h->columns * h->rows;
    if (need > (double)size) {
        return hs_error(path, remedy, "is cut short: %.0f bytes instead of %.0f", (double)size,
                        need);
    }
    if (!isnan(h->azimuth) && !(h->azimuth >= -360 && h->azimuth <= 360)) {
        return hs_error(path, remedy, "TargetAz is no angle: %g", h->azimuth);
    }
    return 0;
}

static float big_endian_float(const unsigned char *b)
{
    const uint32_t bits =
        (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | (uint32_t)b[3];
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Depressions beyond the zenith say nothing. */
static double depression_of(const struct header *h)
{
    const double d = isnan(h->measured) ? h->desired : h->measured;
    return d > 0 && d < 90 ? d : NAN;
}

int nm_chip_parse_mstar(struct nm_chip *chip, const char *path, const unsigned char *bytes,
                        size_t size)
{
    const struct header h = read_header(bytes, size);
    if (check_header(path, &h, size) != 0 ||
        nm_picture_open(&chip->picture, (int)h.columns, (int)h.rows) != 0) {
        return -1;
    }
    const unsigned char *at = bytes + (size_t)h.length;
    const int columns = (int)h.columns, rows = (int)h.rows;
    for (int i = 0; i < columns * rows; i++) {
        const float value = big_endian_float(at + 4 * (size_t)i);
        if (!(value >= 0) || value > 1e9f) {
            nm_picture_close(&chip->picture);
            return hs_error(path, remedy, "column %d of row %d is no magnitude", i % columns + 1,
                            i / columns + 1);
        }
        chip->picture.pixels[i] = (double)value;
    }
    chip->azimuth_deg = isnan(h.azimuth) ? NAN : fmod(h.azimuth + 360, 360);
    chip->depression_deg = depression_of(&h);
    return 0;
}
