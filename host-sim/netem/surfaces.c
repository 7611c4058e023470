#include "netem/surfaces.h"

#include "hs/error.h"

#include <math.h>
#include <string.h>

int nm_surfaces_of(const struct setup *setup, const char names[][TRACE_NAME_SIZE], uint32_t count,
                   struct nm_materials *materials)
{
    struct trace_records records = {.look = {.wavelength_m = setup->wavelength_m},
                                    .material_count = count};
    struct reflect_law law;
    memcpy(records.materials, names, count * sizeof records.materials[0]);
    if (setup_law(setup, &records, &law) != 0) {
        return -1;
    }
    *materials = (struct nm_materials){.count = count};
    memcpy(materials->names, names, count * sizeof materials->names[0]);
    for (uint32_t i = 0; i < count; i++) {
        const struct reflect_material *m = &law.materials[i];
        materials->surfaces[i] =
            (struct nm_surface){m->permittivity, m->loss, m->rms_height_m, m->correlation_m};
    }
    return 0;
}

enum { NUMBERS = 4 };
_Static_assert(sizeof(struct nm_surface) == NUMBERS * sizeof(double), "as an array");

/* Does number n lie between the least and the greatest of the training's? */
static int check_number(const struct nm_materials *known, const struct nm_surface *surface, int n,
                        const char *material)
{
    static const char *const what[NUMBERS] = {"permittivity", "loss", "height of roughness",
                                              "correlation length"};
    double x[NUMBERS], low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < known->count; i++) {
        memcpy(x, &known->surfaces[i], sizeof x);
        low = fmin(low, x[n]);
        high = fmax(high, x[n]);
    }
    memcpy(x, surface, sizeof x);
    return x[n] >= low && x[n] <= high
               ? 0
               : hs_error(material, "train on materials about it",
                          "has a %s of %g, and the training's have %g to %g", what[n], x[n], low,
                          high);
}

static int check_between(const struct nm_materials *known, const struct nm_materials *model)
{
    for (uint32_t i = 0; i < model->count; i++) {
        for (int n = 0; n < NUMBERS; n++) {
            if (check_number(known, &model->surfaces[i], n, model->names[i]) != 0) {
                return -1;
            }
        }
    }
    return 0;
}

int nm_surfaces_meet(struct nm_materials *known, const struct nm_materials *model, bool is_given)
{
    struct nm_materials met = *known, asked = {.count = 0};
    for (uint32_t i = 0; i < model->count; i++) {
        uint32_t k = 0;
        while (k < met.count && strcmp(met.names[k], model->names[i]) != 0) {
            k++;
        }
        if (k < met.count && !is_given) {
            continue;
        }
        if (k == TRACE_MATERIALS_MAX) {
            return hs_error(model->names[i], NULL, "is one material too many");
        }
        met.count = k == met.count ? k + 1 : met.count;
        memcpy(met.names[k], model->names[i], sizeof met.names[k]);
        met.surfaces[k] = model->surfaces[i];
        memcpy(asked.names[asked.count], model->names[i], sizeof asked.names[0]);
        asked.surfaces[asked.count++] = model->surfaces[i];
    }
    if (check_between(known, &asked) != 0) {
        return -1;
    }
    *known = met;
    return 0;
}

int nm_surfaces_introduce(struct nm_materials *known, const struct setup *setup,
                          const char names[][TRACE_NAME_SIZE], uint32_t count)
{
    struct nm_materials model;
    return nm_surfaces_of(setup, names, count, &model) == 0
               ? nm_surfaces_meet(known, &model, setup->materials != NULL)
               : -1;
}

int nm_surfaces_allow(const struct setup *setup, const struct nm_architecture *architecture)
{
    return !setup->materials || architecture->material == NM_AS_SURFACE
               ? 0
               : hs_error("--materials", "leave it out, or train EP10",
                          "the training's networks know materials by name alone");
}

struct hs_option nm_surfaces_option(struct setup *setup)
{
    return (struct hs_option){
        "materials",
        HS_INPUT,
        &setup->materials,
        0,
        0,
        "FILE",
        "surfaces in the place of the training's, for networks of EP10, in the\n"
        "form that `landmass-target materials` prints",
        false};
}
