/* The functions of <string.h> that a compiler may call by itself. Whoever links an image supplies
 * them: the C library on a hosted board, the board's own start-up files on bare metal. */
#ifndef FX_MEM_H
#define FX_MEM_H

#include <stddef.h>

void *memcpy(void *restrict to, const void *restrict from, size_t len);
void *memset(void *to, int byte, size_t len);
int memcmp(const void *a, const void *b, size_t len);

#endif
