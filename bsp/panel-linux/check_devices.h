/* Check of the panel's devices, for `landmass-panel --check --devices`: each is opened as the panel
 * opens it, and given back. What is wrong is reported with the remedy. Nothing is shown, no key is
 * taken and no frame is sent; a board's watchdog is not opened, because that starts it. */
#ifndef PANEL_CHECK_DEVICES_H
#define PANEL_CHECK_DEVICES_H

#include "config.h"

/* Try the screen, the lines of keys and lamps, the backlight, the bus, the hand controller, and the
 * folders that are written. Rights are those of whoever calls. Lines and screen that somebody
 * holds, such as a panel that runs, are said not to have been tried, and count as sound. Returns
 * the number of devices with a fault. */
int check_devices(const struct config *config);

#endif
