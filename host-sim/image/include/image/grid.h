/* Grid of an image: angles, areas that may cross Greenwich or the antimeridian, and the tiles that
 * cover them (docs/FORMATS.md, 1.2). Latitudes are signed BAM, -2^30 (south pole) to 2^30;
 * longitudes are BAM modulo 2^32, from Greenwich eastward. 2^32 BAM are 360 degrees. */
#ifndef IMAGE_GRID_H
#define IMAGE_GRID_H

#include <stdbool.h>
#include <stdint.h>

#define IMAGE_BAM_ROUND   ((int64_t)1 << 32)
#define IMAGE_BAM_QUARTER ((int64_t)1 << 30)

/* Metres of the meridian quadrant of WGS-84 to one BAM: 40,007,862.917 m / 2^32. */
#define IMAGE_METRES_PER_BAM (40007862.917 / 4294967296.0)

/* To the nearest BAM; not reduced modulo 2^32. */
int64_t image_bam(double degrees);
double image_degrees(int64_t bam);
/* A longitude in BAM as degrees, -180 (inclusive) to 180. */
double image_longitude_degrees(uint32_t bam);

/* South to north, and `width` eastward from `west`. */
struct image_area {
    int64_t south, north; /* -2^30..2^30 */
    uint32_t west;
    int64_t width; /* 0 (empty) .. 2^32 (all round) */
};

/* Make `area` the smallest that holds both; an empty one adds nothing. */
void image_area_add(struct image_area *area, const struct image_area *other);
/* Touching along an edge counts. */
bool image_areas_meet(const struct image_area *a, const struct image_area *b);
/* The middle, the longitude modulo 2^32. */
void image_area_centre(const struct image_area *area, int64_t *latitude, uint32_t *longitude);

/* A tile and its cells on the ground. `shift` is shift0 + level. */
struct image_frame {
    uint8_t shift, zone;
    uint32_t row, column;
    int64_t south;                         /* of row 0 */
    uint32_t west;                         /* of column 0 */
    int64_t latitude_step, longitude_step; /* of one cell */
};

/* The frame of a tile, and the area that it covers. */
struct image_frame image_frame_of(uint8_t shift, uint8_t zone, uint32_t row, uint32_t column);
struct image_area image_frame_area(const struct image_frame *frame);

/* Tile columns once round the Earth, and tile rows from pole to pole, at a shift. */
uint32_t image_columns_round(uint8_t shift, uint8_t zone);
uint32_t image_rows_all(uint8_t shift);

/* Zone of a tile row. */
uint8_t image_row_zone(uint8_t shift, uint32_t row);
/* Tile row of a latitude; the north pole belongs to the last row. */
uint32_t image_row_of(uint8_t shift, int64_t latitude);

#endif
