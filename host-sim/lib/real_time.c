#include "hs/real_time.h"

#include <signal.h>

static volatile sig_atomic_t is_interrupted;

int64_t hs_clock_us(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (int64_t)t.tv_sec * 1000000 + t.tv_nsec / 1000;
}

static void interrupt(int number)
{
    (void)number;
    is_interrupted = 1;
}

void hs_catch_interrupts(void)
{
    signal(SIGINT, interrupt);
    signal(SIGTERM, interrupt);
}

bool hs_is_interrupted(void)
{
    return is_interrupted;
}
