/* The script of landmass-sim: what it accepts is in order and within what controls.h allows. */
#include "fuzz.h"
#include "sim/script.h"

const uint32_t fuzz_mutations = 40000;

static void check_event(const struct script_event *e)
{
    const struct lm_control *c = &e->control;
    if (e->is_picture) {
        FUZZ_ASSERT(memchr(e->picture, 0, sizeof e->picture) && !strchr(e->picture, '/'));
    } else if (c->kind == LM_CONTROL_SAR) {
        FUZZ_ASSERT(c->sar.cell_mm >= 100 && c->sar.cell_mm <= 1000000);
        FUZZ_ASSERT(c->sar.range_m <= 1000000);
        const int32_t latitude = (int32_t)c->sar.centre.latitude;
        FUZZ_ASSERT(latitude <= (int32_t)FX_BAM_90 && latitude >= -(int32_t)FX_BAM_90);
    } else if (c->kind == LM_CONTROL_GAIN) {
        FUZZ_ASSERT(c->gain_db >= -30 && c->gain_db <= 30);
    } else if (c->kind == LM_CONTROL_DOWN || c->kind == LM_CONTROL_UP) {
        FUZZ_ASSERT(c->button >= 1 && c->button <= LM_BUTTONS);
    } else if (c->kind == LM_CONTROL_SLEW) {
        FUZZ_ASSERT(abs(c->slew.x) <= LM_FULL_DEFLECTION && abs(c->slew.y) <= LM_FULL_DEFLECTION);
    } else if (c->kind == LM_CONTROL_KNOB) {
        FUZZ_ASSERT(abs(c->knob) <= LM_FULL_DEFLECTION);
    }
}

/* Opens anything: an image that cannot be opened is no event. */
static bool open_image(void *ctx, int32_t place, const char *path, struct lm_control *control)
{
    (void)ctx;
    (void)control;
    FUZZ_ASSERT(place >= 1 && place <= LM_IMAGES_MAX && (!path || *path));
    return true;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    struct script script;
    fuzz_file_open(&file, data, size);
    if (script_read(&script, file.path, &lm_radar_default) == 0) {
        int handed_out = 0;
        script.images.open = open_image;
        struct lm_control control;
        for (int i = 0; i < script.count; i++) {
            check_event(&script.events[i]);
            FUZZ_ASSERT(i == 0 || script.events[i].time_us >= script.events[i - 1].time_us);
        }
        while (script_advance(&script, UINT64_MAX) ||
               script.port.next(script.port.ctx, &control) == 1) {
            handed_out++;
        }
        FUZZ_ASSERT(handed_out == script.count);
    }
    script_free(&script);
    fuzz_file_close(&file);
    return 0;
}
