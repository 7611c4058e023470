/* World flights: a unit over an image of the whole Earth, without a bus log of hours.
 *
 *     world_flights IMAGE.lmdb [FLIGHT]...        without a name: all; make world-flights
 *
 * Round the equator, past both poles, across the antimeridian at three latitudes, at 600 knots and
 * at ten times that, at the range scale of 80 nautical miles; and from one place to another, 200
 * times. The bus's table ends at 1,500 m/s: above that the speed that is told is less than that of
 * the places that are told. The flash reads 20 MB/s, after 100 us each. A line for each flight:
 * look-ups answered by the tile itself, those whose tile came too late, tiles and bytes read, and
 * the most that a step asked of processor and flash. */
#include "bus_frames.h"
#include "memory_board.h"

#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>

enum { S = 1000000, STEP_US = 4000, SIDE = 768, TILES = 384, NAV_US = 25000, MOVES = 200 };

#define KNOT_M_S      0.514444
#define EARTH_M       6378137.0
#define TOLD_M_S      1499
#define FLASH_BYTES_S 20e6
#define FLASH_READ_US 100

static const double radian = 3.14159265358979323846 / 180;

/* Where an aircraft is after some seconds. */
struct place {
    double latitude_deg, longitude_deg, heading_deg;
};

struct flight {
    const char *name;
    struct place from;
    double knots, seconds;
};

struct flyer {
    struct memory_board board;
    struct lm_unit unit;
    const uint8_t *image;
    uint64_t now_us, nav_us, began_us, read_ends_us, bytes_asked;
    uint32_t nav_at;
    struct place at, from;
    double speed_m_s;
    bool is_meridian, has_range;
    uint8_t code;
    struct {
        uint64_t offset;
        void *to;
        uint32_t length;
    } read;
    uint32_t glass[SIDE * SIDE];
    uint8_t plane[SIDE * SIDE];
    uint64_t pool[TILES * sizeof(struct lm_tile) / 8];
};

/* ---- the flash: so many bytes a second ---- */

static int read_start(void *ctx, uint64_t offset, void *to, uint32_t length)
{
    struct flyer *f = ctx;
    if (offset > f->board.flash.port.size_bytes ||
        length > f->board.flash.port.size_bytes - offset) {
        return LM_ERR_RANGE;
    }
    f->read.offset = offset;
    f->read.to = to;
    f->read.length = length;
    f->bytes_asked += length;
    f->read_ends_us = f->now_us + FLASH_READ_US + (uint64_t)((double)length * (S / FLASH_BYTES_S));
    return LM_OK;
}

static int read_poll(void *ctx)
{
    struct flyer *f = ctx;
    /* Before the first step no time passes. */
    if (f->now_us > 0 && f->now_us + STEP_US <= f->read_ends_us) {
        return LM_BUSY;
    }
    memcpy(f->read.to, f->image + f->read.offset, f->read.length);
    return LM_OK;
}

/* ---- the bus ---- */

/* Along a parallel, or along a meridian and over the pole. */
static void move(struct flyer *f)
{
    const double angle = (double)(f->now_us - f->began_us) / S * f->speed_m_s / EARTH_M / radian;
    f->at = f->from;
    if (!f->is_meridian) {
        f->at.longitude_deg += angle / cos(f->from.latitude_deg * radian);
    } else {
        const bool is_north = f->from.heading_deg < 90;
        double latitude = f->from.latitude_deg + (is_north ? angle : -angle);
        if (fabs(latitude) > 90) {
            latitude = (is_north ? 180 : -180) - latitude;
            f->at.longitude_deg += 180;
            f->at.heading_deg = is_north ? 180 : 0;
        }
        f->at.latitude_deg = latitude;
    }
    f->at.longitude_deg = remainder(f->at.longitude_deg, 360);
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct flyer *f = ctx;
    if (f->nav_at == 0) {
        if (f->now_us < f->nav_us) {
            return 0;
        }
        f->nav_us = f->now_us + NAV_US;
        f->code++;
        move(f);
    }
    const struct {
        uint32_t id;
        double value;
    } items[] = {{1036, f->at.latitude_deg},
                 {1037, f->at.longitude_deg},
                 {1038, 9000},
                 {320, 9000},
                 {1133, f->at.heading_deg},
                 {321, f->at.heading_deg},
                 {1039, fmin(f->speed_m_s, TOLD_M_S)},
                 {1040, f->at.heading_deg},
                 {311, 2},
                 {312, 0},
                 {303, 0},
                 {305, 0}};
    *frame = bus_frame(items[f->nav_at].id, LM_CANAS_FLOAT, f->code,
                       bus_float_bits(items[f->nav_at].value), f->now_us);
    f->nav_at = (f->nav_at + 1) % (sizeof items / sizeof *items);
    return 1;
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct flyer *f = ctx;
    if (f->has_range) {
        return 0;
    }
    f->has_range = true;
    *control = (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = 80};
    return 1;
}

/* ---- a flight ---- */

static void switch_on(struct flyer *f, const uint8_t *image, uint64_t size)
{
    const struct memory_board_parts parts = {.ctx = f,
                                             .receive = receive,
                                             .next_control = next_control,
                                             .width_px = SIDE,
                                             .height_px = SIDE,
                                             .glass = f->glass,
                                             .plane = f->plane,
                                             .tile_pool = f->pool,
                                             .tile_pool_bytes = sizeof f->pool};
    memset(f, 0, sizeof *f);
    f->image = image;
    memory_board_open(&f->board, image, size, &parts);
    f->board.flash.port = (struct lm_flash){
        .ctx = f, .size_bytes = size, .read_start = read_start, .read_poll = read_poll};
    if (lm_unit_init(&f->unit, &f->board.lent) != LM_OK || !f->unit.map.is_usable) {
        fprintf(stderr, "world_flights: the image cannot be used; see landmass-db verify\n");
        exit(1);
    }
    f->now_us = STEP_US;
}

static void place_at(struct flyer *f, struct place from, double knots)
{
    f->from = f->at = from;
    f->began_us = f->nav_us = f->now_us;
    f->nav_at = 0;
    f->speed_m_s = knots * KNOT_M_S;
    f->is_meridian = fabs(remainder(from.heading_deg, 180)) < 45;
}

/* Microseconds of the processor that a step took. */
static double step(struct flyer *f)
{
    struct timespec from, to;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &from);
    lm_unit_step(&f->unit, f->now_us);
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &to);
    f->now_us += STEP_US;
    return 1e6 * (double)(to.tv_sec - from.tv_sec) + 1e-3 * (double)(to.tv_nsec - from.tv_nsec);
}

struct tally {
    uint32_t lookups, late, tiles, jumps, lines;
    uint64_t bytes, most_bytes_s, most_bytes_step;
    double processor_us, worst_us, polar_s;
    uint32_t steps, seconds_late;
};

static uint32_t jumps_of(const struct lm_unit *u)
{
    return u->position_seen.jumps;
}

/* A second of flight. */
static void fly_second(struct flyer *f, struct tally *t)
{
    const struct lm_tile_cache *c = &f->unit.map.tiles;
    const uint64_t until_us = f->now_us + S, bytes = f->bytes_asked;
    const uint32_t late = c->count.misses;
    while (f->now_us < until_us) {
        const uint64_t before = f->bytes_asked;
        const double took_us = step(f);
        t->processor_us += took_us;
        t->worst_us = fmax(t->worst_us, took_us);
        t->steps++;
        t->most_bytes_step = f->bytes_asked - before > t->most_bytes_step ? f->bytes_asked - before
                                                                          : t->most_bytes_step;
        t->polar_s += f->unit.is_polar ? (double)STEP_US / S : 0;
    }
    const uint64_t read = f->bytes_asked - bytes;
    t->most_bytes_s = read > t->most_bytes_s ? read : t->most_bytes_s;
    t->seconds_late += c->count.misses != late;
}

static void print_tally(const char *name, double knots, double seconds, const struct tally *t)
{
    printf("%-22s %5.0f %7.0f %8u %9.4f %7u %6u %6.1f %6.1f %6.1f %7.2f %8.2f %5u %6.1f\n", name,
           knots, seconds, t->lines, 100.0 * t->late / fmax(t->lookups, 1), t->seconds_late,
           t->tiles, (double)t->bytes / seconds / 1e3, (double)t->most_bytes_s / 1e3,
           (double)t->most_bytes_step / 1e3, t->processor_us / t->steps / 1e3, t->worst_us / 1e3,
           t->jumps, t->polar_s);
    fflush(stdout);
}

/* From two seconds after its beginning, when the unit has found its place. */
static void fly(struct flyer *f, const struct flight *w)
{
    struct tally t = {0}, settle = {0};
    const struct lm_unit *u = &f->unit;
    place_at(f, w->from, w->knots);
    fly_second(f, &settle);
    fly_second(f, &settle);
    const uint32_t clock = u->map.tiles.clock, late = u->map.tiles.count.misses;
    const uint32_t tiles = u->map.tiles.count.tiles_read, jumps = jumps_of(u),
                   lines = u->count.lines;
    const uint64_t bytes = f->bytes_asked;
    for (double s = 0; s < w->seconds; s += 1) {
        fly_second(f, &t);
    }
    t.lookups = u->map.tiles.clock - clock;
    t.late = u->map.tiles.count.misses - late;
    t.tiles = u->map.tiles.count.tiles_read - tiles;
    t.bytes = f->bytes_asked - bytes;
    t.jumps = jumps_of(u) - jumps;
    t.lines = u->count.lines - lines;
    print_tally(w->name, w->knots, w->seconds, &t);
}

/* ---- from one place to another ---- */

static uint32_t drawn(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static int by_size(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Places of equal share of the sphere up to 85 degrees. A picture is there when the first line is
 * drawn, and right when no look-up is late for a second from then on. */
static void reposition(struct flyer *f)
{
    double first_s[MOVES], right_s[MOVES];
    uint32_t state = 1;
    for (int i = 0; i < MOVES; i++) {
        const double sine = (drawn(&state) / 8388608.0 - 1) * sin(85 * radian);
        const struct place to = {asin(sine) / radian, drawn(&state) / 8388608.0 * 180 - 180,
                                 drawn(&state) % 360};
        place_at(f, to, 600);
        const uint32_t lines = f->unit.count.lines;
        first_s[i] = right_s[i] = 0;
        for (int k = 0; k < 4 * S / STEP_US; k++) {
            const uint32_t late = f->unit.map.tiles.count.misses;
            const uint64_t from_us = f->now_us;
            step(f);
            const double since_s = (double)(from_us - f->began_us + STEP_US) / S;
            if (f->unit.map.tiles.count.misses != late && since_s <= right_s[i] + 1) {
                right_s[i] = since_s;
            }
            if (first_s[i] == 0 && f->unit.count.lines != lines) {
                first_s[i] = since_s;
            }
        }
    }
    qsort(first_s, MOVES, sizeof *first_s, by_size);
    qsort(right_s, MOVES, sizeof *right_s, by_size);
    printf(
        "%d moves: first line after %.3f s (median), %.3f s (worst); no look-up late after %.3f s "
        "(median), %.3f s (worst)\n",
        MOVES, first_s[MOVES / 2], first_s[MOVES - 1], right_s[MOVES / 2], right_s[MOVES - 1]);
}

static const struct flight flights[] = {
    {"equator", {0, 0, 90}, 600, 3600},
    {"equator, whole", {0, 0, 90}, 6000, 12982},
    {"north pole", {83.5, 30, 0}, 600, 1200},
    {"north pole", {80, 30, 0}, 6000, 720},
    {"south pole", {-83.5, -60, 180}, 600, 1200},
    {"south pole", {-80, -60, 180}, 6000, 720},
    {"antimeridian, 66 N", {66, 178, 90}, 600, 600},
    {"antimeridian, 17 S", {-17, 178, 90}, 600, 1400},
    {"antimeridian, 17 S", {-17, 170, 90}, 6000, 700},
    {"antimeridian, 78 S", {-78, 178, 90}, 600, 300},
    {"Norway, along 62 N", {62, 0, 90}, 6000, 600},
};

static const uint8_t *map_file(const char *path, uint64_t *size)
{
    struct stat s;
    const int file = open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0 || fstat(file, &s) != 0 || s.st_size == 0) {
        fprintf(stderr, "world_flights: %s: cannot be read; name an image\n", path);
        exit(1);
    }
    *size = (uint64_t)s.st_size;
    const void *bytes = mmap(NULL, *size, PROT_READ, MAP_PRIVATE, file, 0);
    if (bytes == MAP_FAILED) {
        perror(path);
        exit(1);
    }
    return bytes;
}

static bool is_chosen(int argc, char **argv, const char *name)
{
    for (int i = 2; i < argc; i++) {
        if (strncmp(name, argv[i], strlen(argv[i])) == 0) {
            return true;
        }
    }
    return argc == 2;
}

int main(int argc, char **argv)
{
    if (argc < 2 || argv[1][0] == '-') {
        fprintf(stderr, "usage: world_flights IMAGE.lmdb [FLIGHT]...\n");
        return 1;
    }
    uint64_t size;
    const uint8_t *image = map_file(argv[1], &size);
    struct flyer *f = malloc(sizeof *f);
    if (!f) {
        fprintf(stderr, "world_flights: out of memory\n");
        return 1;
    }
    printf(
        "flight                 knots seconds    lines    late %% seconds  tiles   kB/s    most "
        "kB/step ms/step "
        "   worst jumps  polar\n"
        "                                                        with late              kB/s    "
        "most            "
        "      ms             s\n");
    for (size_t i = 0; i < sizeof flights / sizeof *flights; i++) {
        if (is_chosen(argc, argv, flights[i].name)) {
            switch_on(f, image, size);
            fly(f, &flights[i]);
        }
    }
    if (is_chosen(argc, argv, "moves")) {
        switch_on(f, image, size);
        reposition(f);
    }
    free(f);
    return 0;
}
