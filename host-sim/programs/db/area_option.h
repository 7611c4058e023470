/* Area option of the sub-commands that look at an image: --area LATS,LONW,LATN,LONE. */
#ifndef DB_AREA_OPTION_H
#define DB_AREA_OPTION_H

#include "image/grid.h"

/* Read south, west, north and east in degrees. Returns 0, or -1 with the error reported. */
int db_area_read(struct image_area *area, const char *text);

/* Report that an area shows nothing, at `level` or coarser; `place` is for the message. Returns -1.
 */
int db_area_is_empty(const char *place, int level);

#endif
