/* Atomic file: it appears under its final name whole, or not at all. Usage: hs_atomic_open, write
 * to `stream`, then hs_atomic_commit, or hs_atomic_abort to give up. */
#ifndef HS_ATOMIC_FILE_H
#define HS_ATOMIC_FILE_H

#include <stdio.h>

struct hs_atomic_file {
    FILE *stream;    /* open for reading and writing until commit or abort */
    char *path;      /* owned */
    char *temporary; /* owned: the name used while writing, in the same folder */
};

/* Begin a file that will be called `path`, and put it in place. Commit flushes to the disk before
 * it renames. Both return 0, or -1 with the error reported; nothing is left of the temporary file
 * then, nor after a commit. Failures:
 * - open: `path` exists and is no ordinary file (a device, a pipe, a folder), because it would be
 *   replaced; the folder is missing or cannot be written; no memory,
 * - commit: the disk is full, or the rename is refused. */
int hs_atomic_open(struct hs_atomic_file *f, const char *path);
int hs_atomic_commit(struct hs_atomic_file *f);

/* Forget the file: removes the temporary one. Harmless after a commit or a failed open. */
void hs_atomic_abort(struct hs_atomic_file *f);

/* For libraries that insist on opening the file themselves: the temporary name for `path` (caller
 * frees), and the rename at the end. `hs_atomic_rename` reports, removes `temporary` and returns -1
 * on failure. */
char *hs_atomic_temporary_name(const char *path);
int hs_atomic_rename(const char *temporary, const char *path);

#endif
