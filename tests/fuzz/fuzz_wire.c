/* Any messages over a wire, to the panel and to the PC. The input is a program: each message has a
 * few bytes of it in its fields, and is sealed or not; some blocks are no messages. What the panel
 * reads lies inside the image that was offered; what the PC tells lies inside the image it has. */
#include "fuzz.h"
#include "fx/crc32c.h"
#include "wire/panel.h"
#include "wire/pc.h"

#include <errno.h>
#include <stddef.h>

const uint32_t fuzz_mutations = 20000;

enum { IMAGE_BYTES = 70000, MESSAGES_MAX = 300 };

struct wire_end {
    struct fuzz_supply supply;
    uint32_t messages;
    uint32_t payload_bytes; /* that are due */
    bool is_spoilt;         /* the payload does not fit */
    struct wire_link link;
};

static uint64_t draw_size(struct fuzz_supply *s)
{
    switch (fuzz_u8(s) & 7) {
    case 0:
        return fuzz_take(s, 8);
    case 1:
        return IMAGE_BYTES;
    case 2:
        return WIRE_PIECE_BYTES;
    case 3:
        return fuzz_u32(s);
    default:
        return fuzz_u16(s);
    }
}

/* The payload of a sealed message is all of this byte. */
enum { FILLING = 0x5a };

static uint32_t crc_of_filling(uint32_t bytes)
{
    static uint8_t filling[WIRE_PIECE_BYTES];
    memset(filling, FILLING, sizeof filling);
    return bytes <= sizeof filling ? fx_crc32c(0, filling, bytes) : 0;
}

static void make_message(struct wire_end *e, struct wire_message *m)
{
    struct fuzz_supply *s = &e->supply;
    const uint8_t how = fuzz_u8(s);
    memset(m, 0, sizeof *m);
    memcpy(m->magic, "LMDBWIRE", sizeof m->magic);
    m->version = how & 1 ? fuzz_u8(s) : WIRE_VERSION;
    m->kind = fuzz_u8(s) % 24;
    m->session = fuzz_u8(s) & 1;
    m->offset = draw_size(s);
    m->bytes = draw_size(s);
    m->payload_bytes = how & 2 ? (uint32_t)draw_size(s) : 0;
    m->payload_crc = crc_of_filling(m->payload_bytes);
    const size_t text = s->left < sizeof m->text ? s->left : sizeof m->text;
    memcpy(m->text, s->at, how & 4 ? text : 0);
    m->crc = fx_crc32c(0, m, offsetof(struct wire_message, crc)) ^ (how & 8 ? 1 : 0);
    e->payload_bytes = m->payload_bytes;
    e->is_spoilt = (how & 16) != 0;
}

static int fuzz_receive(void *ctx, void *to, uint32_t length, uint32_t timeout_ms)
{
    struct wire_end *e = ctx;
    (void)timeout_ms;
    if (e->supply.left == 0 || ++e->messages > MESSAGES_MAX) {
        return ENODEV;
    }
    if (length == sizeof(struct wire_message) && e->payload_bytes == 0) {
        make_message(e, to);
        return 0;
    }
    memset(to, e->is_spoilt ? 0 : FILLING, length);
    e->payload_bytes = 0;
    return 0;
}

static int fuzz_send(void *ctx, const void *from, uint32_t length, uint32_t timeout_ms)
{
    struct wire_end *e = ctx;
    (void)timeout_ms;
    FUZZ_ASSERT(length > 0 && length % WIRE_BLOCK_BYTES == 0);
    volatile uint8_t sum = 0; /* every byte can be read */
    for (uint32_t i = 0; i < length; i++) {
        sum = (uint8_t)(sum + ((const uint8_t *)from)[i]);
    }
    return e->supply.left == 0 ? ENODEV : 0;
}

static int guess(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    (void)ctx;
    memset(to, FILLING, length);
    return offset & 1 ? EIO : 0;
}

static void be_panel(struct wire_end *e)
{
    static struct wire_panel p;
    static uint8_t to[3 * WIRE_PIECE_BYTES + 1];
    wire_panel_open(&p, &e->link, 1);
    while (wire_panel_wait(&p) == 0) {
        wire_panel_welcome(&p, "slot A: whole");
        p.guess = fuzz_u8(&e->supply) & 1 ? guess : NULL;
        for (int i = 0; i < 4; i++) {
            const uint64_t offset = draw_size(&e->supply);
            const uint32_t length = (uint32_t)(draw_size(&e->supply) % sizeof to);
            memset(to, 0, sizeof to);
            const int status = p.port.read_start(p.port.ctx, offset, to, length);
            const bool is_inside =
                offset <= p.port.size_bytes && length <= p.port.size_bytes - offset;
            FUZZ_ASSERT(is_inside == (status != LM_ERR_RANGE));
            FUZZ_ASSERT(status != LM_OK || length == 0 ||
                        (to[0] == FILLING && to[length - 1] == FILLING));
            FUZZ_ASSERT(to[length] == 0);
        }
        wire_panel_status(&p, draw_size(&e->supply), draw_size(&e->supply));
        FUZZ_ASSERT(p.percent <= 100);
        wire_panel_refuse(&p, "no");
    }
}

static int read_image(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    (void)ctx;
    FUZZ_ASSERT(length > 0 && length <= WIRE_PIECE_BYTES && offset < IMAGE_BYTES &&
                length <= IMAGE_BYTES - offset);
    memset(to, FILLING, length);
    return 0;
}

static void show_text(void *ctx, const char *text)
{
    (void)ctx;
    for (; *text != '\0'; text++) {
        FUZZ_ASSERT(*text >= ' ' && *text <= '~');
    }
}

static void show_progress(void *ctx, enum wire_stage stage, uint64_t done, uint64_t all)
{
    (void)ctx;
    FUZZ_ASSERT(stage <= WIRE_CHECKING && done <= all);
}

static void be_pc(struct wire_end *e)
{
    static struct wire_pc pc;
    pc = (struct wire_pc){.link = &e->link,
                          .image = {NULL, IMAGE_BYTES, read_image},
                          .session = 1,
                          .wait_ms = 1,
                          .progress = show_progress,
                          .welcome = show_text};
    const int cause = wire_pc_run(&pc);
    if (cause == 0 || cause == ECANCELED) {
        show_text(NULL, pc.text);
    }
    FUZZ_ASSERT(wire_cause(cause) != NULL);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct wire_end end = {.supply = {data, size}};
    end.link = (struct wire_link){&end, fuzz_send, fuzz_receive};
    const bool is_panel = fuzz_u8(&end.supply) & 1;
    (is_panel ? be_panel : be_pc)(&end);
    return 0;
}
