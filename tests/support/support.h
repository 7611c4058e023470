/* What the tests share: where the real data lies, and how a test says that it is not there. */
#ifndef SUPPORT_H
#define SUPPORT_H

#include <stddef.h>

/* Write the path of `relative` below the real data into `path` and return 1 when it is there.
 * The data lies in $LANDMASS_DATA, or else beside the checkout in ../shared/data; when it is absent
 * the function says so in the test's log and returns 0, and the caller calls skip(). */
int support_data_path(const char *relative, char *path, size_t size);

/* The build folder ("build/bench-linux"), where a test finds the programs (bin/) and may write
 * (tmp/). */
const char *support_build_dir(void);

/* A number that the environment has for a test, such as SEED, or else the usual one. */
unsigned long support_number(const char *variable, unsigned long usual);

/* Run a shell command with its output going to the test's log; returns the exit status. */
int support_run(const char *format, ...) __attribute__((format(printf, 1, 2)));

#endif
