#include "drv/dp_link.h"

#include "lm/status.h"

enum {
    LINK_BW_SET = 0x000,
    LANE_COUNT_SET = 0x004,
    ENHANCED_FRAME_EN = 0x008,
    TRAINING_PATTERN_SET = 0x00C,
    SCRAMBLING_DISABLE = 0x014,
    DOWNSPREAD_CTRL = 0x018,
    AUX_COMMAND = 0x100,
    AUX_WRITE_FIFO = 0x104,
    AUX_ADDRESS = 0x108,
    AUX_CLOCK_DIVIDER = 0x10C,
    INTERRUPT_SIGNAL_STATE = 0x130,
    AUX_REPLY_DATA = 0x134,
    AUX_REPLY_CODE = 0x138,
    REPLY_DATA_COUNT = 0x148,
    PHY_RESET = 0x200,
    PHY_PREEMPHASIS_LANE_0 = 0x210, /* and 4 bytes on for each lane */
    PHY_VOLTAGE_DIFF_LANE_0 = 0x220,
    PHY_CLOCK_SELECT = 0x234,
    TX_PHY_POWER_DOWN = 0x238,
    PHY_STATUS = 0x280,

    AUX_WRITE = 8 << 8,
    AUX_READ = 9 << 8,
    AUX_DIVIDER_100_MHZ = 100 | 40 << 8, /* and a filter of 0.4 us */
    STATE_REPLY = 1 << 2,
    STATE_REPLY_TIMEOUT = 1 << 3,
    REPLY_ACK = 0,

    /* The panel's. */
    DPCD_REV = 0x000,
    DPCD_LINK_BW_SET = 0x100,
    DPCD_LANE_COUNT_SET = 0x101,
    DPCD_TRAINING_PATTERN_SET = 0x102,
    DPCD_TRAINING_LANE0_SET = 0x103,
    DPCD_DOWNSPREAD_CTRL = 0x107,
    DPCD_CODING_SET = 0x108,
    DPCD_LANE0_1_STATUS = 0x202,
    DPCD_SET_POWER = 0x600,
    CAPABILITIES = 4, /* bytes from DPCD_REV on */
    STATUS_BYTES = 6, /* from DPCD_LANE0_1_STATUS on: lanes, alignment, sink, what it asks for */
    REV_1_2 = 0x12,
    HAS_ENHANCED_FRAMES = 1 << 7,
    HAS_PATTERN_3 = 1 << 6,
    LANE_COUNT_MASK = 0x1F,
    SCRAMBLING_OFF = 1 << 5,
    MAX_SWING_REACHED = 1 << 2,
    MAX_EMPHASIS_REACHED = 1 << 5,

    LANE_CLOCK_RECOVERED = 1 << 0,
    LANE_READY = 1 << 0 | 1 << 1 | 1 << 2, /* and equalised, symbols locked */
    ALIGNED = 1 << 0,

    AUX_TRIES = 7,
    AUX_REPLY_US = 500,
    CLOCK_WAIT_US = 100,
    EQUALISE_WAIT_US = 400,
    TRIES = 5,
    PHY_WAIT_US = 5000,
    BITS_A_PIXEL = 24
};

static void wait_us(const struct drv_dp_link *l, uint64_t us)
{
    const uint64_t end_us = l->now_us(l->clock) + us;
    while (l->now_us(l->clock) < end_us) {
    }
}

/* ---- AUX channel ---- */

static bool is_answered(const struct drv_dp_link *l)
{
    const uint64_t end_us = l->now_us(l->clock) + AUX_REPLY_US;
    do {
        const uint32_t state = drv_read(l->dp, INTERRUPT_SIGNAL_STATE);
        if (state & STATE_REPLY) {
            return drv_read(l->dp, AUX_REPLY_CODE) == REPLY_ACK;
        }
        if (state & STATE_REPLY_TIMEOUT) {
            return false;
        }
    } while (l->now_us(l->clock) < end_us);
    return false;
}

/* A panel may defer its answer; the standard demands seven attempts. */
static int request(struct drv_dp_link *l, uint32_t command, uint32_t address, uint8_t *bytes,
                   uint32_t count)
{
    for (uint32_t try = 0; try < AUX_TRIES; try++) {
        drv_write(l->dp, AUX_ADDRESS, address);
        for (uint32_t i = 0; i < count && command == AUX_WRITE; i++) {
            drv_write(l->dp, AUX_WRITE_FIFO, bytes[i]);
        }
        drv_write(l->dp, AUX_COMMAND, command | (count - 1));
        if (!is_answered(l)) {
            l->count.unanswered++;
            continue;
        }
        if (command == AUX_READ && (drv_read(l->dp, REPLY_DATA_COUNT) & 0xFF) != count) {
            continue;
        }
        for (uint32_t i = 0; i < count && command == AUX_READ; i++) {
            bytes[i] = (uint8_t)drv_read(l->dp, AUX_REPLY_DATA);
        }
        return LM_OK;
    }
    return LM_ERR_IO;
}

static int write_byte(struct drv_dp_link *l, uint32_t address, uint32_t value)
{
    uint8_t byte = (uint8_t)value;
    return request(l, AUX_WRITE, address, &byte, 1);
}

/* ---- training ---- */

/* What to drive the lanes with, at both ends. */
static int set_drive(struct drv_dp_link *l)
{
    const uint32_t swing = l->drive & 3u, emphasis = l->drive >> 3 & 3u;
    uint8_t bytes[DRV_DP_LANES_MAX];
    for (uint32_t lane = 0; lane < l->lanes; lane++) {
        bytes[lane] = (uint8_t)(l->drive | (swing == 3 ? MAX_SWING_REACHED : 0) |
                                (emphasis == 3 ? MAX_EMPHASIS_REACHED : 0));
        drv_write(l->dp, PHY_VOLTAGE_DIFF_LANE_0 + 4 * lane, swing);
        drv_write(l->dp, PHY_PREEMPHASIS_LANE_0 + 4 * lane, emphasis);
    }
    return request(l, AUX_WRITE, DPCD_TRAINING_LANE0_SET, bytes, l->lanes);
}

/* The highest that the panel asks for, of all lanes. */
static uint8_t asked_drive(const struct drv_dp_link *l, const uint8_t status[STATUS_BYTES])
{
    uint32_t swing = 0, emphasis = 0;
    for (uint32_t lane = 0; lane < l->lanes; lane++) {
        const uint32_t asked = status[4 + lane / 2] >> 4 * (lane % 2);
        swing = (asked & 3) > swing ? asked & 3 : swing;
        emphasis = (asked >> 2 & 3) > emphasis ? asked >> 2 & 3 : emphasis;
    }
    return (uint8_t)(swing | emphasis << 3);
}

static bool all_lanes(const struct drv_dp_link *l, const uint8_t status[STATUS_BYTES],
                      uint32_t bits)
{
    for (uint32_t lane = 0; lane < l->lanes; lane++) {
        if ((status[lane / 2] >> 4 * (lane % 2) & bits) != bits) {
            return false;
        }
    }
    return true;
}

/* Send a training pattern until the panel reports `bits` on all lanes. */
static int train_with(struct drv_dp_link *l, uint32_t pattern, uint32_t wait, uint32_t bits)
{
    uint8_t status[STATUS_BYTES];
    drv_write(l->dp, TRAINING_PATTERN_SET, pattern);
    if (write_byte(l, DPCD_TRAINING_PATTERN_SET, pattern | SCRAMBLING_OFF) != LM_OK) {
        return LM_ERR_IO;
    }
    /* Five times at each swing, of which there are four; a panel may not ask to and fro for
     * ever. */
    for (uint32_t all = 0, tries = 0; all < 4 * TRIES && tries < TRIES; all++, tries++) {
        if (set_drive(l) != LM_OK) {
            return LM_ERR_IO;
        }
        wait_us(l, wait);
        if (request(l, AUX_READ, DPCD_LANE0_1_STATUS, status, STATUS_BYTES) != LM_OK) {
            return LM_ERR_IO;
        }
        if (all_lanes(l, status, bits) && (bits == LANE_CLOCK_RECOVERED || (status[2] & ALIGNED))) {
            return LM_OK;
        }
        const uint8_t asked = asked_drive(l, status);
        if ((asked & 3) > (l->drive & 3)) {
            tries = 0;
        }
        l->drive = asked;
    }
    return LM_ERR_IO;
}

static bool is_phy_ready(const struct drv_dp_link *l)
{
    const uint32_t ready = (1u << l->lanes) - 1;
    const uint64_t end_us = l->now_us(l->clock) + PHY_WAIT_US;
    while ((drv_read(l->dp, PHY_STATUS) & ready) != ready) {
        if (l->now_us(l->clock) > end_us) {
            return false;
        }
    }
    return true;
}

/* Tell both ends how many lanes, and how fast. */
static int set_up(struct drv_dp_link *l, bool has_enhanced_frames)
{
    const drv_registers r = l->dp;
    const uint32_t enhanced = has_enhanced_frames ? HAS_ENHANCED_FRAMES : 0;
    drv_write(r, LANE_COUNT_SET, l->lanes);
    drv_write(r, ENHANCED_FRAME_EN, has_enhanced_frames);
    drv_write(r, DOWNSPREAD_CTRL, 0);
    drv_write(r, LINK_BW_SET, l->rate);
    drv_write(r, PHY_CLOCK_SELECT, l->rate == 6 ? 1 : l->rate == 10 ? 3 : 5);
    const bool is_told = write_byte(l, DPCD_LINK_BW_SET, l->rate) == LM_OK &&
                         write_byte(l, DPCD_LANE_COUNT_SET, l->lanes | enhanced) == LM_OK &&
                         write_byte(l, DPCD_DOWNSPREAD_CTRL, 0) == LM_OK &&
                         write_byte(l, DPCD_CODING_SET, 1) == LM_OK; /* 8b/10b */
    return is_told && is_phy_ready(l) ? LM_OK : LM_ERR_IO;
}

static int train(struct drv_dp_link *l, bool has_enhanced_frames)
{
    l->count.attempts++;
    l->drive = 0;
    if (set_up(l, has_enhanced_frames) != LM_OK) {
        return LM_ERR_IO;
    }
    drv_write(l->dp, SCRAMBLING_DISABLE, 1);
    int status = train_with(l, 1, CLOCK_WAIT_US, LANE_CLOCK_RECOVERED);
    if (status == LM_OK) {
        status = train_with(l, l->has_pattern_3 ? 3 : 2, EQUALISE_WAIT_US, LANE_READY);
    }
    drv_write(l->dp, TRAINING_PATTERN_SET, 0);
    drv_write(l->dp, SCRAMBLING_DISABLE, 0);
    const int told = write_byte(l, DPCD_TRAINING_PATTERN_SET, 0);
    return status == LM_OK ? told : status;
}

int drv_dp_link_train(struct drv_dp_link *l, uint32_t pixel_khz)
{
    static const uint8_t rates[] = {6, 10, 20};
    uint8_t panel[CAPABILITIES];
    drv_write(l->dp, AUX_CLOCK_DIVIDER, AUX_DIVIDER_100_MHZ);
    drv_write(l->dp, PHY_RESET, 0);
    drv_write(l->dp, TX_PHY_POWER_DOWN, 0);
    if (request(l, AUX_READ, DPCD_REV, panel, CAPABILITIES) != LM_OK) {
        return LM_ERR_IO;
    }
    write_byte(l, DPCD_SET_POWER, 1); /* a panel that was never asleep may not know it */
    l->has_pattern_3 = panel[0] >= REV_1_2 && (panel[2] & HAS_PATTERN_3);
    int status = LM_ERR_RANGE;
    for (uint32_t i = 0; i < sizeof rates && rates[i] <= panel[1]; i++) {
        for (uint8_t lanes = 1; lanes <= l->board_lanes && lanes <= (panel[2] & LANE_COUNT_MASK);
             lanes = (uint8_t)(2 * lanes)) {
            /* 0.27 Gbit/s carry 216 Mbit/s of pixels, of 8 bits in 10. */
            if (rates[i] * lanes * 216000u < pixel_khz * BITS_A_PIXEL) {
                continue;
            }
            l->rate = rates[i];
            l->lanes = lanes;
            status = train(l, (panel[2] & HAS_ENHANCED_FRAMES) != 0);
            if (status == LM_OK) {
                return LM_OK;
            }
        }
    }
    return status;
}
