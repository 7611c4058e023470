/* Scripted operation of the bench: what happens when, one line each.
 *
 *   SECONDS gm|gmt|sea|bcn [norm|exp|dbs1|dbs2]   mode and field of view; norm when none is named
 *   SECONDS range 10|20|40|80                 nautical miles: a scale of the radar in use
 *   SECONDS azimuth 60|30|10                  degrees to each side
 *                                             (these words are the radar table's)
 *   SECONDS sar LAT LON CELL_M [EFFECT..]     a patch seen from the ownship
 *   SECONDS sarfrom LAT LON CELL_M LOOK_DEG RANGE_M HEIGHT_M [EFFECT..]
 *                                             EFFECT: plan, without layover; steady, without the
 *                                             blur of turns
 *   SECONDS weather fair                      no rain, nobody jams
 *   SECONDS rain LAT LON RADIUS_KM MM_PER_H   one more circle of rain
 *   SECONDS jam LAT LON DB                    one more jammer, over the noise at ten nautical miles
 *   SECONDS seastate 0..8 [WIND_DEG]     degrees from north that the wind comes from
 *   SECONDS clock SHOWN_S [SEED]              an exercise clock that shows SHOWN_S then; once
 *   SECONDS clock rate RATE                   seconds of the exercise in a second, 0..16
 *   SECONDS break NAME[=VALUE[,VALUE]] [FOR_S]  a malfunction, named as landmass-nav names it
 *   SECONDS gain DB                           -30..30
 *   SECONDS freeze on|off
 *   SECONDS osb N [HELD_S]                    press option select button 1..20, for 0.1 s or HELD_S
 *   SECONDS rocker gain|sym|brt|con +1|-1     one step
 *   SECONDS knob X                            range knob, -1..1
 *   SECONDS slew X Y FOR_S                    cursor to the right and up, -1..1, then centred
 *   SECONDS cursor LAT LON                    put the cursor at a place
 *   SECONDS designate                         target management switch up
 *   SECONDS drop                              target management switch down
 *   SECONDS track                             the switch right: track what is at the cursor
 *   SECONDS ranging                           range the ground straight ahead, or end that
 *   SECONDS mount 2|3|4 FILE                  an image comes to this place beside the database
 *   SECONDS unmount 2|3|4                     the image at this place goes
 *   SECONDS picture NAME                      write NAME.png into the folder of --png
 *
 * Times do not fall from line to line; '#' begins a remark. A press or a slew that lasts ends by
 * itself, whatever the lines behind it do. */
#ifndef SIM_SCRIPT_H
#define SIM_SCRIPT_H

#include "lm/controls.h"
#include "lm/port.h"
#include "lm/radar.h"
#include "nav/exercise.h"

struct script_event {
    uint64_t time_us;
    int order; /* of the event in the script */
    int line;  /* of the script, from 1 */
    bool is_picture;
    char picture[64];
    char image[256]; /* file of LM_CONTROL_IMAGE; empty: it goes */
    struct lm_control control;
};

/* Who opens and closes the images of a script. `open` fills the control of a file at a place, or of
 * none (NULL); false if it cannot be told: the event is left out. */
struct script_images {
    void *ctx;
    bool (*open)(void *ctx, int32_t place, const char *path, struct lm_control *control);
};

struct script {
    const struct lm_radar *radar;      /* borrowed */
    int32_t mode, field, range_nm;     /* selected by the lines so far; -1 behind a key */
    struct lm_environment environment; /* of the line read last: rain and jammers add up */
    struct nav_exercise exercise;      /* what all the lines say, for the bus (sim/drill.h) */
    struct script_event *events;       /* owned */
    int count, next;
    char path[256];   /* of the file, as reports name it; cut off if it is longer */
    int line_taken;   /* line of the control handed out last; 0: none */
    uint64_t last_us; /* of the line read last */
    uint64_t now_us;
    struct lm_controls port;     /* its ctx is this struct, which must not move */
    struct script_images images; /* set by the program; without `open` images are left out */
};

/* Read a script, or make an empty one when `path` is NULL, for a unit with this radar table, which
 * is borrowed. Returns 0, or -1 with the error reported by file and line: a line that is no
 * command, goes back in time, or starts what the table does not have (a field of view that the mode
 * lacks, a scale that both lack). Behind a line that presses a key, the unit alone can tell, and
 * refuses. */
int script_read(struct script *s, const char *path, const struct lm_radar *radar);
void script_free(struct script *s);

/* Report the control handed out last as refused, by file and line, on standard error. The port
 * calls it. */
void script_report_refusal(const struct script *s, enum lm_refusal reason);

/* Controls up to `now_us` are handed out through the port. A picture that is due by then is taken
 * out of the way and its name returned, else NULL. */
const char *script_advance(struct script *s, uint64_t now_us);

#endif
