/* Reads the glass as a person does.
 *
 *   glass text FILE.png              every line of text on the picture, one a line, from the top;
 *                                    * is the degree sign, ^ and v are the triangles
 *   glass differ A.png B.png [X Y W H]
 *                                    how many pixels are not the same in both; those of the
 *                                    rectangle are not looked at */
#include "lm/draw.h"
#include "lm/font.h"

#include <png.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GAP_MAX = 12 };

/* Glyphs and how they are printed. */
static const char glyphs[] = LM_GLYPH_UP LM_GLYPH_DOWN LM_GLYPH_DEGREE
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ+-/.,:;%()<>=?!*# ";
static const char printed[] =
    "^v*"
    "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ+-/.,:;%()<>=?!*# ";
_Static_assert(sizeof glyphs == sizeof printed, "one character for each glyph");

struct picture {
    int32_t width, height;
    uint32_t *pixels; /* 0xAABBGGRR as libpng gives it */
    bool *is_read;    /* text was found here */
};

static int load(struct picture *p, const char *path)
{
    png_image png = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(&png, path)) {
        fprintf(stderr, "%s: %s\n", path, png.message);
        return -1;
    }
    png.format = PNG_FORMAT_RGBA;
    *p = (struct picture){.width = (int32_t)png.width, .height = (int32_t)png.height};
    p->pixels = malloc(PNG_IMAGE_SIZE(png));
    p->is_read = calloc((size_t)png.width * png.height, sizeof *p->is_read);
    if (!p->pixels || !p->is_read || !png_image_finish_read(&png, NULL, p->pixels, 0, NULL)) {
        fprintf(stderr, "%s: cannot be read: %s\n", path, png.message);
        return -1;
    }
    return 0;
}

static uint32_t at(const struct picture *p, int32_t x, int32_t y)
{
    return p->pixels[y * p->width + x];
}

/* A box of text: two colours, of which the ground is that of the column behind the glyph. */
struct cell {
    int32_t x, y, dot_px;
    uint32_t ink, ground;
};

static bool is_lit(const uint8_t *rows, int32_t column, int32_t row)
{
    return column < LM_FONT_WIDTH && (rows[row] >> (LM_FONT_WIDTH - 1 - column) & 1);
}

/* Whether the cell shows the glyph; its gap to the next character belongs to it where the picture
 * goes on. */
static bool shows(const struct picture *p, const struct cell *c, const uint8_t *rows)
{
    for (int32_t y = 0; y < LM_FONT_HEIGHT * c->dot_px; y++) {
        for (int32_t x = 0; x < (LM_FONT_WIDTH + 1) * c->dot_px && c->x + x < p->width; x++) {
            const bool lit = is_lit(rows, x / c->dot_px, y / c->dot_px);
            if (at(p, c->x + x, c->y + y) != (lit ? c->ink : c->ground)) {
                return false;
            }
        }
    }
    return true;
}

/* The character in the cell, a space, or 0. Underscores are not looked for: the upper edges of
 * other letters look like them. */
static char read_cell(const struct picture *p, struct cell *c)
{
    if (c->x + LM_FONT_WIDTH * c->dot_px > p->width ||
        c->y + LM_FONT_HEIGHT * c->dot_px > p->height || p->is_read[c->y * p->width + c->x]) {
        return 0;
    }
    for (size_t i = 0; glyphs[i]; i++) {
        if (shows(p, c, lm_font_glyph(glyphs[i]))) {
            return printed[i];
        }
    }
    return 0;
}

/* What colours text would have that begins here: the first pixel of another colour, going right and
 * down, tells ink from ground. */
static bool guess_colours(const struct picture *p, struct cell *c)
{
    if (c->x < 1) {
        return false;
    }
    c->ground = at(p, c->x - 1, c->y);
    for (int32_t y = 0; y < LM_FONT_HEIGHT * c->dot_px; y += c->dot_px) {
        for (int32_t x = 0; x < LM_FONT_WIDTH * c->dot_px; x += c->dot_px) {
            if (at(p, c->x + x, c->y + y) != c->ground) {
                c->ink = at(p, c->x + x, c->y + y);
                return true;
            }
        }
    }
    return false;
}

static void mark_read(struct picture *p, const struct cell *first, int32_t characters)
{
    const int32_t end = first->x + characters * (LM_FONT_WIDTH + 1) * first->dot_px;
    for (int32_t y = first->y; y < first->y + LM_FONT_HEIGHT * first->dot_px; y++) {
        for (int32_t x = first->x; x < end && x < p->width; x++) {
            p->is_read[y * p->width + x] = true;
        }
    }
}

/* Print the line of text whose first character is here, if there is one. A single character is as
 * likely a part of the picture. */
static void read_line(struct picture *p, struct cell first)
{
    char line[256];
    int32_t length = 0, end = 0;
    struct cell c = first;
    while (length < (int32_t)sizeof line - 1 && length - end <= GAP_MAX) {
        const char glyph = read_cell(p, &c);
        if (glyph == 0) {
            break;
        }
        line[length++] = glyph;
        end = glyph != ' ' ? length : end;
        c.x += (LM_FONT_WIDTH + 1) * c.dot_px;
    }
    line[end] = 0;
    if (end >= 2) {
        mark_read(p, &first, end);
        printf("%s\n", line);
    }
}

static int print_text(const char *path)
{
    struct picture p;
    if (load(&p, path) != 0) {
        return 1;
    }
    const struct lm_surface surface = {.width_px = (uint16_t)p.width,
                                       .height_px = (uint16_t)p.height};
    struct cell c = {.dot_px = lm_pen_for(&surface, 0).dot_px};
    for (c.y = 0; c.y + LM_FONT_HEIGHT * c.dot_px <= p.height; c.y++) {
        for (c.x = 1; c.x + LM_FONT_WIDTH * c.dot_px <= p.width; c.x++) {
            if (!p.is_read[c.y * p.width + c.x] && guess_colours(&p, &c) &&
                read_cell(&p, &c) > ' ') {
                read_line(&p, c);
            }
        }
    }
    free(p.pixels);
    free(p.is_read);
    return 0;
}

static int print_differences(int count, char **argument)
{
    struct picture a, b;
    if (load(&a, argument[0]) != 0 || load(&b, argument[1]) != 0) {
        return 1;
    }
    if (a.width != b.width || a.height != b.height) {
        printf("sizes %dx%d and %dx%d\n", a.width, a.height, b.width, b.height);
        return 1;
    }
    int32_t box[4] = {0};
    for (int i = 0; i < 4 && count == 6; i++) {
        box[i] = atoi(argument[2 + i]);
    }
    uint32_t differences = 0;
    for (int32_t y = 0; y < a.height; y++) {
        for (int32_t x = 0; x < a.width; x++) {
            const bool is_left_out =
                x >= box[0] && x < box[0] + box[2] && y >= box[1] && y < box[1] + box[3];
            differences += !is_left_out && at(&a, x, y) != at(&b, x, y);
        }
    }
    printf("%u\n", differences);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "text") == 0) {
        return print_text(argv[2]);
    }
    if ((argc == 4 || argc == 8) && strcmp(argv[1], "differ") == 0) {
        return print_differences(argc - 2, argv + 2);
    }
    fprintf(stderr, "glass: text FILE.png | differ A.png B.png [X Y W H]\n");
    return 2;
}
