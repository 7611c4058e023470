/* The CAN controllers of Zynq UltraScale+ as struct lm_can. Registers and sequences: UG1085,
 * chapter 20, and UG1087, module CAN.
 *
 * Frames are received by interrupt into a ring, stamped with the time of the interrupt, and handed
 * out in order. A controller that leaves the bus (bus-off: 256 transmit errors) is reset by the
 * interrupt; receive() brings it back after DRV_CAN_OFF_US and answers LM_ERR_IO until then.
 *
 * Tested in QEMU: frames of both kinds between two controllers, the filters, a full ring. The model
 * has no bit timing and no errors; bus-off and its recovery are tested on registers in memory
 * (tests/unit/drivers/test_zynqmp_devices.c). NOT tested: a real bus. */
#ifndef DRV_CAN_ZYNQMP_H
#define DRV_CAN_ZYNQMP_H

#include <stdbool.h>

#include "drv/registers.h"
#include "lm/port.h"

enum {
    DRV_CAN_RING = 256, /* frames, a power of two: 32 ms of a full bus at 1 Mbit/s */
    DRV_CAN_OFF_US = 100000,
    DRV_CAN_FILTERS = 4
};

/* A frame passes when its identifier equals `id` in the bits of `mask`; 11-bit ones. */
struct drv_can_filter {
    uint16_t id, mask;
};

struct drv_can {
    drv_registers base;
    uint64_t (*now_us)(const void *clock);
    const void *clock;   /* borrowed */
    uint64_t deliver_us; /* receive() hands out frames that came up to then (drv_can_deliver) */
    uint32_t clock_hz, bit_rate;
    struct drv_can_filter filters[DRV_CAN_FILTERS];
    uint32_t filter_count;
    struct lm_can_frame ring[DRV_CAN_RING];
    volatile uint32_t head, tail; /* written by the interrupt, by receive() */
    volatile bool is_off;         /* the bus was left at off_us */
    volatile uint64_t off_us;
    struct lm_can port; /* hand this to the firmware; its ctx is this struct, which must not move */
    struct {
        uint32_t frames;
        uint32_t overflowed;      /* frames that found the ring full */
        uint32_t fifo_overflowed; /* times that the controller's own FIFO was full */
        uint32_t errors;          /* of the bus, as the controller reports them */
        uint32_t bus_off, recovered;
        uint32_t sent, refused; /* refused: the transmit FIFO was full */
    } count;
};

/* What the board says of its controller. Bit times have 10 quanta, sampled at 80 %: `bit_rate`
 * times 10 must divide clock_hz, with a quotient of 1..256. No filters: every frame passes. */
struct drv_can_config {
    drv_registers base;
    uint32_t clock_hz, bit_rate;
    struct drv_can_filter filters[DRV_CAN_FILTERS];
    uint32_t filter_count;
    uint64_t (*now_us)(const void *clock);
    const void *clock;
};

/* Enter the bus. LM_OK, LM_ERR_RANGE when the bit rate cannot be made, LM_ERR_IO when the
 * controller does not come out of its reset. */
int drv_can_open(struct drv_can *c, const struct drv_can_config *config);

/* Frames that came after `time_us` wait for later: so that a step of the firmware sees exactly what
 * had come by its time, however long it waited for its turn. */
void drv_can_deliver(struct drv_can *c, uint64_t time_us);

/* The interrupt handler. At most one FIFO, 64 frames, in a call. */
void drv_can_interrupt(void *can);

/* Identifier register <-> frame, and the data words, whose first byte is the most significant. */
uint32_t drv_can_id_word(const struct lm_can_frame *frame);
struct lm_can_frame drv_can_frame_of(const uint32_t words[4]);

#endif
