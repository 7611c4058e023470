/* The golden pictures on a Cortex-M7: the firmware alone, no drivers. The microcontroller has no
 * room for the images, so the flash is a file of the host's, read a record at a time; it keeps the
 * promises of memory_flash.h. */
#include "fx/crc32c.h"
#include "golden_flash.h"
#include "golden_flight.h"
#include "host.h"

#include <string.h>

int main(void);
_Noreturn void reset(void);

/* The rig knows its flash by an address, which here stands for an offset in this file. */
static int image_file;

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct memory_flash *f = ctx;
    if (offset > f->port.size_bytes || length > f->port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    f->reads++;
    f->now.offset = offset;
    f->now.to = destination;
    f->now.length = length;
    f->now.is_failing = f->fail_every && f->reads % f->fail_every == 0;
    return LM_OK;
}

static int read_poll(void *ctx)
{
    const struct memory_flash *f = ctx;
    if (f->now.is_failing) {
        memset(f->now.to, 0x5A, f->now.length / 2);
        return LM_ERR_IO;
    }
    const uint32_t offset = (uint32_t)((uintptr_t)f->bytes + f->now.offset);
    return host_read(image_file, offset, f->now.to, f->now.length) ? LM_OK : LM_ERR_IO;
}

void memory_flash_open(struct memory_flash *f, const uint8_t *bytes, size_t size)
{
    *f = (struct memory_flash){
        .bytes = bytes,
        .port = {.ctx = f, .size_bytes = size, .read_start = read_start, .read_poll = read_poll}};
}

int main(void)
{
    static struct golden_rig rig;
    static struct golden_flash flash;
    image_file = host_open("golden.img");
    if (image_file < 0 || !host_read(image_file, 0, &flash, sizeof flash) ||
        flash.magic != GOLDEN_FLASH_MAGIC) {
        host_say("golden.img cannot be read\n");
        return 1;
    }
    for (uint32_t i = 0; i < golden_picture_count; i++) {
        const struct golden_picture *p = &golden_pictures[i];
        const uint8_t *start = (const uint8_t *)(uintptr_t)flash.places[p->place].offset;
        if (golden_fly(&rig, p, flash.places[p->place].centre, start,
                       (size_t)flash.places[p->place].size) != LM_OK) {
            host_say("the unit does not start\n");
            return 1;
        }
        host_say_checksums(p->name, golden_radar_checksum(&rig), golden_glass_checksum(&rig));
    }
    return 0;
}

/* QEMU has loaded .data and cleared .bss. */
_Noreturn void reset(void)
{
    host_exit(main());
}

static _Noreturn void fault(void)
{
    host_say("a fault\n");
    host_exit(2);
}

extern char __stack_top[];

struct vectors {
    const void *stack;
    void (*handlers[15])(void);
};

extern const struct vectors vectors;
__attribute__((section(".vectors"), used))
const struct vectors vectors = {__stack_top, {reset, fault, fault, fault, fault, fault}};
