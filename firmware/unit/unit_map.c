#include "lm/unit_map.h"

#include <stddef.h>

#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/radar_record.h"
#include "lm/sensor.h"

enum { TILE_READS_A_STEP = 16 };

uint32_t lm_unit_map_image_from(const struct lm_unit_map *m, uint64_t offset)
{
    uint32_t i = 0;
    while (i < m->image_count && m->images[i].base != offset) {
        i++;
    }
    return i;
}

/* Number of the image of a place of the board; image_count: none is there, or it is refused. */
static uint32_t image_of_place(const struct lm_unit_map *m, uint32_t place)
{
    const bool is_open = m->parts[place].bytes != 0 && m->part_status[place] == LM_OK;
    return is_open ? lm_unit_map_image_from(m, m->parts[place].offset) : m->image_count;
}

/* Signatures of an image that have room. */
static uint32_t signatures_held(const struct lm_unit_map *m, const struct lm_db *image)
{
    return fx_min_u32(image->signature_count, LM_SIGNATURES_MAX - m->target_set.signature_count);
}

/* Read the targets of an image, whose signatures are read next: behind those that are there. */
static void read_targets(struct lm_unit_map *m, const struct lm_db *image, uint32_t poll_limit)
{
    const uint32_t before = m->target_set.count, held = signatures_held(m, image);
    for (uint32_t i = 0; i < image->target_count && m->target_set.count < LM_TARGETS_MAX; i++) {
        struct lm_target *const t = &m->targets[m->target_set.count];
        if (lm_target_read(image, i, t, poll_limit) != LM_OK) {
            continue;
        }
        m->target_set.count++;
        if (t->flags & LM_TARGET_HAS_SIGNATURE) {
            t->signature =
                (uint8_t)(t->signature < held ? m->target_set.signature_count + t->signature
                                              : LM_SIGNATURES_MAX);
        }
    }
    m->count.targets_lost += image->target_count - (m->target_set.count - before);
}

/* Read the signatures of an image. Targets name them by number, so each keeps its place, and one
 * that is lost is left empty: its targets return no echo. */
static void read_signatures(struct lm_unit_map *m, const struct lm_db *image, uint32_t poll_limit)
{
    const uint32_t held = signatures_held(m, image);
    m->count.signatures_lost += image->signature_count - held;
    for (uint32_t i = 0; i < held; i++) {
        const uint32_t at = m->target_set.signature_count++;
        m->chip_source[at] = (struct lm_chip_source){image->chips_offset, i};
        if (lm_signature_read(image, i, &m->signatures[at], poll_limit) != LM_OK) {
            memset(&m->signatures[at], 0, sizeof m->signatures[at]);
            m->count.signatures_lost++;
        }
    }
}

/* Read targets and signatures of all images, in the order of the board's places. Nothing else is
 * being read, so this may wait for the flash. */
static void read_all_targets(struct lm_unit_map *m, uint32_t poll_limit)
{
    m->target_set.items = m->targets;
    m->target_set.signatures = m->signatures;
    m->target_set.count = m->target_set.signature_count = 0;
    m->target_set.live_signatures = 0;
    m->count.targets_lost = m->count.signatures_lost = 0;
    for (uint32_t place = 0; place < LM_IMAGES_MAX; place++) {
        const uint32_t i = image_of_place(m, place);
        if (i == m->image_count) {
            continue;
        }
        if (place == m->live_place) {
            m->target_set.live_signature0 = m->target_set.signature_count;
            m->target_set.live_signatures = signatures_held(m, &m->images[i]);
        }
        read_targets(m, &m->images[i], poll_limit);
        read_signatures(m, &m->images[i], poll_limit);
    }
}

/* The flash hangs: no targets can be read, and those of before may be an image's that has gone. */
static void lose_targets(struct lm_unit_map *m)
{
    m->target_set.count = m->target_set.signature_count = m->target_set.live_signatures = 0;
    m->count.targets_lost = m->count.signatures_lost = 0;
    for (uint32_t i = 0; i < m->image_count; i++) {
        m->count.targets_lost += m->images[i].target_count;
        m->count.signatures_lost += m->images[i].signature_count;
    }
}

/* Read the image's radar table. */
static int read_radar(struct lm_unit_map *m, uint32_t poll_limit)
{
    uint8_t record[LM_RADAR_RECORD_BYTES];
    const uint32_t bytes = fx_min_u32(m->db.radar_bytes, sizeof record);
    int status = lm_db_read(m->db.flash, m->db.radar_offset, record, bytes, poll_limit);
    if (status == LM_OK) {
        status = lm_radar_unpack(&m->radar_of_image, record, bytes);
    }
    if (status == LM_OK) {
        m->radar = &m->radar_of_image;
        m->radar_origin = LM_RADAR_OF_IMAGE;
    }
    return status;
}

/* Read the image's bus table. The pool, in which no tile is yet, has room for any record. */
static int read_bus(struct lm_unit_map *m, const struct lm_unit_map_lent *lent)
{
    const uint32_t bytes = m->db.bus_bytes;
    if (bytes == 0 || lent->has_bus_profile) {
        return LM_OK;
    }
    if (bytes > LM_BUS_RECORD_BYTES_MAX || bytes > lent->tile_pool_bytes) {
        return LM_ERR_CORRUPT;
    }
    int status =
        lm_db_read(m->db.flash, m->db.bus_offset, lent->tile_pool, bytes, lent->flash_poll_limit);
    if (status == LM_OK) {
        status = lm_bus_unpack(&m->bus_of_image, lent->tile_pool, bytes);
    }
    m->bus = status == LM_OK ? &m->bus_of_image.profile : NULL;
    return status;
}

/* Open the tables, and see that the radar is the one for this ground. */
static int open_tables(struct lm_unit_map *m, const struct lm_unit_map_lent *lent,
                       const struct lm_flash_part *part)
{
    m->radar = lent->radar ? lent->radar : &lm_radar_default;
    m->radar_origin = lent->radar ? LM_RADAR_OF_BOARD : LM_RADAR_BUILT_IN;
    int status = lm_db_open_part(&m->db, lent->flash, part, lent->flash_poll_limit);
    if (status == LM_OK && !lent->radar && m->db.radar_bytes != 0) {
        status = read_radar(m, lent->flash_poll_limit);
    }
    if (status == LM_OK) {
        status = read_bus(m, lent);
    }
    return status != LM_OK || m->db.sensor == m->radar->sensor ? status : LM_ERR_SENSOR;
}

static bool is_before(const struct lm_db *a, const struct lm_db *b)
{
    return a->shift0 < b->shift0 || (a->shift0 == b->shift0 && a->base < b->base);
}

/* Put the image that was opened last at its place: behind those whose cells are as fine and that
 * lie before it in the flash. */
static void sort_in(struct lm_unit_map *m)
{
    uint32_t at = m->image_count++;
    struct lm_db *image = &m->images[LM_IMAGES_MAX];
    *image = m->images[at];
    for (; at > 0 && is_before(image, &m->images[at - 1]); at--) {
        m->images[at] = m->images[at - 1];
    }
    m->images[at] = *image;
}

/* Open an image beside the first. */
static int open_further(struct lm_unit_map *m, const struct lm_flash_part *part,
                        uint32_t poll_limit)
{
    struct lm_db *image = &m->images[m->image_count];
    int status = lm_db_open_part(image, m->db.flash, part, poll_limit);
    if (status == LM_OK) {
        status = lm_images_judge(&m->db, image);
    }
    if (status == LM_OK) {
        sort_in(m);
    }
    return status;
}

/* Open the images of the parts. The first that can be used brings the tables. */
static void open_parts(struct lm_unit_map *m, const struct lm_unit_map_lent *lent)
{
    for (uint32_t i = 0; i < LM_IMAGES_MAX; i++) {
        const struct lm_flash_part *const part = &m->parts[i];
        m->parts[i] = lent->parts[i];
        if (i > 0 && part->bytes == 0) {
            continue;
        }
        if (LM_IMAGES_MAX > 1 && m->image_count > 0) {
            m->part_status[i] = open_further(m, part, lent->flash_poll_limit);
            continue;
        }
        m->part_status[i] = m->open_status = open_tables(m, lent, part);
        if (m->open_status == LM_OK) {
            m->live_place = i;
            m->images[m->image_count++] = m->db;
        }
    }
    if (LM_IMAGES_MAX > 1 && m->image_count > 0) {
        lm_images_view(&m->db, m->images, m->image_count);
    }
}

static int open_tiles(struct lm_unit_map *m, const struct lm_unit_map_lent *lent)
{
    void *const pool = lent->tile_pool;
    if (LM_IMAGES_MAX == 1 || m->image_count == 1) {
        return lm_tile_cache_init(&m->tiles, &m->db, pool, lent->tile_pool_bytes,
                                  lent->flash_poll_limit);
    }
    return lm_tile_cache_init_over(&m->tiles, &m->db, m->images, m->image_count, pool,
                                   lent->tile_pool_bytes, lent->flash_poll_limit);
}

int lm_unit_map_open(struct lm_unit_map *m, const struct lm_unit_map_lent *lent)
{
    const struct lm_flash_part whole[LM_IMAGES_MAX] = {{0, lent->flash->size_bytes}};
    struct lm_unit_map_lent all = *lent;
    memset(m, 0, sizeof *m);
    m->open_status = LM_ERR_CORRUPT;
    if (!lent->parts || lent->parts[0].bytes == 0) {
        all.parts = whole;
    }
    open_parts(m, &all);
    m->is_usable = m->image_count > 0;
    if (!m->is_usable) {
        return LM_OK;
    }
    lm_chips_init(&m->chips, m->chip_source, m->signatures);
    read_all_targets(m, lent->flash_poll_limit);
    return open_tiles(m, lent);
}

bool lm_unit_map_is_last(const struct lm_unit_map *m, uint64_t offset)
{
    return m->image_count == 1 && m->images[0].base == offset;
}

static void take_out(struct lm_unit_map *m, uint64_t offset)
{
    uint32_t i = lm_unit_map_image_from(m, offset);
    if (i < m->image_count) {
        m->image_count--;
    }
    for (; i < m->image_count; i++) {
        m->images[i] = m->images[i + 1];
    }
}

/* No image answers, and what is being read of them ends. False if it does not. */
static bool drain(struct lm_unit_map *m, uint32_t poll_limit)
{
    lm_tile_cache_mount(&m->tiles, m->images, 0);
    for (uint32_t i = 0; i < poll_limit && !lm_tile_cache_is_drained(&m->tiles); i++) {
        lm_tile_cache_service(&m->tiles, m->tiles.now_us, 1);
    }
    return lm_tile_cache_is_drained(&m->tiles);
}

/* The image of the first place leads: what all have in common is read from its tables. The radar
 * is that of the start; who has a table of its own has that one. */
static void lead(struct lm_unit_map *m)
{
    const uint32_t radar_bytes = m->db.radar_bytes, radar_crc = m->db.radar_crc;
    uint32_t place = 0;
    while (place + 1 < LM_IMAGES_MAX && image_of_place(m, place) == m->image_count) {
        place++;
    }
    m->db = m->images[image_of_place(m, place)];
    m->db.radar_bytes = radar_bytes;
    m->db.radar_crc = radar_crc;
    lm_images_view(&m->db, m->images, m->image_count);
}

int lm_unit_map_mount(struct lm_unit_map *m, uint32_t place, const struct lm_flash_part *part,
                      uint32_t poll_limit)
{
    if (!m->is_usable || LM_IMAGES_MAX == 1 || place >= LM_IMAGES_MAX ||
        lm_unit_map_is_last(m, part->offset)) {
        return LM_ERR_RANGE;
    }
    const bool is_drained = drain(m, poll_limit);
    take_out(m, part->offset);
    m->parts[place] = *part;
    m->part_status[place] = part->bytes == 0 ? LM_OK
                            : is_drained     ? open_further(m, part, poll_limit)
                                             : LM_ERR_IO;
    lead(m);
    lm_chips_empty(&m->chips);
    if (is_drained) {
        read_all_targets(m, poll_limit);
    } else {
        lose_targets(m);
    }
    m->geoid = (struct lm_geoid_reader){.corrupt = m->geoid.corrupt};
    lm_tile_cache_mount(&m->tiles, m->images, m->image_count);
    return LM_OK;
}

uint32_t lm_unit_map_refused(const struct lm_unit_map *m)
{
    uint32_t refused = 0;
    for (uint32_t i = 0; i < LM_IMAGES_MAX && m->is_usable; i++) {
        refused += m->part_status[i] != LM_OK;
    }
    return refused;
}

void lm_unit_map_look(struct lm_unit_map *m, struct lm_position place, uint32_t reach_m)
{
    if (LM_IMAGES_MAX > 1 && m->image_count > 1) {
        lm_images_look(&m->db, m->images, m->image_count, place, reach_m);
    }
}

static const struct lm_db *image_at(const struct lm_unit_map *m, struct lm_position place)
{
    return &m->images[LM_IMAGES_MAX > 1 ? lm_images_at(m->images, m->image_count, place) : 0];
}

int32_t lm_unit_map_geoid_m_q6(const struct lm_unit_map *m, struct lm_position place)
{
    return lm_geoid_reader_height_m_q6(&m->geoid, image_at(m, place), place);
}

struct lm_text lm_unit_map_refusal(const struct lm_unit_map *m)
{
    struct lm_text t = {0};
    if (m->open_status == LM_ERR_VERSION) {
        lm_text_add(&t, "OTHER VERSION");
    } else if (m->open_status == LM_ERR_SENSOR) {
        lm_text_add(&t, "IMAGE ");
        lm_text_add(&t, lm_sensor_word(m->db.sensor));
        lm_text_add(&t, "  RADAR ");
        lm_text_add(&t, lm_sensor_word(m->radar->sensor));
    }
    return t;
}

void lm_unit_map_service(struct lm_unit_map *m, const struct lm_position *aircraft, uint64_t now_us)
{
    if (m->is_usable) {
        if (aircraft) {
            lm_tile_cache_keep_around(&m->tiles, *aircraft);
            lm_geoid_reader_service(&m->geoid, &m->tiles, image_at(m, *aircraft), *aircraft);
        }
        lm_chips_service(&m->chips, &m->tiles);
        lm_tile_cache_service(&m->tiles, now_us, TILE_READS_A_STEP);
    }
}

uint32_t lm_unit_map_corrupt_records(const struct lm_unit_map *m)
{
    return m->tiles.count.corrupt + m->chips.count.corrupt + m->geoid.corrupt;
}
