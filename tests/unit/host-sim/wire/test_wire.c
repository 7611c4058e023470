/* A load over a wire, PC and panel as two threads at both ends of a socket: cut at every block,
 * taken up again, with flipped bits, with another version, with ends that keep to no protocol. */
#include "check.h"
#include "fx/crc32c.h"
#include "lm/db.h"
#include "wire/panel.h"
#include "wire/pc.h"
#include "wire/socket.h"

#include <errno.h>
#include <pthread.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

enum { IMAGE_BYTES = 200001, ANSWER_MS = 60 * 1000 };

static uint8_t image[IMAGE_BYTES], slot[IMAGE_BYTES];

/* The panel's link, which counts blocks, and cuts or damages one of them. */
struct tap {
    struct wire_socket under;
    struct wire_link link;
    uint32_t calls, cut_at;   /* 0: never */
    uint64_t bytes, flip_bit; /* of what the PC sends, counted from 1; 0: none */
};

static int tap_send(void *ctx, const void *from, uint32_t length, uint32_t timeout_ms)
{
    struct tap *t = ctx;
    if (++t->calls == t->cut_at) {
        (void)shutdown(t->under.fd, SHUT_RDWR);
        return ENODEV;
    }
    return t->under.link.send(t->under.link.ctx, from, length, timeout_ms);
}

static int tap_receive(void *ctx, void *to, uint32_t length, uint32_t timeout_ms)
{
    struct tap *t = ctx;
    if (++t->calls == t->cut_at) {
        (void)shutdown(t->under.fd, SHUT_RDWR);
        return ENODEV;
    }
    const int cause = t->under.link.receive(t->under.link.ctx, to, length, timeout_ms);
    const uint64_t byte = t->flip_bit / 8;
    if (cause == 0 && t->flip_bit != 0 && byte >= t->bytes && byte < t->bytes + length) {
        ((uint8_t *)to)[byte - t->bytes] ^= (uint8_t)(1u << t->flip_bit % 8);
    }
    t->bytes += length;
    return cause;
}

/* Both ends of one session. */
struct both {
    struct tap tap;
    struct wire_panel panel;
    struct wire_socket socket;
    struct wire_pc pc;
    pthread_t thread;
    int result; /* of the PC */
};

static int read_image(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    const uint64_t *broken_at = ctx;
    if (offset <= *broken_at && *broken_at < offset + length) {
        return EIO;
    }
    memcpy(to, image + offset, length);
    return 0;
}

static uint64_t broken_at = UINT64_MAX;

static void *run_pc(void *ctx)
{
    struct both *b = ctx;
    b->result = wire_pc_run(&b->pc);
    wire_socket_close(&b->socket); /* as a program that ends */
    return NULL;
}

static struct both *begin(void)
{
    static uint64_t session;
    struct both *b = calloc(1, sizeof *b);
    int ends[2];
    assert_non_null(b);
    assert_int_equal(socketpair(AF_UNIX, SOCK_STREAM, 0, ends), 0);
    wire_socket_lend(&b->tap.under, ends[0]);
    wire_socket_lend(&b->socket, ends[1]);
    b->tap.link = (struct wire_link){&b->tap, tap_send, tap_receive};
    b->pc.link = &b->socket.link;
    b->pc.image = (struct wire_image){&broken_at, IMAGE_BYTES, read_image};
    b->pc.session = ++session;
    b->pc.wait_ms = ANSWER_MS;
    wire_panel_open(&b->panel, &b->tap.link, ANSWER_MS);
    return b;
}

static void start(struct both *b)
{
    assert_int_equal(pthread_create(&b->thread, NULL, run_pc, b), 0);
}

/* The panel goes; what the PC says then. */
static int end(struct both *b)
{
    wire_socket_close(&b->tap.under);
    assert_int_equal(pthread_join(b->thread, NULL), 0);
    const int result = b->result;
    free(b);
    return result;
}

static int guess(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    memcpy(to, (const uint8_t *)ctx + offset, length);
    return 0;
}

/* What a loader does: the header, then all pieces into the slot. 0, or the first fault. */
static int load(struct wire_panel *p)
{
    static uint8_t piece[WIRE_PIECE_BYTES];
    int status = wire_panel_wait(p) == 0 ? LM_OK : LM_ERR_IO;
    if (status != LM_OK) {
        return status;
    }
    assert_int_equal(p->port.size_bytes, IMAGE_BYTES);
    wire_panel_welcome(p, "slot A: whole; slot B: absent");
    status = lm_db_read(&p->port, 0, piece, 1000, 1);
    p->guess = guess;
    p->guess_ctx = slot;
    for (uint64_t at = 0; at < IMAGE_BYTES && status == LM_OK; at += sizeof piece) {
        const uint64_t left = IMAGE_BYTES - at;
        const uint32_t length = left < sizeof piece ? (uint32_t)left : (uint32_t)sizeof piece;
        status = lm_db_read(&p->port, at, piece, length, 1);
        if (status == LM_OK) {
            assert_memory_equal(piece, image + at, length); /* never a wrong byte */
            memcpy(slot + at, piece, length);
        }
    }
    return status;
}

static void finish(struct wire_panel *p)
{
    const struct wire_figures figures = {.load = 7, .image_bytes = IMAGE_BYTES};
    for (uint64_t done = 0; done <= IMAGE_BYTES; done += 1000) {
        wire_panel_status(p, done, IMAGE_BYTES);
    }
    wire_panel_done(p, &figures, "slot B: load 7");
}

static int set_up(void **state)
{
    (void)state;
    uint32_t random = 1;
    for (uint32_t i = 0; i < IMAGE_BYTES; i++) {
        random = random * 1664525u + 1013904223u;
        image[i] = (uint8_t)(random >> 24);
    }
    memset(slot, 0, sizeof slot);
    broken_at = UINT64_MAX;
    return 0;
}

TEST_WITH(every_byte_arrives_and_both_ends_know_how_it_ended, set_up, NULL)
{
    struct both *b = begin();
    start(b);
    assert_int_equal(load(&b->panel), LM_OK);
    uint8_t some[3000];
    assert_int_equal(lm_db_read(&b->panel.port, 199, some, sizeof some, 1), LM_OK);
    assert_memory_equal(some, image + 199, sizeof some);
    assert_int_equal(lm_db_read(&b->panel.port, IMAGE_BYTES - 1, some, 2, 1), LM_ERR_IO);
    finish(&b->panel);
    assert_int_equal(b->panel.cause, 0);
    assert_int_equal(b->panel.sent_bytes, 1000 + IMAGE_BYTES + sizeof some);
    assert_int_equal(pthread_join(b->thread, NULL), 0);
    assert_int_equal(b->result, 0);
    assert_string_equal(b->pc.text, "slot B: load 7");
    assert_int_equal(b->pc.figures.load, 7);
    assert_int_equal(b->pc.sent_bytes, b->panel.sent_bytes);
    wire_socket_close(&b->tap.under);
    free(b);
}

TEST_WITH(a_load_that_is_cut_at_any_block_goes_on_where_it_was, set_up, NULL)
{
    uint32_t cuts = 0;
    for (uint32_t cut_at = 1;; cut_at++) {
        memset(slot, 0, sizeof slot);
        struct both *b = begin();
        b->tap.cut_at = cut_at;
        start(b);
        const int status = load(&b->panel);
        const uint64_t had = b->panel.sent_bytes > 1000 ? b->panel.sent_bytes - 1000 : 0;
        const bool is_cut = status != LM_OK;
        assert_int_equal(end(b), ENODEV); /* the PC is told that the panel is gone */
        if (!is_cut) {
            break;
        }
        cuts++;
        b = begin();
        start(b);
        assert_int_equal(load(&b->panel), LM_OK);
        assert_int_equal(b->panel.same_bytes, had);
        assert_int_equal(b->panel.sent_bytes, 1000 + IMAGE_BYTES - had);
        assert_memory_equal(slot, image, IMAGE_BYTES);
        finish(&b->panel);
        assert_int_equal(end(b), 0);
    }
    assert_int_equal(cuts,
                     17); /* offer, welcome, and five answers of two blocks with their questions */
}

TEST_WITH(a_flipped_bit_never_becomes_a_byte_of_the_slot, set_up, NULL)
{
    uint32_t refused = 0, random = 1;
    for (uint32_t i = 0; i < 100; i++) {
        struct both *b = begin();
        random = random * 1664525u + 1013904223u;
        /* Heads are few among payloads: every second flip is in the first ones. */
        const uint32_t range = (i & 1u ? IMAGE_BYTES : 3 * WIRE_BLOCK_BYTES) * 8;
        b->tap.flip_bit = WIRE_BLOCK_BYTES * 8 + (random >> 5) % range;
        b->panel.answer_ms = 20; /* a head that is damaged is waited for in vain */
        memset(slot, 0, sizeof slot);
        start(b);
        refused += load(&b->panel) != LM_OK; /* it compares each byte */
        (void)end(b);
    }
    assert_true(refused > 95); /* zeros behind a payload may flip */
}

/* Send one message by hand. */
static void say(struct both *b, struct wire_message m)
{
    memcpy(m.magic, "LMDBWIRE", 8);
    m.crc = fx_crc32c(0, &m, offsetof(struct wire_message, crc));
    assert_int_equal(b->socket.link.send(&b->socket, &m, sizeof m, ANSWER_MS), 0);
}

static struct wire_message hear(struct both *b)
{
    struct wire_message m;
    assert_int_equal(b->socket.link.receive(&b->socket, &m, sizeof m, ANSWER_MS), 0);
    return m;
}

static void stop(struct both *b)
{
    wire_socket_close(&b->socket);
    wire_socket_close(&b->tap.under);
    free(b);
}

TEST_WITH(a_pc_of_another_version_is_told_so_and_the_next_one_is_waited_for, set_up, NULL)
{
    struct both *b = begin();
    say(b, (struct wire_message){.version = 2, .kind = WIRE_OFFER, .session = 5, .bytes = 10});
    say(b, (struct wire_message){.version = 1, .kind = WIRE_OFFER, .session = 6, .bytes = 11});
    assert_int_equal(wire_panel_wait(&b->panel), 0);
    assert_int_equal(b->panel.port.size_bytes, 11);
    const struct wire_message m = hear(b);
    assert_int_equal(m.kind, WIRE_REFUSED);
    assert_int_equal(m.session, 5);
    assert_non_null(strstr(m.text, "version 1 of the protocol, the PC 2"));
    stop(b);
}

TEST_WITH(a_panel_of_another_version_is_named, set_up, NULL)
{
    struct both *b = begin();
    struct wire_socket panel = b->tap.under;
    struct wire_message m = {.version = 3, .kind = WIRE_WELCOME, .session = b->pc.session};
    memcpy(m.magic, "LMDBWIRE", 8);
    m.crc = fx_crc32c(0, &m, offsetof(struct wire_message, crc));
    assert_int_equal(b->tap.under.link.send(&panel, &m, sizeof m, ANSWER_MS), 0);
    assert_int_equal(wire_pc_run(&b->pc), EPROTONOSUPPORT);
    assert_int_equal(b->pc.version, 3);
    stop(b);
}

TEST_WITH(a_panel_is_given_nothing_outside_the_image, set_up, NULL)
{
    static const uint64_t asks[][2] = {{IMAGE_BYTES, 1}, {IMAGE_BYTES - 1, 2},
                                       {0, 0},           {0, WIRE_PIECE_BYTES + 1},
                                       {UINT64_MAX, 2},  {1, UINT64_MAX}};
    for (size_t i = 0; i < sizeof asks / sizeof asks[0]; i++) {
        struct both *b = begin();
        struct wire_message m = {
            .kind = WIRE_ASK, .session = b->pc.session, .offset = asks[i][0], .bytes = asks[i][1]};
        assert_int_equal(wire_send(&b->tap.under.link, &m, NULL, ANSWER_MS), 0);
        assert_int_equal(wire_pc_run(&b->pc), EPROTO);
        assert_int_equal(b->pc.sent_bytes, 0);
        stop(b);
    }
}

TEST_WITH(answers_that_are_not_to_the_question_end_the_session, set_up, NULL)
{
    static const struct wire_message wrong[] = {
        {.version = 1, .kind = WIRE_DATA, .session = 9, .offset = 1, .bytes = 8},
        {.version = 1, .kind = WIRE_DATA, .session = 9, .offset = 0, .bytes = 8},
        {.version = 1, .kind = WIRE_SAME, .session = 9, .offset = 0, .bytes = 8}, /* as what? */
        {.version = 1, .kind = WIRE_DONE, .session = 9, .offset = 0, .bytes = 8},
        {.version = 1, .kind = 99, .session = 9, .offset = 0, .bytes = 8}};
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct both *b = begin();
        uint64_t eight;
        say(b, (struct wire_message){.version = 1, .kind = WIRE_OFFER, .session = 9, .bytes = 100});
        assert_int_equal(wire_panel_wait(&b->panel), 0);
        say(b, wrong[i]);
        assert_int_equal(lm_db_read(&b->panel.port, 0, &eight, 8, 1), LM_ERR_IO);
        assert_int_equal(b->panel.cause, EPROTO);
        assert_int_equal(b->panel.bad, 1);
        assert_int_equal(hear(b).kind, WIRE_ASK);
        wire_panel_refuse(&b->panel, "no");
        assert_int_equal(hear(b).kind, WIRE_REFUSED); /* it is told all the same */
        stop(b);
    }
}

/* Eight bytes as an answer, by hand. */
static void answer(struct both *b, uint64_t session, uint64_t offset, const char *text)
{
    static uint8_t payload[WIRE_BLOCK_BYTES];
    struct wire_message m = {
        .kind = WIRE_DATA, .session = session, .offset = offset, .bytes = 8, .payload_bytes = 8};
    memcpy(payload, text, 8);
    assert_int_equal(wire_send(&b->socket.link, &m, payload, ANSWER_MS), 0);
}

TEST_WITH(bytes_of_another_place_or_session_are_not_taken, set_up, NULL)
{
    struct both *b = begin();
    char eight[9] = "";
    say(b, (struct wire_message){.version = 1, .kind = WIRE_OFFER, .session = 9, .bytes = 100});
    assert_int_equal(wire_panel_wait(&b->panel), 0);
    answer(b, 8, 16, "another!");
    answer(b, 9, 16, "this one");
    assert_int_equal(lm_db_read(&b->panel.port, 16, eight, 8, 1), LM_OK);
    assert_string_equal(eight, "this one");
    answer(b, 9, 17, "misplace");
    assert_int_equal(lm_db_read(&b->panel.port, 16, eight, 8, 1), LM_ERR_IO);
    assert_int_equal(b->panel.cause, EPROTO);
    stop(b);
}

TEST_WITH(what_is_left_of_an_earlier_session_is_passed_over, set_up, NULL)
{
    struct both *b = begin();
    uint8_t rubbish[20 * WIRE_BLOCK_BYTES];
    memset(rubbish, 0x5a, sizeof rubbish);
    struct wire_socket *pc = &b->socket;
    assert_int_equal(pc->link.send(pc, rubbish, sizeof rubbish, ANSWER_MS), 0);
    say(b, (struct wire_message){.version = 1, .kind = WIRE_SAME, .session = 4});
    struct wire_message late = {.kind = WIRE_ASK, .session = 4, .bytes = 10};
    assert_int_equal(wire_send(&b->tap.under.link, &late, NULL, ANSWER_MS), 0);
    start(b);
    assert_int_equal(load(&b->panel), LM_OK);
    finish(&b->panel);
    assert_int_equal(end(b), 0);
}

TEST_WITH(a_pc_that_begins_anew_ends_the_load_and_begins_the_next, set_up, NULL)
{
    struct both *b = begin();
    uint64_t eight;
    say(b, (struct wire_message){.version = 1, .kind = WIRE_OFFER, .session = 1, .bytes = 100});
    assert_int_equal(wire_panel_wait(&b->panel), 0);
    say(b, (struct wire_message){.version = 1, .kind = WIRE_OFFER, .session = 2, .bytes = 200});
    assert_int_equal(lm_db_read(&b->panel.port, 0, &eight, 8, 1), LM_ERR_IO);
    assert_int_equal(b->panel.cause, ECONNRESET);
    wire_panel_refuse(&b->panel, "not for the new one");
    assert_int_equal(wire_panel_wait(&b->panel), 0);
    assert_int_equal(b->panel.port.size_bytes, 200);
    assert_int_equal(b->panel.cause, 0);
    assert_int_equal(hear(b).kind, WIRE_ASK);
    stop(b);
}

TEST_WITH(an_image_that_cannot_be_read_any_more_is_told_to_the_panel, set_up, NULL)
{
    struct both *b = begin();
    broken_at = 150000;
    start(b);
    assert_int_equal(load(&b->panel), LM_ERR_IO);
    assert_int_equal(b->panel.cause, ECANCELED);
    assert_string_equal(b->panel.text, "the PC cannot read the image any more");
    assert_int_equal(end(b), EIO);
}

TEST_WITH(a_refusal_comes_to_the_pc_in_the_panels_words_made_printable, set_up, NULL)
{
    struct both *b = begin();
    start(b);
    assert_int_equal(wire_panel_wait(&b->panel), 0);
    wire_panel_refuse(&b->panel, "older\033[2J\n");
    assert_int_equal(pthread_join(b->thread, NULL), 0);
    assert_int_equal(b->result, ECANCELED);
    assert_string_equal(b->pc.text, "older?[2J?");
    wire_socket_close(&b->tap.under);
    free(b);
}

TEST_WITH(a_side_that_says_nothing_is_given_up, set_up, NULL)
{
    struct both *b = begin();
    uint64_t eight;
    say(b, (struct wire_message){.version = 1, .kind = WIRE_OFFER, .session = 1, .bytes = 100});
    assert_int_equal(wire_panel_wait(&b->panel), 0);
    b->panel.answer_ms = 1;
    assert_int_equal(lm_db_read(&b->panel.port, 0, &eight, 8, 1), LM_ERR_IO);
    assert_int_equal(b->panel.cause, ETIMEDOUT);
    stop(b);
}
