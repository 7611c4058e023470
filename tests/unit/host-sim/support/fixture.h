/* A folder for the files of one test program, small rasters in it, and the program under test. */
#ifndef FIXTURE_H
#define FIXTURE_H

#include "gis/raster.h"

#include <stddef.h>
#include <stdint.h>

enum { FIXTURE_PATH = 256 };

/* Make the folder anew; for the group set-up and tear-down of cmocka. */
int fixture_open(void **state);
int fixture_close(void **state);

/* The path of `name` in the folder. The same few buffers are used in turn. */
const char *fixture_path(const char *name);

void fixture_write(const char *name, const char *text);

/* A one-metre grid at 500000, -400000 in UTM zone 22 N, whose northings are negative. */
struct db_grid fixture_grid(int width, int height);

/* Write a one-band GeoTIFF of `values`, row by row, on `grid`. */
void fixture_raster(const char *name, const struct db_grid *grid, GDALDataType type,
                    const float *values, double nodata);

/* Run landmass-db; its output goes to `said` (NULL: to the log). Returns the exit status. */
int fixture_run(char *said, size_t size, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Whether landmass-db failed with `exit_code` and said `text` on its way. */
int fixture_fails(int exit_code, const char *text, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
