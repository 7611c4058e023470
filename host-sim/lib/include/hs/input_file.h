/* Input files of a run. Whatever a program reads is noted here, and no output may take its place
 * (hs/atomic_file.h). Files are compared by device and inode: other names, symbolic links and hard
 * links of a file are the file. */
#ifndef HS_INPUT_FILE_H
#define HS_INPUT_FILE_H

#include <stdbool.h>
#include <stdio.h>

/* Note files from here on; hs_set_program calls it. A test that reads and writes one file again and
 * again does not. */
void hs_input_guard(void);

/* Open a file for reading and note it. Returns NULL with errno set as fopen does. */
FILE *hs_input_open(const char *path, const char *mode);

/* Note a file that a library opens by itself. What does not exist or is no ordinary file is passed
 * over. */
void hs_input_note(const char *path);

/* Note a folder that is read as one thing: no output may be put into it. */
void hs_input_note_folder(const char *path);

/* Take a file off the list: it is read in order to be continued under its own name. */
void hs_input_forget(const char *path);

/* Is what stands at `path` an input, or would it lie in a folder that is one? */
bool hs_input_is(const char *path);

#endif
