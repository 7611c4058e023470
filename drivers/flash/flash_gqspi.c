#include "drv/flash_gqspi.h"

#include "fx/mem.h"

enum {
    /* Of the legacy controller, which shares the block. */
    LQSPI_CFG = 0xA0,
    LQSPI_EN = 0x14,

    GQSPI_CFG = 0x100,
    GQSPI_ISR = 0x104,
    GQSPI_EN = 0x114,
    GQSPI_RXD = 0x120,
    GQSPI_GEN_FIFO = 0x140,
    GQSPI_SEL = 0x144,
    GQSPI_FIFO_CTRL = 0x14C,
    QSPIDMA_DST_ADDR = 0x800,
    QSPIDMA_DST_SIZE = 0x804,
    QSPIDMA_DST_I_STS = 0x814,
    QSPIDMA_DST_ADDR_MSB = 0x828,

    ISR_RX_FIFO_EMPTY = 1 << 11,
    DMA_DONE = 1 << 1,
    DMA_ALL = 0xFE,
    CFG_BAUD_DIV_4 = 1 << 3,

    /* Entries of the command FIFO. */
    IMMEDIATE = 0xFF,
    DATA_XFER = 1 << 8,
    EXPONENT = 1 << 9,
    SPI = 1 << 10,
    QUAD = 3 << 10,
    LOWER = 1 << 14, /* bus, */
    LOWER_CS = 1 << 12,
    UPPER = 1 << 15,
    UPPER_CS = 1 << 13,
    TRANSMIT = 1 << 16,
    RECEIVE = 1 << 17,
    CS_SETUP_CLOCKS = 4,

    QUAD_OUTPUT_READ_4 = 0x6C,
    READ_ID = 0x9F,
    DUMMY_CLOCKS = 8,
    MANUFACTURER_AND_TYPE = 0xBB20, /* Micron, 1.8 V, the first byte in bits 0..7 */
    ID_POLLS = 10000
};
#define CFG_DMA 0x80000000u

/* Queue an entry for a device. The FIFO holds 32 and a read makes at most 16, so that this finds
 * room at once. */
static void queue(const struct drv_flash *f, uint32_t device, uint32_t entry)
{
    drv_write(f->base, GQSPI_GEN_FIFO, entry | (device ? UPPER | UPPER_CS : LOWER | LOWER_CS));
}

static void queue_byte(const struct drv_flash *f, uint32_t device, uint32_t byte)
{
    queue(f, device, SPI | TRANSMIT | byte);
}

static void select_device(const struct drv_flash *f, uint32_t device)
{
    queue(f, device, SPI | CS_SETUP_CLOCKS);
}

/* The bus without the chip select. */
static void release_device(const struct drv_flash *f, uint32_t device)
{
    drv_write(f->base, GQSPI_GEN_FIFO, (device ? UPPER : LOWER) | SPI | CS_SETUP_CLOCKS);
}

static void reset(const struct drv_flash *f, uint32_t mode)
{
    const drv_registers r = f->base;
    drv_write(r, GQSPI_EN, 0);
    drv_write(r, GQSPI_FIFO_CTRL, 7); /* empty all three */
    drv_write(r, GQSPI_CFG, mode | CFG_BAUD_DIV_4);
    drv_write(r, QSPIDMA_DST_I_STS, DMA_ALL);
    drv_write(r, GQSPI_EN, 1);
}

/* A length as powers of two, and what is left of it below 256. */
static void queue_data(const struct drv_flash *f, uint32_t device, uint32_t length)
{
    const uint32_t entry = QUAD | RECEIVE | DATA_XFER;
    for (uint32_t power = 16; power >= 8; power--) {
        if (length >> power & 1) {
            queue(f, device, entry | EXPONENT | power);
        }
    }
    if (length & IMMEDIATE) {
        queue(f, device, entry | (length & IMMEDIATE));
    }
}

static void queue_read(const struct drv_flash *f, uint32_t device, uint32_t address,
                       uint32_t length)
{
    select_device(f, device);
    queue_byte(f, device, QUAD_OUTPUT_READ_4);
    for (uint32_t shift = 32; shift > 0; shift -= 8) {
        queue_byte(f, device, address >> (shift - 8) & 0xFF);
    }
    queue(f, device, SPI | DATA_XFER | DUMMY_CLOCKS);
    queue_data(f, device, length);
    release_device(f, device);
}

static uint32_t least(uint64_t a, uint64_t b)
{
    return (uint32_t)(a < b ? a : b);
}

/* Begin with the next piece, which ends with its device at the latest. DMA moves whole words. */
static void start_piece(struct drv_flash *f)
{
    const drv_registers r = f->base;
    const uint32_t device = f->now.offset >= f->device_bytes;
    const uint64_t start = f->now.offset - (device ? f->device_bytes : 0);
    const uint64_t address = start & ~UINT64_C(3);
    const uint64_t destination = (uint64_t)(uintptr_t)f->piece;
    f->now.skip = (uint32_t)(start - address);
    const uint32_t room = least(DRV_FLASH_PIECE, f->device_bytes - address);
    f->now.piece = least(room, ((uint64_t)f->now.skip + f->now.left + 3) & ~UINT64_C(3));
    reset(f, CFG_DMA);
    drv_write(r, QSPIDMA_DST_ADDR_MSB, (uint32_t)(destination >> 32));
    drv_write(r, QSPIDMA_DST_ADDR, (uint32_t)destination);
    drv_write(r, QSPIDMA_DST_SIZE, f->now.piece);
    queue_read(f, device, (uint32_t)address, f->now.piece);
    f->now.deadline_us = f->now_us(f->clock) + DRV_FLASH_TIMEOUT_US;
    f->count.pieces++;
}

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct drv_flash *f = ctx;
    if (offset > f->port.size_bytes || length > f->port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    f->now.to = destination;
    f->now.offset = offset;
    f->now.left = length;
    if (length > 0) {
        start_piece(f);
    }
    return LM_OK;
}

/* The piece has come: hand it over, and go on with the next if there is more. */
static void take_piece(struct drv_flash *f)
{
    const uint32_t length = least(f->now.piece - f->now.skip, f->now.left);
    memcpy(f->now.to, (const uint8_t *)f->piece + f->now.skip, length);
    f->now.to += length;
    f->now.offset += length;
    f->now.left -= length;
    if (f->now.left > 0) {
        start_piece(f);
    }
}

static bool is_piece_done(const struct drv_flash *f)
{
    if (!(drv_read(f->base, QSPIDMA_DST_I_STS) & DMA_DONE)) {
        return false;
    }
    drv_write(f->base, QSPIDMA_DST_I_STS, DMA_DONE);
    return true;
}

static int read_poll(void *ctx)
{
    struct drv_flash *f = ctx;
    while (f->now.left > 0 && is_piece_done(f)) {
        take_piece(f);
    }
    if (f->now.left == 0) {
        return LM_OK;
    }
    if (f->now_us(f->clock) > f->now.deadline_us) {
        f->count.timeouts++;
        f->now.left = 0;
        drv_write(f->base, GQSPI_EN, 0);
        return LM_ERR_IO;
    }
    return LM_BUSY;
}

/* The three bytes of the identification, the first in bits 0..7; 0 when none come. */
static uint32_t read_identification(const struct drv_flash *f, uint32_t device)
{
    reset(f, 0);
    select_device(f, device);
    queue_byte(f, device, READ_ID);
    queue(f, device, SPI | RECEIVE | DATA_XFER | 4);
    release_device(f, device);
    return drv_wait_for(f->base, GQSPI_ISR, ISR_RX_FIFO_EMPTY, 0, ID_POLLS)
               ? drv_read(f->base, GQSPI_RXD) & 0xFFFFFFu
               : 0;
}

/* Bytes of the device, or 0 when there is none of the kind. Its size code is the binary logarithm
 * up to 19h, 32 MiB, and goes on with 20h for 64 MiB. */
static uint64_t device_size(const struct drv_flash *f, uint32_t device)
{
    const uint32_t id = read_identification(f, device), code = id >> 16;
    if ((id & 0xFFFF) != MANUFACTURER_AND_TYPE || code < 0x10 || code > 0x22) {
        return 0;
    }
    return code >= 0x20   ? UINT64_C(64) << 20 << (code - 0x20)
           : code <= 0x19 ? UINT64_C(1) << code
                          : 0;
}

int drv_flash_open(struct drv_flash *f, const struct drv_flash_config *config)
{
    *f = (struct drv_flash){.base = config->base,
                            .now_us = config->now_us,
                            .clock = config->clock,
                            .piece = config->piece,
                            .port = {.ctx = f, .read_start = read_start, .read_poll = read_poll}};
    drv_write(f->base, LQSPI_EN, 0);
    drv_write(f->base, LQSPI_CFG, 0);
    drv_write(f->base, GQSPI_SEL, 1);
    f->device_bytes = device_size(f, 0);
    const bool are_two = f->device_bytes != 0 && device_size(f, 1) == f->device_bytes;
    f->port.size_bytes = f->device_bytes << are_two;
    return f->device_bytes != 0 ? LM_OK : LM_ERR_IO;
}
