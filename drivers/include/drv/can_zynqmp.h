/* CAN controller of Zynq UltraScale+ as struct lm_can. Registers and sequences: UG1085, chapter 20,
 * and UG1087, module CAN.
 *
 * The interrupt receives frames into a ring, with the time of the interrupt; receive hands them out
 * in order. The interrupt resets a controller that left the bus (bus-off: 256 transmit errors).
 * receive restarts it after DRV_CAN_OFF_US and returns LM_ERR_IO until then.
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

/* Filter: an 11-bit frame passes if its identifier equals `id` in the bits of `mask`. */
struct drv_can_filter {
    uint16_t id, mask;
};

struct drv_can {
    drv_registers base;
    uint64_t (*now_us)(const void *clock);
    const void *clock;   /* borrowed */
    uint64_t deliver_us; /* receive hands out frames up to this time: drv_can_deliver */
    uint32_t clock_hz, bit_rate;
    struct drv_can_filter filters[DRV_CAN_FILTERS];
    uint32_t filter_count;
    struct lm_can_frame ring[DRV_CAN_RING];
    volatile uint32_t head;   /* frames put in; written by the interrupt */
    volatile uint32_t tail;   /* frames taken out; written by receive */
    volatile bool is_off;     /* the controller is bus-off */
    volatile uint64_t off_us; /* time of the bus-off */
    struct lm_can port; /* hand this to the firmware; its ctx is this struct, which must not move */
    struct {
        uint32_t frames;
        uint32_t overflowed;      /* frames that found the ring full */
        uint32_t fifo_overflowed; /* times that the controller's own FIFO was full */
        uint32_t errors;          /* bus errors that the controller reports */
        uint32_t bus_off, recovered;
        uint32_t sent;    /* put into the transmit FIFO */
        uint32_t refused; /* not sent: the transmit FIFO was full */
    } count;
};

/* Configuration by the board. Bit times have 10 quanta and are sampled at 80 %: `bit_rate` times 10
 * must divide clock_hz, with a quotient of 1..256. Without filters every frame passes. */
struct drv_can_config {
    drv_registers base;
    uint32_t clock_hz, bit_rate;
    struct drv_can_filter filters[DRV_CAN_FILTERS];
    uint32_t filter_count;
    uint64_t (*now_us)(const void *clock);
    const void *clock;
};

/* Initialise *c and enter the bus. The config is copied; its clock stays borrowed. Returns
 * - LM_OK;
 * - LM_ERR_RANGE: the bit rate cannot be made from the clock;
 * - LM_ERR_IO: the controller does not come out of its reset. */
int drv_can_open(struct drv_can *c, const struct drv_can_config *config);

/* Hand out frames that came up to `time_us`; later ones wait. A step of the firmware that runs late
 * then still sees exactly the frames up to its own time. */
void drv_can_deliver(struct drv_can *c, uint64_t time_us);

/* Interrupt handler; `can` is the struct drv_can. Takes at most one FIFO, 64 frames, in a call. */
void drv_can_interrupt(void *can);

/* The identifier register of a frame, and the frame of the four words of a message: identifier,
 * length and two data words, whose first byte is the most significant. */
uint32_t drv_can_id_word(const struct lm_can_frame *frame);
struct lm_can_frame drv_can_frame_of(const uint32_t words[4]);

#endif
