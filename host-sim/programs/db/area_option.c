#include "area_option.h"

#include "hs/error.h"
#include "hs/number.h"

#include <math.h>
#include <stddef.h>

int db_area_read(struct image_area *area, const char *text)
{
    double d[4];
    if (hs_numbers(text, ',', d, 4) != 4 || !(d[0] >= -90 && d[2] <= 90 && d[0] < d[2]) ||
        !(fabs(d[1]) <= 360 && fabs(d[3]) <= 360) || d[1] == d[3]) {
        return hs_error("--area", "write it as 36.5,14.2,36.6,14.4",
                        "must be south,west,north,east in degrees");
    }
    area->south = image_bam(d[0]);
    area->north = image_bam(d[2]);
    area->west = (uint32_t)image_bam(d[1]);
    area->width = (int64_t)(uint32_t)(image_bam(d[3]) - image_bam(d[1]));
    return area->width > 0 ? 0 : hs_error("--area", NULL, "is empty");
}

int db_area_is_empty(const char *place, int level)
{
    return hs_error(place, "see `landmass-db inspect` for where there is",
                    "there is no data in this area at level %d or coarser", level);
}
