/* Picture: the radar picture, a sector or a patch, drawn line by line into the plane.
 *
 * The functions below are the interface of every kind of picture (enum lm_picture_kind); no other
 * part of the unit asks which kind is shown. A new kind is a file beside picture_sector.c and
 * picture_patch.c, a row of the table in picture.c, its name in lm/radar.h and its state in struct
 * lm_picture.
 *
 * Order of calls:
 *
 *     lm_picture_init
 *     lm_picture_start           whenever the operator selects another picture
 *     in each step:
 *         lm_picture_follow_view
 *         lm_picture_prefetch
 *         while a line is due and lm_picture_is_ready: lm_picture_draw_line
 *     in each frame:
 *         lm_picture_describe
 */
#ifndef LM_PICTURE_H
#define LM_PICTURE_H

#include <stdbool.h>
#include <stdint.h>

#include "lm/coverage.h"
#include "lm/cursor.h"
#include "lm/environment.h"
#include "lm/exercise.h"
#include "lm/malfunction.h"
#include "lm/nav.h"
#include "lm/overlay.h"
#include "lm/page.h"
#include "lm/sar.h"
#include "lm/sector.h"
#include "lm/unit_map.h"

/* Inputs of a picture. All pointers stay borrowed as long as the picture is used. */
struct lm_picture_lent {
    const struct lm_radar *radar;
    struct lm_unit_map *map;
    const struct lm_environment *environment;
    const struct lm_ownship *ownship;
    struct lm_page
        *page; /* the operator's selection; is told of the picture's kind and the beam's tilt */
    struct lm_cursor *cursor; /* centre of windows and patches; is located again in a new view */
    const struct lm_exercise *exercise; /* its clock and its seed */
    const struct lm_malfunctions *malfunctions;
    struct lm_glass_options options;
};

struct lm_picture {
    struct lm_picture_lent lent;

    struct lm_sector sector;
    bool is_cursor_awaited; /* a window is selected, but swept as NORM until the cursor is placed */
    bool is_recentred; /* the window's next sweep has its centre; its geometry is still the old one
                        */
    struct {
        uint64_t begun_us, period_us; /* by the exercise clock; period 0: by the unit's */
    } turn;                           /* the running sweep's place in the exercise */

    struct lm_sar sar;
    struct lm_patch_painter painter;
    struct {
        bool is_reading;          /* the patch's tiles are being read; no line is drawn */
        bool has_tiles;           /* all tiles and chips are there; detail may still be read */
        uint32_t lines_asked_for; /* the tiles of lines below this one were requested */
        uint64_t until_us;        /* end of the wait: lines are then drawn with the tiles at hand */
        uint64_t most_us;         /* end of it, however many tiles come */
        uint32_t tiles_read;      /* by the cache, when it was last put off */
    } acquire;

    struct lm_tone tone[LM_PICTURES];
    uint32_t targets_left_out; /* times that a sample or a patch had no room for one: only grows */
    int32_t patch_loss_db_q8;  /* of the signal by a weak transmitter, at the patch's start */
    struct lm_line line;       /* work space */
    struct lm_coverage coverage;
    uint64_t next_line_us; /* when the next line is due */
    bool is_step_spent;    /* a picture or a sweep began in this step, at the cost of a step */

    struct lm_plane plane; /* the pixels are lent by the board */
    struct lm_frame frame; /* part of the plane that shows radar */
    struct lm_view view;   /* of the picture in the plane */
    bool is_view_held;     /* the picture stands and the aircraft moves over it */
};

/* Begin with a black plane; *lent and *plane are copied. lm_picture_start must be the next call. */
void lm_picture_init(struct lm_picture *p, const struct lm_picture_lent *lent,
                     const struct lm_plane *plane);

/* Begin a picture of the page's settings on a black plane. Its kind becomes the page's. `patch` is
 * the request for a patch, copied, and NULL for any other kind. A sector always begins. Returns
 * LM_REFUSED_NOT; or the reason, and the present picture goes on unchanged:
 * - LM_REFUSED_MAP: a patch is asked for and there is no usable map;
 * - LM_REFUSED_SILENT, LM_REFUSED_GIMBAL: an exercise has broken transmitter or antenna;
 * - LM_REFUSED_NAV: the patch is seen from the ownship, and navigation is not good (enum
 *   lm_nav_quality);
 * - what lm_sar_judge says of the patch. */
enum lm_refusal lm_picture_start(struct lm_picture *p, enum lm_picture_kind kind,
                                 const struct lm_sar_command *patch, uint64_t now_us);

/* Make the plane black, because what it shows is no longer true. A patch begins again from its
 * first line; a sector sweeps on. */
void lm_picture_remove(struct lm_picture *p);

/* Take the page's gain and tone settings, for every kind of picture. */
void lm_picture_set_tone(struct lm_picture *p);

/* Take the page's tilt and beam shape. No effect on a patch, whose beam the operator does not
 * point. */
void lm_picture_set_beam(struct lm_picture *p);

/* Request some tiles of lines to come. Call once a step. Never waits. */
void lm_picture_prefetch(struct lm_picture *p);

/* True if lines may be drawn at `now_us`: no tiles are awaited, and the picture is not complete. */
bool lm_picture_is_ready(struct lm_picture *p, uint64_t now_us);

/* Draw the next line into the plane, and advance next_line_us to when the line after it is due.
 * *azimuths is the number of azimuths that this step may still trace; those traced are subtracted.
 * False if the line needs more samples than that, or a sweep began: call again in the next step. */
bool lm_picture_draw_line(struct lm_picture *p, uint64_t now_us, uint32_t *azimuths);

/* Update the view, and locate the cursor in it. A picture that moves with the aircraft keeps the
 * view it was drawn with while it `is_standing`. When that ends, it is removed, and swept anew
 * where the antenna is. */
void lm_picture_follow_view(struct lm_picture *p, bool is_standing);

/* The map has other images than before, when its finest cells were of `shift_was`. A sweep begins
 * again over what is drawn; a patch that is whole stays as it is. True for one that is not: it must
 * be started again. */
bool lm_picture_change_map(struct lm_picture *p, uint32_t shift_was);

/* True if the picture is drawn around the aircraft, at the page's range scale, and moves with it.
 * Such a picture must be started again when the aircraft's position jumps. */
bool lm_picture_moves(const struct lm_picture *p);

/* True if the picture cannot be continued without the ownship's position. */
bool lm_picture_needs_ownship(const struct lm_picture *p);

/* Surroundings of the cursor; the view in it is borrowed from *p. */
struct lm_cursor_scene lm_picture_cursor_scene(const struct lm_picture *p);

/* Set the members of *symbols that belong to the kind of picture: those of sector, window, antenna
 * or patch. */
void lm_picture_describe(const struct lm_picture *p, struct lm_symbols *symbols);

#endif
