#include "glass_walk.h"

#include "check.h"
#include "lm/font.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The walks that are alive: a text belongs to the one whose glass it is drawn on. */
enum { WALKS = 2 };
static struct walk *alive[WALKS];

static struct walk *find_walk(const uint32_t *pixels)
{
    for (int i = 0; i < WALKS; i++) {
        if (alive[i] && alive[i]->glass == pixels) {
            return alive[i];
        }
    }
    return NULL;
}

static void cover(struct walk *w, const struct walk_text *t, int32_t ground)
{
    for (int32_t y = t->top - ground; y < t->bottom + ground; y++) {
        for (int32_t x = t->left - ground; x < t->right + ground; x++) {
            if (x >= 0 && y >= 0 && x < w->side_px && y < w->side_px) {
                w->is_text[y * w->side_px + x] = 1;
            }
        }
    }
}

void __real_lm_draw_text(const struct lm_pen *pen, int32_t x, int32_t y, const char *words);
void __wrap_lm_draw_text(const struct lm_pen *pen, int32_t x, int32_t y, const char *words);

void __wrap_lm_draw_text(const struct lm_pen *pen, int32_t x, int32_t y, const char *words)
{
    struct walk *w = find_walk(pen->surface.pixels);
    if (w && *words) {
        assert_true(w->texts < WALK_TEXTS);
        struct walk_text *t = &w->text[w->texts++];
        snprintf(t->words, sizeof t->words, "%s", words);
        t->left = x, t->right = x + lm_text_width(pen, words);
        t->top = y, t->bottom = y + LM_FONT_HEIGHT * pen->dot_px;
        cover(w, t, pen->dot_px);
    }
    __real_lm_draw_text(pen, x, y, words);
}

/* A frame begins: the texts of the one before go. */
static int acquire(void *ctx, struct lm_surface *surface)
{
    const struct memory_board *b = ctx;
    struct walk *w = find_walk(b->glass);
    const uint16_t side = (uint16_t)w->side_px;
    w->texts = 0;
    memset(w->is_text, 0, (size_t)side * side);
    *surface = (struct lm_surface){
        .pixels = w->glass, .stride_px = side, .width_px = side, .height_px = side};
    return LM_OK;
}

struct walk *walk_begin(uint16_t side_px, const struct lm_glass_options *options)
{
    struct walk *w = calloc(1, sizeof *w);
    const size_t pixels = (size_t)side_px * side_px;
    w->side_px = side_px;
    w->glass = calloc(pixels, sizeof *w->glass);
    w->plane = calloc(pixels, 1);
    w->is_text = calloc(pixels, 1);
    const int place = alive[0] ? 1 : 0;
    assert_null(alive[place]);
    alive[place] = w;
    w->rig = make_rig();
    struct memory_board *b = &w->rig->board;
    b->glass = w->glass;
    b->display.width_px = b->display.height_px = side_px;
    b->display.acquire = acquire;
    b->lent.plane = w->plane;
    b->lent.options = *options;
    assert_int_equal(lm_unit_init(&w->rig->unit, &b->lent), LM_OK);
    command(w->rig, range_10);
    run(w->rig, 1);
    return w;
}

void walk_end(struct walk *w)
{
    for (int i = 0; i < WALKS; i++) {
        alive[i] = alive[i] == w ? NULL : alive[i];
    }
    free_rig(w->rig);
    free(w->glass);
    free(w->plane);
    free(w->is_text);
    free(w);
}

int32_t walk_dot_px(const struct walk *w)
{
    const uint16_t side = (uint16_t)w->side_px;
    const struct lm_surface s = {
        .pixels = w->glass, .stride_px = side, .width_px = side, .height_px = side};
    return lm_pen_for(&s, 0).dot_px;
}

bool walk_has_text(const struct walk *w, int32_t x, int32_t y)
{
    return w->is_text[y * w->side_px + x];
}

bool walk_says(const struct walk *w, const char *words)
{
    for (uint32_t i = 0; i < w->texts; i++) {
        if (strstr(w->text[i].words, words)) {
            return true;
        }
    }
    return false;
}
