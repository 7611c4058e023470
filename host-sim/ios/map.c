#include "ios/map.h"

#include "hs/png.h"
#include "ios/request.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

int ios_map_open(struct ios_map *map, const struct image *image)
{
    memset(map, 0, sizeof *map);
    map->image = image;
    return image_look_begin(&map->look, image);
}

void ios_map_close(struct ios_map *map)
{
    for (int i = 0; i < IOS_TILES_KEPT; i++) {
        free(map->kept[i].bytes);
    }
    image_look_end(&map->look);
    memset(map, 0, sizeof *map);
}

/* ---- the projection ---- */

/* Latitude, degrees, of a row of pixels: `y` in tiles, from the north. */
static double latitude_of(double y, uint32_t zoom)
{
    return atan(sinh(PI * (1.0 - 2.0 * ldexp(y, -(int)zoom)))) * 180.0 / PI;
}

static double longitude_of(double x, uint32_t zoom)
{
    return 360.0 * ldexp(x, -(int)zoom) - 180.0;
}

/* Level whose cells are no longer than a pixel at this latitude, or the finest. */
static int level_of(const struct image *image, uint32_t zoom, double latitude_deg)
{
    const double pixel_bam = ldexp(cos(latitude_deg * PI / 180.0), 32 - 8 - (int)zoom);
    const int level = (int)floor(log2(pixel_bam)) - image->header.shift0;
    return level < 0 ? 0 : level < image->header.lod_count ? level : image->header.lod_count - 1;
}

struct ios_bounds ios_map_bounds(const struct ios_map *map)
{
    const struct image *image = map->image;
    struct image_area area = {0};
    for (uint32_t i = 0; i < image->db.band_count; i++) {
        const struct lm_band *b = &image->db.bands[i];
        const uint8_t shift = (uint8_t)(image->header.shift0 + b->lod);
        const struct image_frame first = image_frame_of(shift, b->zone, b->row0, b->column0),
                                 last = image_frame_of(shift, b->zone, b->row0 + b->rows - 1,
                                                       b->column0 + b->columns - 1);
        const struct image_area a = image_frame_area(&first), z = image_frame_area(&last);
        if (b->lod == 0) {
            image_area_add(&area, &a);
            image_area_add(&area, &z);
        }
    }
    int64_t latitude;
    uint32_t longitude;
    image_area_centre(&area, &latitude, &longitude);
    uint32_t zoom = 0;
    while (zoom < IOS_ZOOM_MAX && level_of(image, zoom, image_degrees(latitude)) > 0) {
        zoom++;
    }
    return (struct ios_bounds){
        image_longitude_degrees(area.west), image_degrees(area.south),
        image_longitude_degrees((uint32_t)(area.west + (uint64_t)area.width)),
        image_degrees(area.north), zoom};
}

/* ---- drawing ---- */

/* The class's colour, lit as relief is; level ground has three quarters of it. */
static bool draw_pixel(const struct ios_map *map, const struct image_spot *spot, int64_t latitude,
                       uint8_t rgb[3])
{
    const double class = image_spot_value(map->image, IMAGE_PLANE_CLASS, spot, latitude);
    const double shade = image_spot_value(map->image, IMAGE_PLANE_SHADE, spot, latitude);
    if (isnan(class) || isnan(shade)) {
        return false;
    }
    const uint8_t *colour = map->image->db.classes.entry[(int)class].colour;
    for (int i = 0; i < 3; i++) {
        const double lit = colour[i] * (0.3 + 0.45 * shade / IMAGE_SHADE_FLAT);
        rgb[i] = (uint8_t)fmin(255.0, lit + 0.5);
    }
    return true;
}

/* False where nothing of the database lies in the tile. */
static bool draw(struct ios_map *map, const struct ios_tile *tile, uint8_t *pixels)
{
    bool has_data = false;
    for (int y = 0; y < IOS_TILE_PIXELS; y++) {
        const double latitude_deg = latitude_of(tile->y + (y + 0.5) / IOS_TILE_PIXELS, tile->zoom);
        const int level = level_of(map->image, tile->zoom, latitude_deg);
        const int64_t latitude = image_bam(latitude_deg);
        for (int x = 0; x < IOS_TILE_PIXELS; x++) {
            const double longitude_deg =
                longitude_of(tile->x + (x + 0.5) / IOS_TILE_PIXELS, tile->zoom);
            struct image_spot spot;
            uint8_t *rgb = pixels + 3 * (y * IOS_TILE_PIXELS + x);
            has_data |= image_look_at(&map->look, level, latitude,
                                      (uint32_t)image_bam(longitude_deg), &spot) &&
                        draw_pixel(map, &spot, latitude, rgb);
        }
    }
    return has_data;
}

static int make(struct ios_map *map, struct ios_tile *tile)
{
    uint8_t *pixels = calloc((size_t)IOS_TILE_PIXELS * IOS_TILE_PIXELS, 3);
    if (pixels == NULL) {
        return -1;
    }
    int status = 0;
    if (draw(map, tile, pixels)) {
        FILE *out = open_memstream(&tile->bytes, &tile->size);
        status =
            out != NULL ? hs_png_encode_rgb(out, pixels, IOS_TILE_PIXELS, IOS_TILE_PIXELS) : -1;
        if (out != NULL && fclose(out) != 0) {
            status = -1;
        }
        map->drawn++;
    }
    free(pixels);
    return status;
}

/* A free slot, or that of the tile that was asked for longest ago. */
static struct ios_tile *slot_for(struct ios_map *map)
{
    struct ios_tile *best = &map->kept[0];
    for (int i = 1; i < IOS_TILES_KEPT; i++) {
        if (map->kept[i].last_use < best->last_use) {
            best = &map->kept[i];
        }
    }
    return best;
}

const struct ios_tile *ios_map_tile(struct ios_map *map, uint32_t zoom, uint32_t x, uint32_t y)
{
    map->clock++;
    for (int i = 0; i < IOS_TILES_KEPT; i++) {
        struct ios_tile *t = &map->kept[i];
        if (t->last_use != 0 && t->zoom == zoom && t->x == x && t->y == y) {
            t->last_use = map->clock;
            return t;
        }
    }
    struct ios_tile *t = slot_for(map);
    free(t->bytes);
    *t = (struct ios_tile){.zoom = zoom, .x = x, .y = y, .last_use = map->clock};
    if (make(map, t) != 0) {
        free(t->bytes);
        *t = (struct ios_tile){0};
        return NULL;
    }
    return t;
}
