/* Hand controller of the panel: it runs on the USB driver's thread, and passes controls to the loop
 * through a ring. */
#ifndef PANEL_HAND_CONTROLLER_H
#define PANEL_HAND_CONTROLLER_H

#include "config.h"
#include "drv/control_ring.h"
#include "drv/stick.h"
#include "drv/usb.h"

struct hand {
    const struct config *config;  /* borrowed */
    struct drv_stick stick;       /* used by the thread only */
    struct drv_control_ring ring; /* from the thread to the loop */
    struct drv_usb *usb;          /* NULL: none is wanted */
};

/* Start to look for the hand controller that the config names. The config stays borrowed, and *h
 * must not move, until hand_close. */
void hand_open(struct hand *h, const struct config *config);
void hand_close(struct hand *h);

#endif
