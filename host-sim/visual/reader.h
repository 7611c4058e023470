/* Readers of models in processes of their own. */
#ifndef VISUAL_READER_H
#define VISUAL_READER_H

#include "visual/model.h"

#include <signal.h>
#include <stdint.h>

/* What a reader writes into its file: this, then materials, triangles, and embedded textures, each
 * a length of 8 bytes and its bytes. */
struct reader_head {
    uint32_t triangle_count, material_count, embedded_count;
    uint32_t upright, not_finite, crossed;
};

enum reader_exit { READER_DONE, READER_REPORTED = 1, READER_NO_PROGRAM = 127 };

/* Between these two, signals that end a program wait, so that what was made for a reader is
 * removed. They reach a reader at once. */
void reader_hold_signals(sigset_t *before);
void reader_release_signals(const sigset_t *before);

/* Run `work` in a child under the limits of visual/model.h; its value is the child's exit status.
 * Returns 0 when it is READER_DONE, READER_REPORTED when it is that, or else -1 with the error
 * reported. */
int reader_run(int (*work)(void *), void *context, const char *place);

/* For `work`: read a file with Assimp and write what visual/model.h promises to `out_fd`. */
struct reader_job {
    const char *path;
    const char *name; /* for messages */
    double metres_per_unit;
    enum visual_up up;
    bool keeps_walls;
    int out_fd;
};
int reader_assimp(void *context);

/* Convert an OpenFlight file into `folder`/model.obj with osgconv, run as a child. Counts textures
 * that it misses into m->lost_textures. Returns 0, or -1 with the error reported. */
int reader_osgconv(struct visual_model *m, const char *path, const char *search,
                   const char *folder);

#endif
