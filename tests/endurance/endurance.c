/* Endurance: one display flies round the Earth again and again (tour.h) and is never restarted.
 *
 *   endurance HOURS [START_MS]   so many hours of it; make endurance
 *   endurance wraps              every clock and counter a minute before its wrap; part of make
 * check
 *
 * Flown is the real unit, lm_unit_step, with a bus, four maps, ships and rain. So that 1,000 hours
 * fit in one of a processor, steps are 25 ms apart and the antenna turns by 10 degrees a second.
 * All counters begin just before their wrap, the unit's clock at START_MS.
 *
 * No drift: in each hour over a map, and so at each midnight, a display that was just switched on
 * flies beside the old one. After two sweeps, or a patch, both must have the same picture, byte by
 * byte, the same ownship and the same flags.
 * No false flag: at each step the flags must be those that place and time ask for.
 * No growth: counts of what goes wrong stay where they were, and a lap reads as many tiles, draws
 * as many lines and takes as long as the one before.
 *
 * SIGINT and SIGTERM land it, with what was found until then. Exit code 0: nothing was found; 1:
 * something, which is told. */
#include "tour.h"

#include "memory_board.h"
#include "tiny_image.h"

#include "lm/bit.h"
#include "lm/radar.h"
#include "lm/radar_check.h"

#include <inttypes.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#define ANTENNA FX_BAM_DEG(10) /* a second: a sweep takes 12 s */

enum {
    S = 1000000,
    PX = 256,
    ENDURANCE_STEP_US = 4000, /* the longest that lm_unit_step allows */
    TILES = 300,
    QUEUE = 3 * TOUR_FRAMES,
    MAP_TILES = 10,
    SETTLES_S = 40, /* after a place is reached or left, until the sweep that judges it ended */
    NEAR_KM = 60,   /* so near a map's middle the picture may be half on it */
    CHECK_EVERY_S = 3600,
    CHECK_BEFORE_S = 20, /* the hour: a check is under way at midnight */
    WARMS_UP_S = 180,    /* it has looked to all sides, and has read the tiles there */
    CHECK_S = WARMS_UP_S + 75,
    CHECK_LOOKS = 4,
    LOOK_EVERY_S = 7,
    CHECKED_MODES = 6
};

/* ---- the maps ---- */

struct world {
    uint8_t *bytes;
    size_t size;
    struct lm_flash_part parts[TOUR_PLACES];
    struct lm_radar radar;
};

static struct tiny_cell country(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    if (hypot(p->east_m - 3000, p->north_m) < 2500) {
        return (struct tiny_cell){-40, TINY_WATER, 0};
    }
    const bool is_house =
        fabs(remainder(p->east_m, 900)) < 90 && fabs(remainder(p->north_m, 900)) < 90;
    return is_house ? (struct tiny_cell){0, TINY_STRUCTURE, 5}
                    : (struct tiny_cell){-18, TINY_SOIL, 0};
}

static double hills(void *ctx, const struct tiny_place *p)
{
    (void)ctx;
    return 100 + 50 * sin(p->east_m / 1900);
}

static void die(const char *what)
{
    fprintf(stderr, "endurance: %s\n", what);
    exit(1);
}

static struct tiny_image map_of(const struct tour_place *place)
{
    struct tiny_spec spec = tiny_spec_at(place->latitude_deg, place->longitude_deg);
    struct tiny_image image;
    spec.shift0 = 13;
    spec.rows = spec.columns = MAP_TILES;
    spec.cell = country;
    spec.elevation_m = hills;
    if (tiny_image_build(&image, &spec) != 0) {
        die("a map cannot be built");
    }
    return image;
}

static void make_radar(struct lm_radar *radar)
{
    *radar = lm_radar_default;
    for (uint32_t m = 0; m < LM_SECTOR_MODES; m++) {
        radar->mode[m].bam_per_s = ANTENNA;
    }
    radar->fov[LM_FOV_DBS1].bam_per_s = ANTENNA;
    if (lm_radar_check(radar, NULL) != LM_OK) {
        die("the radar table is refused");
    }
}

static struct world make_world(void)
{
    struct world w = {0};
    struct tiny_image images[TOUR_PLACES];
    for (int i = 0; i < TOUR_PLACES; i++) {
        images[i] = map_of(&tour_places[i]);
    }
    w.bytes = tiny_images_join(images, TOUR_PLACES, w.parts, &w.size);
    if (w.bytes == NULL) {
        die("no memory");
    }
    for (int i = 0; i < TOUR_PLACES; i++) {
        tiny_image_free(&images[i]);
    }
    make_radar(&w.radar);
    return w;
}

/* ---- a display ---- */

struct seat {
    struct memory_board board;
    struct lm_can_frame queue[QUEUE]; /* of the bus, not yet heard */
    uint32_t head, tail;
    uint64_t tick;     /* of the tour, the next to be heard */
    uint64_t world_us; /* time of the tour at the next step */
    uint64_t ahead_us; /* the unit's clock minus that, modulo 2^64 */
    uint64_t said;     /* frames that the unit sent */
    struct lm_control control[8];
    uint32_t controls, controls_taken;
    uint32_t glass[PX * PX];
    uint8_t plane[PX * PX];
    uint64_t pool[TILES * sizeof(struct lm_tile) / 8];
    struct lm_unit unit;
};

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct seat *s = ctx;
    if (s->tail == s->head) {
        return 0;
    }
    *frame = s->queue[s->tail++ % QUEUE];
    frame->time_us += s->ahead_us;
    return 1;
}

static int send(void *ctx, const struct lm_can_frame *frame)
{
    struct seat *s = ctx;
    (void)frame;
    s->said++;
    return LM_OK;
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct seat *s = ctx;
    if (s->controls_taken == s->controls) {
        s->controls = s->controls_taken = 0;
        return 0;
    }
    *control = s->control[s->controls_taken++];
    return 1;
}

static void command(struct seat *s, struct lm_control control)
{
    s->control[s->controls++] = control;
}

/* Switched on at a time of the tour, when its own clock says `clock_us`. */
static struct seat *switch_on(const struct world *w, uint64_t world_us, uint64_t clock_us)
{
    struct seat *s = calloc(1, sizeof *s);
    if (s == NULL) {
        die("no memory");
    }
    const struct memory_board_parts parts = {.ctx = s,
                                             .receive = receive,
                                             .next_control = next_control,
                                             .width_px = PX,
                                             .height_px = PX,
                                             .glass = s->glass,
                                             .plane = s->plane,
                                             .tile_pool = s->pool,
                                             .tile_pool_bytes = sizeof s->pool};
    memory_board_open(&s->board, w->bytes, w->size, &parts);
    s->board.can.send = send;
    s->board.lent.radar = &w->radar;
    s->board.lent.bus_node = 20;
    s->board.lent.tells_reports = true;
    s->board.lent.noise_seed = UINT32_MAX - 200; /* number of the first sweep: it wraps soon */
    memcpy(s->board.lent.images, w->parts, sizeof w->parts);
    s->world_us = world_us;
    s->ahead_us = clock_us - world_us;
    s->tick = (world_us + TOUR_TICK_US - 1) / TOUR_TICK_US;
    if (lm_unit_init(&s->unit, &s->board.lent) != LM_OK || !s->unit.map.is_usable ||
        s->unit.map.image_count != TOUR_PLACES) {
        die("the display does not start");
    }
    command(s, (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 10});
    return s;
}

static void step(struct seat *s)
{
    for (; s->tick * TOUR_TICK_US <= s->world_us; s->tick++) {
        struct lm_can_frame frames[TOUR_FRAMES];
        const uint32_t count = tour_frames(s->tick, frames);
        for (uint32_t i = 0; i < count; i++) {
            s->queue[s->head++ % QUEUE] = frames[i];
        }
        if (s->head - s->tail > QUEUE) {
            die("the display does not hear its bus");
        }
    }
    lm_unit_step(&s->unit, s->world_us + s->ahead_us);
    s->world_us += ENDURANCE_STEP_US;
}

/* ---- counters ---- */

struct counter {
    const char *name;
    uint32_t *at;
    bool is_fault; /* it must not count */
};

enum { COUNTERS = 48 };

static uint32_t list_counters(struct lm_unit *u, struct counter list[COUNTERS])
{
    const struct counter all[] = {
        {"frames of the glass", &u->count.frames, false},
        {"lines", &u->count.lines, false},
        {"frames of the bus", &u->count.bus_frames, false},
        {"lines dropped", &u->count.lines_dropped, false},
        {"bus down", &u->count.bus_errors, true},
        {"screen errors", &u->count.display_errors, true},
        {"screen busy", &u->count.display_busy, true},
        {"frames hurried", &u->count.frames_hurried, true},
        {"commands refused", &u->count.commands_refused, true},
        {"pages exchanged", &u->count.swaps, true},
        {"frames decoded", &u->bus.count.frames, false},
        {"values decoded", &u->bus.count.outcome[LM_BUS_VALUE], false},
        {"halves torn", &u->bus.canas.count.torn_pairs, true},
        {"breaks of a sequence", &u->bus.canas.count.sequence_breaks, true},
        {"stuck senders", &u->bus.canas.count.stuck, true},
        {"jumps of the position", &u->nav.position_jumps, true},
        {"values crowded out", &u->nav.crowded, true},
        {"rival senders", &u->nav.rivals, true},
        {"senders that differ", &u->nav.disagreements, true},
        {"steps of the exercise", &u->exercise.count.steps, false},
        {"rivals of the exercise", &u->exercise.count.rivals, true},
        {"live sets", &u->live.count.sets, false},
        {"live sets torn", &u->live.count.torn, true},
        {"live sets refused", &u->live.count.refused, true},
        {"live rivals", &u->live.count.rivals, true},
        {"live targets aged", &u->live.count.aged, true},
        {"sets of weather torn", &u->weather.bus.count.torn, true},
        {"sets of weather refused", &u->weather.bus.count.refused, true},
        {"numbers of weather", &u->weather.bus.count.numbers, true},
        {"rivals of the weather", &u->weather.bus.count.rivals, true},
        {"reports sent", &u->report.count.sent, false},
        {"reports cut", &u->report.count.cut, false},
        {"reports lost", &u->report.count.lost, true},
        {"faults logged", &u->faults.count, false},
        {"keys stuck", &u->keys.count.stuck, true},
        {"targets left out", &u->picture.targets_left_out, true},
        {"look-ups of tiles", &u->map.tiles.clock, false},
        {"look-ups that were late", &u->map.tiles.count.not_exact, false},
        {"look-ups missed", &u->map.tiles.count.misses, false},
        {"look-ups answered by coarser tiles", &u->map.tiles.count.substituted, false},
        {"look-ups off the map", &u->map.tiles.count.off_map, false},
        {"tiles read", &u->map.tiles.count.tiles_read, false},
        {"reads that failed", &u->map.tiles.count.io_errors, true},
        {"records that were wrong", &u->map.tiles.count.corrupt, true},
        {"encodings that are unknown", &u->map.tiles.count.encodings, true},
        {"requests dropped", &u->map.tiles.count.requests_dropped, false},
        {"tiles put out", &u->map.tiles.count.evicted, false},
        {"chips left out", &u->map.chips.count.left_out, true},
    };
    _Static_assert(sizeof all / sizeof *all == COUNTERS, "as many as the list has");
    memcpy(list, all, sizeof all);
    return COUNTERS;
}

/* Every counter just before its wrap. What others remember of it goes with it. */
static void wind_up(struct lm_unit *u, uint32_t begin[COUNTERS])
{
    struct counter list[COUNTERS];
    const uint32_t count = list_counters(u, list);
    for (uint32_t i = 0; i < count; i++) {
        /* What must not count wraps with its first: a flag that compares would see it. */
        *list[i].at = begin[i] = list[i].is_fault ? UINT32_MAX : UINT32_MAX - 1000;
    }
    u->map.tiles.wanted_head = u->map.tiles.wanted_tail = UINT32_MAX - 20;
    u->position_seen.jumps = u->nav.position_jumps;
    const struct lm_sender_counts senders = lm_sender_counts(u);
    u->senders.stuck = senders.stuck;
    u->senders.rivals = senders.rivals;
    u->senders.disagreements = senders.disagreements;
    u->tile_faults.seen = u->map.tiles.count.io_errors + lm_unit_map_corrupt_records(&u->map);
}

/* ---- what is found ---- */

struct findings {
    uint32_t count;
};

static void find(struct findings *f, const struct seat *s, const char *what, uint32_t number)
{
    if (f->count++ < 20) {
        const struct tour_point p = tour_at(s->world_us);
        fprintf(stderr,
                "endurance: after %.4f h, at %.4f %.4f, unit's clock %" PRIu64 " us: %s (%" PRIu32
                ")\n",
                (double)s->world_us / S / 3600, p.latitude_deg, p.longitude_deg,
                s->world_us + s->ahead_us, what, number);
    }
}

/* Since when the aircraft is where it is: over a map, on the way, near a pole. */
struct stay {
    int circling;
    bool is_polar, is_near;
    uint64_t since_us, polar_since_us;
};

static void judge_flags(struct findings *f, const struct seat *s, struct stay *stay)
{
    const struct tour_point p = tour_at(s->unit.now_us - s->ahead_us);
    const bool is_polar = fabs(p.latitude_deg) > 85;
    const bool is_near = p.distance_km < NEAR_KM;
    if (p.circling != stay->circling || is_near != stay->is_near) {
        stay->circling = p.circling;
        stay->is_near = is_near;
        stay->since_us = s->world_us;
    }
    if (is_polar != stay->is_polar) {
        stay->is_polar = is_polar;
        stay->polar_since_us = s->world_us;
    }
    uint32_t may = 0, must = 0;
    if (s->world_us - stay->polar_since_us < S / 2) {
        may |= LM_FLAG_POLE; /* the extrapolated position and the true one differ by metres */
    } else if (is_polar && s->unit.page.picture == LM_PICTURE_SECTOR) {
        must |= LM_FLAG_POLE;
    }
    const bool has_settled = s->world_us - stay->since_us > (uint64_t)SETTLES_S * S &&
                             s->world_us - stay->polar_since_us > (uint64_t)SETTLES_S * S;
    if (!has_settled || is_polar || (p.circling < 0 && is_near)) {
        may |= LM_FLAG_OFF_MAP;
    } else if (p.circling < 0) {
        must |= LM_FLAG_OFF_MAP;
    }
    const uint32_t flags = s->unit.flags;
    if ((flags & ~(may | must)) != 0) {
        find(f, s, "a flag that nothing here raises", flags & ~(may | must));
    }
    if ((must & ~flags) != 0) {
        find(f, s, "a flag is missing", must & ~flags);
    }
}

/* ---- checks beside a display that was just switched on ---- */

/* The last is a patch of the place's middle, seen from a place of its own. */
static struct lm_control mode_of(uint32_t n, struct lm_position middle)
{
    const struct lm_control modes[CHECKED_MODES] = {
        {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GM, LM_FOV_NORM}},
        {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GMT, LM_FOV_NORM}},
        {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_SEA, LM_FOV_NORM}},
        {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GM, LM_FOV_EXP}},
        {.kind = LM_CONTROL_SECTOR, .sector = {LM_SECTOR_GM, LM_FOV_DBS1}},
        {.kind = LM_CONTROL_SAR,
         .sar = {.centre = middle,
                 .cell_mm = 10000,
                 .look_azimuth = FX_BAM_DEG(45),
                 .range_m = 12000,
                 .height_m_q6 = 2500 * 64}},
    };
    return modes[n % CHECKED_MODES];
}

static bool is_same_ownship(const struct lm_ownship *a, const struct lm_ownship *b)
{
    return a->latitude == b->latitude && a->longitude == b->longitude &&
           a->height_m_q6 == b->height_m_q6 && a->heading == b->heading && a->track == b->track &&
           a->ground_speed_mm_s == b->ground_speed_mm_s &&
           a->position_quality == b->position_quality;
}

static void compare(struct findings *f, const struct seat *old, const struct seat *fresh)
{
    uint32_t apart = 0;
    for (uint32_t i = 0; i < PX * PX; i++) {
        apart += old->plane[i] != fresh->plane[i];
    }
    if (apart != 0) {
        find(f, old, "pixels differ from those of a fresh start", apart);
    }
    if (!is_same_ownship(&old->unit.ownship, &fresh->unit.ownship)) {
        find(f, old, "its aircraft is not where a fresh start has it", 0);
    }
    if (old->unit.flags != fresh->unit.flags) {
        find(f, old, "flags differ from a fresh start's", old->unit.flags ^ fresh->unit.flags);
    }
    if (old->unit.exercise.time_us != fresh->unit.exercise.time_us) {
        find(f, old, "its exercise clock differs from a fresh start's", 0);
    }
    if (old->unit.live.live.count != fresh->unit.live.live.count) {
        find(f, old, "it has other live targets than a fresh start", old->unit.live.live.count);
    }
}

/* Returns pixels that were lit in all looks together. */
static uint32_t check(struct findings *f, const struct world *w, struct seat *old,
                      struct stay *stay, uint32_t number)
{
    struct seat *fresh = switch_on(w, old->world_us, 0);
    const struct tour_point p = tour_at(old->world_us);
    const struct tour_place *place = &tour_places[p.circling];
    const double bam = 4294967296.0 / 360;
    /* Nearer to the equator, so that beside the pole it lies where patches are made. */
    const double nearer_deg = copysign(0.03, place->latitude_deg);
    const struct lm_position middle = {(fx_bam_t)llround((place->latitude_deg - nearer_deg) * bam),
                                       (fx_bam_t)llround(place->longitude_deg * bam)};
    const struct lm_control cursor = {.kind = LM_CONTROL_CURSOR, .cursor = middle};
    uint32_t lit = 0;
    for (uint64_t us = 0, look = 0; look < CHECK_LOOKS; us += ENDURANCE_STEP_US) {
        if (us == (uint64_t)WARMS_UP_S * S) {
            command(old, cursor);
            command(fresh, cursor);
            command(old, mode_of(number, middle));
            command(fresh, mode_of(number, middle));
        }
        step(old);
        step(fresh);
        judge_flags(f, old, stay);
        if (us >= (CHECK_S + look * LOOK_EVERY_S) * (uint64_t)S) {
            compare(f, old, fresh);
            look++;
            for (uint32_t i = 0; i < PX * PX; i++) {
                lit += old->plane[i] > 20;
            }
        }
    }
    free(fresh);
    command(old, mode_of(0, middle));
    return lit;
}

/* ---- the flight ---- */

static volatile sig_atomic_t must_land;

static void ask_to_land(int number)
{
    (void)number;
    must_land = 1;
}

struct lap {
    uint32_t lines, frames, tiles, late, faults;
    double processor_s;
};

struct flight {
    const struct world *world;
    struct seat *old;
    struct stay stay;
    struct findings findings;
    uint32_t begin[COUNTERS];
    uint32_t checks, dark_checks, midnights, crossings;
    uint64_t begun_us, next_check_us, checked_us;
    double longitude_deg;
};

static double processor_s(void)
{
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    return (double)used.ru_utime.tv_sec + (double)used.ru_utime.tv_usec / 1e6;
}

static long memory_kib(void)
{
    struct rusage used;
    getrusage(RUSAGE_SELF, &used);
    return used.ru_maxrss;
}

static struct lap lap_of(const struct seat *s)
{
    return (struct lap){.lines = s->unit.count.lines,
                        .frames = s->unit.count.frames,
                        .tiles = s->unit.map.tiles.count.tiles_read,
                        .late = s->unit.map.tiles.count.misses,
                        .faults = s->unit.faults.count,
                        .processor_s = processor_s()};
}

static struct flight take_off(const struct world *w, uint64_t world_us, uint64_t clock_us)
{
    struct flight f = {.world = w,
                       .old = switch_on(w, world_us, clock_us),
                       .begun_us = world_us,
                       .stay = {.circling = -1, .since_us = world_us, .polar_since_us = world_us}};
    wind_up(&f.old->unit, f.begin);
    for (uint32_t i = 0; i < 5 * S / ENDURANCE_STEP_US; i++) {
        step(f.old); /* until navigation has been heard */
    }
    f.next_check_us = (uint64_t)(CHECK_EVERY_S - CHECK_BEFORE_S) * S;
    return f;
}

static void land(struct flight *f)
{
    free(f->old);
}

static void check_now(struct flight *f)
{
    f->dark_checks += check(&f->findings, f->world, f->old, &f->stay, f->checks) == 0;
    f->checks++;
    f->checked_us = f->old->world_us;
}

static uint64_t day_of(uint64_t world_us)
{
    return (world_us / S + 86400 - TOUR_MIDNIGHT_S) / 86400;
}

static void fly_until(struct flight *f, uint64_t world_us)
{
    struct seat *s = f->old;
    while (s->world_us < world_us && !must_land) {
        const uint64_t before_us = s->world_us;
        const uint32_t dropped = s->unit.count.lines_dropped;
        step(s);
        const bool is_antenna_free =
            s->world_us > f->stay.polar_since_us + (uint64_t)SETTLES_S * S &&
            s->world_us > f->checked_us + (uint64_t)SETTLES_S * S;
        if (s->unit.count.lines_dropped != dropped && is_antenna_free) {
            find(&f->findings, s, "a line was dropped", s->unit.picture.sector.line);
        }
        judge_flags(&f->findings, s, &f->stay);
        const double longitude_deg = tour_at(s->world_us).longitude_deg;
        f->crossings += fabs(longitude_deg - f->longitude_deg) > 180;
        f->longitude_deg = longitude_deg;
        if (s->world_us >= f->next_check_us) {
            f->next_check_us += (uint64_t)CHECK_EVERY_S * S;
            /* Over a map, and for long enough. */
            const struct tour_point now = tour_at(s->world_us),
                                    then = tour_at(s->world_us + 300ull * S);
            if (now.circling >= 0 && now.circling == then.circling) {
                check_now(f);
            }
        }
        f->midnights += day_of(s->world_us) != day_of(before_us);
    }
}

/* Counts that must stay; and the glass has 30 pictures a second, as on the first day. */
static void judge_counters(struct flight *f)
{
    const struct seat *s = f->old;
    const uint64_t pictures = (s->world_us - f->begun_us) / LM_FRAME_US;
    const uint32_t shown = s->unit.count.frames - f->begin[0];
    if (shown > pictures + 1 || shown < pictures - pictures / 8) {
        find(&f->findings, s, "too many or too few pictures on the glass", shown);
    }
    struct counter list[COUNTERS];
    const uint32_t count = list_counters(&f->old->unit, list);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t grown = *list[i].at - f->begin[i];
        if (list[i].is_fault && grown != 0) {
            find(&f->findings, f->old, list[i].name, grown);
        }
    }
}

static void print_lap(const struct flight *f, uint64_t lap, const struct lap *from)
{
    const struct lap now = lap_of(f->old);
    printf("| %" PRIu64 " | %.1f | %" PRIu32 " | %" PRIu32 " | %" PRIu32 " | %" PRIu32 " | %" PRIu32
           " | %.1f | %ld |\n",
           lap, (double)f->old->world_us / S / 3600, now.lines - from->lines,
           now.frames - from->frames, now.tiles - from->tiles, now.late - from->late,
           now.faults - from->faults, now.processor_s - from->processor_s, memory_kib());
    fflush(stdout);
}

static int endure(double hours, uint64_t clock_us)
{
    const struct world w = make_world();
    struct flight f = take_off(&w, 0, clock_us);
    signal(SIGINT, ask_to_land);
    signal(SIGTERM, ask_to_land);
    const uint64_t end_us = (uint64_t)(hours * 3600) * S;
    printf(
        "| lap | hours | lines | frames | tiles read | look-ups late | faults logged | processor, "
        "s | memory, KiB |\n|---|---|---|---|---|---|---|---|---|\n");
    for (uint64_t lap = 1; f.old->world_us < end_us && !must_land; lap++) {
        const struct lap from = lap_of(f.old);
        const uint64_t until_us = lap * tour_lap_us();
        fly_until(&f, until_us < end_us ? until_us : end_us);
        print_lap(&f, lap, &from);
    }
    judge_counters(&f);
    printf("%.1f hours, %" PRIu32 " crossings of the date line, %" PRIu32 " midnights, %" PRIu32
           " checks (%" PRIu32 " of a dark picture), %" PRIu64 " frames said, %" PRIu32
           " findings\n",
           (double)f.old->world_us / S / 3600, f.crossings, f.midnights, f.checks, f.dark_checks,
           f.old->said, f.findings.count);
    land(&f);
    free(w.bytes);
    return f.findings.count != 0;
}

/* ---- wraps ---- */

/* Clocks of 32 bits, with and without a sign, of microseconds and of milliseconds; and half a
 * century, which is more than any clock of the bus tells. */
static const struct {
    const char *name;
    uint64_t at_us;
} wraps[] = {
    {"2^31 us", 1ull << 31},
    {"2^32 us", 1ull << 32},
    {"2^31 ms", (1ull << 31) * 1000},
    {"2^32 ms", (1ull << 32) * 1000},
    {"2^31 s", (1ull << 31) * 1000000},
    {"2^48 us", 1ull << 48},
};

static int fly_wraps(void)
{
    const struct world w = make_world();
    const uint32_t count = sizeof wraps / sizeof *wraps;
    uint32_t findings = 0;
    printf("1..%" PRIu32 "\n", count);
    for (uint32_t i = 0; i < count; i++) {
        const uint64_t begin_us = (TOUR_MIDNIGHT_S - 60) * (uint64_t)S;
        struct flight f = take_off(&w, begin_us, wraps[i].at_us - 60ull * S);
        f.next_check_us = UINT64_MAX;
        f.checks = i; /* another mode each */
        fly_until(&f, begin_us + 20ull * S);
        check_now(&f); /* from before the wrap to behind it */
        check_now(&f);
        judge_counters(&f);
        const bool is_good = f.findings.count == 0 && f.dark_checks == 0;
        printf("%s %" PRIu32
               " - at midnight a clock and all counters wrap at %s, and nothing is seen of it\n",
               is_good ? "ok" : "not ok", i + 1, wraps[i].name);
        findings += !is_good;
        land(&f);
    }
    free(w.bytes);
    return findings != 0;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "wraps") == 0) {
        return fly_wraps();
    }
    const double hours = argc > 1 ? strtod(argv[1], NULL) : 0;
    if (!(hours > 0 && hours <= 100000)) {
        fprintf(stderr, "endurance HOURS [START_MS] | wraps\n");
        return 2;
    }
    /* Half way through 1,000 hours the milliseconds pass 2^32, unless another start is given. */
    const uint64_t start_ms =
        argc > 2 ? strtoull(argv[2], NULL, 10) : (1ull << 32) - 500ull * 3600 * 1000;
    return endure(hours, start_ms * 1000);
}
