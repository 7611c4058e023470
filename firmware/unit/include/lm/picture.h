/* The radar picture: a sector or a patch, drawn line by line into the plane.
 *
 * Every kind of picture (enum lm_picture_kind) stands behind the functions below; nobody else asks
 * which kind is shown. A new kind is a file beside picture_sector.c and picture_patch.c, a row of
 * the table in picture.c, its name in lm/radar.h and its state in struct lm_picture.
 *
 * Order of the calls: init, start, and then in each step prefetch, while is_ready: draw_line, and
 * once a frame describe. */
#ifndef LM_PICTURE_H
#define LM_PICTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/coverage.h"
#include "lm/cursor.h"
#include "lm/environment.h"
#include "lm/nav.h"
#include "lm/overlay.h"
#include "lm/page.h"
#include "lm/sar.h"
#include "lm/sector.h"
#include "lm/unit_map.h"

/* What every picture reads. All borrowed, for as long as the picture lives. */
struct lm_picture_lent {
    const struct lm_radar *radar;
    struct lm_unit_map *map;
    const struct lm_environment *environment;
    const struct lm_ownship *ownship;
    struct lm_page *page;     /* what is selected; notes which picture begins and the beam's tilt */
    struct lm_cursor *cursor; /* where windows and patches lie; located again in a new view */
    uint32_t noise_seed;
};

struct lm_picture {
    struct lm_picture_lent lent;

    struct lm_sector sector;
    bool is_cursor_awaited; /* by a window: the whole sector is swept until the cursor is placed */

    struct lm_sar sar;
    struct {
        bool is_reading;          /* tiles of the patch are being read, and no line is drawn */
        uint32_t lines_asked_for; /* lines whose tiles were asked for */
        uint64_t until_us;        /* then lines are drawn with the tiles that have come */
    } acquire;

    struct lm_tone tone[LM_PICTURES];
    struct lm_line line; /* work */
    struct lm_coverage coverage;
    uint64_t next_line_us; /* when the next line is due */

    struct lm_plane plane; /* the pixels are the board's */
    struct lm_frame frame; /* where radar is drawn in it */
    struct lm_view view;   /* how the picture in the plane lies over the ground */
    bool is_view_held;     /* the picture stands, and the aircraft moves over it */
};

/* Nothing is shown yet: the plane is black, and lm_picture_start comes next. */
void lm_picture_init(struct lm_picture *p, const struct lm_picture_lent *lent,
                     const struct lm_plane *plane);

/* Begin a picture, as the page has it selected, on a black plane; the page notes its kind. `patch`
 * is the request for a patch, and NULL for any other kind. False, with the picture at hand going on
 * unchanged, when
 * - there is no map that a patch could be made from;
 * - the patch is to be seen from the ownship, and navigation is not good (enum lm_nav_quality);
 * - lm_sar_start refuses it.
 * A sector always begins. */
bool lm_picture_start(struct lm_picture *p, enum lm_picture_kind kind,
                      const struct lm_sar_command *patch, uint64_t now_us);

/* Remove what is drawn, because the glass may not show it any longer. A patch then begins again
 * from its first line; a sector sweeps on. */
void lm_picture_remove(struct lm_picture *p);

/* Take the page's gain and tone, for every kind of picture. */
void lm_picture_set_tone(struct lm_picture *p);

/* Point the beam as the page says. A patch's beam is not the operator's: nothing happens. */
void lm_picture_set_beam(struct lm_picture *p);

/* Ask for some tiles that lines to come will need. Once a step. */
void lm_picture_prefetch(struct lm_picture *p);

/* True when lines may be drawn at `now_us`; false while tiles are awaited and once the picture is
 * complete. */
bool lm_picture_is_ready(struct lm_picture *p, uint64_t now_us);

/* Draw the next line into the plane and say when the one after is due (next_line_us). Takes off
 * `*azimuths` what it traced of the azimuths that this step may still trace. False when the line
 * needs more samples than that: call again in the next step. */
bool lm_picture_draw_line(struct lm_picture *p, uint64_t now_us, uint32_t *azimuths);

/* Put the view where the picture lies now, and the cursor in it. A picture that moves with the
 * aircraft keeps the view it was drawn with while it `is_standing`. */
void lm_picture_follow_view(struct lm_picture *p, bool is_standing);

/* True for a picture that is drawn around the aircraft and moves with it, at the page's range
 * scale: it begins again when the aircraft's position jumps. */
bool lm_picture_moves(const struct lm_picture *p);

/* True when the picture cannot go on without the ownship. */
bool lm_picture_needs_ownship(const struct lm_picture *p);

/* What the cursor is moved against; good until the picture changes. */
struct lm_cursor_scene lm_picture_cursor_scene(const struct lm_picture *p);

/* Fill in the symbols that belong to the kind of picture: scales and antenna, window, patch. */
void lm_picture_describe(const struct lm_picture *p, struct lm_symbols *symbols);

#endif
