/* The panel's USB hand controller: it lives on the USB driver's thread, and speaks to the loop
 * through a ring only. */
#ifndef PANEL_HAND_CONTROLLER_H
#define PANEL_HAND_CONTROLLER_H

#include "config.h"
#include "drv/control_ring.h"
#include "drv/stick.h"
#include "drv/usb.h"

struct hand {
    const struct config *config;  /* borrowed */
    struct drv_stick stick;       /* the thread's */
    struct drv_control_ring ring; /* from the thread to the loop */
    struct drv_usb *usb;          /* NULL: none is wanted */
};

/* Start to look for the hand controller that the config wants. *h must not move. */
void hand_open(struct hand *h, const struct config *config);
void hand_close(struct hand *h);

#endif
