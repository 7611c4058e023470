/* Needs no C library: a board without an operating system records with it too (bsp/zcu102). */
#include "record.h"

#include "fx/crc32c.h"
#include "fx/mem.h"

/* ---- text ---- */

enum { LOWER_CASE = 'a' - 'A' };

static char *add_text(char *to, const char *text)
{
    while (*text != '\0') {
        *to++ = *text++;
    }
    return to;
}

static char *add_decimal(char *to, uint64_t value, uint32_t least_digits)
{
    char digits[20]; /* of 2^64 */
    uint32_t count = 0;
    do {
        digits[count++] = (char)('0' + value % 10);
        value /= 10;
    } while (value != 0 || count < least_digits);
    while (count > 0) {
        *to++ = digits[--count];
    }
    return to;
}

static char *add_hex(char *to, uint32_t value, uint32_t digits, uint32_t letters)
{
    while (digits > 0) {
        const uint32_t digit = value >> 4 * --digits & 15;
        *to++ = (char)(digit < 10 ? '0' + digit : 'A' - 10 + letters + digit);
    }
    return to;
}

/* ---- lines ---- */

/* A line is shorter than RECORD_LINE_MAX: 20 digits of seconds and 17 of a frame's data are the
 * longest. */
static void put_line(struct recorder *r, uint64_t time_us, const char *interface,
                     const struct lm_can_frame *f)
{
    char line[RECORD_LINE_MAX];
    const uint64_t us = r->zero_us + time_us;
    char *to = add_decimal(add_text(line, "("), us / 1000000, 1);
    to = add_decimal(add_text(to, "."), us % 1000000, 6);
    to = add_text(add_text(add_text(to, ") "), interface), " ");
    to = add_hex(to, f->id | (f->is_error ? 0x20000000u : 0), f->is_extended || f->is_error ? 8 : 3,
                 0);
    *to++ = '#';
    if (f->is_remote) {
        to = add_decimal(add_text(to, "R"), f->length, 1);
    }
    for (uint32_t i = 0; i < f->length && !f->is_remote; i++) {
        to = add_hex(to, f->data[i], 2, 0);
    }
    *to++ = '\n';
    r->lines.count++;
    r->lines.crc = fx_crc32c(r->lines.crc, line, (size_t)(to - line));
    r->sink.put(r->sink.ctx, line, (size_t)(to - line));
}

static void put_own(struct recorder *r, uint64_t time_us, uint32_t kind, const uint8_t *data,
                    uint32_t count)
{
    struct lm_can_frame f = {.id = RECORD_ID + kind, .is_extended = true, .length = (uint8_t)count};
    memcpy(f.data, data, count);
    put_line(r, time_us, RECORD_OWN, &f);
}

static void put_word(struct recorder *r, uint32_t kind, uint8_t first, uint32_t word)
{
    const uint8_t data[5] = {first, (uint8_t)word, (uint8_t)(word >> 8), (uint8_t)(word >> 16),
                             (uint8_t)(word >> 24)};
    put_own(r, r->now_us, kind, data, sizeof data);
}

/* The steps that are not written yet. The line has the time of the step before them: frames that
 * came since then stand below it. */
static void put_ticks(struct recorder *r)
{
    if (r->ticks.count > 0) {
        put_own(r, r->ticks.base_us, RECORD_STEPS, r->ticks.bytes, r->ticks.count);
        r->ticks.count = 0;
        if (r->options.has_sums && r->lines.count >= RECORD_SUM_LINES) {
            put_word(r, RECORD_SUM, 0, r->lines.crc);
            r->lines.count = r->lines.crc = 0; /* the sum is not in the next one */
        }
    }
}

/* Reads that ended well, and polls that found one under way. One of the two is zero. */
static void put_reads(struct recorder *r)
{
    if (r->read.waits > 0) {
        put_word(r, RECORD_WAITS, 0, r->read.waits);
        r->read.waits = 0;
    }
    if (r->read.count > 0) {
        put_word(r, RECORD_READS, (uint8_t)r->read.count, r->read.crc);
        r->read.count = r->read.crc = 0;
    }
}

/* Before any event: what came before it. */
static void put_pending(struct recorder *r)
{
    put_ticks(r);
    put_reads(r);
}

static void put_blob(struct recorder *r, uint32_t kind, const uint8_t *bytes, uint32_t count)
{
    uint8_t whole[RECORD_BLOB_MAX + 1];
    put_pending(r);
    whole[0] = (uint8_t)count;
    if (count > 0) {
        memcpy(whole + 1, bytes, count);
    }
    for (uint32_t at = 0; at <= count; at += 8) {
        const uint32_t left = count + 1 - at;
        put_own(r, r->now_us, kind, whole + at, left < 8 ? left : 8);
    }
}

static void put_event(struct recorder *r, uint32_t kind, int status, uint32_t word)
{
    put_pending(r);
    put_word(r, kind, (uint8_t)status, word);
}

/* ---- flash ---- */

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct recorder *r = ctx;
    const int status = r->flash->read_start(r->flash->ctx, offset, destination, length);
    if (status == LM_OK) {
        r->read.destination = destination;
        r->read.length = length;
    } else {
        put_event(r, RECORD_READ_REFUSED, status, 0);
    }
    return status;
}

static int read_poll(void *ctx)
{
    struct recorder *r = ctx;
    const int status = r->flash->read_poll(r->flash->ctx);
    if (status == LM_BUSY) {
        if (r->steps == 0) {
            if (r->read.count > 0) {
                put_reads(r);
            }
            r->read.waits++;
        }
        return status;
    }
    if (r->read.waits > 0 || r->read.count == UINT8_MAX) {
        put_reads(r);
    }
    if (status == LM_OK) {
        put_ticks(r);
        r->read.count++;
        r->read.crc = fx_crc32c(r->read.crc, r->read.destination, r->read.length);
    } else {
        put_event(r, RECORD_READ_FAILED, status, 0);
    }
    return status;
}

/* ---- bus ---- */

/* From interface 0 or 1. */
static int hear(struct recorder *r, uint32_t interface, struct lm_can_frame *frame)
{
    const struct lm_can *can = interface == 0 ? r->can : r->can_2;
    const int status = can->receive(can->ctx, frame);
    if (status == 1) {
        put_pending(r);
        put_line(r, frame->time_us, interface == 0 ? RECORD_HEARD : RECORD_HEARD_2, frame);
    } else if (status < 0) {
        put_event(r, RECORD_BUS_DOWN, status, interface);
    }
    return status;
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    return hear(ctx, 0, frame);
}

static int receive_2(void *ctx, struct lm_can_frame *frame)
{
    return hear(ctx, 1, frame);
}

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct recorder *r = ctx;
    const int status = r->can->send(r->can->ctx, frame);
    if (status == LM_OK) {
        put_pending(r);
        put_line(r, r->now_us, RECORD_SENT, frame);
    } else {
        put_event(r, RECORD_UNSENT, status, 0);
    }
    return status;
}

/* ---- controls ---- */

static int next_control(void *ctx, struct lm_control *control)
{
    struct recorder *r = ctx;
    const int status = r->controls->next(r->controls->ctx, control);
    if (status == 1) {
        uint8_t bytes[RECORD_BLOB_MAX];
        put_blob(r, RECORD_CONTROL, bytes, record_control_bytes(control, bytes));
    }
    return status;
}

static void tell_refusal(void *ctx, enum lm_refusal reason)
{
    const struct recorder *r = ctx;
    if (r->controls->refused) {
        r->controls->refused(r->controls->ctx, reason);
    }
}

/* ---- display ---- */

static int acquire(void *ctx, struct lm_surface *surface)
{
    struct recorder *r = ctx;
    const int status = r->display->acquire(r->display->ctx, surface);
    const uint8_t age = status == LM_OK ? surface->age : r->age;
    if (status != r->acquire_status || age != r->age) {
        put_event(r, RECORD_ACQUIRE, status, age);
        r->acquire_status = status;
        r->age = age;
    }
    if (status == LM_OK) {
        r->surface = *surface;
    }
    return status;
}

static void put_check(struct recorder *r, uint32_t number)
{
    if (r->options.is_check_of_one_row) {
        const uint32_t row = number * RECORD_ROW_STEP % r->surface.height_px;
        const uint32_t crc = record_row_crc(0, &r->surface, row);
        const uint8_t data[6] = {(uint8_t)row,        (uint8_t)(row >> 8),  (uint8_t)crc,
                                 (uint8_t)(crc >> 8), (uint8_t)(crc >> 16), (uint8_t)(crc >> 24)};
        put_pending(r);
        put_own(r, r->now_us, RECORD_ROW, data, sizeof data);
    } else {
        put_event(r, RECORD_CHECK, (int)(number % RECORD_CHECK_ROWS),
                  record_rows_crc(&r->surface, number));
    }
}

static int present(void *ctx, const struct lm_damage *changed)
{
    struct recorder *r = ctx;
    r->pictures++;
    if (r->options.check_every != 0 && r->pictures % r->options.check_every == 0) {
        put_check(r, r->pictures / r->options.check_every);
    }
    const int status = r->display->present(r->display->ctx, changed);
    if (status != r->present_status) {
        put_event(r, RECORD_PRESENT, status, 0);
        r->present_status = status;
    }
    return status;
}

/* ---- begin, steps, end ---- */

static char *add_word(char *to, const char *text)
{
    return add_text(add_text(to, text), " ");
}

static char *add_number(char *to, uint64_t value)
{
    return add_text(add_decimal(to, value, 1), " ");
}

static char *add_crc(char *to, uint32_t crc)
{
    return add_text(add_hex(to, crc, 8, LOWER_CASE), " ");
}

/* The longest words of every member, and a blank behind each. */
enum { HEAD_TEXT_MAX = sizeof(struct record_head) + 16 * 10 };

/* The head as a text of words: how many bytes. */
static uint32_t write_head(const struct record_head *h, char text[HEAD_TEXT_MAX])
{
    char *to = add_word(add_number(text, RECORD_VERSION), h->version);
    to = add_number(add_number(to, h->zero_us), h->image_bytes);
    to = add_word(add_crc(to, h->image_crc), h->profile);
    to = add_crc(add_crc(to, h->profile_crc), h->radar_crc);
    const uint32_t numbers[] = {h->width_px,      h->height_px,         h->tile_slots,
                                h->glass_step_px, h->noise_seed,        h->flash_poll_limit,
                                h->node,          h->hardware_revision, h->switches};
    for (uint32_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        to = add_number(to, numbers[i]);
    }
    to = add_text(add_word(to, h->restart), h->build);
    return (uint32_t)(to - text);
}

static void wrap(struct recorder *r, struct lm_board *board)
{
    r->flash = board->flash;
    r->can = board->can;
    r->can_2 = board->can_2;
    r->controls = board->controls;
    r->display = board->display;
    r->flash_of_unit = (struct lm_flash){.ctx = r,
                                         .size_bytes = r->flash->size_bytes,
                                         .read_start = read_start,
                                         .read_poll = read_poll};
    r->can_of_unit = (struct lm_can){.ctx = r, .receive = receive};
    r->can_2_of_unit = (struct lm_can){.ctx = r, .receive = receive_2};
    r->controls_of_unit =
        (struct lm_controls){.ctx = r, .next = next_control, .refused = tell_refusal};
    r->display_of_unit = (struct lm_display){.ctx = r,
                                             .width_px = r->display->width_px,
                                             .height_px = r->display->height_px,
                                             .acquire = acquire,
                                             .present = present};
    board->flash = &r->flash_of_unit;
    board->can = &r->can_of_unit;
    board->can_2 = r->can_2 ? &r->can_2_of_unit : NULL;
    board->controls = &r->controls_of_unit;
    board->display = &r->display_of_unit;
}

/* The images beside the first, if there are any. */
static void put_images(struct recorder *r, const struct record_head *head)
{
    uint8_t bytes[RECORD_FURTHER * RECORD_IMAGE_BYTES];
    uint64_t all = 0;
    for (uint32_t i = 0; i < sizeof bytes; i++) {
        const struct record_image *image = &head->further[i / RECORD_IMAGE_BYTES];
        const uint32_t at = i % RECORD_IMAGE_BYTES;
        bytes[i] = (uint8_t)(at < 8 ? image->bytes >> 8 * at : image->crc >> 8 * (at - 8));
        all |= image->bytes;
    }
    if (all != 0) {
        put_blob(r, RECORD_IMAGES, bytes, sizeof bytes);
    }
}

void record_begin_as(struct recorder *r, const struct record_sink *sink, struct lm_board *board,
                     const struct record_head *head, const struct record_options *options)
{
    char text[HEAD_TEXT_MAX];
    memset(r, 0, sizeof *r);
    r->sink = *sink;
    r->zero_us = head->zero_us;
    r->options = *options;
    wrap(r, board);
    const uint32_t length = write_head(head, text);
    put_blob(r, RECORD_HEAD, (const uint8_t *)text,
             length < RECORD_BLOB_MAX ? length : RECORD_BLOB_MAX);
    if (board->settings) {
        put_blob(r, RECORD_SETTINGS, (const uint8_t *)board->settings, sizeof *board->settings);
    }
    if (head->has_nodes) {
        put_blob(r, RECORD_NODES, head->nodes, sizeof head->nodes);
    }
    put_images(r, head);
}

void record_begin(struct recorder *r, const struct record_sink *sink, struct lm_board *board,
                  uint64_t zero_us, uint32_t check_every)
{
    struct record_head head;
    record_describe(&head, board, zero_us);
    record_begin_as(r, sink, board, &head, &(struct record_options){.check_every = check_every});
}

/* A step's time is the pause since the one before, less the usual one, folded to a small number:
 * 0, -1, 1, -2, ... are 0, 1, 2, 3, in groups of seven bits, the lowest first. */
void record_step(struct recorder *r, uint64_t now_us)
{
    uint8_t bytes[10];
    uint8_t count = 0;
    const uint64_t late = now_us - r->now_us - RECORD_TICK_US; /* below 2^63 either way */
    uint64_t folded = late >> 63 ? ~(late << 1) : late << 1;
    put_reads(r);
    do {
        bytes[count++] = (uint8_t)((folded & 0x7f) | (folded > 0x7f ? 0x80 : 0));
        folded >>= 7;
    } while (folded != 0 && count < 8);
    if (r->ticks.count + count > 8) {
        put_ticks(r);
    }
    if (r->ticks.count == 0) {
        r->ticks.base_us = r->now_us;
    }
    memcpy(r->ticks.bytes + r->ticks.count, bytes, count);
    r->ticks.count = (uint8_t)(r->ticks.count + count);
    r->now_us = now_us;
    r->steps++;
    if ((r->can->send != NULL) != (r->can_of_unit.send != NULL)) {
        r->can_of_unit.send = r->can->send ? send_frame : NULL;
        put_event(r, RECORD_VOICE, r->can->send != NULL, 0);
    }
}

void record_flush(struct recorder *r)
{
    put_pending(r);
}

void record_part(struct recorder *r, uint32_t number)
{
    put_event(r, RECORD_PART, 0, number);
}

void record_restart(struct recorder *r, const char *restart)
{
    uint32_t length = 0;
    while (restart && restart[length] != '\0') {
        length++;
    }
    put_blob(r, RECORD_RESTART, (const uint8_t *)restart,
             (uint32_t)(length < RECORD_BLOB_MAX ? length : RECORD_BLOB_MAX));
}

void record_cease(struct recorder *r, enum record_reason reason, uint32_t lines_lost)
{
    if (lines_lost > 0) { /* what is pending came after them */
        r->ticks.count = 0;
        r->read.count = r->read.crc = r->read.waits = 0;
    }
    put_event(r, RECORD_CEASED, (int)reason, lines_lost);
}

const char *record_reason_words(uint32_t reason)
{
    static const char *const words[RECORD_REASONS] = {
        [RECORD_FULL] = "it is as long as it may be",
        [RECORD_BEHIND] = "lines came faster than they could be written",
        [RECORD_BROKEN] = "it could not be written"};
    return reason < RECORD_REASONS && words[reason] ? words[reason] : "for a reason of its own";
}

void record_end(struct recorder *r)
{
    put_event(r, RECORD_END, 0, (uint32_t)r->steps);
}
