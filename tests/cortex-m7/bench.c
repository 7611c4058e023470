/* What a SAR patch costs a Cortex-M7, which has no vectors: instructions a pixel, drawn and
 * painted. QEMU is told to count an instruction as a nanosecond (bench.sh), and its SysTick, of 25
 * MHz, then counts forties of instructions. */
#include "host.h"
#include "patch_rig.h"

int main(void);

static int image_file;
static struct patch_rig rig;
static uint8_t pixels[PATCH_RIG_PX * PATCH_RIG_PX];
static struct lm_tile pool[PATCH_RIG_TILES];

/* Addresses of the rig's flash stand for offsets in this file. */
static bool fetch(void *to, const uint8_t *from, uint32_t length)
{
    return host_read(image_file, (uint32_t)(uintptr_t)from, to, length);
}

/* SysTick of Armv7-M (DDI 0403E, B3.3): 24 bits that count down. */
static volatile uint32_t *const systick = (volatile uint32_t *)0xE000E010;
enum { CONTROL, RELOAD, VALUE, ENABLE_CORE_CLOCK = 5 };
#define VALUE_MAX 0xffffffu

static uint32_t ticks_to_draw(bool paints)
{
    systick[RELOAD] = VALUE_MAX;
    systick[VALUE] = 0;
    systick[CONTROL] = ENABLE_CORE_CLOCK;
    const uint32_t start = systick[VALUE];
    patch_rig_draw(&rig, paints);
    return (start - systick[VALUE]) & VALUE_MAX;
}

static int measure(const char *name, uint32_t cell_mm)
{
    for (uint32_t paints = 0; paints < 2; paints++) {
        if (patch_rig_begin(&rig, NULL, cell_mm) != LM_OK) {
            host_say("the patch cannot be begun\n");
            return 1;
        }
        host_say(name);
        host_say(paints ? " painted " : " drawn ");
        host_say_number(ticks_to_draw(paints));
        host_say("\n");
    }
    return 0;
}

int main(void)
{
    image_file = host_open("patch.img");
    uint32_t image_bytes;
    if (image_file < 0 || !host_length(image_file, &image_bytes) ||
        patch_rig_open(&rig, NULL, image_bytes, fetch, pool, pixels) != LM_OK) {
        host_say("patch.img cannot be read\n");
        return 1;
    }
    return measure("patch", PATCH_RIG_CELL_MM) != 0 || measure("finer", 1000) != 0;
}
