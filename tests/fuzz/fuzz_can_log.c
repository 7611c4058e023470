/* A recorded bus: any bytes as one line, and as a whole log. */
#include "can_log_check.h"
#include "fuzz.h"

const uint32_t fuzz_mutations = 40000;

static void check_frame(const struct lm_can_frame *f)
{
    FUZZ_ASSERT(f->length <= 8 && f->id <= 0x1FFFFFFF);
    FUZZ_ASSERT(f->is_extended || f->is_error || f->id <= 0x7FF);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char *text = malloc(size + 1);
    FUZZ_ASSERT(text);
    memcpy(text, data, size);
    text[size] = '\0';
    struct drv_can_log log;
    FUZZ_ASSERT(size == 0 || !can_log_check(text, size, &log));
    struct lm_can_frame frame;
    if (!drv_can_log_parse(text, &frame)) {
        check_frame(&frame);
    }
    free(text);
    return 0;
}
