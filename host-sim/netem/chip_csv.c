#include "hs/error.h"
#include "netem/chip.h"

#include <stdlib.h>
#include <string.h>

static const char remedy[] = "give rows of amplitudes with commas between them";

static const char *skip_blanks(const char *at)
{
    while (*at == ' ' || *at == '\t' || *at == '\r') {
        at++;
    }
    return at;
}

/* The numbers of one line into `row`, at most `most`; returns how many, or -1 at something else. */
static int read_row(const char *at, const char *end, double *row, int most)
{
    int count = 0;
    for (at = skip_blanks(at); at < end; at = skip_blanks(at)) {
        char *after;
        const double value = strtod(at, &after);
        if (after == at || after > end || count == most || !(value >= 0 && value <= 1e9)) {
            return -1;
        }
        row[count++] = value;
        at = skip_blanks(after);
        at += at < end && *at == ',';
    }
    return count;
}

/* Step over empty lines; the end of the line that follows. */
static const char *next_line(const char **at, const char *end)
{
    for (;;) {
        const char *stop = memchr(*at, '\n', (size_t)(end - *at));
        stop = stop ? stop : end;
        if (stop == end || skip_blanks(*at) < stop) {
            return stop;
        }
        *at = stop + 1;
    }
}

static int read_rows(const char *path, const char *text, const char *end, double *pixels,
                     int *width, int *height)
{
    for (const char *at = text; at < end;) {
        const char *stop = next_line(&at, end);
        if (skip_blanks(at) >= stop) {
            break;
        }
        if (*height == NM_PICTURE_SIDE_MAX) {
            return hs_error(path, remedy, "has more than %d rows", NM_PICTURE_SIDE_MAX);
        }
        double *row = pixels + (size_t)*height * (size_t)*width;
        const int count = read_row(at, stop, row, *height == 0 ? NM_PICTURE_SIDE_MAX : *width);
        if (count <= 0 || (*height > 0 && count != *width)) {
            return hs_error(path, remedy, "row %d is not a row of amplitudes as long as the first",
                            *height + 1);
        }
        *width = count;
        ++*height;
        at = stop < end ? stop + 1 : end;
    }
    return *height > 0 ? 0 : hs_error(path, remedy, "holds no numbers");
}

int nm_chip_parse_csv(struct nm_chip *chip, const char *path, const char *text, size_t size)
{
    if (memchr(text, '\0', size)) {
        return hs_error(path, remedy, "is no text");
    }
    /* A number takes two characters or more, so no file holds more of them than this. */
    double *pixels = malloc((size / 2 + NM_PICTURE_SIDE_MAX + 1) * sizeof *pixels);
    int width = 0, height = 0;
    int result = pixels ? read_rows(path, text, text + size, pixels, &width, &height)
                        : hs_error(path, NULL, "out of memory");
    result = result == 0 ? nm_picture_open(&chip->picture, width, height) : result;
    if (result == 0) {
        memcpy(chip->picture.pixels, pixels, (size_t)width * (size_t)height * sizeof *pixels);
    }
    free(pixels);
    return result;
}
