#include "image/format.h"

#include "fx/crc32c.h"

#include <stddef.h>

uint32_t image_entry_crc(uint32_t number, const struct lm_tile_entry *entry)
{
    const uint32_t crc = fx_crc32c(0, &number, sizeof number);
    return fx_crc32c(crc, entry, offsetof(struct lm_tile_entry, crc));
}

const char *image_section_name(uint32_t type)
{
    static const char *const names[LM_IMAGE_SECTION_TYPES] = {
        "unknown",    "CLASSES", "BANDS",  "DIRECTORY", "TILES", "MANIFEST", "TARGETS",
        "SIGNATURES", "GEOID",   "DETAIL", "RADAR",     "SEAL",  "BUS",      "GEOID_PAGES"};
    return type < LM_IMAGE_SECTION_TYPES ? names[type] : names[0];
}
