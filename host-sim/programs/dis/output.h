/* Output: where the frames of landmass-dis go. */
#ifndef DIS_OUTPUT_H
#define DIS_OUTPUT_H

#include "drv/can_socket.h"
#include "hs/atomic_file.h"
#include "options.h"

struct output {
    const struct command *command; /* borrowed */
    FILE *log;                     /* NULL: an interface */
    struct hs_atomic_file file;
    struct drv_can_socket socket;
    bool has_file, has_failed;
};

/* Returns 0, or -1 with the error reported. */
int output_open(struct output *o, const struct command *c);

/* A sink of the gateway. */
bool output_send(void *context, const struct lm_can_frame *frame, int64_t time_us);

/* What was sent leaves this program. */
void output_flush(struct output *o);

/* Finish a run that went well, or not. Returns 0, or -1 with the error reported. */
int output_close(struct output *o, bool is_well);

#endif
