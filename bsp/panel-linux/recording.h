/* Recording of the panel: the last hours of flight as files in a folder, in a ring of sessions
 * (docs/FORMATS.md, 2.8; docs/panel.md, "Recording").
 *
 *     recording_open(&r, folder, &recording_usual);       once
 *     recording_begin(&r, &board, now_us);                before each lm_unit_init
 *     recording_start(&r, board.restart);                 after it
 *     recording_step(&r, now_us);                         before each lm_unit_step
 *     recording_close(&r);
 *
 * The loop puts lines into a ring of bytes and never waits; a thread writes them
 * (recording_files.h). Whatever goes wrong is reported once, and the panel flies on. A recording
 * that has lost a line cannot be shown any further, so it ends there. */
#ifndef PANEL_RECORDING_H
#define PANEL_RECORDING_H

#include "byte_ring.h"
#include "record.h"
#include "recording_files.h"

struct recording {
    bool is_on;     /* the unit's ports are the recorder's */
    bool is_over;   /* nothing more is recorded */
    bool is_behind; /* a line did not fit into the ring */
    struct recorder recorder;
    struct byte_ring ring;
    struct recording_files files;
    uint32_t part;       /* number of the present one */
    size_t part_began;   /* place in the stream of bytes at which it began */
    const char *trouble; /* why the flight is not recorded, in static memory; NULL: it is, or
                            nobody asked for it */
    struct {
        uint32_t lines_lost;
        size_t waiting_max; /* most bytes that waited in the ring */
    } count;
};

/* Open the folder, which is made if its parent is there. An empty name: no recording. */
void recording_open(struct recording *r, const char *folder, const struct recording_limits *limits);

/* Put the recorder between the board's ports and its unit. A second call, before another
 * lm_unit_init, begins again: what the unit of the first one did is forgotten. The board must not
 * move. `now_us` is the time of the unit's clock. */
void recording_begin(struct recording *r, struct lm_board *board, uint64_t now_us);

/* Start to write. `restart` is the board's, which may have been learnt since recording_begin. */
void recording_start(struct recording *r, const char *restart);

void recording_step(struct recording *r, uint64_t now_us);

/* Report the counters. */
void recording_report(const struct recording *r);

/* Write what is there, with the recording's end, and wait for that. */
void recording_close(struct recording *r);

#endif
