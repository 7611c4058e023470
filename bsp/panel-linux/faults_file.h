/* The last faults of the panel, in a text file that outlives a restart and a power cut:
 *
 *     faults_file_start(&f, path);                read what is there; start the thread
 *     faults_file_keep(&f, &unit->faults, now);   in each step; never waits
 *     faults_file_close(&f);
 *
 * One line a fault, the oldest first: when it rose by the panel's clock, how long after its start,
 * and its word on the glass. A thread writes the file anew at each fault, beside the old one,
 * brings it to the medium and renames it: after a power cut it has all but what rose in the last
 * moments, or all. */
#ifndef PANEL_FAULTS_FILE_H
#define PANEL_FAULTS_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "hand_over.h"
#include "lm/fault_log.h"

enum { FAULTS_LINES = 32, FAULTS_LINE_BYTES = 64, FAULTS_BYTES = FAULTS_LINES * FAULTS_LINE_BYTES };

struct faults_news {
    struct lm_fault_log log;
    uint64_t now_us; /* of the panel's clock when it was handed over */
};

struct faults_file {
    const char *path;        /* borrowed; "": none are kept */
    char text[FAULTS_BYTES]; /* of the file; the thread's once it runs */
    size_t size;
    struct hand_over writer;
    struct faults_news handed, taken; /* the place, and the thread's copy */
    uint32_t told;                    /* faults that the loop has handed over */
    uint32_t written;                 /* faults that the thread has put into the text */
    bool is_failing;                  /* told once, until a write succeeds */
};

/* Read the file, tell how many it has and the last one, and start the thread. What is not such a
 * file is reported and begun anew with the next fault. */
void faults_file_start(struct faults_file *f, const char *path);

/* Hand the log over where a fault has risen since. */
void faults_file_keep(struct faults_file *f, const struct lm_fault_log *log, uint64_t now_us);

/* Write what was handed over last, and end. */
void faults_file_close(struct faults_file *f);

#endif
