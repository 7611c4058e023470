/* The golden pictures on a Cortex-M7: the firmware alone, no drivers. The microcontroller has no
 * room for the images, so the flash is a file of the host's, read a record at a time. */
#include "fx/crc32c.h"
#include "golden_flash.h"
#include "golden_flight.h"
#include "host.h"

#include <string.h>

int main(void);

static int image_file;

/* The rig knows its flash by an address, which here stands for an offset in this file. */
static bool fetch(void *to, const uint8_t *from, uint32_t length)
{
    return host_read(image_file, (uint32_t)(uintptr_t)from, to, length);
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
        const uint64_t offset = flash.places[p->place].offset;
        const struct golden_country country = {.centre = flash.places[p->place].centre,
                                               .image = (const uint8_t *)(uintptr_t)offset,
                                               .image_bytes = (size_t)flash.places[p->place].size,
                                               .fetch = fetch};
        if (golden_fly(&rig, p, &country) != LM_OK) {
            host_say("the unit does not start\n");
            return 1;
        }
        host_say_checksums(p->name, golden_radar_checksum(&rig), golden_glass_checksum(&rig));
    }
    return 0;
}
