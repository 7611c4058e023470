/* Descriptors and reports of a USB hand controller (drv/hid.h).
 *
 * Proved: prove_item: any bytes give an item of 1 byte or more that they hold, or none, so that
 * parsing ends. prove_read: any report of 0..64 bytes, of any field of 1..32 bits that end within
 * 64 bytes: no byte behind the report is read, and a value has the field's range. Nowhere a bad
 * access, shift or overflow.
 *
 * Assumed: a field's least value is no more than its greatest, as the parser wants. */
#include "drivers/usb/hid.c"

#include "prove.h"

void *malloc(size_t bytes);
struct drv_hid_map nondet_map(void);

static bool is_field_kept(const struct drv_hid_field *f)
{
    return f->bits >= 1 && f->bits <= 32 && f->bit + f->bits <= REPORT_BITS && f->low <= f->high;
}

void prove_item(void)
{
    const size_t left = nondet_u64();
    ASSUME(left >= 1 && left <= DRV_HID_DESCRIPTOR_BYTES);
    const uint8_t *bytes = malloc(left);
    ASSUME(bytes != NULL);
    struct item item;
    const size_t length = read_item(bytes, left, &item);
    PROVE(length <= left && item.bytes <= 4 && item.bytes != 3);
}

void prove_read(void)
{
    const struct drv_hid_map map = {.has_numbers = nondet_bool()};
    const struct drv_hid_map any = nondet_map();
    const struct drv_hid_field field = any.field[0];
    const size_t size = nondet_u64();
    ASSUME(size <= DRV_HID_REPORT_BYTES && is_field_kept(&field));
    const uint8_t *report = malloc(size);
    int32_t value;
    ASSUME(report != NULL);
    if (drv_hid_read(&map, &field, report, size, &value)) {
        PROVE(value >= field.low && value <= field.high);
    }
}
