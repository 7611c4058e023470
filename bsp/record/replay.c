/* Needs no C library: a browser replays with it too (bsp/web). */
#include "replay.h"

#include "drv/can_line.h"
#include "fx/crc32c.h"
#include "fx/mem.h"

/* ---- errors ---- */

static void add_text(struct replay *p, const char *text)
{
    size_t at = 0;
    while (p->error[at] != '\0') {
        at++;
    }
    for (; *text != '\0' && at + 1 < sizeof p->error; at++) {
        p->error[at] = *text++;
    }
    p->error[at] = '\0';
}

static void add_number(struct replay *p, uint64_t value)
{
    char digits[21];
    size_t at = sizeof digits - 1;
    digits[at] = '\0';
    do {
        digits[--at] = (char)('0' + value % 10);
        value /= 10;
    } while (value != 0);
    add_text(p, digits + at);
}

/* The recording is over. True if no cause was told before: the first one stays. */
static bool ends(struct replay *p)
{
    p->next.kind = REPLAY_OVER;
    return p->error[0] == '\0';
}

/* What is wrong with the line read last. */
static void stop(struct replay *p, const char *cause)
{
    if (ends(p)) {
        add_text(p, p->path);
        add_text(p, " line ");
        add_number(p, p->line);
        add_text(p, ": ");
        add_text(p, cause);
    }
}

/* The last step of a recording that was torn off may lack what it had. */
static void depart(struct replay *p)
{
    if (p->next.kind == REPLAY_OVER && !p->has_ended) {
        return;
    }
    if (p->count.departures++ == 0) {
        p->departed_us = p->now_us;
    }
}

/* ---- lines ---- */

static bool is_same(const char *a, const char *b)
{
    while (*a != '\0' && *a == *b) {
        a++;
        b++;
    }
    return *a == *b;
}

static bool is_interface(const char *line, const char *name)
{
    const char *c = line;
    while (*c != '\0' && *c != ' ') {
        c++;
    }
    for (c += *c == ' '; *name != '\0' && *c == *name; c++) {
        name++;
    }
    return *name == '\0' && *c == ' ';
}

static void add_to_sum(struct replay *p, const char *line)
{
    uint32_t length = 0;
    while (line[length] != '\0') {
        length++;
    }
    p->lines_crc = fx_crc32c(fx_crc32c(p->lines_crc, line, length), "\n", 1);
}

/* Read a line into the event. False if there is none. */
static bool read_line(struct replay *p, struct replay_event *e)
{
    char line[REPLAY_LINE_BYTES];
    const enum replay_line is = p->next_line(p, line);
    p->line += is != REPLAY_LINE_OVER;
    p->count.torn += is == REPLAY_LINE_TORN;
    if (is == REPLAY_LINE_BAD) {
        stop(p, "no line of a recording");
    }
    if (is != REPLAY_LINE) {
        return false;
    }
    const char *cause = drv_can_log_parse(line, &e->frame);
    const bool is_own = is_interface(line, RECORD_OWN);
    if (cause || (is_own && (e->frame.id < RECORD_ID || e->frame.id >= RECORD_ID + RECORD_KINDS))) {
        stop(p, cause ? cause : "the recorder writes no such frame");
        return false;
    }
    e->kind = is_own                               ? REPLAY_OWN
              : is_interface(line, RECORD_SENT)    ? REPLAY_SENT
              : is_interface(line, RECORD_HEARD_2) ? REPLAY_HEARD_2
                                                   : REPLAY_HEARD;
    e->frame.id -= is_own ? RECORD_ID : 0;
    e->frame.time_us -= p->head.zero_us; /* of a frame that is heard, its arrival */
    if (e->kind != REPLAY_OWN || e->frame.id != RECORD_SUM) {
        add_to_sum(p, line);
    }
    return true;
}

static uint32_t word_of(const struct lm_can_frame *f)
{
    const uint8_t *d = f->data;
    return d[1] | (uint32_t)d[2] << 8 | (uint32_t)d[3] << 16 | (uint32_t)d[4] << 24;
}

/* What an own frame is besides an answer of a port: a sum, the mark of a part, or of the end. */
static bool take_mark(struct replay *p)
{
    const struct lm_can_frame *f = &p->next.frame;
    if (f->id == RECORD_PART) {
        if (word_of(f) != ++p->part) {
            stop(p, "a part is missing before it");
        }
        return true;
    }
    if (f->id == RECORD_SUM) {
        if (word_of(f) != p->lines_crc) {
            stop(p, "lines before it are damaged or missing");
        }
        p->lines_crc = 0;
        return true;
    }
    if (f->id == RECORD_END || f->id == RECORD_CEASED) {
        p->has_ended = f->id == RECORD_END || word_of(f) == 0;
        p->ceased = f->id == RECORD_CEASED ? f->data[0] : 0;
        p->next.kind = REPLAY_OVER;
    }
    return false;
}

/* Join the lines of a blob: its length, then its bytes. */
static void join_blob(struct replay *p)
{
    struct replay_event *e = &p->next;
    const struct lm_can_frame first = e->frame;
    uint8_t whole[RECORD_BLOB_MAX + 9];
    const uint32_t wanted = first.length > 0 ? 1u + first.data[0] : 1;
    uint32_t got = first.length;
    memcpy(whole, first.data, first.length);
    while (got < wanted) {
        if (!read_line(p, e)) {
            e->kind = REPLAY_OVER;
            return;
        }
        if (e->kind == REPLAY_OWN && e->frame.id == RECORD_CEASED) {
            (void)take_mark(p); /* lines were lost before it */
            return;
        }
        if (e->kind != REPLAY_OWN || e->frame.id != first.id || e->frame.length == 0) {
            stop(p, "the lines of a control are not complete");
            return;
        }
        memcpy(whole + got, e->frame.data, e->frame.length);
        got += e->frame.length;
    }
    e->frame = first;
    e->blob_bytes = got - 1 < RECORD_BLOB_MAX ? got - 1 : RECORD_BLOB_MAX;
    memcpy(e->blob, whole + 1, e->blob_bytes);
    e->blob[e->blob_bytes] = '\0';
}

/* The images beside the first. */
static void take_images(struct record_head *h, const uint8_t *bytes)
{
    for (uint32_t i = 0; i < RECORD_FURTHER; i++, bytes += RECORD_IMAGE_BYTES) {
        struct record_image *image = &h->further[i];
        *image = (struct record_image){0};
        for (uint32_t k = 0; k < 8; k++) {
            image->bytes |= (uint64_t)bytes[k] << 8 * k;
        }
        for (uint32_t k = 0; k < 4; k++) {
            image->crc |= (uint32_t)bytes[8 + k] << 8 * k;
        }
    }
}

/* A blob that is a setting of the board. True if it is one. */
static bool take_setting(struct replay *p)
{
    const struct replay_event *e = &p->next;
    struct record_head *h = &p->head;
    if (e->frame.id == RECORD_NODES && e->blob_bytes == sizeof h->nodes) {
        h->has_nodes = true;
        memcpy(h->nodes, e->blob, sizeof h->nodes);
        return true;
    }
    if (e->frame.id == RECORD_IMAGES && e->blob_bytes == RECORD_FURTHER * RECORD_IMAGE_BYTES) {
        take_images(h, e->blob);
        return true;
    }
    if (e->frame.id == RECORD_SETTINGS && e->blob_bytes == sizeof h->settings) {
        h->has_settings = true;
        memcpy(&h->settings, e->blob, sizeof h->settings);
        return true;
    }
    if (e->frame.id == RECORD_RESTART) {
        memcpy(h->restart, e->blob, sizeof h->restart - 1); /* whose last byte stays 0 */
        if (p->board) {
            p->board->restart = h->restart[0] == '\0' ? NULL : h->restart;
        }
        return true;
    }
    return false;
}

static bool is_blob(uint32_t kind)
{
    return kind == RECORD_HEAD || kind == RECORD_CONTROL || kind == RECORD_NODES ||
           kind == RECORD_RESTART || kind == RECORD_SETTINGS || kind == RECORD_IMAGES;
}

/* See that the next event is there. */
static void look_ahead(struct replay *p)
{
    struct replay_event *e = &p->next;
    while (e->kind == REPLAY_NONE) {
        if (!read_line(p, e)) {
            e->kind = REPLAY_OVER;
            return;
        }
        if (e->kind != REPLAY_OWN) {
            return;
        }
        if (e->frame.id == RECORD_HEAD && p->steps > 0) {
            stop(p, "another recording begins here, as the board was restarted");
        } else if (is_blob(e->frame.id)) {
            join_blob(p);
            if (e->kind == REPLAY_OWN && take_setting(p)) {
                e->kind = REPLAY_NONE;
            }
        } else if (e->frame.id == RECORD_READS) {
            e->left = e->frame.data[0];
        } else if (e->frame.id == RECORD_WAITS) {
            e->left = word_of(&e->frame);
        } else if (take_mark(p) && e->kind != REPLAY_OVER) {
            e->kind = REPLAY_NONE;
        }
    }
}

/* What stands below a line of steps happened in the last of them. */
static bool is_due(const struct replay *p)
{
    return p->ticks.at >= p->ticks.count;
}

/* True if the next event of this step is this one of the recorder's. */
static bool is_next(struct replay *p, uint32_t kind)
{
    if (!is_due(p)) {
        return false;
    }
    look_ahead(p);
    return p->next.kind == REPLAY_OWN && p->next.frame.id == kind;
}

/* The same of a frame heard or sent. */
static bool is_next_frame(struct replay *p, uint32_t kind)
{
    if (!is_due(p)) {
        return false;
    }
    look_ahead(p);
    return (uint32_t)p->next.kind == kind;
}

static void take(struct replay *p)
{
    p->next.kind = REPLAY_NONE;
}

static int status_of(const struct replay *p)
{
    return (int8_t)p->next.frame.data[0];
}

/* A status that may change: the present one. */
static int status_now(struct replay *p, uint32_t kind, int *status)
{
    if (is_next(p, kind)) {
        *status = status_of(p);
        take(p);
    }
    return *status;
}

/* ---- flash ---- */

static int read_start(void *ctx, uint64_t offset, void *destination, uint32_t length)
{
    struct replay *p = ctx;
    if (is_next(p, RECORD_READ_REFUSED)) {
        const int status = status_of(p);
        take(p);
        return status == LM_OK ? LM_ERR_IO : status;
    }
    if (offset > p->image->size_bytes || length > p->image->size_bytes - offset) {
        depart(p); /* the recorder would have said so */
        return LM_ERR_RANGE;
    }
    p->offset = offset;
    p->destination = destination;
    p->length = length;
    return LM_OK;
}

static int fetch(struct replay *p)
{
    int status = p->image->read_start(p->image->ctx, p->offset, p->destination, p->length);
    if (status == LM_OK) {
        do {
            status = p->image->read_poll(p->image->ctx);
        } while (status == LM_BUSY);
    }
    if (status != LM_OK) {
        if (ends(p)) {
            add_text(p, "the image cannot be read at ");
            add_number(p, p->offset);
        }
    }
    return status;
}

/* One read of a run is over: at the end of the run its bytes must be those of the recording. */
static void count_read(struct replay *p)
{
    p->reads_crc = fx_crc32c(p->reads_crc, p->destination, p->length);
    if (--p->next.left == 0) {
        p->count.reads_differ += p->reads_crc != word_of(&p->next.frame);
        p->reads_crc = 0;
        take(p);
    }
}

static int read_poll(void *ctx)
{
    struct replay *p = ctx;
    if (is_next(p, RECORD_WAITS) && p->next.left > 0) {
        p->next.left--;
        if (p->next.left == 0) {
            take(p);
        }
        return LM_BUSY;
    }
    if (is_next(p, RECORD_READ_FAILED)) {
        take(p);
        return LM_ERR_IO;
    }
    if (!is_next(p, RECORD_READS) || p->next.left == 0) {
        return LM_BUSY;
    }
    const int status = fetch(p);
    if (status == LM_OK) {
        count_read(p);
    }
    return status;
}

/* ---- bus ---- */

/* From interface 0 or 1. */
static int hear(struct replay *p, uint32_t interface, struct lm_can_frame *frame)
{
    if (is_next(p, RECORD_BUS_DOWN) && word_of(&p->next.frame) == interface) {
        take(p);
        return LM_ERR_IO;
    }
    if (!is_next_frame(p, interface == 0 ? REPLAY_HEARD : REPLAY_HEARD_2)) {
        return 0;
    }
    *frame = p->next.frame;
    take(p);
    return 1;
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    return hear(ctx, 0, frame);
}

static int receive_2(void *ctx, struct lm_can_frame *frame)
{
    return hear(ctx, 1, frame);
}

static bool are_same(const struct lm_can_frame *a, const struct lm_can_frame *b)
{
    return a->id == b->id && a->is_extended == b->is_extended && a->length == b->length &&
           memcmp(a->data, b->data, a->length < 8 ? a->length : 8) == 0;
}

static int send_frame(void *ctx, const struct lm_can_frame *frame)
{
    struct replay *p = ctx;
    if (is_next(p, RECORD_UNSENT)) {
        const int status = status_of(p);
        take(p);
        return status;
    }
    const bool is_sent = is_next_frame(p, REPLAY_SENT);
    if (!is_sent || !are_same(frame, &p->next.frame)) {
        depart(p);
    }
    if (is_sent) {
        take(p);
    }
    return LM_OK;
}

/* ---- controls ---- */

/* Whether an image that comes is the one that came. */
static bool is_at_hand(const struct replay *p, const struct lm_image_change *change)
{
    const uint32_t place = (uint32_t)change->place - 1;
    if (change->bytes == 0 || place >= LM_IMAGES_MAX) {
        return true;
    }
    const struct lm_flash_part part = {p->board->images[place].offset, change->bytes};
    return record_image_crc(p->image, &part, p->head.flash_poll_limit) == change->crc;
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct replay *p = ctx;
    if (!is_next(p, RECORD_CONTROL)) {
        return 0;
    }
    const bool is_sound = record_control_read(control, p->next.blob, p->next.blob_bytes);
    take(p);
    if (!is_sound) {
        stop(p, "no control");
    } else if (control->kind == LM_CONTROL_IMAGE && !is_at_hand(p, &control->image)) {
        stop(p, "an image comes here that is not at hand: name the same file at its place");
        return 0;
    }
    return is_sound;
}

/* ---- display ---- */

static size_t pixels(const struct replay *p)
{
    return (size_t)p->head.width_px * p->head.height_px;
}

size_t replay_pixels(const struct replay *p)
{
    return (1 + REPLAY_BUFFERS) * pixels(p);
}

static struct lm_surface canvas(const struct replay *p, uint8_t age)
{
    return (struct lm_surface){.pixels = p->canvas,
                               .stride_px = p->head.width_px,
                               .width_px = (uint16_t)p->head.width_px,
                               .height_px = (uint16_t)p->head.height_px,
                               .age = age};
}

static int acquire(void *ctx, struct lm_surface *surface)
{
    struct replay *p = ctx;
    if (is_next(p, RECORD_ACQUIRE)) {
        const uint32_t age = word_of(&p->next.frame);
        p->acquire_status = status_of(p);
        p->age = age <= UINT8_MAX ? (uint8_t)age : 0;
        take(p);
    }
    if (p->acquire_status != LM_OK) {
        return p->acquire_status;
    }
    const uint32_t age = p->age;
    if (age > 0 && age <= LM_AGES && age <= p->pictures) {
        memcpy(p->canvas, p->shown[(p->pictures + REPLAY_BUFFERS - (age - 1)) % REPLAY_BUFFERS],
               pixels(p) * sizeof *p->canvas);
    }
    *surface = canvas(p, p->age);
    return LM_OK;
}

/* A row that this glass does not have fails. */
static void check_row(struct replay *p)
{
    const struct lm_surface s = canvas(p, 0);
    const uint8_t *d = p->next.frame.data;
    const uint32_t row = d[0] | (uint32_t)d[1] << 8;
    const uint32_t crc = d[2] | (uint32_t)d[3] << 8 | (uint32_t)d[4] << 16 | (uint32_t)d[5] << 24;
    p->count.checks++;
    p->count.checks_failed += row >= s.height_px || record_row_crc(0, &s, row) != crc;
    take(p);
}

static void check_picture(struct replay *p)
{
    if (is_next(p, RECORD_ROW)) {
        check_row(p);
    }
    if (is_next(p, RECORD_CHECK)) {
        const struct lm_surface s = canvas(p, 0);
        p->count.checks++;
        p->count.checks_failed +=
            record_rows_crc(&s, p->next.frame.data[0]) != word_of(&p->next.frame);
        take(p);
    }
}

static int present(void *ctx, const struct lm_damage *changed)
{
    struct replay *p = ctx;
    (void)changed;
    check_picture(p);
    p->pictures++;
    memcpy(p->shown[p->pictures % REPLAY_BUFFERS], p->canvas, pixels(p) * sizeof *p->canvas);
    return status_now(p, RECORD_PRESENT, &p->present_status);
}

const uint32_t *replay_glass(const struct replay *p)
{
    return p->shown[p->pictures % REPLAY_BUFFERS];
}

/* ---- begin, steps, end ---- */

int replay_begin(struct replay *p, enum replay_line (*next_line)(struct replay *, char *))
{
    p->next_line = next_line;
    const bool has_head = is_next(p, RECORD_HEAD);
    if (!has_head || !record_head_read(&p->head, (const char *)p->next.blob)) {
        p->error[0] = '\0';
        add_text(p, p->path);
        add_text(p, has_head ? ": a recording of another form" : ": does not begin as a recording");
        return -1;
    }
    take(p);
    look_ahead(p); /* settings stand below the head */
    return 0;
}

/* What differs in the images beside the first, or NULL. One that the recording lacks may be at
 * hand: it is not shown. */
static const char *further_difference(const struct record_head *h, const struct record_head *mine)
{
    static const char *const words[RECORD_FURTHER] = {"another second image", "another third image",
                                                      "another fourth image"};
    for (uint32_t i = 0; i < RECORD_FURTHER; i++) {
        const struct record_image *theirs = &h->further[i], *ours = &mine->further[i];
        if (theirs->bytes != 0 &&
            (ours->bytes == 0 || theirs->bytes < ours->bytes || theirs->crc != ours->crc)) {
            return words[i];
        }
    }
    return NULL;
}

const char *replay_difference(const struct replay *p, const struct record_head *mine)
{
    const struct record_head *h = &p->head;
    return !is_same(h->version, mine->version) ? "another version of the firmware"
           : h->image_bytes < mine->image_bytes || h->image_crc != mine->image_crc ? "another image"
           : h->profile_crc != mine->profile_crc ? "another table of the bus"
           : h->radar_crc != mine->radar_crc     ? "another radar table"
                                                 : further_difference(h, mine);
}

bool replay_is_other_build(const struct replay *p)
{
    return !is_same(p->head.build, record_build);
}

static void set_board(struct replay *p, struct lm_board *board)
{
    const struct record_head *h = &p->head;
    const uint32_t s = h->switches;
    board->bus_node = (uint8_t)h->node;
    board->bus_partner = (uint8_t)(s >> RECORD_PARTNER_BIT);
    board->hardware_revision = (uint8_t)h->hardware_revision;
    board->is_heading_magnetic = (s & 1) != 0;
    board->tells_reports = (s >> 1 & 1) != 0;
    board->obeys_controls = (s >> 2 & 1) != 0;
    board->options = (struct lm_glass_options){.is_sector_whole = (s >> 3 & 1) != 0,
                                               .has_heading = (s >> 4 & 1) != 0,
                                               .has_strobe = (s >> 5 & 1) != 0,
                                               .has_borders = (s >> 6 & 1) != 0};
    board->is_database_unsigned = (s & RECORD_IS_UNSIGNED) != 0;
    board->glass_step_px = h->glass_step_px;
    board->noise_seed = h->noise_seed;
    board->flash_poll_limit = h->flash_poll_limit;
    board->tile_pool_bytes = h->tile_slots * sizeof(struct lm_tile);
    board->bus_nodes = h->has_nodes ? p->head.nodes : NULL;
    board->settings = h->has_settings ? &h->settings : NULL;
    for (uint32_t i = 1; i <= RECORD_FURTHER && i < LM_IMAGES_MAX; i++) {
        board->images[i].bytes = h->further[i - 1].bytes;
    }
    board->restart = is_same(h->restart, "-") || h->restart[0] == '\0' ? NULL : p->head.restart;
}

void replay_wrap_with(struct replay *p, struct lm_board *board, uint32_t *memory)
{
    p->canvas = memory;
    for (uint32_t i = 0; i < REPLAY_BUFFERS; i++) {
        p->shown[i] = memory + (1 + i) * pixels(p);
    }
    memset(memory, 0, replay_pixels(p) * sizeof *memory);
    set_board(p, board);
    p->image = board->flash;
    p->flash = (struct lm_flash){.ctx = p,
                                 .size_bytes = p->image->size_bytes > p->head.image_bytes
                                                   ? p->image->size_bytes
                                                   : p->head.image_bytes,
                                 .read_start = read_start,
                                 .read_poll = read_poll};
    p->can = (struct lm_can){.ctx = p, .receive = receive};
    p->can_2 = (struct lm_can){.ctx = p, .receive = receive_2};
    p->controls = (struct lm_controls){.ctx = p, .next = next_control};
    p->display = (struct lm_display){.ctx = p,
                                     .width_px = (uint16_t)p->head.width_px,
                                     .height_px = (uint16_t)p->head.height_px,
                                     .acquire = acquire,
                                     .present = present};
    board->flash = &p->flash;
    board->can = &p->can;
    board->can_2 = (p->head.switches & RECORD_HAS_SECOND) != 0 ? &p->can_2 : NULL;
    p->board = board;
    board->controls = &p->controls;
    board->display = &p->display;
}

/* The next number of the line of steps (record.c). */
static bool take_tick(struct replay *p, uint64_t *pause_us)
{
    uint64_t folded = 0;
    for (uint32_t shift = 0; p->ticks.at < p->ticks.count; shift += 7) {
        const uint8_t byte = p->ticks.bytes[p->ticks.at++];
        folded |= (uint64_t)(byte & 0x7f) << shift;
        if ((byte & 0x80) == 0) {
            const uint64_t late = folded & 1 ? ~(folded >> 1) : folded >> 1;
            *pause_us = late + RECORD_TICK_US;
            return true;
        }
    }
    return false;
}

/* What the step before left is a departure: it did not ask for it. */
static bool find_ticks(struct replay *p)
{
    bool has_departed = false;
    while (!is_next(p, RECORD_STEPS)) {
        if (p->next.kind == REPLAY_OVER) {
            return false;
        }
        if (!has_departed) {
            depart(p);
            has_departed = true;
        }
        take(p);
    }
    p->ticks.count = p->next.frame.length;
    p->ticks.at = 0;
    memcpy(p->ticks.bytes, p->next.frame.data, sizeof p->ticks.bytes);
    take(p);
    return true;
}

bool replay_step(struct replay *p, uint64_t *now_us)
{
    uint64_t pause_us;
    while (is_due(p)) {
        if (!find_ticks(p)) {
            return false;
        }
    }
    if (!take_tick(p, &pause_us) || p->now_us + pause_us < p->now_us) {
        stop(p, "no time of a step");
        return false;
    }
    p->now_us += pause_us;
    p->steps++;
    if (is_next(p, RECORD_VOICE)) {
        p->can.send = status_of(p) != 0 ? send_frame : NULL;
        take(p);
    }
    *now_us = p->now_us;
    return true;
}
