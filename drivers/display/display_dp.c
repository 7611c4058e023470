#include "drv/display_dp.h"

#include "fx/mem.h"

enum {
    /* DisplayPort transmitter. */
    TRANSMITTER_ENABLE = 0x080,
    MAIN_STREAM_ENABLE = 0x084,
    MAIN_STREAM_HTOTAL = 0x180,
    MAIN_STREAM_VTOTAL = 0x184,
    MAIN_STREAM_POLARITY = 0x188,
    MAIN_STREAM_HSWIDTH = 0x18C,
    MAIN_STREAM_VSWIDTH = 0x190,
    MAIN_STREAM_HRES = 0x194,
    MAIN_STREAM_VRES = 0x198,
    MAIN_STREAM_HSTART = 0x19C,
    MAIN_STREAM_VSTART = 0x1A0,
    MAIN_STREAM_MISC0 = 0x1A4,
    MSA_TRANSFER_UNIT_SIZE = 0x1B0,
    USER_PIX_WIDTH = 0x1B8,
    USER_DATA_COUNT_PER_LANE = 0x1BC,
    MIN_BYTES_PER_TU = 0x1C4,
    FRAC_BYTES_PER_TU = 0x1C8,
    INIT_WAIT = 0x1CC,
    /* Blender and audio-video buffer, of the same block. */
    V_BLEND_SET_GLOBAL_ALPHA = 0xA00C,
    V_BLEND_OUTPUT_VID_FORMAT = 0xA014,
    V_BLEND_LAYER1_CONTROL = 0xA01C,
    AV_BUF_FORMAT = 0xB000,
    AV_CHBUF3 = 0xB01C,
    AV_BUF_OUTPUT_AUDIO_VIDEO_SELECT = 0xB070,
    AV_BUF_SRST = 0xB124,
    AV_BUF_GRAPHICS_COMP0_SCALE_FACTOR = 0xB200, /* and two more */
    /* DMA. */
    DPDMA_GBL = 0x104,
    DPDMA_CH3_DSCR_STRT_ADDRE = 0x500,
    DPDMA_CH3_DSCR_STRT_ADDR = 0x504,
    DPDMA_CH3_CNTL = 0x518,

    MISC0_RGB_8_BITS = 1 << 5,
    LAYER_IS_RGB = 1 << 1,
    FORMAT_GRAPHICS_RGBA8888 = 0 << 8, /* as a word: red in bits 31..24 */
    CHBUF_ENABLE_LONGEST_BURST = 1 << 0 | 0xF << 2,
    SELECT_NO_VIDEO_GRAPHICS_FROM_MEMORY = 3 << 0 | 1 << 2,
    SCALE_8_BITS = 0x10101,
    CNTL_ENABLE = 1 << 0,
    GBL_TRIGGER_CH3 = 1 << 3,
    GBL_RETRIGGER_CH3 = 1 << 9,

    DESCRIPTOR_PREAMBLE = 0xA5,
    DESCRIPTOR_IGNORE_DONE = 1 << 10,
    DESCRIPTOR_LAST_OF_FRAME = 1 << 21,
    STRIDE_SHIFT = 18, /* in units of 16 bytes */

    /* Reduced blanking: pixels and lines before, of and after the synchronisation. */
    H_FRONT = 48,
    H_SYNC = 32,
    H_BACK = 80,
    V_FRONT = 3,
    V_SYNC = 6,
    V_BACK = 24,
    POLARITY_H_POSITIVE_V_NEGATIVE = 1 << 0,
    PICTURES_PER_S = 60,

    TRANSFER_UNIT_BYTES = 64,
    BYTES_A_PIXEL = 3
};

static uint32_t pixel_count(const struct drv_display *d)
{
    return (uint32_t)d->port.width_px * d->port.height_px;
}

static uint32_t bus_address(const volatile void *p)
{
    return (uint32_t)(uintptr_t)p;
}

/* The buffer that is not shown. */
static const struct drv_display_scan *next_scan(const struct drv_display *d)
{
    return &d->scans[(d->presented + 1) % DRV_DISPLAY_BUFFERS];
}

/* Red is wanted in the highest byte of a pixel. */
static int acquire(void *ctx, struct lm_surface *surface)
{
    const struct drv_display *d = ctx;
    *surface =
        (struct lm_surface){.pixels = next_scan(d)->pixels,
                            .stride_px = d->port.width_px,
                            .width_px = d->port.width_px,
                            .height_px = d->port.height_px,
                            .shift = DRV_DISPLAY_SHIFT,
                            .age = d->presented >= DRV_DISPLAY_BUFFERS ? DRV_DISPLAY_BUFFERS : 0};
    return LM_OK;
}

static int present(void *ctx, const struct lm_damage *changed)
{
    struct drv_display *d = ctx;
    (void)changed;
    /* A write to a device is not overtaken by what was written to memory before it. */
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
    drv_write(d->dma, DPDMA_CH3_DSCR_STRT_ADDR, bus_address(&next_scan(d)->descriptor));
    drv_write(d->dma, DPDMA_GBL, GBL_RETRIGGER_CH3);
    d->presented++;
    return LM_OK;
}

static void describe(const struct drv_display *d, struct drv_display_scan *scan, uint32_t id)
{
    const uint32_t line_bytes = d->port.width_px * 4u;
    scan->descriptor = (struct drv_display_descriptor){
        {DESCRIPTOR_PREAMBLE | DESCRIPTOR_IGNORE_DONE | DESCRIPTOR_LAST_OF_FRAME, id,
         line_bytes * d->port.height_px, line_bytes | line_bytes / 16 << STRIDE_SHIFT, 0, 0, 0,
         bus_address(&scan->descriptor), bus_address(scan->pixels)}};
}

static uint32_t line_clocks(const struct drv_display *d)
{
    return d->port.width_px + (uint32_t)(H_FRONT + H_SYNC + H_BACK);
}

static uint32_t lines_of(const struct drv_display *d)
{
    return d->port.height_px + (uint32_t)(V_FRONT + V_SYNC + V_BACK);
}

static uint32_t pixel_khz(const struct drv_display *d)
{
    return line_clocks(d) * lines_of(d) * PICTURES_PER_S / 1000;
}

/* How the stream is cut into transfer units: UG1085, "Transfer unit". At most 4 lanes of 20 *
 * 27 MB/s against 1184 * 801 * 60 pixels of 3 bytes: every product fits 64 bits by far. */
static void set_transfer(const struct drv_display *d)
{
    const struct drv_dp_link *link = &d->link;
    const uint32_t link_kbytes = link->lanes * link->rate * 27000u;
    const uint64_t stream_kbytes = (uint64_t)pixel_khz(d) * BYTES_A_PIXEL;
    const uint32_t thousandths =
        (uint32_t)(stream_kbytes * TRANSFER_UNIT_BYTES * 1000 / link_kbytes);
    const uint32_t bytes = thousandths / 1000, words = (d->port.width_px * 3u + 1) / 2;
    drv_write(d->dp, MSA_TRANSFER_UNIT_SIZE, TRANSFER_UNIT_BYTES);
    drv_write(d->dp, MIN_BYTES_PER_TU, bytes);
    drv_write(d->dp, FRAC_BYTES_PER_TU, thousandths % 1000);
    drv_write(d->dp, INIT_WAIT, bytes <= 4 ? TRANSFER_UNIT_BYTES : TRANSFER_UNIT_BYTES - bytes);
    drv_write(d->dp, USER_PIX_WIDTH, 1);
    drv_write(d->dp, USER_DATA_COUNT_PER_LANE, words + words % link->lanes - link->lanes);
}

static void set_stream(const struct drv_display *d)
{
    const uint32_t width = d->port.width_px, height = d->port.height_px;
    drv_write(d->dp, MAIN_STREAM_HTOTAL, line_clocks(d));
    drv_write(d->dp, MAIN_STREAM_VTOTAL, lines_of(d));
    drv_write(d->dp, MAIN_STREAM_POLARITY, POLARITY_H_POSITIVE_V_NEGATIVE);
    drv_write(d->dp, MAIN_STREAM_HSWIDTH, H_SYNC);
    drv_write(d->dp, MAIN_STREAM_VSWIDTH, V_SYNC);
    drv_write(d->dp, MAIN_STREAM_HRES, width);
    drv_write(d->dp, MAIN_STREAM_VRES, height);
    drv_write(d->dp, MAIN_STREAM_HSTART, H_SYNC + H_BACK);
    drv_write(d->dp, MAIN_STREAM_VSTART, V_SYNC + V_BACK);
    drv_write(d->dp, MAIN_STREAM_MISC0, MISC0_RGB_8_BITS);
}

static void set_plane(const struct drv_display *d)
{
    drv_write(d->dp, AV_BUF_SRST, 0);
    drv_write(d->dp, AV_BUF_FORMAT, FORMAT_GRAPHICS_RGBA8888);
    for (uint32_t component = 0; component < 3; component++) {
        drv_write(d->dp, AV_BUF_GRAPHICS_COMP0_SCALE_FACTOR + 4 * component, SCALE_8_BITS);
    }
    drv_write(d->dp, AV_CHBUF3, CHBUF_ENABLE_LONGEST_BURST);
    drv_write(d->dp, AV_BUF_OUTPUT_AUDIO_VIDEO_SELECT, SELECT_NO_VIDEO_GRAPHICS_FROM_MEMORY);
    drv_write(d->dp, V_BLEND_SET_GLOBAL_ALPHA, 0);
    drv_write(d->dp, V_BLEND_OUTPUT_VID_FORMAT, 0); /* RGB */
    drv_write(d->dp, V_BLEND_LAYER1_CONTROL, LAYER_IS_RGB);
}

int drv_display_open(struct drv_display *d, const struct drv_display_config *config)
{
    *d = (struct drv_display){.dp = config->dp,
                              .dma = config->dma,
                              .link = {.dp = config->dp,
                                       .now_us = config->now_us,
                                       .clock = config->clock,
                                       .board_lanes = config->lanes},
                              .scans = config->scans,
                              .port = {.ctx = d,
                                       .width_px = config->width_px,
                                       .height_px = config->height_px,
                                       .acquire = acquire,
                                       .present = present}};
    for (uint32_t i = 0; i < DRV_DISPLAY_BUFFERS; i++) {
        describe(d, &d->scans[i], i + 1);
    }
    memset(d->scans[0].pixels, 0, pixel_count(d) * sizeof(uint32_t));
    /* The transmitter and the channel are off while their resolution changes. */
    drv_write(d->dp, TRANSMITTER_ENABLE, 0);
    drv_write(d->dma, DPDMA_CH3_CNTL, 0);
    const int status = drv_dp_link_train(&d->link, pixel_khz(d));
    set_plane(d);
    set_stream(d);
    if (status == LM_OK) {
        set_transfer(d);
    }
    __atomic_thread_fence(__ATOMIC_SEQ_CST);
    drv_write(d->dma, DPDMA_CH3_DSCR_STRT_ADDRE, 0);
    drv_write(d->dma, DPDMA_CH3_DSCR_STRT_ADDR, bus_address(&d->scans[0].descriptor));
    drv_write(d->dma, DPDMA_CH3_CNTL, CNTL_ENABLE);
    drv_write(d->dma, DPDMA_GBL, GBL_TRIGGER_CH3);
    drv_write(d->dp, MAIN_STREAM_ENABLE, 1);
    drv_write(d->dp, TRANSMITTER_ENABLE, 1);
    return status;
}
