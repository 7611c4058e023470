/* A country for flights in tests: hills, a pond, and houses every 400 m. */
#ifndef TINY_COUNTRY_H
#define TINY_COUNTRY_H

#include "tiny_image.h"

/* So many tiles of shift 11 each way round 46 N 11 E. Change what the test needs. */
struct tiny_spec tiny_country(uint8_t tiles);

#endif
