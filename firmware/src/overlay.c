#include "lm/overlay.h"

#include "fx/mem.h"
#include "fx/trig.h"
#include "lm/font.h"

enum { SYMBOL = 0x0040E060, WARNING = 0x00FFB020, ARC_STEPS = 48 };

static void dot(const struct lm_surface *s, int32_t x, int32_t y, uint32_t colour)
{
    if (x >= 0 && y >= 0 && x < s->width_px && y < s->height_px) {
        s->pixels[(uint32_t)y * s->stride_px + (uint32_t)x] = colour;
    }
}

static void line(const struct lm_surface *s, int32_t x0, int32_t y0, int32_t x1, int32_t y1,
                 uint32_t colour)
{
    const int32_t dx = x1 - x0, dy = y1 - y0;
    const int32_t wide = dx < 0 ? -dx : dx, high = dy < 0 ? -dy : dy;
    const int32_t steps = wide > high ? wide : high;
    /* Steps in Q16; coordinates are below 2^12. */
    const int32_t step_x = steps ? dx * 65536 / steps : 0, step_y = steps ? dy * 65536 / steps : 0;
    int32_t x = x0 * 65536 + 32768, y = y0 * 65536 + 32768;
    for (int32_t i = 0; i <= steps; i++, x += step_x, y += step_y) {
        dot(s, x >> 16, y >> 16, colour);
    }
}

/* Dots are drawn 1, 2 or 3 pixels wide, so that text keeps its share of the screen from 256 to 1024
 * pixels. */
static int32_t text_scale(const struct lm_surface *s)
{
    return s->width_px < 400 ? 1 : s->width_px < 900 ? 2 : 3;
}

static void block(const struct lm_surface *s, int32_t x, int32_t y, int32_t size, uint32_t colour)
{
    for (int32_t v = 0; v < size; v++) {
        for (int32_t h = 0; h < size; h++) {
            dot(s, x + h, y + v, colour);
        }
    }
}

static void glyph(const struct lm_surface *s, int32_t x, int32_t y, char c, uint32_t colour)
{
    const uint8_t *rows = lm_font_glyph(c);
    const int32_t scale = text_scale(s);
    for (int32_t row = 0; row < LM_FONT_HEIGHT; row++) {
        for (int32_t column = 0; column < LM_FONT_WIDTH; column++) {
            if (rows[row] >> (LM_FONT_WIDTH - 1 - column) & 1) {
                block(s, x + column * scale, y + row * scale, scale, colour);
            }
        }
    }
}

static int32_t text(const struct lm_surface *s, int32_t x, int32_t y, const char *words,
                    uint32_t colour)
{
    for (; *words; words++) {
        glyph(s, x, y, *words, colour);
        x += (LM_FONT_WIDTH + 1) * text_scale(s);
    }
    return x;
}

static int32_t number(const struct lm_surface *s, int32_t x, int32_t y, uint32_t value,
                      uint32_t digits, uint32_t colour)
{
    char words[11];
    if (digits > 10) {
        digits = 10;
    }
    words[digits] = 0;
    for (uint32_t i = digits; i > 0; i--) {
        words[i - 1] = (char)('0' + value % 10);
        value /= 10;
    }
    return text(s, x, y, words, colour);
}

static uint32_t digits_of(uint32_t value)
{
    uint32_t digits = 1;
    for (; value >= 10; value /= 10) {
        digits++;
    }
    return digits;
}

static void warning(const struct lm_surface *s, int32_t row, const char *words)
{
    int32_t length = 0;
    while (words[length]) {
        length++;
    }
    const int32_t scale = text_scale(s), advance = (LM_FONT_WIDTH + 1) * scale;
    const int32_t high = LM_FONT_HEIGHT * scale, wide = length * advance - scale;
    const int32_t x = (s->width_px - wide) / 2, y = s->height_px / 2 + row * (high + 6 * scale);
    const int32_t margin = 2 * scale;
    for (int32_t v = y - margin; v < y + high + margin; v++) {
        line(s, x - margin, v, x + wide + margin, v, 0);
    }
    line(s, x - margin, y - margin, x + wide + margin, y - margin, WARNING);
    line(s, x - margin, y + high + margin, x + wide + margin, y + high + margin, WARNING);
    text(s, x, y, words, WARNING);
}

struct apex {
    int32_t x, y, radius;
};

static struct apex apex_of(const struct lm_frame *frame)
{
    return (struct apex){frame->left_px + frame->width_px / 2, frame->top_px + frame->height_px - 1,
                         lm_ppi_radius_px(frame)};
}

/* End of a ray of `length` pixels at `azimuth` from straight up. */
static void ray_end(const struct apex *a, fx_bam_t azimuth, int32_t length, int32_t *x, int32_t *y)
{
    *x = a->x + (int32_t)((int64_t)length * fx_sin_q30(azimuth) >> 30);
    *y = a->y - (int32_t)((int64_t)length * fx_cos_q30(azimuth) >> 30);
}

static void ray(const struct lm_surface *s, const struct apex *a, fx_bam_t azimuth, int32_t from,
                int32_t to, uint32_t colour)
{
    int32_t x0, y0, x1, y1;
    ray_end(a, azimuth, from, &x0, &y0);
    ray_end(a, azimuth, to, &x1, &y1);
    line(s, x0, y0, x1, y1, colour);
}

static void arc(const struct lm_surface *s, const struct apex *a, fx_bam_t half, int32_t radius)
{
    int32_t x0, y0;
    ray_end(a, 0u - half, radius, &x0, &y0);
    for (uint32_t i = 1; i <= ARC_STEPS; i++) {
        int32_t x1, y1;
        ray_end(a, 0u - half + (fx_bam_t)((uint64_t)half * 2 * i / ARC_STEPS), radius, &x1, &y1);
        line(s, x0, y0, x1, y1, SYMBOL);
        x0 = x1;
        y0 = y1;
    }
}

/* Range arcs at a quarter, half and three quarters (at 10 nm the half alone), the sector's edges,
 * the antenna. */
static void draw_ppi(const struct lm_surface *s, const struct lm_frame *frame,
                     const struct lm_page *page)
{
    const struct apex a = apex_of(frame);
    const int32_t quarters_from = page->range_nm > 10 ? 1 : 2;
    for (int32_t q = quarters_from; q <= 4 - quarters_from; q++) {
        arc(s, &a, page->azimuth_half, a.radius * q / 4);
    }
    ray(s, &a, page->azimuth_half, 0, a.radius, SYMBOL);
    ray(s, &a, 0u - page->azimuth_half, 0, a.radius, SYMBOL);
    for (int32_t tens = -3; tens <= 3; tens++) {
        ray(s, &a, (fx_bam_t)tens * FX_BAM_DEG(10), a.radius - a.radius / 40, a.radius, SYMBOL);
    }
    if (page->is_sweeping) {
        ray(s, &a, (fx_bam_t)page->sweep_bam, a.radius / 40, a.radius, 0x00307040);
    }
}

/* 2 pi radians to 360 degrees: whole degrees of a binary angle, 0..359. */
static uint32_t degrees_of(fx_bam_t angle)
{
    return (uint32_t)(((uint64_t)angle * 360 + (1u << 31)) >> 32) % 360;
}

static void draw_labels(const struct lm_surface *s, const struct lm_page *page)
{
    const int32_t scale = text_scale(s), edge = 6 * scale, row = (LM_FONT_HEIGHT + 3) * scale;
    const int32_t right = s->width_px - edge - 9 * (LM_FONT_WIDTH + 1) * scale;
    text(s, edge, edge, page->is_sar ? "SAR" : "GM", SYMBOL);
    if (page->has_heading) {
        number(s, s->width_px / 2 - 9 * scale, edge, degrees_of(page->heading), 3, SYMBOL);
    }
    if (page->is_sar) {
        const uint32_t metres = page->sar_cell_dm / 10u;
        int32_t x = text(s, right, edge, "CELL ", SYMBOL);
        x = number(s, x, edge, metres, digits_of(metres), SYMBOL);
        x = text(s, x, edge, ".", SYMBOL);
        number(s, x, edge, page->sar_cell_dm % 10u, 1, SYMBOL);
        x = text(s, right, edge + row, "LOOK ", SYMBOL);
        number(s, x, edge + row, page->sar_look_deg, 3, SYMBOL);
        x = number(s, edge, edge + row, page->sar_percent, digits_of(page->sar_percent), SYMBOL);
        text(s, x, edge + row, "%", SYMBOL);
        return;
    }
    number(s, edge, s->height_px / 4, page->range_nm, 2, SYMBOL);
    text(s, edge, s->height_px / 2, "A", SYMBOL);
    number(s, edge, s->height_px / 2 + row, page->azimuth_tens, 1, SYMBOL);
}

static void draw_warnings(const struct lm_surface *s, uint32_t flags)
{
    static const struct {
        uint32_t flag;
        char words[12];
    } table[] = {
        {LM_FLAG_DB, "DB FAIL"},    {LM_FLAG_BUS, "BUS"},         {LM_FLAG_NAV_DEAD, "NAV FAIL"},
        {LM_FLAG_NAV_STALE, "NAV"}, {LM_FLAG_OFF_MAP, "OFF MAP"}, {LM_FLAG_TILE, "TILE"},
        {LM_FLAG_FROZEN, "FZ"},
    };
    int32_t row = -1;
    for (uint32_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        if (flags & table[i].flag) {
            warning(s, row++, table[i].words);
        }
    }
}

/* A hand that turns one eighth with every picture: when it stands, the display has stopped. */
static void draw_alive(const struct lm_surface *s, uint32_t frame)
{
    const int32_t size = 4 * text_scale(s);
    const struct apex a = {s->width_px - 2 * size, s->height_px - 2 * size, size};
    ray(s, &a, (fx_bam_t)(frame % 8) << 29, 0, size, SYMBOL);
}

void lm_overlay_draw(const struct lm_surface *surface, const struct lm_plane *plane,
                     const struct lm_frame *frame, const struct lm_page *page)
{
    for (uint32_t y = 0; y < surface->height_px; y++) {
        const uint8_t *grey = plane->pixels + y * plane->width_px;
        uint32_t *out = surface->pixels + y * surface->stride_px;
        for (uint32_t x = 0; x < surface->width_px; x++) {
            out[x] = grey[x] * 0x00010101u;
        }
    }
    if (!page->is_sar) {
        draw_ppi(surface, frame, page);
    }
    draw_labels(surface, page);
    draw_warnings(surface, page->flags);
    draw_alive(surface, page->frame);
}
