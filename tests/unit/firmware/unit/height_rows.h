#ifndef HEIGHT_ROWS_H
#define HEIGHT_ROWS_H

#include "lm/bus.h"

/* A bus that is none of those built in: true altitude at another identifier. */
static const struct lm_bus_row height_rows[] = {{.name = "height",
                                                 .id = 700,
                                                 .field = LM_BUS_TRUE_ALTITUDE,
                                                 .stale_ms = 300,
                                                 .dead_ms = 2000,
                                                 .period_us = 100000,
                                                 .low = -1000,
                                                 .high = 30000,
                                                 .types = 1u << LM_CANAS_FLOAT,
                                                 .per_unit = 1}};

#endif
