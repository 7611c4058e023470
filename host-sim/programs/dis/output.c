#include "output.h"

#include "drv/can_log.h"
#include "hs/error.h"

#include <errno.h>
#include <string.h>

int output_open(struct output *o, const struct command *c)
{
    o->command = c;
    o->log = NULL;
    o->has_file = o->has_failed = false;
    if (c->can != NULL) {
        return drv_can_socket_open(&o->socket, c->can, NULL, 0, 0) == LM_OK
                   ? 0
                   : hs_error("--can", "ip link set NAME up type can bitrate 1000000", "%s",
                              o->socket.error);
    }
    if (c->out_path == NULL) {
        o->log = stdout;
        return 0;
    }
    if (hs_atomic_open(&o->file, c->out_path) != 0) {
        return -1;
    }
    o->has_file = true;
    o->log = o->file.stream;
    return 0;
}

bool output_send(void *context, const struct lm_can_frame *frame, int64_t time_us)
{
    struct output *o = context;
    if (o->log == NULL) {
        const struct lm_can port = drv_can_socket_port(&o->socket);
        return port.send(port.ctx, frame) == LM_OK;
    }
    const bool is_written =
        drv_can_log_write(o->log, o->command->interface, (uint64_t)time_us, frame) == LM_OK;
    o->has_failed |= !is_written;
    return is_written;
}

void output_flush(struct output *o)
{
    struct lm_can_frame frame;
    if (o->log == NULL) { /* events of the interface, and what waited for room */
        const struct lm_can port = drv_can_socket_port(&o->socket);
        (void)port.receive(port.ctx, &frame);
    } else if (!o->has_file) {
        o->has_failed |= fflush(o->log) != 0;
    }
}

int output_close(struct output *o, bool is_well)
{
    if (o->log == NULL) {
        drv_can_socket_close(&o->socket);
        return 0;
    }
    if (o->has_file) {
        if (is_well) {
            return hs_atomic_commit(&o->file); /* reports what could not be written */
        }
        hs_atomic_abort(&o->file);
        return 0;
    }
    if (is_well && (fflush(stdout) != 0 || o->has_failed)) {
        return hs_error("standard output", "free some space, or read to the end",
                        "cannot be written: %s", strerror(errno));
    }
    return 0;
}
