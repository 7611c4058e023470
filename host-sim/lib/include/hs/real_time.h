/* Programs that run in real time until somebody ends them. */
#ifndef HS_REAL_TIME_H
#define HS_REAL_TIME_H

#include <stdbool.h>
#include <stdint.h>
#include <time.h>

/* Time of CLOCK_MONOTONIC or CLOCK_REALTIME, microseconds. */
int64_t hs_clock_us(clockid_t clock);

/* From here on SIGINT and SIGTERM do not end the program, but make hs_is_interrupted true. */
void hs_catch_interrupts(void);
bool hs_is_interrupted(void);

#endif
