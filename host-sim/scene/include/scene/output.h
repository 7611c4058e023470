/* Output files of the scene. Each appears whole or not at all. */
#ifndef SCENE_OUTPUT_H
#define SCENE_OUTPUT_H

#include "scene/render.h"

/* All return 0, or -1 with the error reported. The CRS is UTM zone 26 north on WGS 84, and the
 * scene's centre lies at SCENE_EAST_M, SCENE_NORTH_M: open Atlantic, 42 north, 29 west, where
 * nobody will take it for a place that exists. */
#define SCENE_EPSG    32626
#define SCENE_EAST_M  334000.0
#define SCENE_NORTH_M 4651000.0

/* GeoTIFF files: the bands of the image, its true classes, how much of each pixel is
 * of each class, the heights of what stands on the
 * ground, and the elevation of the ground. */
int output_image(const struct scene *s, const struct picture *p, const char *path);
int output_truth(const struct scene *s, const struct picture *p, const char *path);
int output_shares(const struct scene *s, const char *path); /* a band a class: parts of 4 */
int output_heights(const struct scene *s, const struct picture *p, const char *path);
int output_terrain(const struct scene *s, const char *path);

/* Description of the scene, with the positions of its places. */
int output_description(const struct scene *s, const char *path);

/* Three pictures to look at: colours as the eye sees them, classes, and the terrain in the sun. */
int output_preview_image(const struct scene *s, const struct picture *p, const char *path);
int output_preview_truth(const struct scene *s, const struct picture *p, const char *path);
int output_preview_terrain(const struct scene *s, const char *path);

/* Footprints and lines, as `landmass-db build --detail` reads them. */
int output_detail(const struct scene *s, const char *path);

/* Longitude and latitude in degrees of a place. Returns 0, or -1 with the error reported. */
int output_geographic(const struct point *p, int count, double *longitude, double *latitude);

#endif
