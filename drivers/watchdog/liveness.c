#include "drv/watchdog.h"

bool drv_liveness_progressed(struct drv_liveness *last, struct drv_liveness now)
{
    if (now.frames == last->frames || now.bus == last->bus || now.renders == last->renders) {
        return false;
    }
    *last = now;
    return true;
}
