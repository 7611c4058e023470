/* Atomic file: it appears under its final name whole, or not at all. Usage: hs_atomic_open, write
 * to `stream`, then hs_atomic_commit, or hs_atomic_abort to give up.
 *
 * An output never takes the place of an input (hs/input_file.h), of a device, a pipe or a folder.
 * Temporary files vanish when the program ends, at SIGINT, SIGTERM and SIGHUP too. */
#ifndef HS_ATOMIC_FILE_H
#define HS_ATOMIC_FILE_H

#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

struct hs_atomic_file {
    FILE *stream;    /* open for reading and writing until commit or abort */
    char *path;      /* owned */
    char *temporary; /* owned: the name used while writing, in the same folder */
};

/* Make sure, before long work, that `path` can be written at its end: makes the temporary file,
 * which hs_atomic_open takes over. Returns 0, or -1 with the error reported:
 * - `path` exists and is no ordinary file, because it would be replaced,
 * - it is an input of this run, or lies in a folder that is one,
 * - it is claimed already: two outputs would be one file,
 * - the folder is missing or cannot be written. */
int hs_output_claim(const char *path);

/* Begin a file that will be called `path`, and put it in place. Commit flushes to the disk before
 * it renames. Both return 0, or -1 with the error reported; nothing is left of the temporary file
 * then, nor after a commit. Failures:
 * - open: as hs_output_claim, but for a claim; no memory,
 * - commit: the disk is full, the rename is refused, or `path` has become an input. */
int hs_atomic_open(struct hs_atomic_file *f, const char *path);
int hs_atomic_commit(struct hs_atomic_file *f);

/* Forget the file: removes the temporary one. Harmless after a commit or a failed open. */
void hs_atomic_abort(struct hs_atomic_file *f);

/* For libraries that insist on opening the file themselves: the temporary name for `path` (caller
 * frees), and the rename at the end. Both report and return NULL or -1 on failure, the first as
 * hs_atomic_open, the second with `temporary` removed. `hs_atomic_drop` removes a temporary file
 * instead; harmless when there is none. */
char *hs_atomic_temporary_name(const char *path);
int hs_atomic_rename(const char *temporary, const char *path);
void hs_atomic_drop(const char *temporary);

/* Remove what another process that was killed has left of the file it would have called `path`.
 * Harmless when there is nothing. */
void hs_atomic_drop_of(const char *path, pid_t process);

/* Remove `path`, a file that belonged to one that is replaced. Harmless when there is none. */
void hs_atomic_remove(const char *path);

/* For commands whose files belong together: from here on what is committed, renamed or removed
 * waits, with its errors of the disk reported at once, until hs_report_end. That puts all in place
 * after a good run, and nothing after a bad one or a signal; only a kill between two renames or a
 * failed rename can leave some. A file cannot be read back under its final name before. */
void hs_outputs_together(void);

/* The end of that, by hs_report_end: put all in place, or forget all. Harmless when nothing waits.
 * Returns 0, or -1 with the error reported and nothing in place: `path` has become an input or no
 * ordinary file; or some in place: a rename was refused. */
int hs_outputs_end(bool is_good);

#endif
