#include "metal.h"

#include "tracer/trace.h"

struct reflect_law metal_law(enum reflect_kind kind)
{
    struct reflect_law law = {.kind = kind, .wavelength_m = TRACE_WAVELENGTH_M};
    for (int i = 0; i < TRACE_MATERIALS_MAX; i++) {
        law.materials[i] = (struct reflect_material){
            .name = "metal", .permittivity = 1, .loss = 1e12, .specular = 1, .roughness = 1};
    }
    return law;
}
