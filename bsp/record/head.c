/* The head of a recording: what must be the same when it is shown again. Needs no C library. */
#include "record.h"

#include <stddef.h>

#include "fx/crc32c.h"
#include "fx/mem.h"
#include "fx/sat.h"
#include "lm/image.h"
#include "lm/radar_record.h"
#include "lm/version.h"

enum { HEAD_BYTES = 4096 };

/* Without the header's own checksum: bytes that end in theirs leave the same remainder, whatever
 * they are. */
static uint32_t crc_of_head(const uint8_t *bytes, uint32_t length)
{
    const uint32_t before = fx_min_u32(length, offsetof(struct lm_image_header, crc));
    const uint32_t after = fx_min_u32(length, LM_DB_HEADER_BYTES);
    return fx_crc32c(fx_crc32c(0, bytes, before), bytes + after, length - after);
}

uint32_t record_image_crc(const struct lm_flash *flash, const struct lm_flash_part *part,
                          uint32_t polls)
{
    static uint8_t bytes[HEAD_BYTES];
    const uint32_t length = part->bytes < HEAD_BYTES ? (uint32_t)part->bytes : HEAD_BYTES;
    if (length == 0 || flash->read_start(flash->ctx, part->offset, bytes, length) != LM_OK) {
        return 0;
    }
    for (uint32_t i = 0; i < polls; i++) {
        const int status = flash->read_poll(flash->ctx);
        if (status != LM_BUSY) {
            return status == LM_OK ? crc_of_head(bytes, length) : 0;
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
                         b->options.has_borders,     b->bus_profile != NULL, b->can_2 != NULL,
                         b->is_database_unsigned};
    uint32_t word = 0;
    for (uint32_t i = 0; i < sizeof bits / sizeof *bits; i++) {
        word |= (uint32_t)bits[i] << i;
    }
    return word | (uint32_t)b->bus_partner << RECORD_PARTNER_BIT;
}

/* The images beside the first. */
static void describe_further(struct record_head *head, const struct lm_board *board)
{
    for (uint32_t i = 1; i <= RECORD_FURTHER && i < LM_IMAGES_MAX; i++) {
        const struct lm_flash_part *part = &board->images[i];
        if (board->images[0].bytes != 0 && part->bytes != 0) {
            head->further[i - 1] = (struct record_image){
                part->bytes, record_image_crc(board->flash, part, board->flash_poll_limit)};
        }
    }
}

void record_describe_plain(struct record_head *head, const struct lm_board *board, uint64_t zero_us)
{
    const struct lm_flash_part whole = {0, board->flash->size_bytes};
    const struct lm_flash_part *first = board->images[0].bytes != 0 ? board->images : &whole;
    *head = (struct record_head){
        .zero_us = zero_us,
        .image_bytes = first->bytes,
        .image_crc = record_image_crc(board->flash, first, board->flash_poll_limit),
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
    describe_further(head, board);
    head->has_nodes = board->bus_nodes != NULL;
    if (head->has_nodes) {
        memcpy(head->nodes, board->bus_nodes, sizeof head->nodes);
    }
}

void record_describe(struct record_head *head, const struct lm_board *board, uint64_t zero_us)
{
    record_describe_plain(head, board, zero_us);
    head->profile_crc = crc_of_tables(board);
    head->radar_crc = crc_of_radar(board->radar);
}

/* ---- the text ---- */

enum { WORDS = 19 };

/* Words that are read one after the other. */
struct words {
    const char *at;
    uint32_t count; /* read so far and sound */
};

/* The next word of at most `most` characters, which *text moves to. 0: there is none, or it is too
 * long. */
static size_t next_word(struct words *w, const char **text, size_t most)
{
    while (*w->at == ' ') {
        w->at++;
    }
    *text = w->at;
    size_t length = 0;
    while (w->at[length] != '\0' && w->at[length] != ' ') {
        length++;
    }
    w->at += length;
    return length <= most ? length : 0;
}

static int digit_of(char c)
{
    return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : 16;
}

/* A number of at most so many digits; 19 decimal and 8 hexadecimal digits fit. */
static uint64_t number_word(struct words *w, uint32_t base, size_t digits)
{
    const char *text;
    const size_t length = next_word(w, &text, digits);
    uint64_t value = 0;
    for (size_t i = 0; i < length; i++) {
        const uint32_t digit = (uint32_t)digit_of(text[i]);
        if (digit >= base) {
            return 0;
        }
        value = value * base + digit;
    }
    w->count += length > 0;
    return value;
}

/* A number below 2^32: its largest value has as many digits as are allowed, 9 or 10. */
static uint32_t small_word(struct words *w, size_t digits)
{
    const uint64_t value = number_word(w, 10, digits);
    w->count -= value > UINT32_MAX;
    return value > UINT32_MAX ? 0 : (uint32_t)value;
}

static void text_word(struct words *w, char *to, size_t room)
{
    const char *text;
    const size_t length = next_word(w, &text, room - 1);
    memcpy(to, text, length);
    to[length] = '\0';
    w->count += length > 0;
}

static bool is_sound(const struct record_head *h)
{
    return h->width_px >= 256 && h->width_px <= 1024 && h->height_px >= 256 &&
           h->height_px <= 1024 && h->tile_slots <= LM_TILE_SLOTS_MAX && h->node <= 255 &&
           h->hardware_revision <= 255;
}

bool record_head_read(struct record_head *h, const char *text)
{
    struct words w = {.at = text};
    memset(h, 0, sizeof *h);
    const uint32_t version = small_word(&w, 9);
    text_word(&w, h->version, sizeof h->version);
    h->zero_us = number_word(&w, 10, 19);
    h->image_bytes = number_word(&w, 10, 19);
    h->image_crc = (uint32_t)number_word(&w, 16, 8);
    text_word(&w, h->profile, sizeof h->profile);
    h->profile_crc = (uint32_t)number_word(&w, 16, 8);
    h->radar_crc = (uint32_t)number_word(&w, 16, 8);
    h->width_px = small_word(&w, 9);
    h->height_px = small_word(&w, 9);
    h->tile_slots = small_word(&w, 9);
    h->glass_step_px = small_word(&w, 10);
    h->noise_seed = small_word(&w, 10);
    h->flash_poll_limit = small_word(&w, 10);
    h->node = small_word(&w, 9);
    h->hardware_revision = small_word(&w, 9);
    h->switches = small_word(&w, 9);
    text_word(&w, h->restart, sizeof h->restart);
    text_word(&w, h->build, sizeof h->build);
    for (char *c = h->restart; *c != '\0'; c++) {
        if (*c == '_') {
            *c = ' '; /* a cause is words of capitals */
        }
    }
    return w.count == WORDS && version == RECORD_VERSION && is_sound(h);
}
