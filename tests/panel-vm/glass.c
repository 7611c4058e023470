/* Reads the glass as a person does.
 *
 *   glass text FILE.png              every line of text on the picture, one a line, from the top;
 *                                    * is the degree sign, ^ and v are the triangles
 *   glass differ SCREEN.png PICTURE.png [TURN]
 *                                    how many pixels of the screen are not as they should be when
 *                                    it shows the picture turned clockwise by TURN degrees, in its
 *                                    middle, and is black around it
 *   glass among SCREEN.png X Y WIDTH HEIGHT PICTURE.png...
 *                                    the pictures follow each other: the least number of pixels of
 *                                    the rectangle that are in none of three neighbours, because
 *                                    the beam's line hides some in each. It is 0 for a screen that
 *                                    stopped at some moment of that film
 *
 * The hand that turns with every picture is never looked at. */
#include "lm/draw.h"
#include "lm/font.h"

#include <png.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { GAP_MAX = 12 };
#define BLACK 0xff000000u

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

static void unload(struct picture *p)
{
    free(p->pixels);
    free(p->is_read);
    *p = (struct picture){0};
}

/* 0, or -1 with the cause told and nothing kept. */
static int load(struct picture *p, const char *path)
{
    *p = (struct picture){0};
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
        unload(p);
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
    unload(&p);
    return 0;
}

/* Whether the hand of lm_overlay_alive may be there. */
static bool is_hand(const struct picture *p, int32_t x, int32_t y)
{
    const struct lm_surface surface = {.width_px = (uint16_t)p->width,
                                       .height_px = (uint16_t)p->height};
    const int32_t reach = 4 * lm_pen_for(&surface, 0).dot_px;
    return abs(x - (p->width - 2 * reach)) <= reach + 2 &&
           abs(y - (p->height - 2 * reach)) <= reach + 2;
}

/* Where a place of the screen lies in the turned and centred picture. */
static struct lm_point into_picture(const struct picture *screen, const struct picture *p,
                                    int32_t turn, int32_t x, int32_t y)
{
    const bool is_upright = turn % 180 == 0;
    const int32_t width = is_upright ? p->width : p->height;
    const int32_t height = is_upright ? p->height : p->width;
    const int32_t u = x - (screen->width - width) / 2, v = y - (screen->height - height) / 2;
    switch (turn) {
    case 90:
        return (struct lm_point){v, p->height - 1 - u};
    case 180:
        return (struct lm_point){p->width - 1 - u, p->height - 1 - v};
    case 270:
        return (struct lm_point){p->width - 1 - v, u};
    default:
        return (struct lm_point){u, v};
    }
}

static uint32_t count_differences(const struct picture *screen, const struct picture *p,
                                  int32_t turn)
{
    uint32_t differences = 0;
    for (int32_t y = 0; y < screen->height; y++) {
        for (int32_t x = 0; x < screen->width; x++) {
            const struct lm_point at_picture = into_picture(screen, p, turn, x, y);
            const bool is_inside = at_picture.x >= 0 && at_picture.x < p->width &&
                                   at_picture.y >= 0 && at_picture.y < p->height;
            const uint32_t wanted = is_inside ? at(p, at_picture.x, at_picture.y) : BLACK;
            differences += !(is_inside && is_hand(p, at_picture.x, at_picture.y)) &&
                           at(screen, x, y) != wanted;
        }
    }
    return differences;
}

static int print_differences(const char *screen_path, const char *path, int32_t turn)
{
    struct picture screen, p;
    if (load(&screen, screen_path) != 0) {
        return 1;
    }
    const int status = load(&p, path);
    if (status == 0) {
        printf("%u\n", count_differences(&screen, &p, turn));
        unload(&p);
    }
    unload(&screen);
    return status != 0;
}

static uint32_t count_strangers(const struct picture *screen, const struct picture *film,
                                const int32_t *box)
{
    uint32_t count = 0;
    for (int32_t y = box[1]; y < box[1] + box[3]; y++) {
        for (int32_t x = box[0]; x < box[0] + box[2]; x++) {
            const uint32_t pixel = at(screen, x, y);
            count += pixel != at(&film[0], x, y) && pixel != at(&film[1], x, y) &&
                     pixel != at(&film[2], x, y);
        }
    }
    return count;
}

static int print_among(const char *screen_path, char **box_words, int count, char **paths)
{
    struct picture screen, film[3] = {{0}};
    int32_t box[4];
    for (int i = 0; i < 4; i++) {
        box[i] = atoi(box_words[i]);
    }
    if (load(&screen, screen_path) != 0) {
        return 1;
    }
    uint32_t least = UINT32_MAX;
    int status = 0;
    for (int i = 0; i < count && status == 0; i++) {
        unload(&film[i % 3]);
        status = load(&film[i % 3], paths[i]);
        const uint32_t found = status == 0 && i >= 2 ? count_strangers(&screen, film, box) : least;
        least = found < least ? found : least;
    }
    if (status == 0) {
        printf("%u\n", least);
    }
    for (int i = 0; i < 3; i++) {
        unload(&film[i]);
    }
    unload(&screen);
    return status != 0;
}

int main(int argc, char **argv)
{
    if (argc == 3 && strcmp(argv[1], "text") == 0) {
        return print_text(argv[2]);
    }
    if ((argc == 4 || argc == 5) && strcmp(argv[1], "differ") == 0) {
        return print_differences(argv[2], argv[3], argc == 5 ? atoi(argv[4]) : 0);
    }
    if (argc >= 9 && strcmp(argv[1], "among") == 0) {
        return print_among(argv[2], argv + 3, argc - 7, argv + 7);
    }
    fprintf(stderr,
            "glass: text FILE.png | differ SCREEN.png PICTURE.png [TURN] | "
            "among SCREEN.png X Y WIDTH HEIGHT PICTURE.png...\n");
    return 2;
}
