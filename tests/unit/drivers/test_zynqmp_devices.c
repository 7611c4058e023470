/* The drivers of the Zynq UltraScale+ on registers that are memory: what QEMU's model of the board
 * does not do. tests/zcu102 runs them on the model. */
#include "check.h"
#include "drv/can_zynqmp.h"
#include "drv/dp_link.h"
#include "drv/flash_gqspi.h"
#include "drv/irq_gic400.h"
#include "drv/uart_cadence.h"
#include "drv/watchdog_cadence.h"

#include <math.h>
#include <string.h>

enum { WORDS = 1024 };

/* A device: its registers, and what time it is. */
struct device {
    uint32_t registers[WORDS];
    uint64_t now_us;
};

static uint64_t now_us(const void *device)
{
    return ((const struct device *)device)->now_us;
}

/* ---- CAN ---- */

enum {
    CAN_SRR = 0x00,
    CAN_BRPR = 0x08,
    CAN_BTR = 0x0C,
    CAN_ESR = 0x14,
    CAN_SR = 0x18,
    CAN_ISR = 0x1C
};

static void open_can(struct drv_can *c, struct device *d)
{
    const struct drv_can_config config = {.base = d->registers,
                                          .clock_hz = 100000000,
                                          .bit_rate = 1000000,
                                          .now_us = now_us,
                                          .clock = d};
    memset(d, 0, sizeof *d);
    d->registers[CAN_SR / 4] = 1; /* configuration mode */
    assert_int_equal(drv_can_open(c, &config), LM_OK);
}

TEST(a_wait_ends_with_the_value_of_the_register_or_with_its_polls)
{
    volatile uint32_t words[2] = {0, 0x5A};
    assert_true(drv_wait_for(words, 4, 0xF0, 0x50, 1));
    assert_true(drv_wait_for(words, 0, 0xF0, 0, 1));
    assert_false(drv_wait_for(words, 4, 0xF0, 0x40, 1));
    assert_false(drv_wait_for(words, 4, 0xF0, 0x40, 1000));
}

TEST(a_bit_of_one_microsecond_has_ten_quanta_sampled_at_the_eighth)
{
    struct drv_can c;
    struct device d;
    open_can(&c, &d);
    const uint32_t btr = d.registers[CAN_BTR / 4];
    const uint32_t ts1 = (btr & 15) + 1, ts2 = (btr >> 4 & 7) + 1;
    assert_int_equal((d.registers[CAN_BRPR / 4] + 1) * (1 + ts1 + ts2), 100);
    assert_int_equal((1 + ts1) * 10, 8 * (1 + ts1 + ts2));
    assert_int_equal(d.registers[CAN_SRR / 4], 2); /* enabled */
}

TEST(a_controller_that_stays_in_reset_is_an_error)
{
    struct drv_can c;
    struct device d = {{0}, 0};
    const struct drv_can_config config = {.base = d.registers,
                                          .clock_hz = 100000000,
                                          .bit_rate = 500000,
                                          .now_us = now_us,
                                          .clock = &d};
    assert_int_equal(drv_can_open(&c, &config), LM_ERR_IO);
}

TEST(bus_off_is_counted_and_left_after_a_tenth_of_a_second)
{
    struct drv_can c;
    struct device d;
    struct lm_can_frame frame = {0};
    open_can(&c, &d);
    d.now_us = 5000000;
    d.registers[CAN_ISR / 4] = 1 << 9 | 1 << 8;
    d.registers[CAN_ESR / 4] = 1 << 4; /* nobody acknowledges */
    drv_can_interrupt(&c);
    assert_int_equal(c.count.bus_off, 1);
    assert_int_equal(c.count.errors, 1);
    assert_int_equal(d.registers[CAN_SRR / 4], 1); /* in reset */
    d.registers[CAN_ISR / 4] = 0;
    assert_int_equal(c.port.receive(c.port.ctx, &frame), LM_ERR_IO);
    assert_int_equal(c.port.send(c.port.ctx, &frame), LM_ERR_IO);
    d.now_us += DRV_CAN_OFF_US - 1;
    assert_int_equal(c.port.receive(c.port.ctx, &frame), LM_ERR_IO);
    d.now_us += 1;
    assert_int_equal(c.port.receive(c.port.ctx, &frame), 0);
    assert_int_equal(d.registers[CAN_SRR / 4], 2);
    assert_int_equal(c.count.recovered, 1);
    assert_int_equal(c.port.send(c.port.ctx, &frame), LM_OK);
}

TEST(a_controller_that_does_not_come_back_is_asked_again)
{
    struct drv_can c;
    struct device d;
    struct lm_can_frame frame = {0};
    open_can(&c, &d);
    d.registers[CAN_ISR / 4] = 1 << 9;
    drv_can_interrupt(&c);
    d.registers[CAN_SR / 4] = 0;
    d.now_us += 2 * DRV_CAN_OFF_US;
    assert_int_equal(c.port.receive(c.port.ctx, &frame), LM_ERR_IO);
    d.registers[CAN_SR / 4] = 1;
    assert_int_equal(c.port.receive(c.port.ctx, &frame), 0);
    assert_int_equal(c.count.recovered, 1);
}

TEST(a_full_transmit_fifo_is_busy_and_takes_nothing)
{
    struct drv_can c;
    struct device d;
    open_can(&c, &d);
    d.registers[CAN_SR / 4] = 1 << 10;
    const struct lm_can_frame frame = {.id = 0x123, .length = 8};
    assert_int_equal(c.port.send(c.port.ctx, &frame), LM_BUSY);
    assert_int_equal(d.registers[0x30 / 4], 0);
    assert_int_equal(c.count.refused, 1);
}

TEST(an_interrupt_takes_one_fifo_at_most)
{
    struct drv_can c;
    struct device d;
    open_can(&c, &d);
    d.registers[CAN_ISR / 4] = 1 << 7; /* never empty: memory does not clear it */
    drv_can_interrupt(&c);
    assert_int_equal(c.count.frames, 64);
}

TEST(a_length_code_above_eight_is_eight)
{
    const uint32_t words[4] = {0x123u << 21, 0xF0001234u, 0x01020304, 0x05060708};
    const struct lm_can_frame frame = drv_can_frame_of(words);
    assert_int_equal(frame.length, 8);
    assert_int_equal(frame.id, 0x123);
    assert_int_equal(frame.data[0], 1);
    assert_int_equal(frame.data[7], 8);
}

TEST(identifier_words_are_those_of_the_manual)
{
    /* UG1087, TXFIFO_ID: IDH 31..21, SRRRTR 20, IDE 19, IDL 18..1, RTR 0. */
    const struct {
        struct lm_can_frame frame;
        uint32_t word;
    } table[] = {{{.id = 0x7FF}, 0xFFE00000u},
                 {{.id = 0x001, .is_remote = true}, 0x00300000u},
                 {{.id = 0x1FFFFFFF, .is_extended = true}, 0xFFFFFFFEu},
                 {{.id = 0x00040001, .is_extended = true}, 0x00380002u},
                 {{.id = 0, .is_extended = true, .is_remote = true}, 0x00180001u}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        assert_int_equal(drv_can_id_word(&table[i].frame), table[i].word);
        const struct lm_can_frame back = drv_can_frame_of((const uint32_t[4]){table[i].word});
        assert_int_equal(back.id, table[i].frame.id);
        assert_int_equal(back.is_extended, table[i].frame.is_extended);
        assert_int_equal(back.is_remote, table[i].frame.is_remote);
    }
}

/* ---- flash ---- */

enum { GQSPI_ISR = 0x104, GQSPI_EN = 0x114, GQSPI_RXD = 0x120, DMA_STATUS = 0x814 };

static int open_flash(struct drv_flash *f, struct device *d, uint32_t id)
{
    static uint8_t piece[DRV_FLASH_PIECE];
    const struct drv_flash_config config = {
        .base = d->registers, .piece = piece, .now_us = now_us, .clock = d};
    memset(d, 0, sizeof *d);
    d->registers[GQSPI_RXD / 4] = id;
    return drv_flash_open(f, &config);
}

TEST(a_read_that_never_ends_is_given_up)
{
    struct drv_flash f;
    struct device d;
    uint8_t byte = 0x77;
    assert_int_equal(open_flash(&f, &d, 0x0020BB20), LM_OK);
    assert_int_equal(f.port.size_bytes, 128 << 20);
    assert_int_equal(f.port.read_start(f.port.ctx, 0, &byte, 1), LM_OK);
    d.registers[DMA_STATUS / 4] = 0; /* cleared by writing ones, which memory keeps */
    assert_int_equal(f.port.read_poll(f.port.ctx), LM_BUSY);
    d.now_us = DRV_FLASH_TIMEOUT_US;
    assert_int_equal(f.port.read_poll(f.port.ctx), LM_BUSY);
    d.now_us++;
    assert_int_equal(f.port.read_poll(f.port.ctx), LM_ERR_IO);
    assert_int_equal(d.registers[GQSPI_EN / 4], 0); /* no DMA comes after all */
    assert_int_equal(byte, 0x77);
    assert_int_equal(f.count.timeouts, 1);
    assert_int_equal(f.port.read_start(f.port.ctx, 0, &byte, 1), LM_OK);
    assert_int_equal(d.registers[GQSPI_EN / 4], 1);
}

TEST(a_device_that_is_absent_or_another_has_no_size)
{
    struct drv_flash f;
    struct device d;
    uint8_t byte;
    const uint32_t ids[] = {0, 0xFFFFFF, 0x0018C2C2, 0x0023BB20, 0x0005BB20, 0x001ABB20};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++) {
        assert_int_equal(open_flash(&f, &d, ids[i]), LM_ERR_IO);
        assert_int_equal(f.port.size_bytes, 0);
        assert_int_equal(f.port.read_start(f.port.ctx, 0, &byte, 1), LM_ERR_RANGE);
    }
}

TEST(a_read_of_nothing_is_done_at_once)
{
    struct drv_flash f;
    struct device d;
    open_flash(&f, &d, 0x0020BB20);
    assert_int_equal(f.port.read_start(f.port.ctx, 0, NULL, 0), LM_OK);
    assert_int_equal(f.port.read_poll(f.port.ctx), LM_OK);
}

/* ---- display link ---- */

enum {
    AUX_COMMAND = 0x100,
    AUX_ADDRESS = 0x108,
    AUX_STATE = 0x130,
    AUX_REPLY = 0x134,
    AUX_COUNT = 0x148,
    PHY_SWING = 0x220,
    PHY_STATUS = 0x280
};

/* A panel behind the registers: it acts whenever the driver asks what time it is. Memory answers
 * each byte of a request alike, which is why its answers are single bytes. */
struct panel {
    struct device device;
    uint32_t state;     /* of the AUX channel: 4 answered, 8 timed out, 0 silent */
    uint8_t answers[8]; /* to each reading of the status, the last one from then on */
    uint32_t readings, highest_swing;
};

static uint64_t panel_now_us(const void *ctx)
{
    struct panel *p = (struct panel *)(uintptr_t)ctx;
    uint32_t *r = p->device.registers;
    const uint32_t command = r[AUX_COMMAND / 4];
    p->device.now_us += 10;
    p->highest_swing = r[PHY_SWING / 4] > p->highest_swing ? r[PHY_SWING / 4] : p->highest_swing;
    if (command != 0) {
        const bool is_status = r[AUX_ADDRESS / 4] == 0x202;
        const uint32_t last = sizeof p->answers - 1;
        r[AUX_COMMAND / 4] = 0;
        r[AUX_STATE / 4] = p->state;
        r[AUX_COUNT / 4] = (command & 15) + 1;
        r[AUX_REPLY / 4] = is_status ? p->answers[p->readings < last ? p->readings : last] : 10;
        p->readings += is_status && (command & 0x100);
    }
    return p->device.now_us;
}

/* Two rates (6 and 10) and more lanes than the board's two; 80 MHz of pixels fit two lanes of the
 * slow rate, or either number of the fast one. */
static int train(struct drv_dp_link *l, struct panel *p, uint32_t state, const uint8_t answers[8])
{
    *p = (struct panel){.state = state};
    memcpy(p->answers, answers, sizeof p->answers);
    p->device.registers[PHY_STATUS / 4] = 3;
    *l = (struct drv_dp_link){
        .dp = p->device.registers, .now_us = panel_now_us, .clock = p, .board_lanes = 2};
    return drv_dp_link_train(l, 80000);
}

static const uint8_t content[8] = {0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77};

TEST(a_link_comes_up_with_the_slowest_rate_that_is_enough)
{
    struct drv_dp_link l;
    struct panel p;
    assert_int_equal(train(&l, &p, 4, content), LM_OK);
    assert_int_equal(l.rate, 6);
    assert_int_equal(l.lanes, 2);
    assert_int_equal(l.count.attempts, 1);
    assert_int_equal(p.device.registers[0x00C / 4], 0); /* no pattern any more */
    assert_int_equal(p.device.registers[0x014 / 4], 0); /* scrambled again */
    assert_in_range(p.device.now_us, 500, 2000); /* the waits of the standard, and not more */
}

TEST(a_panel_that_is_not_there_is_an_error_soon)
{
    struct drv_dp_link l;
    struct panel p;
    assert_int_equal(train(&l, &p, 8, content), LM_ERR_IO);
    assert_int_equal(l.count.unanswered, 7);
    assert_int_equal(l.count.attempts, 0);
    assert_int_equal(train(&l, &p, 0, content), LM_ERR_IO);
    assert_int_equal(l.count.unanswered, 7);
    assert_in_range(p.device.now_us, 3500, 5000);
}

TEST(a_panel_that_wants_more_swing_gets_it)
{
    struct drv_dp_link l;
    struct panel p;
    const uint8_t late[8] = {0x00, 0x22, 0x77, 0x77, 0x77, 0x77, 0x77, 0x77};
    assert_int_equal(train(&l, &p, 4, late), LM_OK);
    assert_int_equal(l.count.attempts, 1);
    assert_int_equal(p.highest_swing, 2);
}

TEST(a_link_that_does_not_come_up_is_tried_faster_and_given_up)
{
    struct drv_dp_link l;
    struct panel p;
    const uint8_t never[8] = {0};
    assert_int_equal(train(&l, &p, 4, never), LM_ERR_IO);
    assert_int_equal(l.count.attempts, 3);
    assert_int_equal(p.readings, 3 * 5);
    const uint8_t recovers_only[8] = {0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x11, 0x11};
    assert_int_equal(train(&l, &p, 4, recovers_only), LM_ERR_IO);
    assert_in_range(p.readings, 3 * 6, 3 * 8);
}

TEST(a_panel_that_asks_to_and_fro_does_not_hold_the_board)
{
    struct drv_dp_link l;
    struct panel p;
    uint8_t to_and_fro[8];
    for (size_t i = 0; i < sizeof to_and_fro; i++) {
        to_and_fro[i] = i % 2 ? 0x22 : 0x00;
    }
    for (uint32_t last = 0; last < 2; last++) {
        to_and_fro[7] = last ? 0x22 : 0x00;
        assert_int_equal(train(&l, &p, 4, to_and_fro), LM_ERR_IO);
        assert_in_range(p.readings, 15, 3 * 20);
    }
}

TEST(a_phy_that_is_not_ready_is_an_error)
{
    struct drv_dp_link l;
    struct panel p = {.state = 4};
    memcpy(p.answers, content, sizeof content);
    l = (struct drv_dp_link){
        .dp = p.device.registers, .now_us = panel_now_us, .clock = &p, .board_lanes = 2};
    assert_int_equal(drv_dp_link_train(&l, 80000), LM_ERR_IO);
    assert_int_equal(p.readings, 0);
}

/* ---- watchdog ---- */

TEST(the_watchdog_is_set_with_its_keys)
{
    struct drv_watchdog w;
    struct device d = {{0}, 0};
    assert_true(drv_watchdog_start(&w, d.registers, 100000000, 2000));
    /* UG1087, SWDT: MODE.ZKEY 0xABC, CONTROL.CKEY 0x248, RESTART.RSTKEY 0x1999. */
    assert_int_equal(d.registers[0] >> 12, 0xABC);
    assert_int_equal(d.registers[0] & 3, 3); /* on, and it resets */
    assert_int_equal(d.registers[1] >> 14, 0x248);
    assert_int_equal(d.registers[2], 0x1999);
    const double seconds = ((d.registers[1] >> 2 & 0xFFF) + 1) * 4096.0 * 4096.0 / 100e6;
    assert_true(seconds >= 2 && seconds < 2.17);
    d.registers[2] = 0;
    drv_watchdog_feed(&w);
    assert_int_equal(d.registers[2], 0x1999);
}

TEST(a_time_that_the_watchdog_cannot_count_is_refused)
{
    struct drv_watchdog w;
    struct device d = {{0}, 0};
    assert_false(drv_watchdog_start(&w, d.registers, 100000000, 0));
    assert_false(drv_watchdog_start(&w, d.registers, 100000000, 688000));
    assert_int_equal(d.registers[0], 0);
    assert_true(drv_watchdog_start(&w, d.registers, 100000000, 1));
    assert_true(drv_watchdog_start(&w, d.registers, 100000000, 687000));
}

/* ---- UART ---- */

TEST(bit_rates_are_met_within_a_percent)
{
    const uint32_t rates[] = {9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600, 2000000};
    for (size_t i = 0; i < sizeof rates / sizeof *rates; i++) {
        struct drv_uart u;
        struct device d = {{0}, 0};
        drv_uart_init(&u, d.registers, 100000000, rates[i]);
        const double rate = 100e6 / d.registers[0x18 / 4] / (d.registers[0x34 / 4] + 1);
        assert_true(fabs(rate / rates[i] - 1) < 0.01);
    }
}

TEST(a_full_ring_of_the_uart_counts_what_it_loses)
{
    struct drv_uart u;
    struct device d = {{0}, 0};
    drv_uart_init(&u, d.registers, 100000000, 115200);
    d.registers[0x14 / 4] = 0;
    d.registers[0x30 / 4] = 'x'; /* the FIFO never empties: 64 bytes an interrupt */
    for (int i = 0; i < 5; i++) {
        drv_uart_interrupt(&u);
    }
    assert_int_equal(u.count.overflowed, 5 * 64 - DRV_UART_RING);
    for (int i = 0; i < DRV_UART_RING; i++) {
        assert_int_equal(drv_uart_get(&u), 'x');
    }
    assert_int_equal(drv_uart_get(&u), -1);
}

/* A line of no speed: what is in the FIFO stays there until the test empties it. */
enum { UART_IER = 0x08 / 4, UART_IDR = 0x0C / 4, UART_ISR = 0x14 / 4, UART_SR = 0x2C / 4 };
enum { UART_FIFO = 0x30 / 4, UART_EMPTY = 1 << 3 };

TEST(bytes_that_wait_are_sent_by_the_interrupt_in_their_order)
{
    uint8_t ring[128];
    char text[130];
    struct drv_uart u;
    struct device d = {{0}, 0};
    for (size_t i = 0; i < sizeof text; i++) {
        text[i] = (char)i;
    }
    drv_uart_init(&u, d.registers, 100000000, 2000000);
    assert_false(drv_uart_queue(&u, text, 1)); /* nothing was lent */
    drv_uart_lend(&u, ring, sizeof ring);
    assert_false(drv_uart_queue(&u, text, sizeof ring + 1));
    assert_true(drv_uart_queue(&u, text, 100)); /* the first FIFO goes at once */
    assert_int_equal(d.registers[UART_FIFO], 63);
    assert_int_equal(d.registers[UART_IER], UART_EMPTY);
    assert_int_equal(drv_uart_room(&u), sizeof ring - 36);
    assert_true(drv_uart_queue(&u, text + 100, 30)); /* over the ring's end */
    assert_int_equal(d.registers[UART_FIFO], 63);
    assert_false(drv_uart_queue(&u, text, 63));
    d.registers[UART_SR] = 1 << 1; /* nothing is received */
    d.registers[UART_ISR] = UART_EMPTY;
    drv_uart_interrupt(&u);
    assert_int_equal(d.registers[UART_FIFO], 127);
    d.registers[UART_SR] |= 1 << 4; /* full */
    d.registers[UART_ISR] = UART_EMPTY;
    drv_uart_interrupt(&u);
    assert_int_equal(d.registers[UART_FIFO], 127);
    d.registers[UART_SR] = 1 << 1;
    d.registers[UART_ISR] = UART_EMPTY;
    drv_uart_interrupt(&u);
    assert_int_equal(d.registers[UART_FIFO], 129);
    d.registers[UART_IDR] = 0;
    d.registers[UART_ISR] = UART_EMPTY;
    drv_uart_interrupt(&u);
    assert_int_equal(d.registers[UART_IDR], UART_EMPTY);
    assert_false(u.out.is_active);
    assert_true(drv_uart_queue(&u, "x", 1));
    assert_int_equal(d.registers[UART_FIFO], 'x');
}

/* ---- interrupts ---- */

static void count_call(void *ctx)
{
    (*(int *)ctx)++;
}

TEST(an_interrupt_finds_its_handler_and_a_strange_one_is_switched_off)
{
    struct drv_irq q;
    struct device distributor = {{0}, 0}, core = {{0}, 0};
    int calls = 0;
    drv_irq_init(&q, distributor.registers, core.registers);
    assert_true(drv_irq_attach(&q, 55, count_call, &calls));
    assert_int_equal(distributor.registers[0x104 / 4], 1 << 23);
    core.registers[0x0C / 4] = 55;
    drv_irq_dispatch(&q);
    assert_int_equal(calls, 1);
    assert_int_equal(core.registers[0x10 / 4], 55);
    core.registers[0x0C / 4] = 56;
    drv_irq_dispatch(&q);
    assert_int_equal(q.count.strange, 1);
    assert_int_equal(distributor.registers[0x184 / 4], 1 << 24);
    core.registers[0x0C / 4] = 1023;
    core.registers[0x10 / 4] = 0;
    drv_irq_dispatch(&q);
    assert_int_equal(q.count.spurious, 1);
    assert_int_equal(core.registers[0x10 / 4], 0);
    assert_int_equal(calls, 1);
}

TEST(more_handlers_than_there_is_room_for_are_refused)
{
    struct drv_irq q;
    struct device distributor = {{0}, 0}, core = {{0}, 0};
    drv_irq_init(&q, distributor.registers, core.registers);
    assert_false(drv_irq_attach(&q, DRV_IRQ_LINES, count_call, NULL));
    for (uint32_t i = 0; i < DRV_IRQ_HANDLERS; i++) {
        assert_true(drv_irq_attach(&q, 40 + i, count_call, NULL));
    }
    assert_false(drv_irq_attach(&q, 60, count_call, NULL));
}
