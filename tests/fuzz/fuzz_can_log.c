/* A recorded bus: any bytes as one line, and as a whole log. */
#include "drv/can_log.h"
#include "fuzz.h"

const uint32_t fuzz_mutations = 40000;

static void check_frame(const struct lm_can_frame *f)
{
    FUZZ_ASSERT(f->length <= 8 && f->id <= 0x1FFFFFFF);
    FUZZ_ASSERT(f->is_extended || f->is_error || f->id <= 0x7FF);
}

static void read_log(char *text, size_t size)
{
    FILE *file = fmemopen(text, size, "r");
    FUZZ_ASSERT(file);
    struct drv_can_log log;
    drv_can_log_init(&log, file, NULL, NULL);
    drv_can_log_set_now(&log, UINT64_MAX);
    const struct lm_can port = drv_can_log_port(&log);
    struct lm_can_frame frame;
    uint64_t last_us = 0;
    while (port.receive(port.ctx, &frame) == 1) {
        check_frame(&frame);
        FUZZ_ASSERT(frame.time_us >= last_us);
        last_us = frame.time_us;
    }
    FUZZ_ASSERT(drv_can_log_is_over(&log));
    FUZZ_ASSERT(log.count.frames + log.count.malformed <= log.count.lines);
    fclose(file);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    FUZZ_ASSERT(text);
    memcpy(text, data, size);
    text[size] = '\0';
    if (size > 0) {
        read_log(text, size);
    }
    struct lm_can_frame frame;
    if (!drv_can_log_parse(text, &frame)) {
        check_frame(&frame);
    }
    free(text);
    return 0;
}
