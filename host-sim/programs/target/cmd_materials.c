#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "tracer/surfaces.h"
#include "tracer/trace.h"

static const struct hs_usage usage = {
    "materials", "print the built-in surfaces in the form of a file for --materials",
    "Permittivity and loss are relative; heights are the surface's standard deviation; F_S and\n"
    "F_R are RaySAR's specular coefficient and roughness, F_D and F_B its diffuse coefficient\n"
    "and brilliance (Niu and others, eq. 10 and 11). A coat is what lies on metal, such as paint.\n"
    "A model's materials are found by these names, in capitals or not, and by steel, iron,\n"
    "aluminium, tyre, window, paint, dirt, earth, timber and turf. `M_` before a name is dropped."};

int target_cmd_materials(int argc, char **argv)
{
    int exit_code;
    double wavelength_m = TRACE_WAVELENGTH_M;
    bool has_bands = false;
    const struct hs_option options[] = {
        {"wavelength", HS_REAL, &wavelength_m, 0.001, 10, "M", "of the radar", false},
        {"bands", HS_FLAG, &has_bands, 0, 0, NULL,
         "a table over X, Ku, K and Ka band, with the sources, in place of a file", false},
        HS_CLASHES_ROW("wavelength", "bands"),
    };
    if (!hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                         &exit_code)) {
        return exit_code;
    }
    if (has_bands) {
        surfaces_print_bands();
    } else {
        surfaces_print(wavelength_m);
    }
    return HS_EXIT_OK;
}
