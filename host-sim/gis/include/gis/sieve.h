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

/* Write the classes of `from` into `to`, which has the same grid, without components of fewer than
 * `pixels` pixels: they take the class of their largest neighbour. Pixels without data stay so, and
 * are nobody's neighbours. Both are being written. Memory grows with the components. Returns 0, or
 * -1 with the error reported. */
int db_sieve(struct db_raster_out *to, const struct db_raster_out *from, int pixels);

#endif
