/* Output of an import: the ground under it, the detail of the image, and a GeoPackage for people
 * to look at. */
#ifndef VECTORS_OUTPUT_H
#define VECTORS_OUTPUT_H

#include "gis/code_map.h"
#include "vectors/map.h"

/* Fill the class plane from a class raster, whose numbers are matched by name
 * (gis/class_numbers.h), or with `codes` a land cover: the pixel under a cell's centre, or the
 * commonest one where pixels are half a cell or smaller. Call before vector_map_burn. Returns 0, or
 * -1 with the error reported: the raster cannot be read or has no place, or holds a code or class
 * that is unknown. */
int vector_ground(struct vector_map *map, const char *path, const struct db_code_map *codes,
                  const struct db_class_table *table);

/* What was written as detail. */
struct vector_detail_counts {
    uint64_t buildings, boxes, walls, lines, masts, strips;
    double footprint_m2, boxes_m2;
    uint64_t outside; /* pieces beyond the plane, left out */
};

/* Write the detail of all items as text (docs/database.md, "Detail"); `remark` stands in its first
 * line. The file appears whole or not at all. Returns 0, or -1 with the error reported. */
int vector_detail_write(const struct vector_map *map, const struct db_class_table *table,
                        const char *path, const char *remark, struct vector_detail_counts *counts);

/* Write all items with their rule, class, height and origin, layers `areas`, `lines` and `points`.
 * The file appears whole or not at all. Returns 0, or -1 with the error reported. */
int vector_package_write(const struct vector_map *map, const struct db_class_table *table,
                         const char *path);

#endif
