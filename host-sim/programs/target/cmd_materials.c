#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "tracer/materials.h"

static const struct hs_usage usage = {
    "materials", "print the built-in surfaces in the form of a file for --materials",
    "Permittivity and loss are relative; heights are the surface's standard deviation; F_S and\n"
    "F_R are RaySAR's specular coefficient and roughness, F_D and F_B its diffuse coefficient\n"
    "and brilliance (Niu and others, eq. 10 and 11)."};

int target_cmd_materials(int argc, char **argv)
{
    int exit_code;
    if (!hs_options_read(&usage, NULL, 0, argc, argv, &exit_code)) {
        return exit_code;
    }
    materials_print();
    return HS_EXIT_OK;
}
