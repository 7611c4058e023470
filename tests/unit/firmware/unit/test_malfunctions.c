/* What each malfunction of an exercise does to the picture, and that none is taken for a fault. */
#include "bus_frames.h"
#include "check.h"
#include "lm/bit.h"
#include "unit_rig.h"

#include <math.h>
#include <string.h>

enum { ROW_NOW = 16, ROW_BROKEN = 22 };

/* A rig whose bus breaks one thing, or two, from the beginning on. */
struct broken {
    struct rig *r;
    struct lm_can can;
    struct {
        int kind; /* -1: nothing */
        double value;
    } what[2];
    uint64_t told_us;
    int next;
};

static int hear(void *ctx, struct lm_can_frame *frame)
{
    struct broken *b = ctx;
    while (b->next < 2) {
        const int i = b->next++;
        if (b->what[i].kind >= 0) {
            *frame =
                bus_frame(1825, LM_CANAS_FLOAT, 0, bus_float_bits(b->what[i].value), b->r->now_us);
            frame->data[2] = (uint8_t)b->what[i].kind;
            return 1;
        }
    }
    if (b->r->now_us >= b->told_us + 1000000) {
        b->told_us = b->r->now_us;
        b->next = 0;
    }
    return b->r->board.can.receive(b->r, frame);
}

static void fly(struct broken *b, int kind, double value, int kind2, double value2, double seconds)
{
    *b = (struct broken){.r = make_rig(), .what = {{kind, value}, {kind2, value2}}};
    b->can = (struct lm_can){.ctx = b, .receive = hear};
    b->r->board.lent.can = &b->can;
    assert_int_equal(lm_unit_init(&b->r->unit, &b->r->board.lent), LM_OK);
    command(b->r, range_10);
    run(b->r, seconds);
}

/* A sound one, and one with a malfunction, in the same flight. */
struct both {
    struct broken sound, broken;
};

static void fly_both(struct both *p, int kind, double value, int kind2, double value2)
{
    fly(&p->sound, -1, 0, -1, 0, 4);
    fly(&p->broken, kind, value, kind2, value2, 4);
}

static void end(struct both *p)
{
    free_rig(p->sound.r);
    free_rig(p->broken.r);
}

/* Powers of the line drawn last: without its noise, in the stages' own units. */
static double level_db(const struct broken *b, uint32_t bin)
{
    return b->r->unit.picture.sector.level_db_q8[bin] / 256.0;
}

/* The law, bin by bin: 10 log10(S / L + N n) where the sound one has 10 log10(S + N). The draw is
 * the same. Where the sound signal is far above the noise it falls by L; where there is none, the
 * noise rises by n. */
static void check_law(double loss_db, double rise_db)
{
    struct both p;
    fly_both(&p, loss_db > 90 ? LM_MALFUNCTION_NO_TRANSMIT : LM_MALFUNCTION_WEAK_TRANSMIT,
             loss_db > 90 ? 0 : loss_db, LM_MALFUNCTION_NOISE, rise_db);
    const struct lm_sector *s = &p.sound.r->unit.picture.sector;
    const struct lm_sector *t = &p.broken.r->unit.picture.sector;
    assert_int_equal(s->line, t->line);
    const int16_t *draw = NULL;
    (void)draw;
    uint32_t compared = 0;
    for (uint32_t i = 0; i < s->slant.cells; i++) {
        const double fall = s->receiver.fall_db_q8[i] / 256.0;
        const double signal = s->power_q24[i] / 16777216.0;
        const double sound = pow(10, (level_db(&p.sound, i) + fall) / 10);
        const double noise = sound - signal; /* with its draw */
        if (noise < sound / 20) {
            continue; /* what is left of a difference says little */
        }
        const double law = signal * pow(10, -loss_db / 10) + noise * pow(10, rise_db / 10);
        assert_true(fabs(level_db(&p.broken, i) + fall - 10 * log10(law)) < 0.6);
        compared++;
    }
    assert_true(compared > 50);
    end(&p);
}

TEST(a_weak_transmitter_lowers_the_signal_by_its_loss)
{
    check_law(10, 0);
    check_law(25, 0);
}

TEST(a_noisy_receiver_raises_the_noise_by_its_amount)
{
    check_law(0, 6);
    check_law(0, 20);
}

TEST(without_a_transmitter_there_is_noise_and_nothing_else)
{
    check_law(96, 0);
    check_law(96, 10);
    struct broken b;
    fly(&b, LM_MALFUNCTION_NO_TRANSMIT, 0, -1, 0, 4);
    const uint32_t refused = b.r->unit.count.commands_refused;
    command(b.r, patch_here);
    run(b.r, 0.1);
    assert_int_equal(b.r->unit.count.commands_refused, refused + 1);
    assert_int_equal(b.r->unit.refusal, LM_REFUSED_SILENT);
    free_rig(b.r);
}

static double mean_grey(const struct rig *r)
{
    double sum = 0;
    for (size_t i = 0; i < sizeof r->plane; i++) {
        sum += r->plane[i];
    }
    return sum / sizeof r->plane;
}

static void break_in_flight(int kind, double amount)
{
    struct broken b;
    struct both p;
    fly(&b, -1, 0, -1, 0, 4);
    const double sound = mean_grey(b.r);
    b.what[0].kind = kind;
    b.what[0].value = amount;
    run(b.r, 8);
    fly_both(&p, kind, amount, -1, 0);
    run(p.broken.r, 8);
    const double late = mean_grey(b.r), early = mean_grey(p.broken.r);
    print_message("# mean grey %.1f sound, %.1f broken in flight, %.1f before\n", sound, late,
                  early);
    assert_true(fabs(late - early) < 0.02 * early);
    assert_true(fabs(late - sound) > 0.05 * sound);
    b.what[0].kind = -1;
    run(b.r, 20); /* it ages, and a sweep is begun and ended */
    run(p.sound.r, 28);
    assert_true(fabs(mean_grey(b.r) - mean_grey(p.sound.r)) < 0.05 * sound);
    free_rig(b.r);
    end(&p);
}

TEST(what_breaks_in_flight_is_broken_from_the_next_sweep_on)
{
    break_in_flight(LM_MALFUNCTION_WEAK_TRANSMIT, 20);
    break_in_flight(LM_MALFUNCTION_NOISE, 25);
}

/* A patch under half the greys of its law: what is there is darker by what the transmitter lost. */
TEST(a_weak_transmitter_darkens_a_patch_and_the_next_one_with_a_sound_one_is_as_before)
{
    struct both p;
    fly_both(&p, LM_MALFUNCTION_WEAK_TRANSMIT, 12, -1, 0);
    struct rig *pair[2] = {p.sound.r, p.broken.r};
    double grey[2], again[2];
    for (int i = 0; i < 2; i++) {
        command(pair[i], patch_here);
        run(pair[i], 5);
        assert_int_equal(pair[i]->unit.picture.sar.line, pair[i]->unit.picture.sar.lines);
        grey[i] = mean_grey(pair[i]);
    }
    print_message("# mean grey %.1f, with a weak transmitter %.1f\n", grey[0], grey[1]);
    assert_true(grey[1] < 0.8 * grey[0]);
    p.broken.what[0].kind = -1;
    for (int i = 0; i < 2; i++) {
        run(pair[i], 10);
        command(pair[i], (struct lm_control){.kind = LM_CONTROL_DROP});
        run(pair[i], 4);
        again[i] = mean_grey(pair[i]);
    }
    assert_true(fabs(again[0] - again[1]) < 0.1 * again[0]);
    end(&p);
}

/* Azimuth of a pixel from the nose, which points up from the sector's apex. */
static double azimuth_deg(const struct broken *b, int x, int y)
{
    const struct lm_view *v = &b->r->unit.picture.view;
    const struct lm_point apex = lm_view_point(v, (struct lm_offset){0, 0});
    return atan2(x - apex.x, apex.y - y) * 57.29577951308232;
}

static double range_px(const struct broken *b, int x, int y)
{
    const struct lm_point apex = lm_view_point(&b->r->unit.picture.view, (struct lm_offset){0, 0});
    return hypot(x - apex.x, apex.y - y);
}

TEST(a_stuck_antenna_paints_one_azimuth)
{
    for (double at = -40; at <= 40; at += 20) {
        struct broken b;
        fly(&b, LM_MALFUNCTION_STUCK, at, -1, 0, 4);
        uint32_t lit = 0;
        for (int y = 0; y < HEIGHT; y++) {
            for (int x = 0; x < WIDTH; x++) {
                if (b.r->plane[y * WIDTH + x] != 0 && range_px(&b, x, y) > 40) {
                    assert_true(fabs(azimuth_deg(&b, x, y) - at) < 1.2);
                    lit++;
                }
            }
        }
        assert_true(lit > 50);
        struct lm_symbols symbols = {0};
        lm_picture_describe(&b.r->unit.picture, &symbols);
        assert_true(fabs(symbols.antenna_azimuth * (360 / 4294967296.0) - at) < 1e-3);
        free_rig(b.r);
    }
}

TEST(a_stuck_antenna_points_at_no_patch)
{
    struct broken b;
    fly(&b, LM_MALFUNCTION_STUCK, 0, -1, 0, 4);
    command(b.r, patch_here);
    run(b.r, 0.1);
    assert_int_equal(b.r->unit.refusal, LM_REFUSED_GIMBAL);
    free_rig(b.r);
}

/* Mean grey by azimuth, of one degree each, within +-50 degrees. */
static void profile(const struct broken *b, double mean[101])
{
    uint32_t count[101] = {0};
    memset(mean, 0, 101 * sizeof *mean);
    for (int y = 0; y < HEIGHT; y++) {
        for (int x = 0; x < WIDTH; x++) {
            const int at = (int)lround(azimuth_deg(b, x, y)) + 50;
            const double range = range_px(b, x, y);
            if (at >= 0 && at <= 100 && range > 60 && range < 300) {
                mean[at] += b->r->plane[y * WIDTH + x];
                count[at]++;
            }
        }
    }
    for (int i = 0; i < 101; i++) {
        mean[i] /= count[i] ? count[i] : 1;
    }
}

TEST(a_lost_sector_is_black_between_its_edges)
{
    struct both p;
    fly_both(&p, LM_MALFUNCTION_LOST_FROM, -20, LM_MALFUNCTION_LOST_TO, 10);
    double sound[101], broken[101];
    profile(&p.sound, sound);
    profile(&p.broken, broken);
    for (int i = 0; i < 101; i++) {
        const int at = i - 50;
        if (at > -19 && at < 9) {
            assert_true(broken[i] == 0 && sound[i] > 0);
        } else if (at < -21 || at > 11) {
            assert_true(broken[i] == sound[i]);
        }
    }
    end(&p);
    struct broken half; /* one edge alone says nothing */
    fly(&half, LM_MALFUNCTION_LOST_FROM, -20, -1, 0, 4);
    profile(&half, broken);
    assert_true(broken[50] > 0);
    free_rig(half.r);
}

/* Where the drifted picture fits the sound one best, by the correlation of their pixels turned
 * about the apex. */
TEST(a_drifting_antenna_turns_the_picture)
{
    struct both p;
    fly_both(&p, LM_MALFUNCTION_DRIFT, 7, -1, 0);
    double best = -1;
    int best_deg = 0;
    for (int turn = -12; turn <= 12; turn++) {
        double sum_ab = 0, sum_aa = 0, sum_bb = 0;
        const double sine = sin(turn / 57.29577951308232), cosine = cos(turn / 57.29577951308232);
        const struct lm_point apex =
            lm_view_point(&p.sound.r->unit.picture.view, (struct lm_offset){0, 0});
        for (int y = 20; y < HEIGHT - 20; y++) {
            for (int x = 20; x < WIDTH - 20; x++) {
                const double dx = x - apex.x, dy = y - apex.y;
                const int u = apex.x + (int)lround(dx * cosine - dy * sine);
                const int v = apex.y + (int)lround(dx * sine + dy * cosine);
                if (fabs(azimuth_deg(&p.sound, x, y)) > 40 || u < 0 || u >= WIDTH || v < 0 ||
                    v >= HEIGHT) {
                    continue;
                }
                const double a = p.sound.r->plane[y * WIDTH + x];
                const double b = p.broken.r->plane[v * WIDTH + u];
                sum_ab += a * b;
                sum_aa += a * a;
                sum_bb += b * b;
            }
        }
        const double fit = sum_ab / sqrt(sum_aa * sum_bb + 1);
        best_deg = fit > best ? turn : best_deg;
        best = fmax(fit, best);
    }
    assert_int_equal(best_deg, 7); /* to the right */
    end(&p);
}

TEST(frozen_video_stays_while_the_antenna_turns)
{
    struct broken b;
    fly(&b, -1, 0, -1, 0, 4);
    b.what[0].kind = LM_MALFUNCTION_FROZEN;
    run(b.r, 1.1);
    const uint32_t sum = plane_sum(b.r), lines = b.r->unit.count.lines;
    run(b.r, 4);
    assert_int_equal(plane_sum(b.r), sum);
    assert_true(b.r->unit.count.lines > lines + 900);
    b.what[0].kind = -1;
    run(b.r, 13); /* it ends with its silence */
    assert_int_not_equal(plane_sum(b.r), sum);
    free_rig(b.r);
}

/* The beam's axis by its fan: as if the operator had commanded so much more. The mark tells what
 * was commanded. */
TEST(a_tilt_offset_lifts_the_beam_and_not_its_mark)
{
    struct both p;
    fly_both(&p, LM_MALFUNCTION_TILT, 3, -1, 0);
    const struct lm_sector *s = &p.sound.r->unit.picture.sector;
    const struct lm_sector *t = &p.broken.r->unit.picture.sector;
    assert_int_equal(s->tilt, t->tilt);
    const double high = atan(s->fan.high_q20 / 1048576.0), low = atan(s->fan.low_q20 / 1048576.0);
    assert_true(fabs(atan(t->fan.high_q20 / 1048576.0) - high - 3 / 57.29577951308232) < 2e-4);
    assert_true(fabs(atan(t->fan.low_q20 / 1048576.0) - low - 3 / 57.29577951308232) < 2e-4);
    assert_true(lit_pixels(p.broken.r) <
                lit_pixels(p.sound.r)); /* the ground near by is below it */
    end(&p);
}

TEST(a_dead_key_does_nothing_and_others_do)
{
    struct broken b;
    fly(&b, LM_MALFUNCTION_KEY, 19, -1, 0, 2);
    const uint8_t scale = b.r->unit.page.range_index;
    const uint32_t refused = b.r->unit.count.commands_refused;
    press(b.r, 19);
    assert_int_equal(b.r->unit.page.range_index, scale);
    press(b.r, 20);
    assert_int_not_equal(b.r->unit.page.range_index, scale);
    assert_int_equal(b.r->unit.count.commands_refused, refused);
    free_rig(b.r);
}

/* All at once: the flag and the BIT page tell them, the fault log and the glass do not. A true
 * fault is told beside them. */
TEST(no_malfunction_is_a_fault_and_none_hides_one)
{
    struct broken b;
    fly(&b, LM_MALFUNCTION_NOISE, 20, LM_MALFUNCTION_TILT, 2, 3);
    struct lm_unit *u = &b.r->unit;
    assert_true(u->flags & LM_FLAG_MALFUNCTION);
    assert_false(u->flags & LM_FLAG_EXERCISE);
    assert_string_equal(lm_bit_row(u, ROW_NOW).words, "NOW  NO FAULT");
    assert_string_equal(lm_bit_row(u, ROW_BROKEN).words, "EXC RX TILT");
    const struct lm_fault *last = lm_fault_log_at(&u->faults, 0);
    assert_true(last == NULL || last->flag != 14);
    b.r->bus.stop_us = b.r->now_us; /* true: the aircraft's own navigation is silent */
    run(b.r, 0.8);
    assert_true(u->flags & LM_FLAG_NAV_STALE);
    assert_int_equal(lm_fault_log_at(&u->faults, 0)->flag, 0);
    assert_string_equal(lm_bit_row(u, ROW_NOW).words, "NOW  NAV");
    b.what[0].kind = b.what[1].kind = -1;
    run(b.r, 5);
    assert_true(u->flags & LM_FLAG_EXERCISE); /* its sender is silent */
    run(b.r, 8);
    assert_false(u->flags & (LM_FLAG_MALFUNCTION | LM_FLAG_EXERCISE));
    assert_string_equal(lm_bit_row(u, ROW_BROKEN).words, "");
    u->malfunctions.now.set = (1 << LM_MALFUNCTIONS) - 1;
    assert_string_equal(lm_bit_row(u, ROW_BROKEN).words,
                        "EXC TX WEAK RX STUCK DRIFT SECT VIDEO TILT KEY");
    free_rig(b.r);
}
