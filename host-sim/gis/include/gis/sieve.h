/* Sieve: specks of a class raster take the class of their largest neighbour; classify/specks.h goes
 * on from there. A speck is an 8-connected component of one class that covers less ground than a
 * limit. A classifier that looks at one pixel at a time makes them at borders, where a pixel is a
 * mixture of two classes and looks like a third. */
#ifndef GIS_SIEVE_H
#define GIS_SIEVE_H

#include "gis/raster.h"

/* How many pixels components must have not to be specks of less than `speck_m2`; 1 when a single
 * pixel is no speck, or the grid does not say how large a pixel is. */
int db_sieve_pixels(const struct db_grid *grid, double speck_m2);

/* Rasters are sieved in bands of so many rows, each with a margin on either side, so that memory is
 * bounded and a raster that is made in strips (gis/strips.h) comes out as one that is not. What is
 * a speck is exact. Which neighbour is the largest is told by the pixels within the margin. */
enum { DB_SIEVE_ROWS = 1024 };

/* Rows of the margin: 0 without a sieve, else at least 256 and four times `pixels`. A component
 * that reaches from a band beyond its margin has more pixels than a speck in the margin alone, and
 * so has a speck's neighbour. */
int db_sieve_margin(int pixels);

/* Take components of fewer than `pixels` pixels out of rows * width classes: they get the class of
 * their largest neighbour. Pixels without data stay so, and are nobody's neighbours. `name` is for
 * messages. Memory: some 24 bytes a component. Returns 0, or -1 with the error reported. */
int db_sieve(uint8_t *classes, int width, int rows, int pixels, const char *name);

#endif
