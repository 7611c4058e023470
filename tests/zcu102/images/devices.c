/* The drivers on the board's devices, each claim a line "ok STATEMENT" or "not ok STATEMENT". The
 * flash holds a pattern that the host wrote: the byte at offset n is 11 n + 37 (n / 4096). */
#include "addresses.h"
#include "board.h"
#include "console.h"
#include "fx/crc32c.h"
#include "fx/mem.h"
#include "look.h"
#include "psci.h"

int main(void);
bool registers_survive(const volatile uint32_t *interrupts);

enum { BORDER = 64 << 20, FLASH_BYTES = 128 << 20 };

struct devices {
    struct zcu102 z;
    struct drv_can other; /* the second controller, on the same bus */
};

static void claim(struct devices *d, const char *statement, bool is_true)
{
    zcu102_print(&d->z.console, is_true ? "ok " : "not ok ");
    zcu102_print(&d->z.console, statement);
    zcu102_print(&d->z.console, "\n");
}

/* ---- bus ---- */

static int open_can(struct devices *d, struct drv_can *can, uint32_t base, uint32_t filters)
{
    const struct drv_can_config config = {.base = (drv_registers)(uintptr_t)base,
                                          .clock_hz = CAN_CLOCK_HZ,
                                          .bit_rate = ZCU102_BUS_BIT_RATE,
                                          .filters = {{0x100, 0x700}, {0x555, 0x7FF}},
                                          .filter_count = filters,
                                          .now_us = zcu102_now_us,
                                          .clock = &d->z.timer};
    return drv_can_open(can, &config);
}

static void send(struct devices *d, const struct lm_can_frame *frame)
{
    d->other.port.send(d->other.port.ctx, frame);
}

static int receive(struct devices *d, struct lm_can_frame *frame)
{
    return d->z.can.port.receive(d->z.can.port.ctx, frame);
}

static bool arrives(struct devices *d, const struct lm_can_frame *sent)
{
    struct lm_can_frame got;
    send(d, sent);
    return receive(d, &got) == 1 && got.id == sent->id && got.is_extended == sent->is_extended &&
           got.is_remote == sent->is_remote && !got.is_error && got.length == sent->length &&
           memcmp(got.data, sent->data, got.length) == 0;
}

static uint32_t count_waiting(struct devices *d)
{
    struct lm_can_frame frame;
    uint32_t count = 0;
    while (receive(d, &frame) == 1) {
        count++;
    }
    return count;
}

static void check_frames(struct devices *d)
{
    bool all = true;
    for (uint8_t length = 0; length <= 8; length++) {
        all = all && arrives(d, &(struct lm_can_frame){.id = 0x7FFu - length,
                                                       .length = length,
                                                       .data = {1, 2, 3, 4, 5, 6, 7, 8}});
    }
    claim(d, "data frames of 11 bits and every length arrive as sent", all);
    all = true;
    for (uint32_t bit = 0; bit < 29; bit++) {
        all = all &&
              arrives(d, &(struct lm_can_frame){.id = 1u << bit, .is_extended = true, .length = 1});
    }
    claim(d, "so does each bit of an identifier of 29", all);
    claim(d, "the sender does not hear itself",
          d->other.port.receive(d->other.port.ctx, &(struct lm_can_frame){0}) == 0);
    struct lm_can_frame first, second;
    send(d, &(struct lm_can_frame){.id = 1});
    send(d, &(struct lm_can_frame){.id = 2});
    claim(d, "frames come in their order, with times that do not fall",
          receive(d, &first) == 1 && receive(d, &second) == 1 && first.id == 1 && second.id == 2 &&
              first.time_us <= second.time_us && first.time_us > 0);
}

static void check_delivery(struct devices *d)
{
    struct lm_can_frame frame;
    const uint64_t before_us = drv_timer_us(&d->z.timer);
    drv_can_deliver(&d->z.can, before_us);
    drv_timer_alarm(&d->z.timer, before_us + 100); /* time must pass */
    while (drv_timer_us(&d->z.timer) <= before_us + 100) {
        drv_timer_wait();
    }
    send(d, &(struct lm_can_frame){.id = 3});
    claim(d, "a frame of a later time than that of the step waits", receive(d, &frame) == 0);
    drv_can_deliver(&d->z.can, UINT64_MAX);
    claim(d, "and is not lost", receive(d, &frame) == 1 && frame.id == 3);
}

static void check_overflow(struct devices *d)
{
    zcu102_mask_interrupts();
    for (uint32_t i = 0; i < 100; i++) {
        send(d, &(struct lm_can_frame){.id = i, .length = 2, .data = {0xAB, (uint8_t)i}});
    }
    zcu102_unmask_interrupts();
    claim(d, "64 frames wait in the controller, the rest is lost and said to be",
          count_waiting(d) == 64 && d->z.can.count.fifo_overflowed == 1);
    for (uint32_t i = 0; i < DRV_CAN_RING + 20; i++) {
        send(d, &(struct lm_can_frame){.id = 5});
    }
    claim(d, "a full ring counts what it loses, and keeps the oldest",
          d->z.can.count.overflowed == 20 && count_waiting(d) == DRV_CAN_RING);
    claim(d, "and works on", arrives(d, &(struct lm_can_frame){.id = 6, .length = 8}));
}

static void check_filters(struct devices *d)
{
    claim(d, "a controller opens with filters", open_can(d, &d->z.can, CAN0_BASE, 2) == LM_OK);
    for (uint32_t id = 0; id < 0x800; id++) {
        send(d, &(struct lm_can_frame){.id = id});
        send(d, &(struct lm_can_frame){.id = id << 18, .is_extended = true});
        if (id % 32 == 31) {
            struct lm_can_frame frame;
            while (receive(d, &frame) == 1) {
                const bool is_wanted =
                    !frame.is_extended && ((frame.id & 0x700) == 0x100 || frame.id == 0x555);
                d->z.steps += is_wanted ? 1 : 1000000;
            }
        }
    }
    claim(d, "exactly the identifiers that a filter names pass, none of 29 bits",
          d->z.steps == 0x100 + 1);
    const struct drv_can_config wrong = {.clock_hz = CAN_CLOCK_HZ, .bit_rate = 300000};
    struct drv_can *can = &d->z.can;
    claim(d, "a bit rate that cannot be made is refused",
          drv_can_open(can, &wrong) == LM_ERR_RANGE);
}

static void check_bus(struct devices *d)
{
    claim(d, "both controllers enter the bus", open_can(d, &d->other, CAN1_BASE, 0) == LM_OK);
    check_frames(d);
    check_delivery(d);
    check_overflow(d);
    check_filters(d);
}

/* ---- flash ---- */

static uint8_t pattern(uint64_t offset)
{
    return (uint8_t)(11 * offset + 37 * (offset / 4096));
}

static bool reads_right(struct devices *d, uint64_t offset, uint32_t length)
{
    static uint8_t bytes[100000 + 2];
    const struct lm_flash *flash = &d->z.flash.port;
    memset(bytes, 0x5A, sizeof bytes);
    int status = flash->read_start(flash->ctx, offset, bytes + 1, length);
    for (uint32_t i = 0; i < 100 && status == LM_OK; i++) {
        status = flash->read_poll(flash->ctx) == LM_BUSY ? LM_OK : LM_BUSY; /* LM_BUSY: done */
    }
    bool is_right = status == LM_BUSY && bytes[0] == 0x5A && bytes[length + 1] == 0x5A;
    for (uint32_t i = 0; i < length && is_right; i++) {
        is_right = bytes[1 + i] == pattern(offset + i);
    }
    return is_right;
}

static void check_flash(struct devices *d)
{
    const struct lm_flash *flash = &d->z.flash.port;
    claim(d, "two devices are one flash of 128 MiB", flash->size_bytes == FLASH_BYTES);
    bool all = true;
    for (uint32_t length = 0; length < 40; length++) {
        for (uint32_t offset = 0; offset < 5; offset++) {
            all = all && reads_right(d, 1000003 + offset, length);
        }
    }
    claim(d, "short reads of every length from every offset hold what was asked for, and no more",
          all);
    claim(d, "a read longer than a piece is whole", reads_right(d, 12345, 100000));
    claim(d, "so is one across the border of the devices", reads_right(d, BORDER - 20001, 40003));
    claim(d, "so is the last one", reads_right(d, FLASH_BYTES - 4097, 4097));
    claim(d, "past the end is refused",
          flash->read_start(flash->ctx, FLASH_BYTES - 10, NULL, 11) == LM_ERR_RANGE &&
              flash->read_start(flash->ctx, UINT64_MAX, NULL, 1) == LM_ERR_RANGE);
    claim(d, "no read was given up", d->z.flash.count.timeouts == 0);
}

/* Bit by bit, from the polynomial. */
static uint32_t crc_by_bits(uint32_t crc, const uint8_t *data, uint32_t length)
{
    crc = ~crc;
    for (uint32_t i = 0; i < length; i++) {
        crc ^= data[i];
        for (uint32_t bit = 0; bit < 8; bit++) {
            crc = crc >> 1 ^ (crc & 1 ? 0x82F63B78u : 0);
        }
    }
    return ~crc;
}

static void check_crc(struct devices *d)
{
    static uint8_t bytes[64];
    bool all = fx_crc32c(0, "123456789", 9) == 0xE3069283u;
    for (uint32_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = pattern(i * 4099);
    }
    for (uint32_t start = 0; start < 16; start++) {
        for (uint32_t length = 0; length <= sizeof bytes - start; length++) {
            all = all && fx_crc32c(length, bytes + start, length) ==
                             crc_by_bits(length, bytes + start, length);
        }
    }
    claim(d, "the core's instruction makes the checksum that the polynomial does", all);
}

/* ---- display ---- */

static void check_link(struct devices *d)
{
    struct drv_dp_link *link = &d->z.display.link;
    claim(d, "the panel is asked, and the slowest link that carries the picture comes up at once",
          link->rate == 6 && link->lanes == 1 && link->count.attempts == 1 &&
              link->count.unanswered == 0);
    claim(d, "more pixels take the second lane, and then a faster rate",
          drv_dp_link_train(link, 60000) == LM_OK && link->rate == 6 && link->lanes == 2 &&
              drv_dp_link_train(link, 150000) == LM_OK && link->rate == 10 && link->lanes == 2);
    claim(d, "what two lanes cannot carry is refused",
          drv_dp_link_train(link, 400000) == LM_ERR_RANGE);
    claim(d, "the link of this picture comes up again", drv_dp_link_train(link, 44000) == LM_OK);
}

/* ---- timer, console ---- */

static void check_timer(struct devices *d)
{
    const struct drv_timer *timer = &d->z.timer;
    bool all = true;
    d->z.tick_us = UINT64_MAX / 4; /* the board's own tick stays away */
    for (uint64_t i = 1; i <= 50; i++) {
        const uint64_t due_us = drv_timer_us(timer) + 37 * i;
        zcu102_mask_interrupts();
        drv_timer_alarm(timer, due_us);
        drv_timer_wait();
        const uint64_t now_us = drv_timer_us(timer);
        drv_timer_stop();
        zcu102_unmask_interrupts();
        all = all && now_us >= due_us && now_us < due_us + 1000;
    }
    claim(d, "the alarm comes when it is due, not before", all);
}

static void check_registers(struct devices *d)
{
    bool all = true;
    for (uint32_t i = 0; i < 20; i++) {
        drv_timer_alarm(&d->z.timer, drv_timer_us(&d->z.timer) + 3);
        all = all && registers_survive(&d->z.irq.count.taken);
    }
    claim(d, "an interrupt leaves every register as it was", all);
}

static void check_console(struct devices *d)
{
    zcu102_print(&d->z.console, "TYPE\n"); /* the host types abc */
    char got[3];
    for (uint32_t i = 0; i < sizeof got; i++) {
        int byte;
        zcu102_mask_interrupts();
        while ((byte = drv_uart_get(&d->z.console)) < 0) {
            drv_timer_wait();
            zcu102_unmask_interrupts();
            zcu102_mask_interrupts();
        }
        zcu102_unmask_interrupts();
        got[i] = (char)byte;
    }
    claim(d, "what is typed on the console comes in its order", memcmp(got, "abc", 3) == 0);
}

/* Fill bytes first..end - 1 of a field of others, and look at all of it. */
static bool fills(uint32_t first, uint32_t end, uint8_t byte)
{
    enum { FIELD = 1024, OTHER = 0xA5 };
    static uint8_t field[FIELD] __attribute__((aligned(64)));
    for (uint32_t i = 0; i < FIELD; i++) {
        field[i] = OTHER;
    }
    bool is_right = memset(field + first, byte, end - first) == field + first;
    for (uint32_t i = 0; i < FIELD; i++) {
        is_right = is_right && field[i] == (i >= first && i < end ? byte : OTHER);
    }
    return is_right;
}

/* Of its own (memory.S): blocks of the cache, and what lies around them. */
static void check_memset(struct devices *d)
{
    bool is_right = true;
    for (uint32_t first = 0; first <= 130; first += 13) {
        for (uint32_t bytes = 0; first + bytes <= 960; bytes += bytes < 280 ? 23 : 1 + bytes % 8) {
            is_right =
                is_right && fills(first, first + bytes, 0) && fills(first, first + bytes, 0x5A);
        }
    }
    claim(d, "memset fills what it is told to, and nothing beside it", is_right);
}

int main(void)
{
    static struct devices d;
    zcu102_open(&d.z);
    check_bus(&d);
    check_flash(&d);
    check_crc(&d);
    check_memset(&d);
    check_link(&d);
    check_timer(&d);
    check_registers(&d);
    check_console(&d);
    claim(&d, "no interrupt came that nobody had asked for", d.z.irq.count.strange == 0);
    zcu102_print(&d.z.console, "all done\n");
    zcu102_power_off();
}
