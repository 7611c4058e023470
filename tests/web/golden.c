/* The golden pictures as a module of WebAssembly: the page puts a country's image into its memory,
 * and asks for one picture after the other. */
#include "exports.h"
#include "golden_flight.h"
#include "golden_scene.h"

#include "fx/crc32c.h"

enum { IMAGE_BYTES_MAX = 32 << 20 };

static struct golden_rig rig;
static uint8_t image[IMAGE_BYTES_MAX];

WEB_EXPORT("image") uint8_t *golden_web_image(void);
WEB_EXPORT("image_bytes_max") uint32_t golden_web_image_bytes_max(void);
WEB_EXPORT("image_checksum") uint32_t golden_web_image_checksum(uint32_t bytes);
WEB_EXPORT("count") uint32_t golden_web_count(void);
WEB_EXPORT("name") const char *golden_web_name(uint32_t number);
WEB_EXPORT("place") uint32_t golden_web_place(uint32_t number);
WEB_EXPORT("fly")
int golden_web_fly(uint32_t number, uint32_t image_bytes, uint32_t latitude, uint32_t longitude);
WEB_EXPORT("radar_checksum") uint32_t golden_web_radar_checksum(void);
WEB_EXPORT("glass_checksum") uint32_t golden_web_glass_checksum(void);

uint8_t *golden_web_image(void)
{
    return image;
}

uint32_t golden_web_image_bytes_max(void)
{
    return sizeof image;
}

uint32_t golden_web_image_checksum(uint32_t bytes)
{
    return fx_crc32c(0, image, bytes);
}

uint32_t golden_web_count(void)
{
    return golden_picture_count;
}

const char *golden_web_name(uint32_t number)
{
    return golden_pictures[number].name;
}

uint32_t golden_web_place(uint32_t number)
{
    return golden_pictures[number].place;
}

int golden_web_fly(uint32_t number, uint32_t image_bytes, uint32_t latitude, uint32_t longitude)
{
    const struct golden_country country = {.centre = {.latitude = latitude, .longitude = longitude},
                                           .image = image,
                                           .image_bytes = image_bytes};
    return golden_fly(&rig, &golden_pictures[number], &country);
}

uint32_t golden_web_radar_checksum(void)
{
    return golden_radar_checksum(&rig);
}

uint32_t golden_web_glass_checksum(void)
{
    return golden_glass_checksum(&rig);
}
