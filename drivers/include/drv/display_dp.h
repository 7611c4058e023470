/* DisplayPort controller of Zynq UltraScale+ as struct lm_display: its graphics plane, fed from
 * memory by channel 3 of its DMA. Registers and sequences: UG1085, chapter 33, and UG1087, modules
 * DP and DPDMA; blanking: VESA Coordinated Video Timings 1.2, reduced blanking.
 *
 * The firmware draws in the scan-out buffer that is not shown, in the plane's format (red in the
 * highest byte), and finds there the picture before the last. The DMA reads that buffer from the
 * next frame on, so no picture is shown half drawn; it has left the other one after
 * LM_DISPLAY_REST_US. Cost: nothing by the pixel.
 *
 * Tested in QEMU: the picture shown, bit for bit, at several resolutions. QEMU reads the picture
 * only on request, so tearing cannot be tested. NOT done here: the clocks of pixels and serial
 * lanes, which the first-stage loader sets up from the board's design. */
#ifndef DRV_DISPLAY_DP_H
#define DRV_DISPLAY_DP_H

#include "drv/dp_link.h"
#include "drv/registers.h"
#include "lm/port.h"

/* Descriptor of the DMA: UG1085, table 33-12. */
struct drv_display_descriptor {
    uint32_t words[16];
};

enum { DRV_DISPLAY_BUFFERS = 2, DRV_DISPLAY_SHIFT = 8 };

/* Scan-out memory, not cached, 256-byte aligned. */
struct drv_display_scan {
    _Alignas(256) struct drv_display_descriptor descriptor;
    uint32_t *pixels; /* width_px * height_px, 256-byte aligned, below 4 GiB */
};

struct drv_display {
    drv_registers dp, dma;
    struct drv_dp_link link;
    struct drv_display_scan *scans; /* borrowed: DRV_DISPLAY_BUFFERS */
    uint32_t presented; /* pictures; buffer `presented` % DRV_DISPLAY_BUFFERS is shown */
    struct lm_display
        port; /* hand this to the firmware; its ctx is this struct, which must not move */
};

struct drv_display_config {
    drv_registers dp, dma;
    uint8_t lanes; /* lanes that the board connects: 1, 2 or 4 */
    uint64_t (*now_us)(const void *clock);
    const void *clock;
    uint16_t width_px, height_px; /* multiples of 4 */
    struct drv_display_scan *scans;
};

/* Train the link, set the resolution at 60 frames a second, and show a black picture. Memory and
 * clock of the config stay borrowed. Returns LM_OK; or the error of drv_dp_link_train: the display
 * then still works, but nobody sees it. */
int drv_display_open(struct drv_display *d, const struct drv_display_config *config);

#endif
