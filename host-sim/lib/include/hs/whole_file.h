/* Reading and writing at a place of a file or device, all of it. */
#ifndef HS_WHOLE_FILE_H
#define HS_WHOLE_FILE_H

#include <stdint.h>

/* Transfer `length` bytes at offset `from` or `to`; the descriptor's position is not used. 0, or an
 * errno: EIO where the file ends before. Signals do not end it. */
int hs_read_whole(int fd, void *to, uint32_t length, uint64_t from);
int hs_write_whole(int fd, const void *from, uint32_t length, uint64_t to);

#endif
