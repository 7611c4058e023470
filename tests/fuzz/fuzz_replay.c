/* A recording: any lines, through every port of the replay, as a unit would ask them. */
#include "fuzz.h"
#include "replay.h"

const uint32_t fuzz_mutations = 3000;

enum { STEPS = 200, CALLS = 12, FLASH_BYTES = 4096, SIDE = 24 };

static uint8_t flash_bytes[FLASH_BYTES];

static int start_read(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    (void)ctx;
    FUZZ_ASSERT(offset <= FLASH_BYTES && length <= FLASH_BYTES - offset);
    memcpy(destination, flash_bytes + offset, length);
    return LM_OK;
}

static int poll_read(void *ctx)
{
    (void)ctx;
    return LM_OK;
}

static void ask_ports(const struct lm_board *b, uint32_t call)
{
    uint8_t bytes[64];
    struct lm_can_frame frame = {.id = 1500, .length = 8};
    struct lm_control control;
    struct lm_surface surface;
    if (call % 3 == 0 && b->flash->read_start(b->flash->ctx, call, bytes, sizeof bytes) == LM_OK) {
        (void)b->flash->read_poll(b->flash->ctx);
    }
    if (b->can->receive(b->can->ctx, &frame) == 1) {
        FUZZ_ASSERT(frame.length <= 8);
    }
    if (b->can_2 && b->can_2->receive(b->can_2->ctx, &frame) == 1) {
        FUZZ_ASSERT(frame.length <= 8);
    }
    if (b->can->send) {
        (void)b->can->send(b->can->ctx, &frame);
    }
    if (b->controls->next(b->controls->ctx, &control) == 1) {
        FUZZ_ASSERT((uint32_t)control.kind < LM_CONTROL_KINDS);
    }
    if (b->display->acquire(b->display->ctx, &surface) == LM_OK) {
        FUZZ_ASSERT(surface.width_px <= 1024 && surface.height_px <= 1024);
        (void)b->display->present(b->display->ctx, NULL);
    }
}

static void fly(struct replay *p)
{
    const struct lm_flash flash = {
        .size_bytes = FLASH_BYTES, .read_start = start_read, .read_poll = poll_read};
    struct lm_board board = {.flash = &flash};
    FUZZ_ASSERT(replay_wrap(p, &board) == 0);
    uint64_t now_us, last_us = 0;
    for (uint32_t i = 0; i < STEPS && replay_step(p, &now_us); i++) {
        FUZZ_ASSERT(now_us >= last_us);
        last_us = now_us;
        for (uint32_t call = 0; call < (i < 4 ? CALLS : 1); call++) {
            ask_ports(&board, call);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct replay p;
    struct fuzz_file file;
    fuzz_file_open(&file, data, size);
    if (replay_open(&p, file.path) == 0) {
        if (size % 64 != 0) { /* most glasses are small, since pictures take longer than lines */
            p.head.width_px = 1 + p.head.width_px % SIDE;
            p.head.height_px = 1 + p.head.height_px % SIDE;
        }
        fly(&p);
        replay_close(&p);
    }
    fuzz_file_close(&file);
    return 0;
}
