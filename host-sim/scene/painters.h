/* Painters of the scene, from nature to what people built. Each paints over what the ones before
 * it left. */
#ifndef SCENE_PAINTERS_H
#define SCENE_PAINTERS_H

#include "scene/painting.h"

/* Sea, beach, lake, woods, heath, rock, and meadow for the rest. */
void scene_paint_nature(struct scene *s);
/* Parcels of the plain with their crops, lanes, tree lines and farmsteads. */
void scene_paint_farms(struct scene *s);
/* The river and its streams with the trees on their banks. */
void scene_paint_streams(struct scene *s);
/* Town, industry and villages: streets, blocks, buildings, parks. */
void scene_paint_towns(struct scene *s);
/* Quays, piers, moles, warehouses, tanks, ships. */
void scene_paint_port(struct scene *s);
void scene_paint_airfield(struct scene *s);
/* The main roads and their bridges. */
void scene_paint_roads(struct scene *s);
/* Fences, and the power line: they are in the detail alone. */
void scene_paint_lines(struct scene *s);

#endif
