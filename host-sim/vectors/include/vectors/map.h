/* Vector map: features in metres on a plane, each with the rule that it follows, and the planes
 * that are burnt of them: class and height of each cell.
 *
 * Usage: vector_map_init, vector_map_add for each feature, vector_map_burn once; then the planes
 * and items are read. */
#ifndef VECTORS_MAP_H
#define VECTORS_MAP_H

#include "gis/raster.h"
#include "vectors/census.h"
#include "vectors/rules.h"

#include <ogr_api.h>
#include <ogr_srs_api.h>

/* South, west, north, east in degrees; east may exceed 180. */
struct vector_area {
    double south, west, north, east;
};

struct vector_item {
    const struct vector_rule *rule;
    OGRGeometryH geometry; /* owned; on the plane: as it came, of a building or line too */
    OGRGeometryH cover;    /* owned: what is burnt; NULL: nothing */
    double height_m, width_m, base_m;
    bool has_height, is_gabled, is_replaced; /* replaced: by its parts */
    char origin[32];                         /* "way 123" */
};

/* What became of the features of a rule. */
struct vector_rule_counts {
    uint64_t features, odd, above_ground, heights[VECTOR_TERMS_MAX + 1], replaced;
};

struct vector_map {
    const struct vector_rules *rules; /* borrowed */
    struct db_grid grid;              /* its crs is owned */
    double cell_m;
    struct vector_area area;
    struct vector_item *items; /* owned */
    size_t item_count, item_capacity;
    struct vector_rule_counts counts[VECTOR_RULES_MAX];
    uint8_t *classes; /* owned: width * height; DB_CLASS_NODATA where nothing is known */
    float *heights_m; /* owned: negative where the class decides */
};

enum { VECTOR_CELLS_MAX = 400 << 20 };

/* Lay a plane in the UTM zone of the area's middle, with cells of `cell_m`. Returns 0, or -1 with
 * the error reported and nothing to free: more than VECTOR_CELLS_MAX cells, an area that is none
 * or lies beyond 84 degrees, no memory. */
int vector_map_init(struct vector_map *map, const struct vector_rules *rules,
                    const struct vector_area *area, double cell_m);

/* A feature that rule `rule` fits. */
struct vector_candidate {
    int rule;
    OGRGeometryH geometry; /* taken over; in the source's CRS, x and y */
    struct vector_tags tags;
    char origin[32];
};

/* Add it, brought to the plane by `to_plane` (NULL: it lies there). `census` counts repairs.
 * Returns its fate, or -1 with the error reported: no memory. */
int vector_map_add(struct vector_map *map, const struct vector_candidate *candidate,
                   OGRCoordinateTransformationH to_plane, struct vector_census *census);

/* A transformation from a CRS (NULL: WGS 84, longitude and latitude) to the plane; NULL with the
 * error reported when there is none. The caller destroys it. */
OGRCoordinateTransformationH vector_map_from(const struct vector_map *map, OGRSpatialReferenceH crs,
                                             const char *name);

/* Burn: what the class plane holds already is the ground; then the coast, then the rules in their
 * order, of equal ones the higher over the lower. Returns 0, or -1 with the error reported. */
int vector_map_burn(struct vector_map *map);

/* Print a line for each rule that made something, and where heights come from; and report them as
 * "rules" (hs/report.h). */
void vector_map_print(const struct vector_map *map);

/* Harmless on a zeroed struct. */
void vector_map_free(struct vector_map *map);

#endif
