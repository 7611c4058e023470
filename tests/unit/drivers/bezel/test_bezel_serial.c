/* A bezel on a serial line: its sentences, and everything that is none. */
#include "drv/bezel_serial.h"

#include "hs/rng.h"

#include <stdio.h>
#include <string.h>

#include "check.h"
#include "control_asserts.h"

struct line {
    const char *bytes;
    size_t length, next;
};

static int get(void *ctx)
{
    struct line *l = ctx;
    return l->next < l->length ? (uint8_t)l->bytes[l->next++] : -1;
}

static struct drv_bezel_serial bezel;
static struct line line;

/* What the bezel makes of these bytes: the number of controls, the last of them in *control. */
static int take(const char *bytes, size_t length, struct lm_control *control)
{
    int count = 0;
    line = (struct line){bytes, length, 0};
    while (line.next < line.length) {
        count += bezel.port.next(bezel.port.ctx, control);
    }
    return count;
}

static int start(void **state)
{
    (void)state;
    drv_bezel_serial_init(&bezel, get, &line);
    return 0;
}

TEST_WITH(each_sentence_means_its_control, start, NULL)
{
    const struct {
        const char *text;
        struct lm_control control;
    } table[] = {{"$D12*47\r\n", lm_control_button(true, 12)},
                 {"$U12*56\r\n", lm_control_button(false, 12)},
                 {"$K-500*53\n", lm_control_knob(-500)},
                 {"$S100,-20*61\n", lm_control_slew(100, -20)},
                 {"$S-1000,1000*52", lm_control_slew(-1000, 1000)},
                 {"$T*54", lm_control_designate()},
                 {"$X*58", lm_control_drop()}};
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        struct lm_control c;
        assert_int_equal(take(table[i].text, strlen(table[i].text), &c), 1);
        assert_same_control(&c, table[i].control);
    }
    assert_int_equal(bezel.count.malformed, 0);
}

TEST_WITH(what_is_no_sentence_is_counted_and_the_next_one_heard, start, NULL)
{
    /* The sums are right where it is the text that is wrong. */
    const char *const bad[] = {"$D12*48",  "$D0*74",    "$D29*4F",  "$D*44",
                               "$*00",     "$K1001*4B", "$K--5*7E", "$S100*62",
                               "$Q*51",    "$T1*65",    "$D12*4G",  "$D12",
                               "$D12x*3F", "$K5,5*67",  "$S1,*4E",  "$D123456789012345678*00"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct lm_control c;
        char both[64];
        snprintf(both, sizeof both, "%s\r\n$T*54\r\n", bad[i]);
        start(NULL);
        if (take(both, strlen(both), &c) != 1 || bezel.count.malformed != 1) {
            fail_msg("%s: %u malformed", bad[i], bezel.count.malformed);
        }
        assert_int_equal(c.kind, LM_CONTROL_DESIGNATE);
    }
}

TEST_WITH(any_changed_byte_is_found_or_changes_nothing, start, NULL)
{
    static const char bytes[] = "$S100,-20*61\r\n";
    struct lm_control meant;
    assert_int_equal(take(bytes, strlen(bytes), &meant), 1);
    for (size_t i = 0; i < strlen(bytes); i++) {
        for (int bit = 0; bit < 8; bit++) {
            struct lm_control c;
            char changed[sizeof bytes];
            memcpy(changed, bytes, sizeof bytes);
            changed[i] = (char)(changed[i] ^ 1 << bit);
            start(NULL);
            if (take(changed, strlen(bytes), &c) == 1) {
                assert_same_control(&c, meant);
            }
        }
    }
}

static void assert_in_bounds(const struct lm_control *c)
{
    assert_true(c->kind >= LM_CONTROL_DOWN && c->kind <= LM_CONTROL_DROP);
    if (c->kind <= LM_CONTROL_UP) {
        assert_in_range(c->button, 1, LM_BUTTONS);
    } else if (c->kind == LM_CONTROL_KNOB) {
        assert_in_range(c->knob + 1000, 0, 2000);
    } else if (c->kind == LM_CONTROL_SLEW) {
        assert_in_range(c->slew.x + 1000, 0, 2000);
        assert_in_range(c->slew.y + 1000, 0, 2000);
    }
}

TEST_WITH(noise_never_makes_a_control_out_of_range, start, NULL)
{
    static const char alphabet[] = "$*DUKSTX0123456789-,ABCDEF\r\n";
    struct hs_rng rng;
    hs_rng_seed(&rng, 1);
    int controls = 0;
    for (int run = 0; run < 20000; run++) {
        char bytes[32];
        struct lm_control c;
        for (size_t i = 0; i < sizeof bytes; i++) {
            bytes[i] = run % 2 ? alphabet[hs_rng_below(&rng, sizeof alphabet - 1)]
                               : (char)hs_rng_below(&rng, 256);
        }
        line = (struct line){bytes, sizeof bytes, 0};
        while (line.next < line.length) {
            if (bezel.port.next(bezel.port.ctx, &c) == 1) {
                controls++;
                assert_in_bounds(&c);
            }
        }
    }
    assert_true(bezel.count.malformed > 1000);
    assert_int_equal(bezel.count.sentences, controls);
}
