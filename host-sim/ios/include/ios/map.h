/* Map of the database as tiles of the Web Mercator projection: EPSG:3857, numbered as in
 * OpenStreetMap's "Slippy map tilenames": zoom 0 is one tile, x grows eastward, y southward. */
#ifndef IOS_MAP_H
#define IOS_MAP_H

#include "image/picture.h"

enum {
    IOS_TILE_PIXELS = 256,
    IOS_TILES_KEPT = 512 /* about 40 MB of PNG at most */
};

/* A tile as a PNG. */
struct ios_tile {
    uint32_t zoom, x, y;
    char *bytes; /* owned by the map; NULL: nothing of the database lies there */
    size_t size;
    uint64_t last_use; /* 0: the slot is free */
};

struct ios_map {
    const struct image *image; /* borrowed */
    struct image_look look;
    struct ios_tile kept[IOS_TILES_KEPT];
    uint64_t clock, drawn;
};

/* What the database covers, degrees; `zoom_max` is the zoom whose pixel is no longer than its
 * finest cell. East is less than west where it lies across the antimeridian. */
struct ios_bounds {
    double west, south, east, north;
    uint32_t zoom_max;
};

/* Begin with an image, which must outlive the map; and end. Returns 0, or -1 with the error
 * reported (no memory). */
int ios_map_open(struct ios_map *map, const struct image *image);
void ios_map_close(struct ios_map *map);

struct ios_bounds ios_map_bounds(const struct ios_map *map);

/* A tile: colours of the classes, lit from the north-west. `x` and `y` are below 2^zoom, zoom at
 * most IOS_ZOOM_MAX. It is drawn in about 20 ms where it was not kept, and valid until the next
 * call. NULL: no memory. */
const struct ios_tile *ios_map_tile(struct ios_map *map, uint32_t zoom, uint32_t x, uint32_t y);

#endif
