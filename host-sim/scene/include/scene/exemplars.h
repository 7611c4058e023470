/* Exemplars of the scene: the polygons that a photo-analyst would draw over the image to teach the
 * classes. */
#ifndef SCENE_EXEMPLARS_H
#define SCENE_EXEMPLARS_H

#include "scene/render.h"

/* Write them as GeoJSON (RFC 7946: longitude and latitude on WGS 84) with the properties class and
 * material. Of every material that the picture shows widely enough some polygons are drawn, so that
 * each class has examples of all it comprises; a polygon holds its class in at least nine pixels of
 * ten. Returns 0, or -1 with the error reported. */
int exemplars_write(const struct scene *s, const struct picture *p, const char *path);

#endif
