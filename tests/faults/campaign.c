/* Campaign of faults: a display unit in flight, to which drawn faults happen.
 *
 *   campaign COUNT [SEED]         print the table of docs/faults.md
 *   campaign COUNT SEED NUMBER    tell what run NUMBER of them does, ten times a second
 *
 * A run begins with a unit in good flight in one of several modes. One fault, or two at once, come
 * at a drawn time for a drawn while, and go. Ten times a second the run notes which flags are up
 * and what the picture does. Beside it flies a twin without faults. A run fails if
 *
 * - a flag of `must` is down though the fault has stood for MUST_MS, or all of `soon` are after
 *   SOON_MS;
 * - a flag is up that neither the twin has nor a fault of this run may raise;
 * - frames come, the sweep stands or is gone, and no flag says so;
 * - RECOVERY_S after the faults it has other flags than its twin, or another picture.
 *
 * SIGINT and SIGTERM end it behind the run under way, with the table of those before.
 * Exit code 0: no run failed; 1: some did, and each is named on standard error. */
#include "faults.h"

#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    LOOK_US = 100000,   /* between two looks at the unit */
    STANDING_LOOKS = 8, /* without a line: the sweep stands */
    DARK_PX = 200,      /* so few lit pixels: the picture is gone */
    SOON_MS = 1500,
    MUST_MS = 4000,
    RECOVERY_S = 12,  /* what a sweep of the widest sector takes, and a lit flag */
    STAYS_WELL_S = 4, /* a run ends when all was well for so long */
    BEGIN_MS = 1500,  /* the faults begin before */
    SHORT_MS = 50,
    LONG_MS = 8000, /* the faults' time */
    TILES = 44,     /* so few that tiles are read all the time */
    LOOKS = 300,    /* of a twin */
    BEHIND_BYTES = 4096,
    MODES = 6
};

enum {
    NAV = LM_FLAG_NAV_STALE | LM_FLAG_NAV_DEAD,
    EXERCISE = LM_FLAG_WEATHER | LM_FLAG_EXERCISE,
    /* A sweep that is joined late, or of which navigation left a part out, is judged by the rest.
     */
    LATE = LM_FLAG_OFF_MAP,
    OPERATOR = LM_FLAG_FROZEN | LM_FLAG_SILENT | LM_FLAG_UNABLE | LM_FLAG_OFF_MAP,
    /* What tells the operator that a sweep stands or is gone. */
    STANDS = NAV | LM_FLAG_DB | LM_FLAG_FROZEN | LM_FLAG_SILENT | LM_FLAG_POLE
};

/* What the picture does. */
enum picture { LIVE, STANDING, REMOVED, UNSEEN, PICTURES };
static const char *const picture_words[PICTURES] = {"goes on", "stands", "is removed", "no frame"};

struct kind_of_fault {
    const char *name;
    uint32_t must;     /* flags that are up after MUST_MS */
    uint32_t may;      /* others that can be */
    uint32_t soon;     /* of these flags at least one is up after SOON_MS */
    uint8_t pictures;  /* bits of enum picture that the fault can bring */
    bool changes_page; /* the operator's settings are others afterwards */
};

#define P(p) (1u << (p))
static const struct kind_of_fault kinds[KINDS] = {
    [READS_FAIL] = {"every read of the flash fails", 0, LM_FLAG_TILE, 0, P(LIVE), false},
    [READS_FAIL_SOME] = {"some reads fail", 0, LM_FLAG_TILE, 0, P(LIVE), false},
    [READS_LATE] = {"reads are late", 0, 0, 0, P(LIVE), false},
    [READS_NEVER] = {"a read does not end", 0, LM_FLAG_TILE, 0, P(LIVE), false},
    [READS_TORN] = {"reads bring half of the bytes", 0, LM_FLAG_TILE, 0, P(LIVE), false},
    [READS_FLIP] = {"bits of what is read are wrong", 0, LM_FLAG_TILE, 0, P(LIVE), false},
    [READS_REFUSED] = {"the flash takes no read", 0, LM_FLAG_TILE, 0, P(LIVE), false},
    [READS_ELSEWHERE] = {"reads bring bytes of another place", 0, LM_FLAG_TILE, 0, P(LIVE), false},
    [BUS_SILENT] = {"the bus is silent", LM_FLAG_NAV_DEAD | LM_FLAG_BUS,
                    NAV | LM_FLAG_BUS | EXERCISE, NAV, P(LIVE) | P(STANDING) | P(REMOVED), false},
    [BUS_DOWN] = {"the bus is down", LM_FLAG_NAV_DEAD | LM_FLAG_BUS, NAV | LM_FLAG_BUS | EXERCISE,
                  NAV, P(LIVE) | P(STANDING) | P(REMOVED), false},
    [BUS_FLOOD] = {"the bus is full of strangers' frames", 0, 0, 0, P(LIVE), false},
    [BUS_ERRORS] = {"the controller reports errors", 0, 0, 0, P(LIVE), false},
    [FRAMES_LOST] = {"some frames are lost", 0, NAV | EXERCISE | LATE, 0,
                     P(LIVE) | P(STANDING) | P(REMOVED), false},
    [FRAMES_OLD] = {"frames come with an old time", 0, NAV | EXERCISE | LATE, 0,
                    P(LIVE) | P(STANDING) | P(REMOVED), false},
    [FRAMES_AHEAD] = {"frames come with a time ahead", 0, NAV | EXERCISE | LATE, 0,
                      P(LIVE) | P(STANDING) | P(REMOVED), false},
    [SENDS_BUSY] = {"the bus takes no frame", 0, 0, 0, P(LIVE), false},
    [SENDS_FAIL] = {"sending fails", 0, 0, 0, P(LIVE), false},
    [QUESTIONS] = {"a node asks without a pause", 0, 0, 0, P(LIVE), false},
    [NO_POSITION] = {"no position comes", LM_FLAG_NAV_DEAD, NAV, NAV,
                     P(LIVE) | P(STANDING) | P(REMOVED), false},
    [NO_HEIGHT] = {"no height comes", 0, NAV, NAV, P(LIVE) | P(STANDING) | P(REMOVED), false},
    [NO_HEADING] = {"no heading comes", LM_FLAG_NAV_DEAD, NAV, NAV,
                    P(LIVE) | P(STANDING) | P(REMOVED), false},
    [NO_SPEED] = {"no speed and track come", 0, NAV, 0, P(LIVE) | P(STANDING) | P(REMOVED), false},
    [NO_ATTITUDE] = {"no pitch and roll come", 0, 0, 0, P(LIVE), false},
    [BAD_VALUES] = {"a quantity's values are impossible", 0, NAV | LATE, 0,
                    P(LIVE) | P(STANDING) | P(REMOVED), false},
    [STUCK_CODE] = {"a transmitter is stuck", 0, LM_FLAG_SENDER, LM_FLAG_SENDER, P(LIVE), false},
    [RIVAL] = {"a second node sends a quantity", 0, LM_FLAG_SENDER | NAV, LM_FLAG_SENDER, P(LIVE),
               false},
    [NO_WEATHER] = {"no weather comes", 0, LM_FLAG_WEATHER, 0, P(LIVE), false},
    [NO_EXERCISE] = {"no exercise clock comes", 0, LM_FLAG_EXERCISE | LATE, 0, P(LIVE), false},
    [NO_TARGETS] = {"no live targets come", 0, LM_FLAG_EXERCISE, 0, P(LIVE), false},
    [EXERCISE_LEAPS] = {"the exercise clock leaps", 0, LATE, 0, P(LIVE), false},
    [JUMP_NEAR] = {"the position jumps by a few km", 0, LM_FLAG_OFF_MAP, 0, P(LIVE), true},
    [JUMP_FAR] = {"the position jumps off the map", 0, LM_FLAG_OFF_MAP | LM_FLAG_POLE, 0,
                  P(LIVE) | P(REMOVED), true},
    [NO_SURFACE] = {"no surface is free", 0, 0, 0, P(UNSEEN), false},
    [SCREEN_FAILS] = {"the screen lends no surface", 0, 0, 0, P(UNSEEN), false},
    [SHOWING_FAILS] = {"the screen shows no picture", 0, 0, 0, P(LIVE) | P(UNSEEN), false},
    [SURFACE_LOST] = {"the screen's memory is lost", 0, 0, 0, P(LIVE) | P(UNSEEN), false},
    [KEY_STUCK] = {"a key is stuck", 0, OPERATOR, 0, P(LIVE) | P(STANDING) | P(REMOVED), true},
    [KEY_STORM] = {"all keys and knobs at once", 0, OPERATOR, 0, P(LIVE) | P(STANDING) | P(REMOVED),
                   true},
    [KEY_CHATTERS] = {"a key chatters", 0, OPERATOR, 0, P(LIVE) | P(STANDING) | P(REMOVED), true},
    [STICK_HELD] = {"the stick is held", 0, LM_FLAG_OFF_MAP, 0, P(LIVE), true},
    [BAD_IMAGE] = {"a second database is no database", 0, LM_FLAG_TILE | LATE, LM_FLAG_TILE,
                   P(LIVE), false},
    [BAD_CONTROLS] = {"controls out of their range", 0, OPERATOR, 0, P(LIVE), false},
    [STARVED] = {"steps come late", 0, NAV | LM_FLAG_BUS | EXERCISE | LATE, 0, P(LIVE) | P(UNSEEN),
                 false},
    [STOPPED] = {"no step comes", 0, NAV | LM_FLAG_BUS | EXERCISE | LATE, 0, P(LIVE) | P(REMOVED),
                 false},
    [LEAP] = {"the clock leaps", 0, NAV | LM_FLAG_BUS | EXERCISE | LATE, 0, P(LIVE) | P(REMOVED),
              false},
    [RESTART] = {"the unit restarts", 0, NAV | LM_FLAG_BUS | EXERCISE | LATE, 0,
                 P(LIVE) | P(REMOVED) | P(UNSEEN), true},
};

/* ---- one look at the unit ---- */

struct look {
    uint32_t flags, lit_px;
    enum picture picture;
    bool is_silent; /* the picture stands or is gone, and no word says so */
};

struct watch {
    uint32_t lines, frames;
    uint32_t still;  /* looks without a line */
    uint32_t unsaid; /* of them in a row, those without a word that says so */
};

static struct look look(const struct rig *r, struct watch *w)
{
    const struct lm_unit *u = &r->unit;
    /* A patch that is complete, and an antenna that stays on a target: its symbols say so. */
    const bool may_stand = u->page.picture == LM_PICTURE_PATCH || u->track.state >= LM_TRACK_HELD;
    const bool is_seen = u->count.frames != w->frames;
    w->still = u->count.lines != w->lines || may_stand ? 0 : w->still + 1;
    w->unsaid = w->still == 0 || (u->flags & STANDS) != 0 ? 0 : w->unsaid + 1;
    w->lines = u->count.lines;
    w->frames = u->count.frames;
    const uint32_t lit_px = lit_pixels(r);
    return (struct look){.flags = u->flags,
                         .lit_px = lit_px,
                         .picture = !is_seen                    ? UNSEEN
                                    : w->still < STANDING_LOOKS ? LIVE
                                    : lit_px > DARK_PX          ? STANDING
                                                                : REMOVED,
                         .is_silent = is_seen && w->unsaid >= STANDING_LOOKS};
}

/* ---- a run ---- */

/* What the runs of a kind have in common. */
struct tally {
    uint32_t runs, failed;
    uint32_t flags;                     /* that were up while the fault stood */
    uint32_t pictures;                  /* bits of enum picture */
    uint32_t word_ms[2], well_after_ms; /* least and most time to the first flag; the most */
};

struct campaign {
    uint64_t seed;
    bool is_traced;
    struct rig *rig[MODES], *saved[MODES]; /* in good flight, and as it was then */
    struct faults flown[MODES];            /* as they were then: none */
    struct look twin[MODES][LOOKS];
    struct tally tally[KINDS + 1]; /* the last: two at once */
};

struct run {
    struct faults faults;
    struct watch watch;
    const struct look *twin;
    uint64_t begun_us;
    enum kind kind[2];
    uint32_t kinds, mode, begin_ms, while_ms;
    uint32_t must, soon, may,
        pictures; /* of its faults together; of two, the first two are not asked for */
    bool changes_page;
};

static bool has_kind(const struct run *x, enum kind kind)
{
    return x->kind[0] == kind || (x->kinds == 2 && x->kind[1] == kind);
}

static void draw_run(struct run *x, struct hs_rng *rng)
{
    x->kinds = hs_rng_below(rng, 3) == 0 ? 2 : 1;
    x->kind[0] = (enum kind)hs_rng_below(rng, KINDS);
    x->kind[1] = (enum kind)((x->kind[0] + 1 + hs_rng_below(rng, KINDS - 1)) % KINDS);
    x->mode = hs_rng_below(rng, MODES);
    x->begin_ms = hs_rng_below(rng, BEGIN_MS);
    x->while_ms = (uint32_t)(SHORT_MS * pow(LONG_MS / SHORT_MS, hs_rng_uniform(rng)));
    for (uint32_t i = 0; i < x->kinds; i++) {
        const struct kind_of_fault *k = &kinds[x->kind[i]];
        x->may |= k->may;
        x->must = x->kinds == 1 ? k->must : 0;
        x->soon = x->kinds == 1 ? k->soon : 0;
        x->pictures |= k->pictures;
        x->changes_page |= k->changes_page;
    }
    if (has_kind(x, RESTART) &&
        (has_kind(x, READS_FAIL) || has_kind(x, READS_FAIL_SOME) || has_kind(x, READS_LATE) ||
         has_kind(x, READS_NEVER) || has_kind(x, READS_TORN) || has_kind(x, READS_FLIP) ||
         has_kind(x, READS_REFUSED) || has_kind(x, READS_ELSEWHERE))) {
        x->may |= LM_FLAG_DB;
        x->pictures |= P(REMOVED);
    }
}

/* What the twin does at this time of the flight. */
static const struct look *twin_of(const struct run *x)
{
    const uint64_t flown_us = x->faults.r->now_us - x->faults.leapt_us - x->begun_us;
    const uint64_t n = flown_us / LOOK_US;
    return &x->twin[n < LOOKS ? n : LOOKS - 1];
}

static const char *judge(const struct run *x, const struct look *now, uint32_t ms)
{
    if ((now->flags & ~x->may & ~twin_of(x)->flags) != 0) {
        return "a flag that this fault does not raise";
    }
    if ((ms >= MUST_MS && (x->must & ~now->flags) != 0) ||
        (ms >= SOON_MS && x->soon != 0 && (x->soon & now->flags) == 0)) {
        return "a flag is missing";
    }
    if ((x->pictures & P(now->picture)) == 0) {
        return "the picture does what this fault does not do";
    }
    return now->is_silent ? "the picture stands or is gone, and no word says so" : NULL;
}

static void print_flags(uint32_t flags, const char *mark)
{
    const char *between = "";
    for (uint32_t i = 0; i < LM_FLAGS; i++) {
        if ((flags & 1u << i) != 0) {
            printf("%s%s%s%s", between, mark, lm_flag_word(i), mark);
            between = ", ";
        }
    }
}

/* Fly until the next look. */
static struct look next_look(const struct campaign *c, struct run *x, const char *part,
                             uint32_t *ms)
{
    struct rig *r = x->faults.r;
    const uint64_t from_us = r->now_us;
    while (r->now_us < from_us + LOOK_US) {
        faults_step(&x->faults);
    }
    *ms += (uint32_t)((r->now_us - from_us) / 1000);
    const struct look now = look(r, &x->watch);
    if (c->is_traced) {
        printf("%-6s %6" PRIu32 " ms  %-10s %6" PRIu32 " px (twin %6" PRIu32 ")  ", part, *ms,
               picture_words[now.picture], now.lit_px, twin_of(x)->lit_px);
        print_flags(now.flags, "");
        printf("\n");
    }
    return now;
}

/* The faults stand. Returns what is wrong, or NULL. */
static const char *suffer(const struct campaign *c, struct run *x, struct tally *t)
{
    const char *wrong = NULL;
    bool has_word = false;
    for (uint32_t ms = 0; ms < x->while_ms && wrong == NULL;) {
        const struct look now = next_look(c, x, "fault", &ms);
        const uint32_t words = now.flags & ~twin_of(x)->flags;
        wrong = judge(x, &now, ms);
        t->flags |= words;
        t->pictures |= P(now.picture);
        if (words != 0 && !has_word) {
            has_word = true;
            t->word_ms[0] = t->word_ms[1] == 0 || ms < t->word_ms[0] ? ms : t->word_ms[0];
            t->word_ms[1] = ms > t->word_ms[1] ? ms : t->word_ms[1];
        }
    }
    return wrong;
}

/* A unit on which somebody pressed keys has another picture than its twin. */
static const char *what_is_ill(const struct run *x, const struct look *now)
{
    const struct look *twin = twin_of(x);
    const uint32_t left = now->flags & ~twin->flags;
    if (x->changes_page) {
        return (left & (uint32_t)(LM_FLAGS_FAULT ^ LM_FLAG_OFF_MAP)) != 0 ? "a flag stays" : NULL;
    }
    return left != 0                             ? "a flag stays"
           : now->picture != LIVE                ? "the picture does not come back"
           : now->lit_px * 10 < twin->lit_px * 6 ? "much of the picture does not come back"
                                                 : NULL;
}

/* Of a surface that was lost, the rest. */
static bool has_garbage(const struct rig *r)
{
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
        if (r->glass[i] == FAULTS_GARBAGE) {
            return true;
        }
    }
    return false;
}

/* The faults are gone. An image that could not be read at the start is read at the next one. */
static const char *recover(const struct campaign *c, struct run *x, struct tally *t)
{
    uint32_t ms = 0, ill_ms = 0;
    const char *ill = NULL;
    if ((x->faults.r->unit.flags & LM_FLAG_DB) != 0) {
        faults_begin(&x->faults, RESTART);
        faults_end(&x->faults);
    }
    while (ms < ill_ms + 1000 * STAYS_WELL_S && ms < 1000 * (RECOVERY_S + STAYS_WELL_S)) {
        const struct look now = next_look(c, x, "after", &ms);
        ill = has_garbage(x->faults.r) ? "what was in a lost surface stays" : what_is_ill(x, &now);
        ill_ms = ill != NULL ? ms : ill_ms;
    }
    t->well_after_ms = ill_ms > t->well_after_ms ? ill_ms : t->well_after_ms;
    return ill_ms > 1000 * RECOVERY_S ? (ill != NULL ? ill : "it is not well for long") : NULL;
}

static void tell(FILE *to, uint32_t number, const struct run *x, const char *what)
{
    fprintf(to, "campaign: run %" PRIu32 ", mode %" PRIu32 ": %s%s%s, for %" PRIu32 " ms: %s\n",
            number, x->mode, kinds[x->kind[0]].name, x->kinds == 2 ? " and " : "",
            x->kinds == 2 ? kinds[x->kind[1]].name : "", x->while_ms, what);
}

static bool run_one(struct campaign *c, uint32_t number)
{
    struct hs_rng rng;
    struct run x = {0};
    hs_rng_seed(&rng, c->seed * 1000003 + number);
    draw_run(&x, &rng);
    struct rig *r = c->rig[x.mode];
    memcpy(r, c->saved[x.mode], sizeof *r); /* where it was: it points into itself */
    x.twin = c->twin[x.mode];
    x.begun_us = r->now_us;
    faults_go_on(&x.faults, &c->flown[x.mode], &rng);
    for (const uint64_t until = r->now_us + 1000 * (uint64_t)x.begin_ms; r->now_us < until;) {
        faults_step(&x.faults);
    }
    (void)look(r, &x.watch);
    for (uint32_t i = 0; i < x.kinds; i++) {
        faults_begin(&x.faults, x.kind[i]);
    }
    struct tally *t = &c->tally[x.kinds == 2 ? KINDS : x.kind[0]];
    const char *wrong = suffer(c, &x, t);
    faults_end(&x.faults);
    wrong = wrong != NULL ? wrong : recover(c, &x, t);
    t->runs++;
    t->failed += wrong != NULL;
    if (wrong != NULL || c->is_traced) {
        tell(stderr, number, &x, wrong != NULL ? wrong : "well");
    }
    return wrong == NULL;
}

/* ---- the flights ---- */

static void fly(struct faults *f, double seconds)
{
    for (const uint64_t until = f->r->now_us + (uint64_t)(seconds * 1e6); f->r->now_us < until;) {
        faults_step(f);
    }
}

/* A unit in good flight in mode n. */
static struct rig *fly_mode(struct faults *f, uint32_t n)
{
    static const struct lm_control mode[MODES] = {
        [0] = {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GM, LM_FOV_NORM}},
        [1] = {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GM, LM_FOV_EXP}},
        [2] = {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GM, LM_FOV_DBS2}},
        [3] = {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GMT, LM_FOV_NORM}},
        [4] = {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_SEA, LM_FOV_NORM}},
    };
    const struct lm_position ahead = {FX_BAM_DEG(46), FX_BAM_DEG(11) + FX_BAM_DEG(1) / 40};
    struct rig *r = make_rig();
    r->board.lent.images[1].offset = BEHIND_BYTES; /* of the one image: no image begins there */
    r->board.lent.bus_node = 20;
    r->board.lent.tells_reports = true;
    r->board.lent.tile_pool_bytes = TILES * sizeof(struct lm_tile);
    if (lm_unit_init(&r->unit, &r->board.lent) != LM_OK) {
        abort();
    }
    faults_open(f, r);
    command(r, range_10);
    fly(f, 1.5);
    command(r, (struct lm_control){.kind = LM_CONTROL_CURSOR, .cursor = ahead});
    command(r, n < 5 ? mode[n] : patch_here);
    fly(f, n < 5 ? 8 : 1); /* a whole sweep, or the beginning of a patch */
    return r;
}

static void prepare(struct campaign *c, uint32_t n)
{
    struct faults f;
    c->rig[n] = fly_mode(&f, n);
    c->flown[n] = f;
    c->saved[n] = malloc(sizeof *c->saved[n]);
    if (c->saved[n] == NULL) {
        abort();
    }
    memcpy(c->saved[n], c->rig[n], sizeof *c->saved[n]);
    struct watch w = {0};
    for (uint32_t i = 0; i < LOOKS; i++) {
        c->twin[n][i] = look(c->rig[n], &w);
        fly(&f, LOOK_US / 1e6);
    }
}

static void print_row(const char *name, const struct tally *t)
{
    printf("| %s | ", name);
    print_flags(t->flags, "`");
    printf(" | ");
    const char *between = "";
    for (uint32_t i = 0; i < PICTURES; i++) {
        if ((t->pictures & P(i)) != 0) {
            printf("%s%s", between, picture_words[i]);
            between = ", ";
        }
    }
    if (t->word_ms[1] > 0) {
        printf(" | %.1f to %.1f", t->word_ms[0] / 1000.0, t->word_ms[1] / 1000.0);
    } else {
        printf(" |"); /* none came */
    }
    printf(" | %.1f | %" PRIu32 " |\n", t->well_after_ms / 1000.0, t->runs);
}

static void print_table(const struct campaign *c)
{
    printf(
        "| fault | words | the picture | first word after, s | all well after, s | runs |\n"
        "|---|---|---|---|---|---|\n");
    for (uint32_t k = 0; k < KINDS; k++) {
        print_row(kinds[k].name, &c->tally[k]);
    }
    print_row("two of them at once", &c->tally[KINDS]);
}

static volatile sig_atomic_t must_end;

static void ask_to_end(int number)
{
    (void)number;
    must_end = 1;
}

int main(int argc, char **argv)
{
    static struct campaign c;
    const uint32_t count = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 0;
    if (count == 0) {
        fprintf(stderr, "campaign COUNT [SEED [NUMBER]]\n");
        return 2;
    }
    c.seed = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    c.is_traced = argc > 3;
    for (uint32_t n = 0; n < MODES; n++) {
        prepare(&c, n);
    }
    if (c.is_traced) {
        return !run_one(&c, (uint32_t)strtoul(argv[3], NULL, 10));
    }
    uint32_t failed = 0, flown = 0;
    signal(SIGINT, ask_to_end);
    signal(SIGTERM, ask_to_end);
    for (; flown < count && !must_end; flown++) {
        failed += !run_one(&c, flown);
    }
    print_table(&c);
    fprintf(stderr, "%" PRIu32 " runs, %" PRIu32 " failed\n", flown, failed);
    return failed != 0;
}
