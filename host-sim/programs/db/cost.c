#include "cost.h"

#include "hs/report.h"

#include <stdio.h>
#include <sys/resource.h>
#include <time.h>

double db_cost_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void db_cost_report(double seconds)
{
    struct rusage used;
    if (getrusage(RUSAGE_SELF, &used) == 0) {
        const double processor_s =
            (double)used.ru_utime.tv_sec + 1e-6 * (double)used.ru_utime.tv_usec +
            (double)used.ru_stime.tv_sec + 1e-6 * (double)used.ru_stime.tv_usec;
        const double memory_mib = (double)used.ru_maxrss / 1024;
        printf("done in %.1f s, %.1f s of a processor, %.0f MiB\n", seconds, processor_s,
               memory_mib);
        hs_report_put("seconds", seconds);
        hs_report_put("processor_s", processor_s);
        hs_report_put("memory_mib", memory_mib);
    }
}
