#include "lm/draw_list.h"

#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/font.h"

enum { LINE_MOST_PX = 4 };

void lm_draw_list_begin(struct lm_draw_list *list, struct lm_damage *damage)
{
    list->damage = damage;
    list->was = list->count;
    list->count = list->texts = 0;
}

static struct lm_arc arc_of(const struct lm_draw_item *i)
{
    return (struct lm_arc){i->centre, i->number, i->left_edge, i->span};
}

/* The pixels that an item may touch, and perhaps some more. */
static struct lm_rectangle bounds(const struct lm_draw_item *i)
{
    if (i->kind == LM_DRAW_ARC) {
        const int32_t x = i->centre.x_px_q8 >> 8, y = i->centre.y_px_q8 >> 8;
        const int32_t more = i->number + LINE_MOST_PX;
        return (struct lm_rectangle){x - more, y - more, x + more, y + more};
    }
    const int32_t wide = i->kind == LM_DRAW_LINE ? LINE_MOST_PX : 0;
    return (struct lm_rectangle){.left = fx_min_i32(i->from_x, i->to_x),
                                 .top = fx_min_i32(i->from_y, i->to_y),
                                 .right = fx_max_i32(i->from_x, i->to_x) + wide,
                                 .bottom = fx_max_i32(i->from_y, i->to_y) + wide};
}

/* Mark the blocks along a line, band by band. The dots of row y lie where the line passes from row
 * y - 1/2 to y + 1/2, rounded to pixels, and reach 4 pixels to the right and down. Coordinates are
 * below 2^14: a slope in Q16 is below 2^31, and its products below 2^46. */
static void mark_line(struct lm_damage *damage, const struct lm_draw_item *i)
{
    const bool is_down = i->from_y < i->to_y;
    const int32_t x = is_down ? i->from_x : i->to_x, end_x = is_down ? i->to_x : i->from_x;
    const int32_t first = is_down ? i->from_y : i->to_y, last = is_down ? i->to_y : i->from_y;
    const int64_t slope_q16 = (int64_t)(end_x - x) * 65536 / (last - first);
    const int32_t start = fx_max_i32(first, i->top) / LM_BLOCK_HEIGHT_PX * LM_BLOCK_HEIGHT_PX;
    for (int32_t top = start; top < fx_min_i32(last + 4, i->bottom); top += LM_BLOCK_HEIGHT_PX) {
        const int32_t above = fx_clamp_i32(top - 5, first, last) - first;
        const int32_t below = fx_clamp_i32(top + LM_BLOCK_HEIGHT_PX, first, last) - first;
        const int32_t a = x + (int32_t)(above * slope_q16 >> 16);
        const int32_t b = x + (int32_t)(below * slope_q16 >> 16);
        const struct lm_rectangle part = {fx_min_i32(a, b) - 2, top, fx_max_i32(a, b) + 6,
                                          top + LM_BLOCK_HEIGHT_PX};
        lm_damage_mark(damage, &part);
    }
}

/* Mark the chords of an arc. They are short. */
static void mark_arc(struct lm_damage *damage, const struct lm_draw_item *i)
{
    const struct lm_pen widest = {.line_px = LINE_MOST_PX};
    const struct lm_arc arc = arc_of(i);
    struct lm_point from = lm_arc_end(&arc, 0);
    for (uint32_t chord = 1; chord <= LM_ARC_CHORDS; chord++) {
        const struct lm_point to = lm_arc_end(&arc, chord);
        const struct lm_rectangle part = lm_line_bounds(&widest, from, to);
        lm_damage_mark(damage, &part);
        from = to;
    }
}

static void mark(const struct lm_draw_list *list, const struct lm_draw_item *i)
{
    const struct lm_rectangle all = bounds(i);
    switch ((enum lm_draw_kind)i->kind) {
    case LM_DRAW_LINE:
        mark_line(list->damage, i);
        break;
    case LM_DRAW_ARC:
        mark_arc(list->damage, i);
        break;
    case LM_DRAW_BOX:
    case LM_DRAW_TEXT:
        lm_damage_mark(list->damage, &all);
        break;
    }
}

void lm_draw_list_end(struct lm_draw_list *list)
{
    for (uint32_t n = list->count; n < list->was; n++) {
        mark(list, &list->item[n]);
    }
    list->was = list->count;
}

_Static_assert(sizeof(struct lm_draw_item) == 32, "four words without a gap");

static bool is_same(const struct lm_draw_item *a, const struct lm_draw_item *b)
{
    uint64_t differs = 0;
    for (size_t byte = 0; byte < sizeof *a; byte += 8) {
        differs |= fx_load_u64((const char *)a + byte) ^ fx_load_u64((const char *)b + byte);
    }
    return differs == 0;
}

/* Put an item in its place, and mark it and the one that was there if they differ. */
static void note(struct lm_draw_list *list, const struct lm_draw_item *item, bool has_other_words)
{
    if (list->count == LM_DRAW_ITEMS) {
        return;
    }
    struct lm_draw_item *const place = &list->item[list->count];
    const bool is_new = list->count++ >= list->was;
    if (is_new || has_other_words || !is_same(place, item)) {
        if (!is_new) {
            mark(list, place);
        }
        mark(list, item);
        *place = *item;
    }
}

static struct lm_draw_item item_of(const struct lm_pen *pen, enum lm_draw_kind kind)
{
    return (struct lm_draw_item){.colour = pen->colour,
                                 .kind = (uint16_t)kind,
                                 .left = (int16_t)pen->clip.left,
                                 .top = (int16_t)pen->clip.top,
                                 .right = (int16_t)pen->clip.right,
                                 .bottom = (int16_t)pen->clip.bottom};
}

static void note_between(struct lm_draw_list *list, struct lm_draw_item item, struct lm_point from,
                         struct lm_point to, bool has_other_words)
{
    item.from_x = (int16_t)from.x, item.from_y = (int16_t)from.y;
    item.to_x = (int16_t)to.x, item.to_y = (int16_t)to.y;
    note(list, &item, has_other_words);
}

void lm_draw_list_box(struct lm_draw_list *list, const struct lm_pen *pen,
                      const struct lm_rectangle *box)
{
    /* An empty box may have a corner anywhere. */
    if (box->left < box->right && box->top < box->bottom) {
        note_between(list, item_of(pen, LM_DRAW_BOX), (struct lm_point){box->left, box->top},
                     (struct lm_point){box->right, box->bottom}, false);
    }
}

void lm_draw_list_line(struct lm_draw_list *list, const struct lm_pen *pen, struct lm_point from,
                       struct lm_point to)
{
    note_between(list, item_of(pen, LM_DRAW_LINE), from, to, false);
}

void lm_draw_list_arc(struct lm_draw_list *list, const struct lm_pen *pen, const struct lm_arc *arc)
{
    struct lm_draw_item item = item_of(pen, LM_DRAW_ARC);
    item.centre = arc->centre;
    item.number = (uint16_t)arc->radius;
    item.left_edge = arc->left;
    item.span = arc->span;
    note(list, &item, false);
}

/* Copy the words to their place. True if other ones were there. */
static bool take_words(char *to, const char *from)
{
    bool is_other = false;
    uint32_t n = 0;
    for (; n < LM_TEXT_MAX && from[n]; n++) {
        is_other |= to[n] != from[n];
        to[n] = from[n];
    }
    is_other |= to[n] != '\0';
    to[n] = '\0';
    return is_other;
}

void lm_draw_list_text(struct lm_draw_list *list, const struct lm_pen *pen, struct lm_point at,
                       const char *words)
{
    if (list->texts == LM_DRAW_TEXTS) {
        return;
    }
    struct lm_draw_item item = item_of(pen, LM_DRAW_TEXT);
    item.number = (uint16_t)list->texts++;
    char *const place = list->words[item.number];
    const bool is_other = take_words(place, words);
    const struct lm_point end = {at.x + lm_text_width(pen, place),
                                 at.y + LM_FONT_HEIGHT * pen->dot_px};
    note_between(list, item, at, end, is_other);
}

static struct lm_rectangle common(const struct lm_rectangle *a, const struct lm_rectangle *b)
{
    return (struct lm_rectangle){fx_max_i32(a->left, b->left), fx_max_i32(a->top, b->top),
                                 fx_min_i32(a->right, b->right), fx_min_i32(a->bottom, b->bottom)};
}

/* Draw a text within each rectangle of the damage, rather than each dot within each block. */
static void paint_text(const struct lm_draw_list *list, const struct lm_draw_item *i,
                       struct lm_pen pen)
{
    const char *const words = list->words[i->number];
    const struct lm_damage *const within = pen.within;
    struct lm_rectangle part;
    const struct lm_rectangle all =
        common(&pen.clip, &(struct lm_rectangle){i->from_x, i->from_y, i->to_x, i->to_y});
    struct lm_damage_walk walk = lm_damage_walk(&all);
    pen.within = NULL;
    if (!within) {
        lm_draw_glyphs(&pen, i->from_x, i->from_y, words);
        return;
    }
    while (lm_damage_next(within, &walk, &part)) {
        pen.clip = part;
        lm_draw_glyphs(&pen, i->from_x, i->from_y, words);
    }
}

static void paint(const struct lm_draw_list *list, const struct lm_draw_item *i,
                  const struct lm_pen *pen)
{
    const struct lm_arc arc = arc_of(i);
    switch ((enum lm_draw_kind)i->kind) {
    case LM_DRAW_BOX:
        lm_draw_box(pen, i->from_x, i->from_y, i->to_x - i->from_x, i->to_y - i->from_y);
        break;
    case LM_DRAW_LINE:
        lm_draw_line(pen, (struct lm_point){i->from_x, i->from_y},
                     (struct lm_point){i->to_x, i->to_y});
        break;
    case LM_DRAW_ARC:
        lm_draw_arc(pen, &arc);
        break;
    case LM_DRAW_TEXT:
        paint_text(list, i, *pen);
        break;
    }
}

void lm_draw_list_paint(const struct lm_draw_list *list, const struct lm_surface *surface,
                        const struct lm_damage *within)
{
    struct lm_pen pen = lm_pen_for(surface, 0);
    for (uint32_t n = 0; n < list->count; n++) {
        const struct lm_draw_item *const i = &list->item[n];
        const struct lm_rectangle all = bounds(i);
        if (lm_damage_meets(within, &all)) {
            pen.clip = (struct lm_rectangle){i->left, i->top, i->right, i->bottom};
            pen.colour = i->colour << surface->shift;
            pen.within = lm_damage_covers(within, &all) ? NULL : within;
            paint(list, i, &pen);
        }
    }
}
