/* Devices that a board does not have. The unit says on the glass what follows from it: DB FAIL
 * without flash, BUS without a bus. */
#ifndef DRV_NOT_FITTED_H
#define DRV_NOT_FITTED_H

#include "lm/controls.h"
#include "lm/port.h"

extern const struct lm_flash drv_no_flash;
extern const struct lm_can drv_no_can;
extern const struct lm_controls drv_no_controls;

#endif
