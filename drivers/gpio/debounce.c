#include "drv/debounce.h"

void drv_debounce_init(struct drv_debounce *d, uint32_t period_us, uint64_t levels)
{
    *d = (struct drv_debounce){.period_us = period_us, .at_start = levels};
}

static uint64_t bit(uint32_t key)
{
    return UINT64_C(1) << key;
}

uint64_t drv_debounce_look(struct drv_debounce *d, uint64_t levels, uint64_t edges, uint64_t now_us)
{
    const uint64_t raw_down = d->down | d->at_start;
    const uint64_t differs = levels ^ raw_down;
    const uint64_t restarted = differs & (edges | ~d->differs);
    uint64_t changed = 0;
    d->differs = differs;
    for (uint32_t key = 0; key < DRV_DEBOUNCE_KEYS; key++) {
        if ((differs & bit(key)) == 0) {
            continue;
        }
        if ((restarted & bit(key)) != 0) {
            d->still_us[key] = now_us;
        }
        if (now_us - d->still_us[key] >= d->period_us) {
            changed |= bit(key);
        }
    }
    const uint64_t let_go = changed & d->at_start;
    d->at_start &= ~let_go;
    d->differs &= ~changed;
    changed &= ~let_go;
    d->down ^= changed;
    for (uint32_t key = 0; key < DRV_DEBOUNCE_KEYS; key++) {
        if ((changed & d->down & bit(key)) != 0) {
            d->down_us[key] = now_us;
        }
    }
    return changed;
}

bool drv_debounce_is_waiting(const struct drv_debounce *d)
{
    return d->differs != 0;
}

uint64_t drv_debounce_stuck(const struct drv_debounce *d, uint64_t now_us, uint64_t held_us)
{
    uint64_t stuck = d->at_start;
    for (uint32_t key = 0; key < DRV_DEBOUNCE_KEYS; key++) {
        if ((d->down & bit(key)) != 0 && now_us - d->down_us[key] >= held_us) {
            stuck |= bit(key);
        }
    }
    return stuck;
}
