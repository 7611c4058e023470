/* Files of the panel's recording, and the thread that writes them:
 *
 *     flight-00042-000.log, -001.log, ...   the parts of session 42, one after another
 *     current.log                           symbolic link to the part that grows
 *
 * Sessions are numbered in the order of their starts. The oldest are removed, each as a whole,
 * where the folder or the file system would grow beyond its limits; never the present one. Private
 * to recording.c. */
#ifndef PANEL_RECORDING_FILES_H
#define PANEL_RECORDING_FILES_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>

#include "byte_ring.h"

enum {
    RECORDING_PARTS_MAX = 1000,
    RECORDING_FILES_MAX = 2000, /* in the folder: a panel that restarts for ever makes small ones */
    RECORDING_SYNC_US = 500000, /* what was written is brought to the medium so often */
    RECORDING_REST_US = 50000,  /* the thread looks for lines so often */
    RECORDING_RING_BYTES = 1 << 20
};

struct recording_limits {
    uint64_t bytes;       /* of all parts in the folder */
    uint64_t free_bytes;  /* that the file system keeps */
    uint32_t part_bytes;  /* after which another part begins */
    uint32_t ring_bytes;  /* a power of two */
    uint32_t check_every; /* pictures for each checksum of one */
};

/* The panel's, beside `bytes`, which its configuration says. */
extern const struct recording_limits recording_usual;

struct recording_files {
    char folder[128];
    int folder_fd, fd; /* -1: not open */
    struct recording_limits limits;
    struct byte_ring *ring; /* borrowed */
    pthread_t thread;
    bool has_thread;
    uint32_t session, part;
    uint64_t synced_us; /* time of the last sync */
    bool is_dirty;

    atomic_bool is_closing; /* write what is there, and end */
    atomic_bool is_broken;  /* nothing is written any more */
    atomic_bool may_go_on;  /* there is room for another part */
    atomic_size_t cut;      /* place in the stream at which the next part begins; 0: nowhere yet */
    struct {
        atomic_uint removed;     /* sessions */
        atomic_uint sync_max_us; /* longest sync */
    } count;
};

/* Open the folder. Returns 0 or errno. */
int recording_files_open(struct recording_files *f, const char *folder,
                         const struct recording_limits *limits, struct byte_ring *ring);

/* Begin a session with its part 0, and start the thread. Returns 0 or errno. */
int recording_files_start(struct recording_files *f);

/* Let the thread write what is in the ring and end; close the folder. */
void recording_files_close(struct recording_files *f);

#endif
