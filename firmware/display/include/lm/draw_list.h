/* Draw list: what is drawn over the picture, noted item by item and kept from frame to frame. An
 * item that differs from the one at its place in the list before is damage, there and where it was.
 *
 *     lm_draw_list_begin(&list, &damage);
 *     lm_draw_text(&pen, 10, 10, "NAV FAIL");          pen.list is &list
 *     lm_draw_list_end(&list);                         marks items that are no longer there
 *     lm_draw_list_paint(&list, &surface, &within);
 *
 * The caller owns the list; all zero is an empty one. Nothing here fails. Where the list is full,
 * items are left out: the fullest page takes two thirds of it. */
#ifndef LM_DRAW_LIST_H
#define LM_DRAW_LIST_H

#include <stdint.h>

#include "lm/draw.h"
#include "lm/text.h"

enum { LM_DRAW_ITEMS = 512, LM_DRAW_TEXTS = 96 };

enum lm_draw_kind { LM_DRAW_BOX, LM_DRAW_LINE, LM_DRAW_ARC, LM_DRAW_TEXT };

/* Points are kept in 16 bits: they reach LM_DRAW_FAR pixels from the surface's corners. */
struct lm_draw_item {
    uint32_t colour;
    uint16_t kind;                    /* enum lm_draw_kind */
    uint16_t number;                  /* text: of its words; arc: its radius */
    int16_t left, top, right, bottom; /* the pen's clip */
    union {
        struct {
            int16_t from_x, from_y, to_x, to_y; /* box, text: its rectangle; line: its ends */
        };
        struct lm_spot centre; /* arc */
    };
    fx_bam_t left_edge, span; /* arc */
};

struct lm_draw_list {
    struct lm_damage *damage; /* borrowed: takes what changes */
    uint32_t count, was;      /* items noted so far, and of the list before */
    uint32_t texts;           /* of those items */
    struct lm_draw_item item[LM_DRAW_ITEMS];
    char words[LM_DRAW_TEXTS][LM_TEXT_MAX + 1];
};

/* Begin the next list in the place of the one before. `damage` is borrowed until the end. */
void lm_draw_list_begin(struct lm_draw_list *list, struct lm_damage *damage);
void lm_draw_list_end(struct lm_draw_list *list);

/* Note an item. lm/draw.h calls these. Cost: some 50 instructions; of a text 5 a character more. */
void lm_draw_list_box(struct lm_draw_list *list, const struct lm_pen *pen,
                      const struct lm_rectangle *box);
void lm_draw_list_line(struct lm_draw_list *list, const struct lm_pen *pen, struct lm_point from,
                       struct lm_point to);
void lm_draw_list_arc(struct lm_draw_list *list, const struct lm_pen *pen,
                      const struct lm_arc *arc);
void lm_draw_list_text(struct lm_draw_list *list, const struct lm_pen *pen, struct lm_point at,
                       const char *words);

/* Draw those blocks of the items that `within` marks, the first item first. Cost: some 40
 * instructions an item, and what is drawn. */
void lm_draw_list_paint(const struct lm_draw_list *list, const struct lm_surface *surface,
                        const struct lm_damage *within);

#endif
