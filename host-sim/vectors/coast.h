/* Coast: which cells are sea. OpenStreetMap has no polygon of the sea; its coastlines have the land
 * on their left. */
#ifndef VECTORS_COAST_H
#define VECTORS_COAST_H

#include "vectors/map.h"

/* Burn the classes of both sides of the map's coasts into its class plane: the sea over everything,
 * the land where nothing is known. Without a coast nothing is done. Where the coast is open, so
 * that sea and land meet without a line between them, each cell takes the side of the coast that is
 * nearest to it, and the length of that border is warned of. Returns 0, or -1 with the error
 * reported (no memory: 13 bytes a cell). */
int coast_burn(struct vector_map *map);

#endif
