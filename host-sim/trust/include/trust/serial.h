/* Serial number that was flown last: a file of one line, by which a step back is noticed. */
#ifndef TRUST_SERIAL_H
#define TRUST_SERIAL_H

#include <stdint.h>

/* Read the number. Returns 0; without such a file, too, with *serial 0. Else an errno, EBADMSG if
 * the file holds something else. */
int trust_serial_read(const char *path, uint64_t *serial);

/* Write it, whole or not at all, be the power cut. Returns 0 or an errno. */
int trust_serial_write(const char *path, uint64_t serial);

#endif
