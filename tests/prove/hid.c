/* Descriptors and reports of a USB hand controller (drv/hid.h).
 *
 * Invariant of the parser: `depth` and `pushed` within their limits, at most 64 usages and 96
 * fields, no report longer than 64 bytes; each field kept has 1..32 bits that end within 64 bytes.
 *
 * Proved: prove_item: any bytes give an item of 1 byte or more that they hold, or none, so that
 * parsing ends. prove_collection to prove_local: any item but an input keeps the invariant, of a
 * report and a field chosen freely, hence of all. prove_read: any report of 0..64 bytes, of any
 * field that the parser keeps: no byte behind the report is read, and a value has the field's
 * range. Nowhere a bad access, shift or overflow.
 *
 * Assumed: nothing. */
#include "drivers/usb/hid.c"

#include "prove.h"

void *malloc(size_t bytes);
struct parser nondet_parser(void);
struct drv_hid_map nondet_map(void);
struct item nondet_item(void);

static bool is_field_kept(const struct drv_hid_field *f)
{
    return f->bits >= 1 && f->bits <= 32 && f->bit + f->bits <= REPORT_BITS && f->low <= f->high;
}

static bool is_kept(const struct parser *p, uint8_t report, uint32_t field)
{
    return p->depth <= DRV_HID_DEPTH && p->pushed <= DRV_HID_STACK &&
           p->local.count <= USAGES_MAX && p->map->count <= DRV_HID_FIELDS &&
           p->bits[report] <= REPORT_BITS &&
           (field >= p->map->count || is_field_kept(&p->map->field[field]));
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

/* One call with any item of a kind. */
static void take(const char *(*call)(struct parser *p, const struct item *i), int32_t prefix)
{
    static struct drv_hid_map map;
    struct parser p = nondet_parser();
    struct item item = nondet_item();
    const uint8_t report = nondet_u8();
    const uint32_t field = nondet_u32();
    map = nondet_map();
    p.map = &map;
    item.prefix = prefix >= 0 ? (uint8_t)prefix : item.prefix;
    ASSUME(is_kept(&p, report, field) && is_kept(&p, p.global.report, field));
    call(&p, &item);
    PROVE(is_kept(&p, report, field));
}

void prove_collection(void)
{
    take(take_main, COLLECTION);
}

void prove_end(void)
{
    take(take_main, END_COLLECTION);
}

void prove_global(void)
{
    take(take_global, -1);
}

void prove_local(void)
{
    take(take_local, -1);
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
