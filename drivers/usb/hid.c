#include "drv/hid.h"

#include <string.h>

/* Items (HID 1.11, 6.2.2.4 to 6.2.2.8): the prefix without its two bits of size. */
enum {
    INPUT = 0x80,
    OUTPUT = 0x90,
    FEATURE = 0xb0,
    COLLECTION = 0xa0,
    END_COLLECTION = 0xc0,
    USAGE_PAGE = 0x04,
    LOGICAL_MINIMUM = 0x14,
    LOGICAL_MAXIMUM = 0x24,
    REPORT_SIZE = 0x74,
    REPORT_ID = 0x84,
    REPORT_COUNT = 0x94,
    PUSH = 0xa4,
    POP = 0xb4,
    USAGE = 0x08,
    USAGE_MINIMUM = 0x18,
    USAGE_MAXIMUM = 0x28,
    LONG_ITEM = 0xfe,

    IS_CONSTANT = 1 << 0, /* bits of INPUT */
    IS_VARIABLE = 1 << 1,
    IS_RELATIVE = 1 << 2,

    USAGES_MAX = 64,
    REPORT_BITS = 8 * DRV_HID_REPORT_BYTES,
    MAIN_MASK = 0x0c /* of the prefix: 0 for the main items */
};

/* What holds until it is changed (6.2.2.7). */
struct global {
    uint16_t page;
    uint8_t report;
    uint32_t size_bits, count;
    int32_t low;
    int32_t high, unsigned_high; /* the same data, read either way */
};

/* What holds for the next main item only (6.2.2.8). Usages are page << 16 | usage. */
struct local {
    uint32_t usage[USAGES_MAX];
    uint32_t count;
    uint32_t first, last; /* a range: instead of the list, or after it */
    bool has_first, has_last;
};

struct parser {
    struct drv_hid_map *map;
    struct global global, stack[DRV_HID_STACK];
    struct local local;
    uint32_t pushed, depth;
    uint16_t bits[256]; /* used so far in each input report */
    bool is_early;      /* a field was seen before any report's number */
};

struct item {
    uint8_t prefix; /* without its size */
    uint8_t bytes;  /* of data: 0, 1, 2 or 4 */
    uint32_t data;
};

static int32_t as_signed(const struct item *i)
{
    switch (i->bytes) {
    case 1:
        return (int8_t)i->data;
    case 2:
        return (int16_t)i->data;
    default:
        return (int32_t)i->data;
    }
}

/* A usage of four bytes brings its page with it (6.2.2.8). */
static uint32_t full_usage(const struct parser *p, const struct item *i)
{
    return i->bytes == 4 ? i->data : (uint32_t)p->global.page << 16 | i->data;
}

/* The usage of the n-th field of a main item; the last one serves all that remain. 0: none. */
static uint32_t nth_usage(const struct local *l, uint32_t n)
{
    if (n < l->count) {
        return l->usage[n];
    }
    if (l->has_first && l->has_last) {
        const uint32_t offset = n - l->count;
        return offset <= l->last - l->first ? l->first + offset : l->last;
    }
    return l->count > 0 ? l->usage[l->count - 1] : 0;
}

/* Devices whose numbers are not negative often write 255 as one byte, which is -1 by the letter of
 * 6.2.2.7: the minimum tells how the maximum is meant, whichever came first. */
static int32_t maximum(const struct global *g)
{
    return g->low >= 0 && g->high < 0 ? g->unsigned_high : g->high;
}

static bool is_wanted(uint32_t page, uint32_t usage)
{
    return (page == DRV_HID_PAGE_DESKTOP && usage >= DRV_HID_X && usage <= DRV_HID_HAT) ||
           (page == DRV_HID_PAGE_SIMULATION &&
            (usage == DRV_HID_RUDDER || usage == DRV_HID_THROTTLE)) ||
           page == DRV_HID_PAGE_BUTTON;
}

static void store_field(struct parser *p, uint32_t usage, uint32_t bit, uint32_t flags)
{
    struct drv_hid_map *m = p->map;
    if (m->count == DRV_HID_FIELDS || !is_wanted(usage >> 16, usage & 0xffff)) {
        return;
    }
    m->field[m->count++] = (struct drv_hid_field){
        .page = (uint16_t)(usage >> 16),
        .usage = (uint16_t)usage,
        .bit = (uint16_t)bit,
        .bits = (uint8_t)p->global.size_bits,
        .report = p->global.report,
        .is_relative = (flags & IS_RELATIVE) != 0,
        .low = p->global.low,
        .high = maximum(&p->global),
    };
}

static const char *take_input(struct parser *p, uint32_t flags)
{
    const struct global *g = &p->global;
    const uint32_t begin = p->bits[g->report];
    if (g->size_bits == 0 || g->size_bits > 32 || g->count == 0) {
        return "a field without a size";
    }
    if (g->count > REPORT_BITS || begin + g->size_bits * g->count > REPORT_BITS) {
        return "a report longer than 64 bytes";
    }
    if (p->depth == 0) {
        return "a field outside of any collection";
    }
    p->is_early = p->is_early || g->report == 0;
    p->bits[g->report] = (uint16_t)(begin + g->size_bits * g->count);
    if ((flags & IS_CONSTANT) != 0 || (flags & IS_VARIABLE) == 0) {
        return NULL; /* padding, or a list of keys */
    }
    if (g->low > maximum(g)) {
        return "a field whose minimum is above its maximum";
    }
    for (uint32_t n = 0; n < g->count; n++) {
        store_field(p, nth_usage(&p->local, n), begin + n * g->size_bits, flags);
    }
    return NULL;
}

static const char *begin_collection(struct parser *p)
{
    if (p->depth == DRV_HID_DEPTH) {
        return "collections too deep";
    }
    if (p->depth++ == 0 && p->map->application_page == 0) {
        const uint32_t usage = nth_usage(&p->local, 0);
        p->map->application_page = (uint16_t)(usage >> 16);
        p->map->application = (uint16_t)usage;
    }
    return NULL;
}

static const char *take_main(struct parser *p, const struct item *i)
{
    const char *cause = NULL;
    switch (i->prefix) {
    case INPUT:
        cause = take_input(p, i->data);
        break;
    case COLLECTION:
        cause = begin_collection(p);
        break;
    case END_COLLECTION:
        cause = p->depth == 0 ? "the end of a collection that did not begin" : NULL;
        p->depth -= cause == NULL;
        break;
    default: /* output, feature and what is reserved do not concern us */
        break;
    }
    p->local = (struct local){0};
    return cause;
}

static const char *take_report_number(struct parser *p, const struct item *i)
{
    if (i->data == 0 || i->data > 255) {
        return "a report's number that is not 1..255";
    }
    if (p->is_early) {
        return "a report's number after fields without one";
    }
    p->global.report = (uint8_t)i->data;
    p->map->has_numbers = true;
    return NULL;
}

static const char *take_global(struct parser *p, const struct item *i)
{
    struct global *g = &p->global;
    switch (i->prefix) {
    case USAGE_PAGE:
        g->page = (uint16_t)i->data;
        return i->data > 0xffff ? "a page beyond 16 bits" : NULL;
    case LOGICAL_MINIMUM:
        g->low = as_signed(i);
        return NULL;
    case LOGICAL_MAXIMUM:
        g->high = as_signed(i);
        g->unsigned_high = (int32_t)i->data;
        return NULL;
    case REPORT_SIZE:
        g->size_bits = i->data;
        return NULL;
    case REPORT_COUNT:
        g->count = i->data;
        return NULL;
    case REPORT_ID:
        return take_report_number(p, i);
    case PUSH:
        if (p->pushed == DRV_HID_STACK) {
            return "too much is pushed";
        }
        p->stack[p->pushed++] = *g;
        return NULL;
    case POP:
        if (p->pushed == 0) {
            return "more is popped than was pushed";
        }
        *g = p->stack[--p->pushed];
        return NULL;
    default: /* units and physical limits */
        return NULL;
    }
}

static const char *take_local(struct parser *p, const struct item *i)
{
    struct local *l = &p->local;
    switch (i->prefix) {
    case USAGE:
        if (l->count == USAGES_MAX) {
            return "too many usages for one item";
        }
        l->usage[l->count++] = full_usage(p, i);
        return NULL;
    case USAGE_MINIMUM:
        l->first = full_usage(p, i);
        l->has_first = true;
        break;
    case USAGE_MAXIMUM:
        l->last = full_usage(p, i);
        l->has_last = true;
        break;
    default: /* designators, strings, delimiters */
        return NULL;
    }
    const bool is_range = l->has_first && l->has_last;
    return is_range && l->first > l->last ? "a range of usages that runs backwards" : NULL;
}

/* Take the item at `d` apart. Returns its length, or 0 when it is cut off. */
static size_t read_item(const uint8_t *d, size_t left, struct item *i)
{
    if (d[0] == LONG_ITEM) { /* reserved; its length is in its second byte (6.2.2.3) */
        *i = (struct item){.prefix = LONG_ITEM};
        const size_t length = left >= 3 ? 3u + d[1] : 0;
        return length <= left ? length : 0;
    }
    const uint8_t bytes = (uint8_t)((d[0] & 3) == 3 ? 4 : d[0] & 3);
    *i = (struct item){.prefix = d[0] & 0xfc, .bytes = bytes};
    if (left < 1u + bytes) {
        return 0;
    }
    for (uint32_t n = 0; n < bytes; n++) {
        i->data |= (uint32_t)d[1 + n] << 8 * n;
    }
    return 1u + bytes;
}

static const char *take_item(struct parser *p, const struct item *i)
{
    if (i->prefix == LONG_ITEM) {
        return NULL;
    }
    switch (i->prefix & MAIN_MASK) {
    case 0x00:
        return take_main(p, i);
    case 0x04:
        return take_global(p, i);
    case 0x08:
        return take_local(p, i);
    default:
        return "an item of a kind that does not exist";
    }
}

const char *drv_hid_parse(const uint8_t *descriptor, size_t size, struct drv_hid_map *map)
{
    struct parser p = {.map = map};
    memset(map, 0, sizeof *map);
    if (size > DRV_HID_DESCRIPTOR_BYTES) {
        return "longer than 4096 bytes";
    }
    for (size_t at = 0; at < size;) {
        struct item item;
        const size_t length = read_item(descriptor + at, size - at, &item);
        if (length == 0) {
            return "cut off in the middle of an item";
        }
        const char *cause = take_item(&p, &item);
        if (cause != NULL) {
            return cause;
        }
        at += length;
    }
    return p.depth == 0 ? NULL : "a collection that does not end";
}

bool drv_hid_read(const struct drv_hid_map *map, const struct drv_hid_field *field,
                  const uint8_t *report, size_t size, int32_t *value)
{
    if (map->has_numbers) {
        if (size == 0 || report[0] != field->report) {
            return false;
        }
        report++;
        size--;
    }
    if (((size_t)field->bit + field->bits + 7) / 8 > size) {
        return false;
    }
    uint32_t bits = 0;
    for (uint32_t n = 0; n < field->bits; n++) {
        const uint32_t bit = field->bit + n;
        bits |= (uint32_t)(report[bit / 8] >> bit % 8 & 1) << n;
    }
    const uint32_t sign = field->low < 0 ? 1u << ((field->bits - 1u) & 31u) : 0;
    *value = (int32_t)((bits ^ sign) - sign);
    return *value >= field->low && *value <= field->high;
}
