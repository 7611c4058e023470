/* Output paths: files that a command writes into a folder of the user's choice. */
#ifndef HS_OUTPUT_PATH_H
#define HS_OUTPUT_PATH_H

#include <stddef.h>

/* Make the folder unless it is there, and write "folder/name" into `path`, which has `size` bytes.
 * Returns 0, or -1 with the error reported: the folder cannot be made, or the path is too long. */
int hs_output_path(char *path, size_t size, const char *folder, const char *name);

/* Whether files can be written to the folder, before the work; it need not be there yet. Returns 0,
 * or -1 with the error reported: it is no folder, it cannot be written to, or it cannot be made. */
int hs_output_folder_check(const char *folder);

#endif
