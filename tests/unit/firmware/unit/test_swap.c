/* SWAP: two displays on one bus exchange their pages, both or none. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "glass_text.h"
#include "lm/canas.h"
#include "lm/swap.h"
#include "unit_rig.h"

enum { LEFT = 20, RIGHT = 21, QUEUE = 512, RIVAL = 22 };

struct wire;

/* A display on the wire: the rig's own bus, and behind it what the others said. */
struct seat {
    struct rig *r;
    struct wire *wire;
    int (*receive)(void *ctx, struct lm_can_frame *frame);
    void *ctx;
    struct lm_can_frame waiting[QUEUE];
    uint32_t head, tail;
    bool is_deaf; /* nothing of the others reaches it */
};

/* Frames of swaps reach every other seat, but for those that are lost. */
struct wire {
    struct seat seat[3];
    uint32_t seats, sent;
    uint64_t lost[2];            /* bit n % 64 of word n / 64: the nth frame is lost */
    uint32_t lost_from, lost_to; /* so are these */
    uint32_t noise;              /* chance of a loss in 256, by `seed` */
    uint32_t seed;
    uint32_t busy; /* sends that find the bus busy, from now on */
    bool doubles;  /* each frame comes twice */
};

static uint32_t draw(struct wire *w)
{
    w->seed = w->seed * 1664525u + 1013904223u;
    return w->seed >> 24;
}

static int hear(void *ctx, struct lm_can_frame *frame)
{
    struct seat *s = ctx;
    if (s->tail == s->head) {
        return s->receive(s->ctx, frame);
    }
    *frame = s->waiting[s->tail++ % QUEUE];
    frame->time_us = s->r->now_us;
    return 1;
}

static void put_to(struct seat *s, const struct lm_can_frame *frame)
{
    if (!s->is_deaf && s->head - s->tail < QUEUE) {
        s->waiting[s->head++ % QUEUE] = *frame;
    }
}

static int say(void *ctx, const struct lm_can_frame *frame)
{
    struct seat *from = ctx;
    struct wire *w = from->wire;
    if (w->busy > 0) {
        w->busy--;
        return LM_BUSY;
    }
    const uint32_t n = w->sent++;
    const bool is_lost = (n < 128 && (w->lost[n / 64] >> n % 64 & 1) != 0) ||
                         (n >= w->lost_from && n < w->lost_to) || draw(w) < w->noise;
    for (uint32_t i = 0; i < w->seats && !is_lost; i++) {
        for (int copy = 0; copy <= w->doubles && &w->seat[i] != from; copy++) {
            put_to(&w->seat[i], frame);
        }
    }
    return LM_OK;
}

/* A display in good flight at 10 nm. */
static struct rig *sit(struct wire *w, uint8_t node, uint8_t partner)
{
    struct seat *s = &w->seat[w->seats++];
    struct rig *r = make_rig();
    *s = (struct seat){r, w, r->board.can.receive, r->board.can.ctx, {{0}}, 0, 0, false};
    r->board.can = (struct lm_can){.ctx = s, .receive = hear, .send = say};
    r->board.lent.bus_node = node;
    r->board.lent.bus_partner = partner;
    assert_int_equal(lm_unit_init(&r->unit, &r->board.lent), LM_OK);
    return r;
}

static void fly(struct wire *w, double seconds)
{
    for (uint32_t i = 0; i < seconds * 1e6 / STEP_US; i++) {
        for (uint32_t k = 0; k < w->seats; k++) {
            run(w->seat[k].r, STEP_US * 1e-6);
        }
    }
}

static void press_osb(struct rig *r, int osb)
{
    command(r, lm_control_button(true, osb));
    command(r, lm_control_button(false, osb));
}

static const struct lm_control gain_minus_7 = {.kind = LM_CONTROL_GAIN, .gain_db = -7};
static const struct lm_control sea = {.kind = LM_CONTROL_SECTOR,
                                      .sector = {.mode = LM_SECTOR_SEA, .fov = LM_FOV_NORM}};

static void close_wire(struct wire *w)
{
    for (uint32_t i = 0; i < w->seats; i++) {
        free_rig(w->seat[i].r);
    }
    free(w);
}

/* Two displays in flight, the left one with GM at 10 nm, the right one with SEA at 40 nm. */
static struct wire *begin_pair(struct rig **left, struct rig **right)
{
    struct wire *w = calloc(1, sizeof *w);
    assert_non_null(w);
    *left = sit(w, LEFT, RIGHT);
    *right = sit(w, RIGHT, LEFT);
    command(*left, range_10);
    command(*left, gain_minus_7);
    command(*right, sea);
    fly(w, 0.1);
    w->sent = 0;
    return w;
}

static bool has_first_page(const struct rig *r)
{
    return r->unit.page.mode == LM_SECTOR_GM && r->unit.page.gain_db == -7 &&
           r->unit.page.radar->range[r->unit.page.range_index].range_nm == 10;
}

static bool has_second_page(const struct rig *r)
{
    return r->unit.page.mode == LM_SECTOR_SEA && r->unit.page.gain_db == 0 &&
           r->unit.page.radar->range[r->unit.page.range_index].range_nm == 40;
}

/* 1: exchanged; 0: each as before; -1: neither. */
static int outcome(const struct rig *left, const struct rig *right)
{
    return has_second_page(left) && has_first_page(right)   ? 1
           : has_first_page(left) && has_second_page(right) ? 0
                                                            : -1;
}

static bool says_no_swap(const struct rig *r)
{
    const struct lm_surface glass = glass_of(r);
    const struct lm_palette *p = &r->unit.palette;
    return glass_find(&glass, "UNABLE", p->warning, p->ink, NULL) &&
           glass_find(&glass, "NO SWAP", p->warning, p->ink, NULL);
}

TEST(two_displays_exchange_their_pages_within_a_tenth_of_a_second)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    assert_int_equal(outcome(left, right), 0);
    press_osb(left, 15);
    fly(w, 0.1);
    assert_int_equal(outcome(left, right), 1);
    assert_int_equal(left->unit.count.swaps, 1);
    assert_int_equal(right->unit.count.swaps, 1);
    assert_int_equal(w->sent, 36); /* docs/bus.md: so many frames */
    press_osb(right, 15);
    fly(w, 0.1);
    assert_int_equal(outcome(left, right), 0);
    assert_int_equal(left->unit.count.commands_refused + right->unit.count.commands_refused, 0);
    assert_int_equal(left->unit.swap.refused + right->unit.swap.refused, 0);
    close_wire(w);
}

TEST(a_page_is_what_was_selected_but_not_the_colours_of_the_glass_or_the_knob)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    const int keys[] = {5, 8,  9,  4, 2,  2,
                        6, 18, 11, 1, 13, 11}; /* CNTL: tint, night, beam, tilt.. */
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        press_osb(left, keys[i]);
        fly(w, 0.02);
    }
    command(left, lm_control_knob(500));
    command(left, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                      .cursor = {left->unit.cursor.position.latitude + 70000,
                                                 left->unit.cursor.position.longitude + 90000}});
    fly(w, 0.1);
    const struct lm_page before = left->unit.page, other = right->unit.page;
    const struct lm_position cursor = left->unit.cursor.position;
    press_osb(left, 15);
    fly(w, 0.1);
    const struct lm_page *now = &right->unit.page;
    assert_memory_equal(&now->format, &before.format, LM_PAGE_SHARED_BYTES);
    assert_int_equal(now->hidden, before.hidden);
    assert_int_not_equal(now->hidden, other.hidden); /* the keys above chose a label */
    assert_int_equal(now->tilt_tenths, before.tilt_tenths);
    assert_int_equal(now->cell_mm, before.cell_mm);
    assert_memory_equal(&right->unit.cursor.position, &cursor, sizeof cursor);
    assert_memory_equal(&now->palette, &other.palette, sizeof other.palette);
    assert_memory_not_equal(&before.palette, &other.palette, sizeof other.palette);
    assert_int_equal(now->knob, 0);
    assert_int_equal(left->unit.page.knob, 500);
    close_wire(w);
}

TEST(a_patch_goes_over_and_is_drawn_from_where_it_was_seen)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    fly(w, 1.5);
    command(left, patch_here);
    fly(w, 3);
    assert_int_equal(left->unit.page.picture, LM_PICTURE_PATCH);
    const struct lm_sar_command before = left->unit.picture.sar.command;
    press_osb(right, 15);
    fly(w, 12);
    const struct lm_sar *now = &right->unit.picture.sar;
    assert_int_equal(right->unit.page.picture, LM_PICTURE_PATCH);
    assert_int_equal(left->unit.page.picture, LM_PICTURE_SECTOR);
    assert_memory_equal(&now->command.centre, &before.centre, sizeof before.centre);
    assert_int_equal(now->command.cell_mm, before.cell_mm);
    assert_int_equal(now->command.look_azimuth, before.look_azimuth);
    assert_int_equal(now->command.range_m, before.range_m);
    assert_int_equal(now->command.height_m_q6, before.height_m_q6);
    assert_int_equal(now->line, now->lines);
    assert_true(lit_pixels(right) > 1000);
    close_wire(w);
}

TEST(without_a_partner_swap_does_nothing_and_says_so)
{
    struct rig *r = fly_rig();
    const struct lm_page before = r->unit.page;
    press(r, 15);
    assert_true(says_no_swap(r));
    assert_int_equal(r->unit.refusal, LM_REFUSED_SWAP);
    assert_memory_equal(&r->unit.page.format, &before.format, LM_PAGE_BYTES);
    run(r, 2.5);
    assert_false(says_no_swap(r));
    free_rig(r);
}

TEST(a_silent_partner_is_said_after_half_a_second)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    w->seat[1].is_deaf = true;
    press_osb(left, 15);
    fly(w, 0.45);
    assert_false(says_no_swap(left));
    fly(w, 0.1);
    assert_true(says_no_swap(left));
    assert_int_equal(outcome(left, right), 0);
    w->seat[1].is_deaf = false; /* and it can be asked again */
    fly(w, 2.2);
    press_osb(left, 15);
    fly(w, 0.1);
    assert_int_equal(outcome(left, right), 1);
    close_wire(w);
}

TEST(a_partner_that_hears_nothing_at_the_end_takes_nothing)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    press_osb(left, 15);
    w->lost_from = 34; /* from the first TAKE on */
    w->lost_to = UINT32_MAX;
    fly(w, 3);
    assert_int_equal(outcome(left, right), 0);
    assert_int_equal(left->unit.count.commands_refused, 1);
    assert_int_equal(right->unit.count.commands_refused, 0); /* nobody pressed anything there */
    w->lost_to = 0;
    press_osb(right, 15);
    fly(w, 0.1);
    assert_int_equal(outcome(left, right), 1);
    close_wire(w);
}

/* Every frame, and every pair of frames of the exchange, is lost once. */
TEST(whatever_frames_are_lost_both_take_a_page_or_none)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    uint32_t exchanged = 0, tries = 0;
    for (uint32_t a = 0; a < 40; a++) {
        for (uint32_t b = a; b < 40; b += a < 33 ? 5 : 1) {
            const int before = outcome(left, right);
            w->sent = 0;
            w->lost[0] = (uint64_t)1 << a | (uint64_t)1 << b;
            press_osb(tries % 2 ? left : right, 15);
            fly(w, 2.6);
            const int after = outcome(left, right);
            assert_in_range(after, 0, 1);
            const bool is_told = w->seat[1 - tries % 2].r->unit.count.commands_refused > 0;
            assert_int_equal(after != before, !is_told);
            w->seat[0].r->unit.count.commands_refused = w->seat[1].r->unit.count.commands_refused =
                0;
            exchanged += after != before;
            tries++;
        }
    }
    assert_in_range(exchanged, 1, tries - 1);
    print_message("# %u of %u exchanges came about\n", exchanged, tries);
    close_wire(w);
}

/* A tenth of all frames is lost: by chance, ten TAKEN in a row are not. */
TEST(on_a_bad_bus_both_take_a_page_or_none)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    uint32_t exchanged = 0;
    w->noise = 26;
    for (uint32_t i = 0; i < 80; i++) {
        const int before = outcome(left, right);
        press_osb(i % 3 ? left : right, 15);
        fly(w, 2.6);
        assert_in_range(outcome(left, right), 0, 1);
        exchanged += outcome(left, right) != before;
    }
    assert_in_range(exchanged, 1, 79);
    close_wire(w);
}

TEST(who_press_at_the_same_moment_exchange_once)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    for (uint32_t late = 0; late < 30; late++) {
        const int before = outcome(left, right);
        press_osb(left, 15);
        fly(w, late % 15 * STEP_US * 1e-6);
        press_osb(right, 15);
        fly(w, 0.2);
        if (late % 15 < 10) { /* before the first exchange was over */
            assert_int_equal(outcome(left, right), 1 - before);
        }
        assert_in_range(outcome(left, right), 0, 1);
        assert_int_equal(left->unit.count.commands_refused + right->unit.count.commands_refused, 0);
    }
    close_wire(w);
}

/* The right one has the higher node and asks first, in five steps of four frames. The left one
 * presses before ASK has come: it does not answer, as it asks itself, and is answered. */
TEST(who_has_the_lower_node_and_asks_does_not_answer)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    for (uint32_t late = 1; late < 4; late++) {
        const int before = outcome(left, right);
        const uint32_t swaps = left->unit.count.swaps;
        press_osb(right, 15);
        fly(w, late * STEP_US * 1e-6);
        press_osb(left, 15);
        fly(w, 0.2);
        assert_int_equal(outcome(left, right), 1 - before);
        assert_int_equal(left->unit.count.swaps, swaps + 1);
        assert_int_equal(right->unit.count.swaps, swaps + 1);
        assert_int_equal(left->unit.swap.refused, late); /* ASK of the right one */
        assert_int_equal(left->unit.count.commands_refused + right->unit.count.commands_refused, 0);
    }
    close_wire(w);
}

TEST(frames_that_come_twice_count_once)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    w->doubles = true;
    press_osb(left, 15);
    fly(w, 1.5);
    assert_int_equal(outcome(left, right), 1);
    assert_int_equal(left->unit.count.swaps, 1);
    assert_int_equal(right->unit.count.swaps, 1);
    assert_int_equal(left->unit.count.commands_refused + right->unit.count.commands_refused, 0);
    close_wire(w);
}

TEST(a_display_is_not_its_own_partner)
{
    struct wire *w = calloc(1, sizeof *w);
    assert_non_null(w);
    struct rig *r = sit(w, LEFT, LEFT);
    command(r, range_10);
    fly(w, 0.1);
    w->sent = 0;
    press_osb(r, 15);
    fly(w, 0.1);
    assert_true(says_no_swap(r));
    assert_int_equal(w->sent, 0);
    close_wire(w);
}

/* It answers, takes and asks as a partner would, and names the left one as its partner. */
TEST(a_rival_changes_nothing)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    struct rig *rival = sit(w, RIVAL, LEFT);
    fly(w, 0.1);
    const struct lm_page before = rival->unit.page;
    press_osb(left, 15);
    fly(w, 0.3);
    assert_int_equal(outcome(left, right), 1);
    assert_memory_equal(&rival->unit.page.format, &before.format, LM_PAGE_BYTES);
    press_osb(rival, 15);
    fly(w, 0.7);
    assert_true(says_no_swap(rival));
    assert_int_equal(outcome(left, right), 1);
    assert_true(left->unit.swap.refused > 0 && right->unit.swap.refused > 0);
    close_wire(w);
}

TEST(a_full_bus_only_delays_the_exchange)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    w->busy = 30;
    press_osb(left, 15);
    fly(w, 0.3);
    assert_int_equal(outcome(left, right), 1);
    close_wire(w);
}

/* ---- hostile frames ---- */

static struct lm_can_frame frame_of(uint8_t service, uint8_t code, const uint8_t *bytes)
{
    struct lm_can_frame f = {
        .id = LM_SWAP_ID, .length = 8, .data = {RIGHT, LM_CANAS_UCHAR4, service, code}};
    memcpy(f.data + 4, bytes, 4);
    return f;
}

/* The right one's part, played by hand: settings, and the act ASK. */
static void offer(struct seat *s, const struct lm_settings *settings, uint8_t code)
{
    const uint8_t to[4] = {LEFT, 0, 0, 0};
    for (uint32_t i = 0; i < LM_SWAP_PARTS; i++) {
        const struct lm_can_frame f = frame_of((uint8_t)i, code, (const uint8_t *)settings + 4 * i);
        put_to(s, &f);
    }
    const struct lm_can_frame ask = frame_of(LM_SWAP_ASK, code, to);
    put_to(s, &ask);
}

static struct wire *begin_alone(struct rig **left)
{
    struct wire *w = calloc(1, sizeof *w);
    assert_non_null(w);
    *left = sit(w, LEFT, RIGHT);
    fly(w, 0.1);
    return w;
}

TEST(a_page_that_this_radar_does_not_have_is_not_answered)
{
    static const struct {
        uint8_t at, value;
    } wrong[] = {{0, 5},  {1, 2},   {2, 4},    {3, 4},   {4, 9},   {4, 255}, {5, 3},  {6, 2},
                 {13, 2}, {14, 31}, {14, 225}, {15, 21}, {17, 11}, {18, 3},  {20, 9}, {23, 2}};
    struct rig *left;
    struct wire *w = begin_alone(&left);
    struct lm_settings good = {.page = {0}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct lm_settings s = good;
        s.page[wrong[i].at] = wrong[i].value;
        offer(&w->seat[0], &s, (uint8_t)(i + 1));
        fly(w, 0.05);
        assert_int_equal(w->sent, 0);
        assert_int_equal(left->unit.swap.refused, i + 1);
    }
    good.cursor.latitude = FX_BAM_90 + 1u;
    offer(&w->seat[0], &good, 77);
    fly(w, 0.05);
    assert_int_equal(w->sent, 0);
    good.cursor.latitude = FX_BAM_90;
    offer(&w->seat[0], &good, 78);
    fly(w, 0.05);
    assert_int_equal(w->sent, LM_SWAP_PARTS + 1);
    close_wire(w);
}

/* One frame of an offer is not what it should be: part 3 of the settings, or ASK. Those that are no
 * frames of a swap at all are not even counted. */
TEST(an_offer_with_a_frame_of_another_form_is_not_answered)
{
    static const struct {
        struct lm_can_frame change; /* flags and bits that differ */
        uint8_t counted;
    } forms[] = {{{.id = 1}, 0},
                 {{.is_extended = true}, 0},
                 {{.is_remote = true}, 0},
                 {{.is_error = true}, 0},
                 {{.length = 8 ^ 7}, 1},
                 {{.data = {RIGHT ^ RIVAL}}, 1},
                 {{.data = {0, LM_CANAS_UCHAR4 ^ LM_CANAS_LONG}}, 1}};
    struct rig *left;
    struct wire *w = begin_alone(&left);
    struct seat *s = &w->seat[0];
    const struct lm_settings good = {.page = {0}};
    for (uint32_t i = 0; i < 2 * sizeof forms / sizeof *forms; i++) {
        const struct lm_can_frame *change = &forms[i / 2].change;
        const uint32_t from = s->head, refused = left->unit.swap.refused;
        const uint32_t changed = i % 2 == 0 ? LM_SWAP_PARTS : 3;
        offer(s, &good, (uint8_t)(i + 1));
        struct lm_can_frame *f = &s->waiting[(from + changed) % QUEUE];
        f->id ^= change->id;
        f->length ^= change->length;
        f->is_extended = change->is_extended;
        f->is_remote = change->is_remote;
        f->is_error = change->is_error;
        f->data[0] ^= change->data[0];
        f->data[1] ^= change->data[1];
        fly(w, 0.05);
        assert_int_equal(w->sent, 0);
        /* Of settings that are not whole ASK is refused. */
        assert_int_equal(left->unit.swap.refused - refused, forms[i / 2].counted + i % 2);
    }
    offer(s, &good, 100);
    s->waiting[(s->head - 1) % QUEUE].data[4] = RIVAL; /* it asks another one */
    fly(w, 0.05);
    assert_int_equal(w->sent, 0);
    offer(s, &good, 101);
    fly(w, 0.05);
    assert_int_equal(w->sent, LM_SWAP_PARTS + 1);
    close_wire(w);
}

/* TAKE is for the exchange that was answered, and for no other. Where it comes again because TAKEN
 * was lost, it is answered again, and no page changes twice. */
TEST(a_take_counts_once_and_for_its_own_exchange)
{
    static const uint8_t to_left[4] = {LEFT, 0, 0, 0};
    struct rig *left;
    struct wire *w = begin_alone(&left);
    const struct lm_settings sea_page = {.page = {0, LM_PICTURE_SECTOR, LM_SECTOR_SEA}};
    const struct lm_can_frame take = frame_of(LM_SWAP_TAKE, 7, to_left),
                              of_another = frame_of(LM_SWAP_TAKE, 8, to_left),
                              taken = frame_of(LM_SWAP_TAKEN, 7, to_left),
                              answer = frame_of(LM_SWAP_ANSWER, 7, to_left);
    put_to(&w->seat[0], &take); /* of no exchange */
    fly(w, 0.05);
    assert_int_equal(left->unit.swap.refused, 1);
    offer(&w->seat[0], &sea_page, 7);
    fly(w, 0.05);
    const struct lm_can_frame early[] = {of_another, taken, answer};
    for (uint32_t i = 0; i < 3; i++) {
        put_to(&w->seat[0], &early[i]);
        fly(w, 0.02);
        assert_int_equal(left->unit.swap.refused, 2 + i);
        assert_int_equal(left->unit.count.swaps, 0);
    }
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t sent = w->sent;
        put_to(&w->seat[0], &take);
        fly(w, 0.05);
        assert_int_equal(left->unit.count.swaps, 1);
        assert_int_equal(w->sent, sent + 1); /* TAKEN */
        assert_int_equal(left->unit.page.mode, LM_SECTOR_SEA);
    }
    assert_int_equal(left->unit.swap.refused, 4);
    /* Another page comes behind the one that was answered, but nobody asked with it. */
    struct seat *seat = &w->seat[0];
    offer(seat, &sea_page, 9);
    fly(w, 0.05);
    offer(seat, &sea_page, 10);
    seat->head--; /* without ASK */
    const struct lm_can_frame unasked = frame_of(LM_SWAP_TAKE, 10, to_left);
    put_to(seat, &unasked);
    fly(w, 0.05);
    assert_int_equal(left->unit.count.swaps, 1);
    assert_int_equal(left->unit.swap.refused, 5);
    close_wire(w);
}

/* Codes are of eight bits: the 256th exchange has 0. An offer of 255 came before it, but for one
 * part; nothing of it stands in for what the answer leaves out. */
TEST(an_offer_and_an_answer_are_never_put_together_to_one_page)
{
    struct rig *left;
    struct wire *w = begin_alone(&left);
    struct seat *s = &w->seat[0];
    const struct lm_settings sea_page = {.page = {0, LM_PICTURE_SECTOR, LM_SECTOR_SEA}};
    const uint8_t *bytes = (const uint8_t *)&sea_page;
    const uint32_t last = LM_SWAP_PARTS - 1;
    const struct lm_can_frame rest =
        frame_of((uint8_t)(LM_SWAP_OF_ANSWER + last), 0, bytes + 4 * last);
    const struct lm_can_frame answer = frame_of(LM_SWAP_ANSWER, 0, (const uint8_t[4]){LEFT});
    left->unit.swap.begun = 255;
    offer(s, &sea_page, 255);
    s->head -= 2; /* neither the last part nor ASK */
    fly(w, 0.05);
    press_osb(left, 15);
    fly(w, 0.05);
    assert_int_equal(w->sent, LM_SWAP_PARTS + 1);
    put_to(s, &rest);
    put_to(s, &answer);
    fly(w, 0.3);
    assert_int_equal(w->sent, LM_SWAP_PARTS + 1); /* no TAKE */
    assert_int_equal(left->unit.swap.refused, 1);
    fly(w, 0.3);
    assert_true(says_no_swap(left));
    close_wire(w);
}

/* Whole and sound, but of the exchange before. */
TEST(an_answer_to_another_exchange_is_not_taken)
{
    struct rig *left;
    struct wire *w = begin_alone(&left);
    struct seat *s = &w->seat[0];
    const struct lm_settings sea_page = {.page = {0, LM_PICTURE_SECTOR, LM_SECTOR_SEA}};
    press_osb(left, 15);
    fly(w, 0.05);
    const uint8_t code = left->unit.swap.exchange;
    for (int late = 1; late >= 0; late--) {
        offer(s, &sea_page, (uint8_t)(code - late));
        for (uint32_t i = 0; i <= LM_SWAP_PARTS; i++) { /* as an answer */
            struct lm_can_frame *f = &s->waiting[(s->head - 1 - i) % QUEUE];
            f->data[2] = i == 0 ? LM_SWAP_ANSWER : (uint8_t)(f->data[2] + LM_SWAP_OF_ANSWER);
        }
        fly(w, 0.05);
        assert_int_equal(left->unit.swap.refused, 1);
        assert_int_equal(w->sent, LM_SWAP_PARTS + 1 + (late ? 0 : 1)); /* TAKE of its own alone */
    }
    close_wire(w);
}

TEST(on_a_bus_that_only_hears_swap_says_that_it_cannot)
{
    struct rig *left;
    struct wire *w = begin_alone(&left);
    left->board.can.send = NULL;
    press_osb(left, 15);
    fly(w, 0.6);
    assert_true(says_no_swap(left));
    close_wire(w);
}

TEST(a_cursor_that_stays_ahead_goes_over_as_such)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    command(left, lm_control_button(true, 8));
    command(left, lm_control_button(false, 8));
    fly(w, 0.1);
    press_osb(left, 15);
    fly(w, 0.1);
    assert_int_equal(outcome(left, right), 1);
    const struct lm_position there = right->unit.cursor.position, here = left->unit.cursor.position;
    fly(w, 0.5);
    assert_int_not_equal(right->unit.cursor.position.latitude, there.latitude);
    assert_memory_equal(&left->unit.cursor.position, &here, sizeof here);
    close_wire(w);
}

/* Before the first position a page has no place of a cursor. The other one's goes home then. */
TEST(a_page_without_a_cursor_sends_the_other_ones_home)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    left->bus.is_down = 1;
    assert_int_equal(lm_unit_init(&left->unit, &left->board.lent), LM_OK);
    command(right, (struct lm_control){.kind = LM_CONTROL_CURSOR,
                                       .cursor = {FX_BAM_DEG(46), FX_BAM_DEG(221) / 20}});
    fly(w, 0.1);
    assert_false(left->unit.cursor.is_placed || right->unit.cursor.is_home);
    press_osb(left, 15);
    fly(w, 0.3);
    assert_int_equal(left->unit.count.swaps, 1);
    assert_int_equal(right->unit.count.swaps, 1);
    assert_true(right->unit.cursor.is_placed && right->unit.cursor.is_home);
    assert_int_equal(left->unit.cursor.position.latitude, FX_BAM_DEG(46));
    close_wire(w);
}

TEST(exchanges_go_on_when_their_codes_begin_anew)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    left->unit.swap.begun = 253;
    for (int i = 1; i <= 4; i++) { /* 254, 255, 0, 1 */
        press_osb(left, 15);
        fly(w, 0.1);
        assert_int_equal(outcome(left, right), i % 2);
        assert_int_equal(left->unit.count.swaps, i);
    }
    assert_int_equal(left->unit.count.commands_refused, 0);
    close_wire(w);
}

/* The rest of the settings may hold anything: it is brought into range. */
TEST(numbers_beyond_their_range_do_no_harm)
{
    struct rig *left;
    struct wire *w = begin_alone(&left);
    struct lm_settings s = {.page = {0, LM_PICTURE_PATCH},
                            .hidden = UINT32_MAX,
                            .tilt_tenths = INT32_MIN,
                            .centre = {0x7fffffff, 0x80000000},
                            .cell_mm = UINT32_MAX,
                            .range_m = UINT32_MAX,
                            .height_m_q6 = INT32_MIN};
    s.page[8] = 1;
    offer(&w->seat[0], &s, 1);
    fly(w, 0.05);
    const struct lm_can_frame take = frame_of(LM_SWAP_TAKE, 1, (const uint8_t[]){LEFT, 0, 0, 0});
    put_to(&w->seat[0], &take);
    fly(w, 1);
    assert_int_equal(left->unit.count.swaps, 1);
    assert_int_equal(left->unit.page.picture, LM_PICTURE_SECTOR); /* no such patch */
    assert_int_equal(left->unit.page.hidden, (1u << LM_OSBS) - 1);
    assert_in_range(left->unit.page.cell_mm, 100, 100000);
    assert_in_range(-left->unit.page.tilt_tenths, 1, 900);
    close_wire(w);
}

TEST(any_frames_at_all_are_safe)
{
    struct rig *left, *right;
    struct wire *w = begin_pair(&left, &right);
    w->seed = 7;
    for (uint32_t round = 0; round < 4000; round++) {
        struct lm_can_frame f = frame_of(0, 0, (const uint8_t[4]){LEFT, 0, 0, 0});
        for (uint32_t i = 0; i < 8; i++) {
            f.data[i] = draw(w) < 60 ? (uint8_t)draw(w) : f.data[i];
        }
        f.data[2] = (uint8_t)(draw(w) % 40);
        f.data[3] = (uint8_t)(left->unit.swap.exchange + (draw(w) < 30));
        f.length = draw(w) < 10 ? (uint8_t)(draw(w) % 9) : 8;
        f.is_extended = draw(w) < 5;
        f.is_remote = draw(w) < 5;
        put_to(&w->seat[0], &f);
        if (draw(w) < 8) {
            press_osb(draw(w) % 2 ? left : right, 15);
        }
        fly(w, 0.004);
        const struct lm_page *p = &left->unit.page;
        assert_true(p->format < LM_FORMATS && p->mode < LM_SECTOR_CHOICES &&
                    p->range_index <= lm_page_range_last(p));
    }
    assert_true(left->unit.swap.refused > 100);
    close_wire(w);
}

TEST(a_display_without_a_number_is_nobodys_partner)
{
    struct wire *w = calloc(1, sizeof *w);
    assert_non_null(w);
    struct rig *r = sit(w, 0, RIGHT);
    const struct lm_settings s = {.page = {0}};
    offer(&w->seat[0], &s, 1);
    fly(w, 0.1);
    press_osb(r, 15);
    fly(w, 0.1);
    assert_int_equal(w->sent, 0);
    assert_int_equal(r->unit.count.commands_refused, 1);
    close_wire(w);
}
