/* The head of a recording: what must be the same when it is shown again. */
#include "record.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "fx/crc32c.h"
#include "lm/radar_record.h"
#include "lm/version.h"

enum { HEAD_BYTES = 4096 };

static uint32_t crc_of_flash(const struct lm_flash *flash, uint32_t polls)
{
    static uint8_t bytes[HEAD_BYTES];
    const uint32_t length =
        flash->size_bytes < HEAD_BYTES ? (uint32_t)flash->size_bytes : HEAD_BYTES;
    if (length == 0 || flash->read_start(flash->ctx, 0, bytes, length) != LM_OK) {
        return 0;
    }
    for (uint32_t i = 0; i < polls; i++) {
        const int status = flash->read_poll(flash->ctx);
        if (status != LM_BUSY) {
            return status == LM_OK ? fx_crc32c(0, bytes, length) : 0;
        }
    }
    return 0;
}

static uint32_t add(uint32_t crc, uint64_t number)
{
    uint8_t bytes[8];
    for (uint32_t i = 0; i < sizeof bytes; i++) {
        bytes[i] = (uint8_t)(number >> 8 * i);
    }
    return fx_crc32c(crc, bytes, sizeof bytes);
}

static uint32_t add_packing(uint32_t crc, const struct lm_bus_packing *p)
{
    const uint64_t numbers[] = {
        p->mask,        p->bits.first,  p->bits.count,    p->match.first,
        p->match.count, p->match_value, p->type,          p->is_little_endian,
        p->has_none,    p->is_fast,     p->none,          (uint64_t)p->multiplier,
        p->shift,       p->frac_bits,   (uint64_t)p->bias};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        crc = add(crc, numbers[i]);
    }
    return crc;
}

static uint32_t crc_of_profile(const struct lm_bus_profile *profile)
{
    uint32_t crc = add(0, profile->framing);
    crc = add(crc, profile->are_types_assumed);
    crc = add(crc, profile->channel_mask);
    crc = add(crc, profile->invalid_mask);
    for (uint32_t i = 0; i < profile->row_count; i++) {
        const struct lm_bus_row *row = &profile->rows[i];
        const uint64_t numbers[] = {row->id,
                                    row->field,
                                    row->priority,
                                    row->stale_ms,
                                    row->dead_ms,
                                    row->period_us,
                                    (uint64_t)row->low,
                                    (uint64_t)row->high,
                                    row->types,
                                    (uint64_t)row->per_unit};
        for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
            crc = add(crc, numbers[k]);
        }
        if (profile->framing == LM_BUS_PACKED) {
            crc = add_packing(crc, &row->packing);
        }
    }
    return crc;
}

/* All tables of the board, in their order. */
static uint32_t crc_of_tables(const struct lm_board *board)
{
    uint32_t crc = board->bus_profile ? crc_of_profile(board->bus_profile) : 0;
    for (uint32_t i = 0; i < LM_BUS_TABLES_MORE; i++) {
        if (board->tables[i].profile) {
            crc = add(crc, crc_of_profile(board->tables[i].profile));
            crc = add(crc, board->tables[i].interface);
        }
    }
    return crc;
}

static uint32_t crc_of_radar(const struct lm_radar *radar)
{
    static uint8_t record[LM_RADAR_RECORD_BYTES];
    if (!radar) {
        return 0;
    }
    lm_radar_pack(radar, record);
    return fx_crc32c(0, record, sizeof record);
}

/* One word: what is no letter, digit, point or dash becomes an underscore. */
static void copy_word(char *to, size_t room, const char *from)
{
    size_t i = 0;
    for (; from && from[i] != '\0' && i + 1 < room; i++) {
        const char c = from[i];
        const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                              (c >= '0' && c <= '9') || c == '.' || c == '-';
        to[i] = c;
        if (!is_plain) {
            to[i] = '_';
        }
    }
    if (i == 0) {
        to[i++] = '-';
    }
    to[i] = '\0';
}

static uint32_t switches_of(const struct lm_board *b)
{
    const bool bits[] = {b->is_heading_magnetic,     b->tells_reports,       b->obeys_controls,
                         b->options.is_sector_whole, b->options.has_heading, b->options.has_strobe,
                         b->options.has_borders,     b->bus_profile != NULL, b->can_2 != NULL};
    uint32_t word = 0;
    for (uint32_t i = 0; i < sizeof bits / sizeof *bits; i++) {
        word |= (uint32_t)bits[i] << i;
    }
    return word;
}

void record_describe(struct record_head *head, const struct lm_board *board, uint64_t zero_us)
{
    *head = (struct record_head){
        .zero_us = zero_us,
        .image_bytes = board->flash->size_bytes,
        .image_crc = crc_of_flash(board->flash, board->flash_poll_limit),
        .profile_crc = crc_of_tables(board),
        .radar_crc = crc_of_radar(board->radar),
        .width_px = board->display->width_px,
        .height_px = board->display->height_px,
        .tile_slots = (uint32_t)(board->tile_pool_bytes / sizeof(struct lm_tile)),
        .glass_step_px = board->glass_step_px,
        .noise_seed = board->noise_seed,
        .flash_poll_limit = board->flash_poll_limit,
        .node = board->bus_node,
        .hardware_revision = board->hardware_revision,
        .switches = switches_of(board),
    };
    copy_word(head->version, sizeof head->version, LM_VERSION);
    copy_word(head->profile, sizeof head->profile,
              board->bus_profile ? board->bus_profile->name : NULL);
    copy_word(head->restart, sizeof head->restart, board->restart);
    copy_word(head->build, sizeof head->build, record_build);
    head->has_nodes = board->bus_nodes != NULL;
    if (head->has_nodes) {
        memcpy(head->nodes, board->bus_nodes, sizeof head->nodes);
    }
}

size_t record_head_write(const struct record_head *h, char *text, size_t room)
{
    const int length =
        snprintf(text, room,
                 "%d %s %" PRIu64 " %" PRIu64 " %08" PRIx32 " %s %08" PRIx32 " %08" PRIx32
                 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32
                 " %" PRIu32 " %" PRIu32 " %s %s",
                 RECORD_VERSION, h->version, h->zero_us, h->image_bytes, h->image_crc, h->profile,
                 h->profile_crc, h->radar_crc, h->width_px, h->height_px, h->tile_slots,
                 h->glass_step_px, h->noise_seed, h->flash_poll_limit, h->node,
                 h->hardware_revision, h->switches, h->restart, h->build);
    return length < 0 || (size_t)length >= room ? 0 : (size_t)length;
}

bool record_head_read(struct record_head *h, const char *text)
{
    int version;
    memset(h, 0, sizeof *h);
    const int got =
        sscanf(text,
               "%9d %15s %19" SCNu64 " %19" SCNu64 " %8" SCNx32 " %31s %8" SCNx32 " %8" SCNx32
               " %9" SCNu32 " %9" SCNu32 " %9" SCNu32 " %9" SCNu32 " %10" SCNu32 " %9" SCNu32
               " %9" SCNu32 " %9" SCNu32 " %9" SCNu32 " %23s %15s",
               &version, h->version, &h->zero_us, &h->image_bytes, &h->image_crc, h->profile,
               &h->profile_crc, &h->radar_crc, &h->width_px, &h->height_px, &h->tile_slots,
               &h->glass_step_px, &h->noise_seed, &h->flash_poll_limit, &h->node,
               &h->hardware_revision, &h->switches, h->restart, h->build);
    for (char *c = h->restart; *c != '\0'; c++) {
        if (*c == '_') {
            *c = ' '; /* a cause is words of capitals */
        }
    }
    return got == 19 && version == RECORD_VERSION && h->width_px >= 256 && h->width_px <= 1024 &&
           h->height_px >= 256 && h->height_px <= 1024 && h->tile_slots <= LM_TILE_SLOTS_MAX &&
           h->node <= 255 && h->hardware_revision <= 255;
}
