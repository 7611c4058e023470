/* The host that runs the microcontroller, through semihosting (Arm IHI 0100): its console and one
 * of its files. */
#ifndef HOST_H
#define HOST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

void host_say(const char *words);

/* "name 0123abcd 4567cdef" on a line. */
void host_say_checksums(const char *name, uint32_t first, uint32_t second);

void host_say_number(uint32_t number);

_Noreturn void host_exit(int status);

/* Open for reading; a handle, or -1. */
int host_open(const char *path);
bool host_length(int handle, uint32_t *bytes);
bool host_read(int handle, uint32_t offset, void *to, uint32_t length);

#endif
