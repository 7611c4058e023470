/* A small, valid flash image (docs/FORMATS.md, section 1) made from two functions of a place, for
 * tests of whatever reads images. Written from FORMATS.md alone: it shares no code with the
 * database builder nor with the firmware, except fx_crc32c. Link tests/support/tiny_image.o and
 * $(LIB_fixed).
 *
 *     struct tiny_spec spec = tiny_spec_at(46.0, 11.0);
 *     spec.cell = my_cell;
 *     spec.elevation_m = my_elevation;
 *     struct tiny_image image;
 *     assert_int_equal(tiny_image_build(&image, &spec), 0);
 *     ... image.bytes, image.size ...
 *     tiny_image_free(&image);
 */
#ifndef TINY_IMAGE_H
#define TINY_IMAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lm/db.h"

/* The classes of the built-in table (tiny_classes), which tests may name. */
enum tiny_class {
    TINY_SOIL = 0,      /* ground, -20 dB */
    TINY_ASPHALT = 1,   /* ground, -30 dB */
    TINY_CONCRETE = 2,  /* ground, -28 dB */
    TINY_STRUCTURE = 3, /* structure, 0 dB */
    TINY_TREES = 4,     /* trees, -15 dB */
    TINY_WATER = 5,     /* water, -40 dB */
    TINY_NONE = 15      /* no data */
};

/* A place as the functions are told of it. East and north are metres from the centre of the image
 * by the radii of curvature there: exact at the centre, and good to about 0.1 % of the distance at
 * 10 km; a scene made of these numbers is what the image holds by definition. */
struct tiny_place {
    double latitude_deg, longitude_deg; /* -90..90, -180..180 */
    double east_m, north_m;
};

struct tiny_cell {
    double gamma_db;     /* -80..47.5, stored to the nearest half decibel */
    uint8_t class_index; /* 0..15 */
    uint8_t height_code; /* 0..15, an index into the class table's heights */
};

struct tiny_spec {
    double latitude_deg, longitude_deg; /* the centre of the image */
    uint8_t shift0;                     /* 4..20 */
    uint8_t level_count; /* 1..12; 0: up to the level with 4 tiles or fewer, or shift 20 */
    uint8_t post_shift; /* 0..4: post steps of 2^post_shift / 64 m; more where a tile's relief needs
                           it */
    uint8_t rows, columns; /* tiles of level 0 around the centre, >= 1 (columns as in its zone) */
    uint8_t margin; /* tiles more on each side at each coarser level than the finer one needs; 0
                     * when level_count is 0 */
    double geoid_m;
    const struct lm_classes *classes; /* borrowed; NULL: tiny_classes() */

    /* The content, asked at cell centres and at posts. `elevation_m` NULL: 0 m everywhere. */
    struct tiny_cell (*cell)(void *ctx, const struct tiny_place *place);
    double (*elevation_m)(void *ctx, const struct tiny_place *place);
    /* May be NULL. True leaves the tile out of the image (its directory entry says so). The parent
     * of a tile that is in must be in too (FORMATS.md 1.2); nothing here enforces it. */
    bool (*leave_out)(void *ctx, uint8_t level, uint32_t row, uint32_t column);
    void *ctx;
};

struct tiny_image {
    uint8_t *bytes; /* owned; tiny_image_free */
    size_t size;
    /* Where things are, so that a test can damage them and repair the checksums. */
    size_t classes_offset, bands_offset, directory_offset, tiles_offset, manifest_offset;
    uint32_t band_count, entry_count, record_count;
};

/* One level-0 tile of shift 9 (4.8 m cells, 305 m square) of flat soil at this place: change what
 * the test needs. */
struct tiny_spec tiny_spec_at(double latitude_deg, double longitude_deg);

/* The built-in class table. Height codes 0..15 mean 0, 2, 4, 6, 8, 10, 12, 15, 20, 25, 30, 40, 50,
 * 60, 80, 100 m. */
const struct lm_classes *tiny_classes(void);

/* Build the image in memory. Levels above 0 hold what FORMATS.md makes of the four cells below
 * where all four exist, and the cell at their own centre elsewhere. Returns 0; -1 without memory,
 * with too many bands, when a level asked for does not exist, or when a tile's elevations do not
 * fit the record.
 */
int tiny_image_build(struct tiny_image *image, const struct tiny_spec *spec);

/* Append an optional section and put the checksums right. Returns 0; -1 without memory. */
int tiny_image_add_section(struct tiny_image *image, uint32_t type, const void *bytes,
                           size_t count);

/* Lay images side by side, each from a multiple of 64 bytes on, as one flash has them, and tell
 * where they lie. Returns *size bytes, which the caller frees; NULL without memory. */
uint8_t *tiny_images_join(const struct tiny_image *images, uint32_t count,
                          struct lm_flash_part *parts, size_t *size);

/* Put right every checksum of the image (records, directory, sections, header) after a test has
 * changed its content. */
void tiny_image_seal(struct tiny_image *image);

/* Write the image to a file. Returns 0 or -1. */
int tiny_image_write(const struct tiny_image *image, const char *path);

void tiny_image_free(struct tiny_image *image);

#endif
