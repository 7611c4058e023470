#include "drv/uart_cadence.h"

#include "fx/mem.h"

enum {
    CR = 0x00,
    MR = 0x04,
    IER = 0x08,
    IDR = 0x0C,
    ISR = 0x14,
    BAUDGEN = 0x18,
    RXTOUT = 0x1C,
    RXWM = 0x20,
    SR = 0x2C,
    FIFO = 0x30,
    BAUD_RATE_DIVIDER = 0x34,

    CR_RXRES = 1 << 0,
    CR_TXRES = 1 << 1,
    CR_RXEN = 1 << 2,
    CR_RXDIS = 1 << 3,
    CR_TXEN = 1 << 4,
    CR_TXDIS = 1 << 5,

    MR_PARITY_NONE = 4 << 3,

    IXR_RTRIG = 1 << 0,
    IXR_TEMPTY = 1 << 3,
    IXR_ROVR = 1 << 5,
    IXR_FRAME = 1 << 6,
    IXR_PARE = 1 << 7,
    IXR_TOUT = 1 << 8,
    IXR_RBRK = 1 << 13,
    IXR_ALL = 0x3FFF,

    SR_RXEMPTY = 1 << 1,
    SR_TXEMPTY = 1 << 3,
    SR_TXFULL = 1 << 4,
    SR_TACTIVE = 1 << 11,

    /* Samples of a bit, BAUD_RATE_DIVIDER + 1. */
    SAMPLES_LEAST = 5,
    SAMPLES_MOST = 16,

    FIFO_BYTES = 64
};

/* The transmitter empties by itself, a character in 87 us: this bounds the loop, and no more. */
#define TX_POLLS UINT32_MAX

struct divisors {
    uint32_t baudgen, samples;
};

/* The clock divided by both comes closest to the rate. */
static struct divisors best_divisors(uint32_t clock_hz, uint32_t baud)
{
    struct divisors best = {1, SAMPLES_LEAST};
    uint32_t best_error = UINT32_MAX;
    for (uint32_t samples = SAMPLES_LEAST; samples <= SAMPLES_MOST; samples++) {
        const uint32_t baudgen = (clock_hz + samples * baud / 2) / (samples * baud);
        const uint32_t rate = clock_hz / (samples * (baudgen ? baudgen : 1));
        const uint32_t error = rate > baud ? rate - baud : baud - rate;
        if (baudgen > 0 && error < best_error) {
            best = (struct divisors){baudgen, samples};
            best_error = error;
        }
    }
    return best;
}

void drv_uart_init(struct drv_uart *u, drv_registers base, uint32_t clock_hz, uint32_t baud)
{
    const struct divisors divisors = best_divisors(clock_hz, baud);
    *u = (struct drv_uart){.base = base};
    drv_write(base, CR, CR_RXDIS | CR_TXDIS);
    drv_write(base, IDR, IXR_ALL);
    drv_write(base, MR, MR_PARITY_NONE);
    drv_write(base, BAUDGEN, divisors.baudgen);
    drv_write(base, BAUD_RATE_DIVIDER, divisors.samples - 1);
    drv_write(base, CR, CR_RXRES | CR_TXRES);
    drv_write(base, RXWM, 1);
    drv_write(base, RXTOUT, 0);
    drv_write(base, ISR, IXR_ALL);
    drv_write(base, CR, CR_RXEN | CR_TXEN);
    drv_write(base, IER, IXR_RTRIG | IXR_ROVR | IXR_FRAME | IXR_PARE | IXR_RBRK);
}

void drv_uart_put(struct drv_uart *u, char c)
{
    (void)drv_wait_for(u->base, SR, SR_TXFULL, 0, TX_POLLS);
    drv_write(u->base, FIFO, (uint8_t)c);
}

void drv_uart_drain(struct drv_uart *u)
{
    (void)drv_wait_for(u->base, SR, SR_TXEMPTY | SR_TACTIVE, SR_TXEMPTY, TX_POLLS);
}

void drv_uart_lend(struct drv_uart *u, uint8_t *bytes, uint32_t size)
{
    u->out.bytes = bytes;
    u->out.size = size;
}

uint32_t drv_uart_room(const struct drv_uart *u)
{
    return u->out.size - (u->out.head - u->out.tail);
}

/* At most a FIFO of them. False: none waited. */
static bool refill(struct drv_uart *u)
{
    const uint32_t head = u->out.head, first = u->out.tail;
    uint32_t tail = first;
    while (tail != head && tail - first < FIFO_BYTES && !(drv_read(u->base, SR) & SR_TXFULL)) {
        drv_write(u->base, FIFO, u->out.bytes[tail++ & (u->out.size - 1)]);
    }
    u->out.tail = tail;
    return head != first;
}

/* The first bytes are written here. The interrupt of the empty FIFO brings the next. */
static void start(struct drv_uart *u)
{
    if (!u->out.is_active) {
        drv_write(u->base, ISR, IXR_TEMPTY);
        (void)refill(u);
        u->out.is_active = true;
        drv_write(u->base, IER, IXR_TEMPTY);
    }
}

bool drv_uart_queue(struct drv_uart *u, const void *bytes, uint32_t count)
{
    if (count > drv_uart_room(u)) {
        return false;
    }
    const uint32_t at = u->out.head & (u->out.size - 1);
    const uint32_t first = count < u->out.size - at ? count : u->out.size - at;
    memcpy(u->out.bytes + at, bytes, first);
    memcpy(u->out.bytes, (const uint8_t *)bytes + first, count - first);
    u->out.head += count;
    start(u);
    return true;
}

int drv_uart_get(struct drv_uart *u)
{
    const uint32_t tail = u->tail;
    if (tail == u->head) {
        return -1;
    }
    const uint8_t byte = u->ring[tail % DRV_UART_RING];
    u->tail = tail + 1;
    return byte;
}

static void take_byte(struct drv_uart *u, uint8_t byte)
{
    if (u->head - u->tail == DRV_UART_RING) {
        u->count.overflowed++;
        return;
    }
    u->ring[u->head % DRV_UART_RING] = byte;
    u->head++;
}

void drv_uart_interrupt(void *uart)
{
    struct drv_uart *u = uart;
    const uint32_t cause = drv_read(u->base, ISR);
    u->count.overflowed += (cause & IXR_ROVR) != 0;
    u->count.damaged += (cause & (IXR_FRAME | IXR_PARE | IXR_RBRK)) != 0;
    if (u->out.is_active && (cause & IXR_TEMPTY)) {
        drv_write(u->base, ISR, IXR_TEMPTY);
        u->out.is_active = refill(u);
        drv_write(u->base, u->out.is_active ? IER : IDR, IXR_TEMPTY);
    }
    /* At most a full FIFO, so that a flood cannot keep the core here. */
    for (uint32_t i = 0; i < FIFO_BYTES && !(drv_read(u->base, SR) & SR_RXEMPTY); i++) {
        take_byte(u, (uint8_t)drv_read(u->base, FIFO));
    }
    drv_write(u->base, ISR, cause & ~(uint32_t)IXR_TEMPTY);
}
