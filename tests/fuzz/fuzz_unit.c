/* The whole unit in flight over a hostile image with a hostile bus, hostile controls and failing
 * devices. The input is a programme: a choice of place, patches of the image, then what happens
 * step by step (see act). */
#include "bus_frames.h"
#include "fuzz.h"
#include "lm/image.h"
#include "lm/radar_record.h"
#include "memory_board.h"
#include "seal.h"
#include "tiny_image.h"

#include <math.h>

const uint32_t fuzz_mutations = 400;

enum {
    SIDE = 256,
    POOL_TILES = 64,
    QUEUE = 32,
    STEPS_USUAL = 24, /* in most inputs, so that they are many */
    STEPS_MAX = 300,
    PLACES = 4,
    NODE = 20,
    PARTNER = 21
};

struct world {
    struct tiny_image image; /* a copy, to be damaged */
    struct lm_position centre;
    struct memory_board board;
    struct lm_unit unit;
    uint64_t now_us;
    uint32_t steps, steps_most;
    bool is_record_patched;

    struct lm_can_frame frames[QUEUE];
    uint32_t frame_head, frame_tail;
    struct lm_control control;
    bool has_control;
    uint8_t message_code;
};

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct world *w = ctx;
    if (w->frame_tail == w->frame_head) {
        return 0;
    }
    *frame = w->frames[w->frame_tail++ % QUEUE];
    return 1;
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct world *w = ctx;
    *control = w->control;
    const bool had = w->has_control;
    w->has_control = false;
    return had;
}

static struct tiny_cell scene_cell(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    const double east = fabs(remainder(p->east_m, 900)), north = fabs(remainder(p->north_m, 700));
    const uint8_t kind = east < 80 && north < 80 ? TINY_STRUCTURE
                         : east < 200            ? TINY_WATER
                         : north < 100           ? TINY_TREES
                                                 : TINY_SOIL;
    return (struct tiny_cell){-18 + 4 * kind, kind, kind == TINY_STRUCTURE ? 6 : 0};
}

static double scene_elevation(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 300 + 200 * sin(p->east_m / 1100) * cos(p->north_m / 1700);
}

/* In mid-latitude, on a zone border, on the antimeridian, and round a pole. */
static const double places[PLACES][2] = {{46, 11}, {61.875, -20}, {-3, 180}, {89.95, 77}};

/* Built at the first use of each place and kept. */
static const struct tiny_image *base_image(unsigned place)
{
    static struct tiny_image images[PLACES];
    if (!images[place].bytes) {
        struct tiny_spec spec = tiny_spec_at(places[place][0], places[place][1]);
        spec.shift0 = 11;
        spec.rows = spec.columns = 3;
        spec.cell = scene_cell;
        spec.elevation_m = scene_elevation;
        FUZZ_ASSERT(tiny_image_build(&images[place], &spec) == 0);
        uint8_t radar[LM_RADAR_RECORD_BYTES];
        lm_radar_pack(&lm_radar_default, radar);
        FUZZ_ASSERT(tiny_image_add_section(&images[place], LM_IMAGE_RADAR, radar, sizeof radar) ==
                    0);
    }
    return &images[place];
}

static void patch(struct world *w, struct fuzz_supply *s)
{
    struct tiny_image *image = &w->image;
    const uint8_t region = fuzz_u8(s);
    const uint16_t at = fuzz_u16(s);
    const uint32_t value = fuzz_u32(s);
    const size_t starts[] = {0,
                             image->classes_offset,
                             image->bands_offset,
                             image->directory_offset,
                             image->tiles_offset +
                                 (size_t)LM_TILE_BYTES * ((region >> 5) % image->record_count),
                             image->size - LM_RADAR_RECORD_BYTES};
    const size_t lengths[] = {
        LM_DB_HEADER_BYTES,      sizeof(struct lm_classes),
        image->band_count * 24u, image->entry_count * sizeof(struct lm_tile_entry),
        LM_TILE_BYTES,           LM_RADAR_RECORD_BYTES};
    const unsigned which = region % 6;
    const size_t width = (size_t)1 << (region >> 3 & 3) & 7;
    w->is_record_patched |= which == 3 || which == 4; /* the directory says how one is stored */
    if (width) {
        memcpy(image->bytes + starts[which] + at % (lengths[which] - 3), &value,
               width > 4 ? 4 : width);
    }
}

/* Records take longest, and most patches leave them alone. */
static void seal_world(struct world *w, unsigned parts)
{
    seal_image(w->image.bytes, w->image.size,
               w->is_record_patched ? parts : parts & ~(unsigned)SEAL_RECORDS);
}

static void queue_frame(struct world *w, const struct lm_can_frame *frame)
{
    if (w->frame_head - w->frame_tail < QUEUE) {
        w->frames[w->frame_head++ % QUEUE] = *frame;
    }
}

static void queue_value(struct world *w, uint32_t id, uint8_t type, uint32_t bits)
{
    const struct lm_can_frame f = bus_frame(id, type, w->message_code, bits, w->now_us);
    queue_frame(w, &f);
}

static void queue_float(struct world *w, uint32_t id, double value)
{
    queue_value(w, id, LM_CANAS_FLOAT, bus_float_bits(value));
}

/* A whole, believable position: what it takes before anything is drawn. */
static void queue_fix(struct world *w, struct fuzz_supply *s)
{
    const double north = (int8_t)fuzz_u8(s) / 1000.0, east = (int8_t)fuzz_u8(s) / 1000.0;
    const double height = fuzz_u8(s) * 120.0 - 900, heading = fuzz_u8(s) * 1.4;
    const double degrees = 360 / 4294967296.0;
    w->message_code++;
    queue_float(w, 1036, fmin((int32_t)w->centre.latitude * degrees + north, 90));
    queue_float(w, 1037, remainder((int32_t)w->centre.longitude * degrees + east, 360));
    queue_float(w, 1038, height);
    queue_float(w, 1133, heading);
    queue_float(w, 1039, 150);
    queue_float(w, 1040, heading);
}

/* A whole circle of rain or a jammer near the middle. */
static void queue_weather(struct world *w, struct fuzz_supply *s, bool is_jammer)
{
    const double degrees = 360 / 4294967296.0;
    const uint32_t id = is_jammer ? 1804 : 1800;
    w->message_code++;
    queue_float(w, id, fmin((int32_t)w->centre.latitude * degrees + (int8_t)fuzz_u8(s) / 1e3, 90));
    queue_float(w, id + 1, (int32_t)w->centre.longitude * degrees + (int8_t)fuzz_u8(s) / 1e3);
    queue_float(w, id + 2, is_jammer ? fuzz_u8(s) / 2.0 - 25 : fuzz_u16(s) * 2.0);
    if (!is_jammer) {
        queue_float(w, id + 3, fuzz_u8(s));
    }
}

/* Time, rate and seed of the exercise. */
static void queue_exercise(struct world *w, struct fuzz_supply *s)
{
    const uint32_t which = fuzz_u8(s) % 3, word = fuzz_u32(s);
    w->message_code++;
    if (which == 1) {
        queue_float(w, 1821, word % 20 / 4.0);
    } else {
        queue_value(w, 1820 + which, LM_CANAS_LONG, word >> (word & 31));
    }
}

/* What a partner says in an exchange of pages: a page that may be sound, or an act. */
static void queue_swap(struct world *w, struct fuzz_supply *s)
{
    const uint8_t act = fuzz_u8(s), code = w->unit.swap.exchange;
    const uint32_t first = act & 1 ? LM_SWAP_OF_ANSWER : 0;
    struct lm_can_frame f = bus_frame(LM_SWAP_ID, LM_CANAS_UCHAR4, code, 0, w->now_us);
    f.data[0] = PARTNER;
    f.length = 8;
    for (uint32_t i = 0; i < LM_SWAP_PARTS && (act & 2) != 0; i++) {
        const uint32_t bytes = fuzz_u32(s) & (act & 4 ? UINT32_MAX : 0x01010101);
        f.data[2] = (uint8_t)(first + i);
        memcpy(f.data + 4, &bytes, sizeof bytes);
        queue_frame(w, &f);
    }
    f.data[2] = (uint8_t)(LM_SWAP_ASK + (act >> 3) % 5);
    f.data[4] = NODE;
    queue_frame(w, &f);
}

/* One malfunction of any kind, or the end of all. */
static void queue_malfunction(struct world *w, struct fuzz_supply *s)
{
    const uint8_t kind = fuzz_u8(s) % (LM_MALFUNCTIONS + 2);
    struct lm_can_frame f = bus_frame(1825, LM_CANAS_FLOAT, w->message_code++,
                                      bus_float_bits((int8_t)fuzz_u8(s)), w->now_us);
    f.data[2] = kind;
    if (kind > LM_MALFUNCTIONS) {
        f = bus_frame(1826, LM_CANAS_UCHAR, w->message_code++, UINT32_MAX, w->now_us);
        f.length = 5;
    }
    queue_frame(w, &f);
}

static void queue_any(struct world *w, struct fuzz_supply *s)
{
    struct lm_can_frame f = {.id = fuzz_u32(s), .time_us = w->now_us + fuzz_u16(s)};
    const uint8_t flags = fuzz_u8(s);
    f.is_extended = flags & 1;
    f.is_remote = flags & 2;
    f.is_error = flags & 4;
    f.length = flags >> 4;
    const uint64_t data = fuzz_take(s, 8);
    memcpy(f.data, &data, 8);
    queue_frame(w, &f);
}

static void command_patch(struct world *w, struct fuzz_supply *s)
{
    const uint8_t flags = fuzz_u8(s);
    w->has_control = true;
    w->control = (struct lm_control){.kind = LM_CONTROL_SAR};
    struct lm_sar_command *c = &w->control.sar;
    c->centre = w->centre;
    c->centre.latitude += (fx_bam_t)(int16_t)fuzz_u16(s) << (flags & 15);
    c->centre.longitude += (fx_bam_t)(int16_t)fuzz_u16(s) << (flags & 15);
    c->cell_mm = fuzz_u16(s);
    c->is_from_ownship = flags & 16;
    c->look_azimuth = (fx_bam_t)fuzz_u16(s) << 16;
    c->range_m = flags & 32 ? fuzz_u32(s) : 1000u + 4u * fuzz_u16(s);
    c->height_m_q6 = flags & 64 ? (int32_t)fuzz_u32(s) : (int16_t)fuzz_u16(s) * 59;
}

/* Any kind, one that does not exist included, with `value` wherever the kind has a number. */
static struct lm_control any_control(enum lm_control_kind kind, int32_t value)
{
    struct lm_control c = {.kind = kind};
    switch (kind) {
    case LM_CONTROL_STEERPOINT:
        c.steerpoint.is_set = value & 1;
        break;
    case LM_CONTROL_CURSOR:
        c.cursor.latitude = (fx_bam_t)value;
        c.cursor.longitude = (fx_bam_t)value << 3;
        break;
    case LM_CONTROL_FREEZE:
        c.is_frozen = value & 1;
        break;
    case LM_CONTROL_SLEW:
        c.slew.x = value;
        break;
    case LM_CONTROL_SECTOR:
        c.sector.mode = value;
        break;
    case LM_CONTROL_RANGE:
        c.range_nm = value > 0 && value < 10 ? 10 * value : value;
        break;
    case LM_CONTROL_AZIMUTH:
        c.azimuth_index = value;
        break;
    case LM_CONTROL_GAIN:
        c.gain_db = value;
        break;
    case LM_CONTROL_KNOB:
        c.knob = value;
        break;
    case LM_CONTROL_DOWN:
    case LM_CONTROL_UP:
        c.button = value;
        break;
    default:
        break;
    }
    return c;
}

static void step(struct world *w, uint64_t by_us)
{
    if (w->steps++ < w->steps_most) {
        w->now_us += by_us;
        lm_unit_step(&w->unit, w->now_us);
    }
}

/* As it should be, busy, or broken in one way or the other. */
static void set_display(struct memory_board *b, unsigned mode)
{
    b->acquire_status = mode == 1 ? LM_BUSY : mode == 2 ? LM_ERR_IO : LM_OK;
    b->present_status = mode == 3 ? LM_ERR_IO : LM_OK;
}

static void act(struct world *w, struct fuzz_supply *s)
{
    const uint8_t op = fuzz_u8(s);
    switch (op & 15) {
    case 0:
    case 1:
        queue_fix(w, s);
        step(w, 2000);
        break;
    case 2:
        for (uint8_t n = fuzz_u8(s); n > 0; n--) {
            step(w, 4000);
        }
        break;
    case 3:
        step(w, (uint64_t)fuzz_u16(s) << (op >> 4));
        break;
    case 4:
        queue_value(w, lm_bus_canas17.rows[fuzz_u8(s) % lm_bus_canas17.row_count].id, op >> 4 & 3,
                    fuzz_u32(s));
        break;
    case 5:
        queue_any(w, s);
        break;
    case 6:
    case 7:
        w->has_control = true;
        w->control = any_control((enum lm_control_kind)(op >> 4),
                                 op & 1 ? (int32_t)fuzz_u32(s) : fuzz_u8(s) & 3);
        break;
    case 8:
    case 9:
        command_patch(w, s);
        break;
    case 10:
        w->board.flash.busy_polls = fuzz_u8(s);
        w->board.flash.fail_every = fuzz_u8(s);
        break;
    case 11:
        set_display(&w->board, op >> 4 & 3);
        break;
    case 12:
        patch(w, s);
        seal_world(w, op >> 4);
        break;
    case 13:
        queue_weather(w, s, op >> 4 & 1);
        break;
    case 14:
        if (op >> 5 & 1) {
            queue_swap(w, s);
        } else if (op >> 4 & 1) {
            queue_malfunction(w, s);
        } else {
            queue_exercise(w, s);
        }
        break;
    default:
        step(w, 2000);
    }
}

static void check(const struct world *w)
{
    const struct lm_unit *u = &w->unit;
    FUZZ_ASSERT(u->picture.sector.command.range_index < u->map.radar->ranges &&
                u->picture.sector.command.azimuth_index < LM_AZIMUTHS);
    FUZZ_ASSERT(!u->picture.sector.is_begun || u->picture.sector.line < u->picture.sector.lines);
    FUZZ_ASSERT(u->picture.sar.line <= u->picture.sar.lines);
    FUZZ_ASSERT(u->page.gain_db >= -30 && u->page.gain_db <= 30);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        FUZZ_ASSERT(w->board.glass[i] <= 0x00FFFFFF);
    }
}

/* The unit's memory is in arrays of their own, so that writing past their ends is seen. */
static uint32_t glass[SIDE * SIDE];
static uint8_t plane[SIDE * SIDE];
static struct lm_tile tile_pool[POOL_TILES];

static void fly(struct world *w, struct fuzz_supply *s)
{
    const struct memory_board_parts parts = {.ctx = w,
                                             .receive = receive,
                                             .next_control = next_control,
                                             .width_px = SIDE,
                                             .height_px = SIDE,
                                             .glass = glass,
                                             .plane = plane,
                                             .tile_pool = tile_pool,
                                             .tile_pool_bytes = sizeof tile_pool};
    memset(glass, 0, sizeof glass);
    memory_board_open(&w->board, w->image.bytes, w->image.size, &parts);
    w->board.lent.flash_poll_limit = 20;
    w->board.lent.bus_node = NODE;
    w->board.lent.bus_partner = PARTNER;
    w->board.lent.radar = NULL; /* the image's, which may be hostile */
    if (lm_unit_init(&w->unit, &w->board.lent) == LM_OK) {
        while (s->left > 0 && w->steps < w->steps_most) {
            act(w, s);
        }
        step(w, LM_FRAME_US);
        check(w);
    }
}

/* A world as it begins, but for the unit, which clears itself. */
static struct world *new_world(void)
{
    static struct world w;
    const size_t behind = offsetof(struct world, unit) + sizeof w.unit;
    memset(&w, 0, offsetof(struct world, unit));
    memset((uint8_t *)&w + behind, 0, sizeof w - behind);
    return &w;
}

/* A copy of the place's image, until the next one. It ends where its memory does. */
static void copy_image(struct world *w, const struct tiny_image *base)
{
    static uint8_t *copy;
    static size_t room;
    if (room != base->size) {
        free(copy);
        copy = malloc(base->size);
        FUZZ_ASSERT(copy);
        room = base->size;
    }
    w->image = *base;
    w->image.bytes = memcpy(copy, base->bytes, base->size);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_supply supply = {data, size};
    struct world *w = new_world();
    const uint8_t first = fuzz_u8(&supply);
    const double *place = places[first & 3];
    const struct tiny_image *base = base_image(first & 3);
    w->centre = (struct lm_position){(fx_bam_t)(int64_t)(place[0] / 360 * 4294967296.0),
                                     (fx_bam_t)(int64_t)(place[1] / 360 * 4294967296.0)};
    copy_image(w, base);
    w->steps_most = size % 64 == 0 ? STEPS_MAX : STEPS_USUAL;
    if (first >> 5) {
        for (unsigned patches = first >> 5; patches > 0; patches--) {
            patch(w, &supply);
        }
        /* Mostly everything is put right; now and then only the tables, so that records are bad. */
        seal_world(w, first & 16 ? SEAL_HEADER | SEAL_TABLES
                                 : SEAL_HEADER | SEAL_TABLES | SEAL_DIRECTORY | SEAL_RECORDS);
    }
    fly(w, &supply);
    return 0;
}
