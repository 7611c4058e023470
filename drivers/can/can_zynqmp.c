#include "drv/can_zynqmp.h"

enum {
    SRR = 0x00,
    MSR = 0x04,
    BRPR = 0x08,
    BTR = 0x0C,
    ESR = 0x14,
    SR = 0x18,
    ISR = 0x1C,
    IER = 0x20,
    ICR = 0x24,
    TXFIFO_ID = 0x30,
    TXFIFO_DLC = 0x34,
    TXFIFO_DATA1 = 0x38,
    TXFIFO_DATA2 = 0x3C,
    RXFIFO_ID = 0x50,
    RXFIFO_DLC = 0x54,
    RXFIFO_DATA1 = 0x58,
    RXFIFO_DATA2 = 0x5C,
    AFR = 0x60,
    AFMR1 = 0x64, /* of filter 1; those of the next are 8 bytes on */
    AFIR1 = 0x68,

    SRR_SRST = 1 << 0,
    SRR_CEN = 1 << 1,
    SR_CONFIG = 1 << 0,
    SR_TXFLL = 1 << 10,

    IXR_RXOFLW = 1 << 6,
    IXR_RXNEMP = 1 << 7,
    IXR_ERROR = 1 << 8,
    IXR_BSOFF = 1 << 9,
    IXR_ALL = 0x7FFF,
    IXR_ENABLED = IXR_RXOFLW | IXR_RXNEMP | IXR_ERROR | IXR_BSOFF,

    ID_RTR = 1 << 0,
    ID_IDE = 1 << 19,
    ID_SRRRTR = 1 << 20,

    DLC_SHIFT = 28,
    FIFO_FRAMES = 64,
    QUANTA = 10, /* of a bit: 1, then TS1 = 7 up to the sampling point, then TS2 = 2 */
    BTR_VALUE = (7 - 1) | (2 - 1) << 4 | (1 - 1) << 7,
    RESET_POLLS = 1000
};

uint32_t drv_can_id_word(const struct lm_can_frame *frame)
{
    const uint32_t remote = frame->is_remote;
    if (!frame->is_extended) {
        return frame->id << 21 | remote << 20;
    }
    return frame->id >> 18 << 21 | ID_SRRRTR | ID_IDE | (frame->id & 0x3FFFFu) << 1 | remote;
}

struct lm_can_frame drv_can_frame_of(const uint32_t words[4])
{
    struct lm_can_frame frame = {.id = words[0] >> 21,
                                 .is_extended = (words[0] & ID_IDE) != 0,
                                 .is_remote = (words[0] & ID_SRRRTR) != 0};
    if (frame.is_extended) {
        frame.id = frame.id << 18 | (words[0] >> 1 & 0x3FFFFu);
        frame.is_remote = (words[0] & ID_RTR) != 0;
    }
    const uint32_t length = words[1] >> DLC_SHIFT;
    frame.length = (uint8_t)(length < 8 ? length : 8);
    for (uint32_t i = 0; i < frame.length; i++) {
        frame.data[i] = (uint8_t)(words[2 + i / 4] >> (24 - 8 * (i % 4)));
    }
    return frame;
}

static void set_filters(const struct drv_can *c)
{
    const drv_registers r = c->base;
    drv_write(r, AFR, 0);
    for (uint32_t i = 0; i < c->filter_count; i++) {
        /* The kind of frame belongs to what is compared: the filters are for 11-bit identifiers. */
        drv_write(r, AFMR1 + 8 * i, (uint32_t)c->filters[i].mask << 21 | ID_SRRRTR | ID_IDE);
        drv_write(r, AFIR1 + 8 * i, (uint32_t)c->filters[i].id << 21);
    }
    drv_write(r, AFR, (1u << c->filter_count) - 1);
}

/* Reset the controller, set it up, and enter the bus. */
static int enter_bus(const struct drv_can *c)
{
    const drv_registers r = c->base;
    drv_write(r, SRR, SRR_SRST);
    if (!drv_wait_for(r, SR, SR_CONFIG, SR_CONFIG, RESET_POLLS)) {
        return LM_ERR_IO;
    }
    drv_write(r, BRPR, c->clock_hz / (c->bit_rate * QUANTA) - 1);
    drv_write(r, BTR, BTR_VALUE);
    drv_write(r, MSR, 0);
    set_filters(c);
    drv_write(r, ICR, IXR_ALL);
    drv_write(r, IER, IXR_ENABLED);
    drv_write(r, SRR, SRR_CEN);
    return LM_OK;
}

static void take_frame(struct drv_can *c, uint64_t now_us)
{
    const drv_registers r = c->base;
    const uint32_t words[4] = {drv_read(r, RXFIFO_ID), drv_read(r, RXFIFO_DLC),
                               drv_read(r, RXFIFO_DATA1), drv_read(r, RXFIFO_DATA2)};
    if (c->head - c->tail == DRV_CAN_RING) {
        c->count.overflowed++;
        return;
    }
    struct lm_can_frame *frame = &c->ring[c->head % DRV_CAN_RING];
    *frame = drv_can_frame_of(words);
    frame->time_us = now_us;
    c->head++;
    c->count.frames++;
}

void drv_can_interrupt(void *can)
{
    struct drv_can *c = can;
    const drv_registers r = c->base;
    const uint32_t cause = drv_read(r, ISR);
    const uint64_t now_us = c->now_us(c->clock);
    c->count.fifo_overflowed += (cause & IXR_RXOFLW) != 0;
    if (cause & IXR_ERROR) {
        c->count.errors++;
        drv_write(r, ESR, drv_read(r, ESR)); /* cleared by writing ones */
    }
    if (cause & IXR_BSOFF) {
        c->count.bus_off++;
        c->off_us = now_us;
        c->is_off = true;
        drv_write(r, IER, 0);
        drv_write(r, SRR, SRR_SRST);
        drv_write(r, ICR, IXR_ALL);
        return;
    }
    for (uint32_t i = 0; i < FIFO_FRAMES && (drv_read(r, ISR) & IXR_RXNEMP); i++) {
        take_frame(c, now_us);
        drv_write(r, ICR, IXR_RXNEMP); /* raised again at once while a frame waits */
    }
    drv_write(r, ICR, cause & (IXR_RXOFLW | IXR_ERROR));
}

static void recover(struct drv_can *c)
{
    if (c->now_us(c->clock) - c->off_us >= DRV_CAN_OFF_US && enter_bus(c) == LM_OK) {
        c->is_off = false;
        c->count.recovered++;
    }
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct drv_can *c = ctx;
    if (c->is_off) {
        recover(c);
        return c->is_off ? LM_ERR_IO : 0;
    }
    const uint32_t tail = c->tail;
    if (tail == c->head || c->ring[tail % DRV_CAN_RING].time_us > c->deliver_us) {
        return 0;
    }
    *frame = c->ring[tail % DRV_CAN_RING];
    c->tail = tail + 1;
    return 1;
}

static uint32_t data_word(const uint8_t bytes[4])
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 | bytes[3];
}

/* The last of the four words sends the frame. */
static int send(void *ctx, const struct lm_can_frame *frame)
{
    struct drv_can *c = ctx;
    const drv_registers r = c->base;
    if (c->is_off) {
        return LM_ERR_IO;
    }
    if (drv_read(r, SR) & SR_TXFLL) {
        c->count.refused++;
        return LM_BUSY;
    }
    drv_write(r, TXFIFO_ID, drv_can_id_word(frame));
    drv_write(r, TXFIFO_DLC, (uint32_t)frame->length << DLC_SHIFT);
    drv_write(r, TXFIFO_DATA1, data_word(frame->data));
    drv_write(r, TXFIFO_DATA2, data_word(frame->data + 4));
    c->count.sent++;
    return LM_OK;
}

int drv_can_open(struct drv_can *c, const struct drv_can_config *config)
{
    *c = (struct drv_can){.base = config->base,
                          .now_us = config->now_us,
                          .clock = config->clock,
                          .deliver_us = UINT64_MAX,
                          .clock_hz = config->clock_hz,
                          .bit_rate = config->bit_rate,
                          .filter_count = config->filter_count,
                          .port = {.ctx = c, .receive = receive, .send = send}};
    const uint32_t rate = config->bit_rate * QUANTA;
    if (config->bit_rate == 0 || config->filter_count > DRV_CAN_FILTERS ||
        config->clock_hz % rate != 0 || config->clock_hz / rate > 256 ||
        config->clock_hz / rate == 0) {
        return LM_ERR_RANGE;
    }
    for (uint32_t i = 0; i < config->filter_count; i++) {
        c->filters[i] = config->filters[i];
    }
    return enter_bus(c);
}

void drv_can_deliver(struct drv_can *c, uint64_t time_us)
{
    c->deliver_us = time_us;
}
