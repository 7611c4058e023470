/* A page whose members are all in the range that lm/page.h gives them. */
#ifndef PROVE_PAGE_KEPT_H
#define PROVE_PAGE_KEPT_H

#include "lm/page.h"
#include "prove.h"

struct lm_page nondet_page(void);

static bool is_within(int32_t value, int32_t most)
{
    return value >= -most && value <= most;
}

static bool is_kept(const struct lm_page *p)
{
    const bool is_scan = p->mode < LM_SECTOR_CHOICES && p->fov < LM_FOVS &&
                         p->azimuth_index < LM_AZIMUTHS &&
                         p->fov <= lm_radar_mode(&lm_radar_default, p->mode)->fov_last &&
                         p->range_index <= lm_radar_range_last(&lm_radar_default, p->mode, p->fov);
    return is_scan && p->format < LM_FORMATS && p->hidden >> LM_OSBS == 0 &&
           p->picture < LM_PICTURES && p->track <= 3 && is_within(p->tilt_tenths, 900) &&
           is_within(p->gain_db, LM_GAIN_MAX_DB) && is_within(p->knob, LM_FULL_DEFLECTION) &&
           is_within(p->black_db, LM_WINDOW_MAX_DB) && is_within(p->white_db, LM_WINDOW_MAX_DB) &&
           is_within(p->gamma_tenths, LM_GAMMA_MAX) && p->palette.tint < LM_TINTS &&
           is_within(p->palette.symbology, LM_ROCKER_STEPS) &&
           is_within(p->palette.brightness, LM_ROCKER_STEPS) &&
           is_within(p->palette.contrast, LM_ROCKER_STEPS);
}

static struct lm_page a_page(void)
{
    struct lm_page p = nondet_page();
    p.radar = &lm_radar_default;
    ASSUME(is_kept(&p));
    return p;
}

#endif
