/* Small files that outlive a power cut: the old contents or the new, never a part of either. */
#ifndef HS_DURABLE_FILE_H
#define HS_DURABLE_FILE_H

#include <stddef.h>
#include <sys/types.h>

/* Replace `path` by `length` bytes: written to `path.new`, brought to the medium, renamed, and the
 * folder brought to the medium. A new file has `mode` less the mask of the process. 0, or an errno,
 * and `path` is as it was; after an error of the last part alone it may be the new one. */
int hs_replace_file(const char *path, const void *bytes, size_t length, mode_t mode);

/* Bring the names in the folder of `path` to the medium. 0, or an errno. A file system that cannot
 * do it (EINVAL) is no error: it keeps no names apart from its files. */
int hs_sync_folder(const char *path);

/* Let others use an open file as they do its folder: it gets `mode`, whatever the mask of the
 * process, and from root the owner of the folder. What cannot be changed stays. */
void hs_give_to_owner(int fd, const char *path, mode_t mode);

#endif
