#include <stdbool.h>

#include "fx/sat.h"
#include "lm/radar.h"
#include "lm/units.h"

static const char beacon_name[LM_NAME_SIZE] = "BCN";

static char small(char letter)
{
    return letter >= 'A' && letter <= 'Z' ? (char)(letter - 'A' + 'a') : letter;
}

static bool is_same(const char name[LM_NAME_SIZE], const char *word)
{
    uint32_t i = 0;
    while (i < LM_NAME_SIZE - 1 && name[i] && small(name[i]) == small(word[i])) {
        i++;
    }
    return name[i] == word[i];
}

int32_t lm_radar_find_range(const struct lm_radar *radar, int32_t range_nm)
{
    for (int32_t i = 0; i < radar->ranges; i++) {
        if (radar->range[i].range_nm == range_nm) {
            return i;
        }
    }
    return -1;
}

int32_t lm_radar_find_mode(const struct lm_radar *radar, const char *name)
{
    if (is_same(beacon_name, name)) { /* first: no table may take its name */
        return LM_SECTOR_BEACON;
    }
    for (int32_t i = 0; i < LM_SECTOR_MODES; i++) {
        if (is_same(radar->mode[i].name, name)) {
            return i;
        }
    }
    return -1;
}

const char *lm_radar_mode_name(const struct lm_radar *radar, uint32_t mode)
{
    return mode == LM_SECTOR_BEACON ? beacon_name : radar->mode[mode].name;
}

uint32_t lm_radar_fov_last(const struct lm_radar *radar, uint32_t mode)
{
    const uint32_t last = lm_radar_mode(radar, mode)->fov_last;
    return mode == LM_SECTOR_BEACON ? fx_min_u32(last, LM_FOV_EXP) : last;
}

int32_t lm_radar_find_fov(const struct lm_radar *radar, const char *name)
{
    for (int32_t i = 0; i < LM_FOVS; i++) {
        if (is_same(radar->fov[i].name, name)) {
            return i;
        }
    }
    return -1;
}

int32_t lm_radar_find_azimuth(const struct lm_radar *radar, int32_t degrees)
{
    for (int32_t i = 0; i < LM_AZIMUTHS; i++) {
        if (lm_deg_of_bam(radar->azimuth_half[i]) == (uint32_t)degrees) {
            return i;
        }
    }
    return -1;
}

uint32_t lm_radar_range_last(const struct lm_radar *radar, uint32_t mode, uint32_t fov)
{
    const uint32_t most_nm =
        fx_min_u32(lm_radar_mode(radar, mode)->range_max_nm, radar->fov[fov].range_max_nm);
    uint32_t last = 0;
    while (last + 1 < radar->ranges && radar->range[last + 1].range_nm <= most_nm) {
        last++;
    }
    return last;
}
