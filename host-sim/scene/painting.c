#include "scene/painting.h"

struct brush scene_ground(enum material m, uint64_t variant, material_set over)
{
    return (struct brush){m, (uint8_t)variant, 0, over};
}

struct brush scene_solid(enum material m, uint64_t variant, double height_m)
{
    return (struct brush){m, (uint8_t)variant, height_m, 0};
}
