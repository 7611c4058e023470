#include "gis/length_unit.h"

#include "hs/error.h"

#include <proj.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

static const struct unit {
    const char *name;
    double metres;
} common[] = {
    {"m", 1},
    {"metre", 1},
    {"metres", 1},
    {"meter", 1},
    {"meters", 1},
    {"mm", 0.001},
    {"cm", 0.01},
    {"centimetres", 0.01},
    {"centimeter", 0.01},
    {"centimeters", 0.01},
    {"dm", 0.1},
    {"km", 1000},
    {"ft", 0.3048},
    {"feet", 0.3048},
    {"international foot", 0.3048},
    {"ftus", 1200.0 / 3937},
    {"us-ft", 1200.0 / 3937},
    {"us_survey_foot", 1200.0 / 3937},
    {"us survey feet", 1200.0 / 3937},
    {"foot_us", 1200.0 / 3937},
    {"sft", 1200.0 / 3937},
};

static bool find_in_proj(const char *name, double *metres)
{
    int count = 0;
    bool is_found = false;
    PROJ_UNIT_INFO **units = proj_get_units_from_database(NULL, "EPSG", "linear", 1, &count);
    for (int i = 0; units && i < count && !is_found; i++) {
        if (strcasecmp(units[i]->name, name) == 0) {
            *metres = units[i]->conv_factor;
            is_found = *metres > 0;
        }
    }
    proj_unit_list_destroy(units);
    return is_found;
}

bool db_length_unit(const char *name, double *metres)
{
    for (size_t i = 0; i < sizeof common / sizeof common[0]; i++) {
        if (strcasecmp(common[i].name, name) == 0) {
            *metres = common[i].metres;
            return true;
        }
    }
    return find_in_proj(name, metres);
}

int db_band_unit(GDALRasterBandH band, const char *path, const char *option, double *metres)
{
    char remedy[96];
    const char *name = GDALGetRasterUnitType(band);
    *metres = 1;
    if (!name[0] || db_length_unit(name, metres)) {
        return 0;
    }
    snprintf(remedy, sizeof remedy, "name the unit %s%s",
             option ? "with " : "in the file, as gdal_edit.py -units m does", option ? option : "");
    return hs_error(path, remedy,
                    "its values are in `%s`, which is no unit of length that is known", name);
}
