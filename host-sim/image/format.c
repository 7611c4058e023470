#include "image/format.h"

#include "fx/crc32c.h"

uint32_t image_entry_crc(uint32_t entry, uint32_t record)
{
    const uint32_t covered[2] = {entry, record};
    return fx_crc32c(0, covered, sizeof covered);
}

const char *image_section_name(uint32_t type)
{
    static const char *const names[LM_IMAGE_SECTION_TYPES] = {
        "unknown", "CLASSES", "BANDS", "DIRECTORY", "TILES", "MANIFEST", "TARGETS", "SIGNATURES"};
    return type < LM_IMAGE_SECTION_TYPES ? names[type] : names[0];
}
