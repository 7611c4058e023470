/* Ports of devices that a board does not have. The glass then shows DB FAIL without flash, and BUS
 * without a bus. */
#ifndef DRV_NOT_FITTED_H
#define DRV_NOT_FITTED_H

#include "lm/controls.h"
#include "lm/port.h"

extern const struct lm_flash drv_no_flash;
extern const struct lm_can drv_no_can;
extern const struct lm_controls drv_no_controls;

#endif
