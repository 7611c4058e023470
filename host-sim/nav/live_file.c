/* The routes of live targets, from a text file (docs/nav.md, "Routes of live targets"). */
#include "hs/number.h"
#include "hs/text_file.h"
#include "nav/live.h"

#include <geodesic.h>
#include <math.h>
#include <string.h>

enum { WORDS_MAX = 5 };

static const char words_help[] = "the words are target, at, speed and gone: docs/nav.md";

/* Height of a point that stands on the ground. */
static const double on_ground_m = -INFINITY;

static double metres_between(const struct nav_live_point *a, const struct nav_live_point *b)
{
    struct geod_geodesic earth;
    double way_m;
    geod_init(&earth, 6378137.0, 1 / 298.257223563);
    geod_inverse(&earth, a->latitude_deg, a->longitude_deg, b->latitude_deg, b->longitude_deg,
                 &way_m, NULL, NULL);
    return way_m;
}

/* The target that is being read; NULL: none is, or it is gone. */
static struct nav_live_item *current(struct nav_live *l)
{
    struct nav_live_item *t = l->count > 0 ? &l->item[l->count - 1] : NULL;
    return t && isinf(t->until_s) ? t : NULL;
}

/* A target has a place at least. */
static int finish(const struct db_text_file *f, struct nav_live *l)
{
    return l->count == 0 || l->item[l->count - 1].points > 0
               ? 0
               : db_text_error(f, "add a line: at SECONDS LATITUDE LONGITUDE",
                               "target %d has no place", l->item[l->count - 1].number);
}

static int begin_target(const struct db_text_file *f, struct nav_live *l, char **word, int words)
{
    double number, kind, reply = 0;
    if (words < 3 || words > 4 || !hs_number_within(word[1], 0, NAV_LIVE_MAX - 1, &number) ||
        !hs_number_within(word[2], 0, NAV_LIVE_KINDS - 1, &kind) || number != floor(number) ||
        kind != floor(kind) ||
        (words == 4 && (!hs_number_within(word[3], 0, 255, &reply) || reply != floor(reply) ||
                        kind != NAV_LIVE_BEACON))) {
        return db_text_error(f, "write target 12 3, or of a beacon of code 5 target 12 17 5",
                             "a target has a number of 0..%d and a kind of "
                             "0..%d, and a beacon a reply of 0..255",
                             NAV_LIVE_MAX - 1, NAV_LIVE_KINDS - 1);
    }
    for (int i = 0; i < l->count; i++) {
        if (l->item[i].number == (int)number) {
            return db_text_error(f, "choose another number", "target %d is there already",
                                 (int)number);
        }
    }
    if (finish(f, l) != 0) {
        return -1;
    }
    l->item[l->count++] = (struct nav_live_item){.number = (int)number,
                                                 .kind = (int)kind,
                                                 .reply = (int)reply,
                                                 .first_point = l->point_count,
                                                 .until_s = INFINITY};
    return 0;
}

/* Numbers behind the word: a time or a speed, latitude, longitude, and a height or none. */
static int read_numbers(const struct db_text_file *f, char **word, int words, double value[4])
{
    static const double least[] = {0, -90, -180, -1000}, most[] = {1e6, 90, 180, 16000};
    static const char *const names[] = {"number", "latitude", "longitude", "height"};
    value[3] = on_ground_m;
    if (words < 4) {
        return db_text_error(f, "write at 60 46.1 11.05, or with a height", "lacks a number");
    }
    for (int i = 0; i + 1 < words; i++) {
        if (!hs_number_within(word[i + 1], least[i], most[i], &value[i])) {
            return db_text_error(f, NULL, "\"%s\" is no %s of %g..%g", word[i + 1], names[i],
                                 least[i], most[i]);
        }
    }
    return 0;
}

/* The time of the first point of a route, which has no speed. */
static int set_first_time(const struct db_text_file *f, struct nav_live_point *p, bool is_speed,
                          double value)
{
    p->at_s = value;
    return is_speed ? db_text_error(f, "write at SECONDS", "the first place needs a time") : 0;
}

/* The time of a point, and whether it can be reached from the one before. */
static int set_time(const struct db_text_file *f, const struct nav_live_point *before,
                    struct nav_live_point *p, bool is_speed, double value)
{
    const double way_m = metres_between(before, p);
    if (is_speed && (value <= 0 || way_m < 0.01)) {
        return db_text_error(f, "write at SECONDS",
                             "a speed needs to be above 0, and another place to go to");
    }
    p->at_s = is_speed ? before->at_s + way_m / value : value;
    if (p->at_s <= before->at_s) {
        return db_text_error(f, "put the places in the order of their times",
                             "%g s is not after the place before, %g s", p->at_s, before->at_s);
    }
    if (way_m > NAV_LIVE_SPEED_MOST_MS * (p->at_s - before->at_s)) {
        return db_text_error(f, "give it more time", "%.0f m in %.3g s are above %d m/s", way_m,
                             p->at_s - before->at_s, NAV_LIVE_SPEED_MOST_MS);
    }
    return 0;
}

static int add_point(const struct db_text_file *f, struct nav_live *l, char **word, int words)
{
    struct nav_live_item *t = current(l);
    const bool is_speed = strcmp(word[0], "speed") == 0;
    double value[4] = {0};
    if (t == NULL) {
        return db_text_error(f, "begin with target NUMBER KIND", "belongs to no target");
    }
    if (l->point_count == NAV_LIVE_POINTS) {
        return db_text_error(f, "leave some out", "is one place too many: %d are allowed",
                             NAV_LIVE_POINTS);
    }
    if (read_numbers(f, word, words, value) != 0) {
        return -1;
    }
    struct nav_live_point *p = &l->point[l->point_count];
    const struct nav_live_point *before = t->points > 0 ? p - 1 : NULL;
    *p = (struct nav_live_point){0, value[1], value[2], value[3]};
    if (before && isinf(before->height_m) != isinf(p->height_m)) {
        return db_text_error(f, "give all places of the target a height, or none",
                             "one place of a target has a height and one has none");
    }
    const int status = before ? set_time(f, before, p, is_speed, value[0])
                              : set_first_time(f, p, is_speed, value[0]);
    if (status != 0) {
        return -1;
    }
    t->from_s = before ? t->from_s : p->at_s;
    t->height_m = p->height_m;
    t->points++;
    l->point_count++;
    return 0;
}

/* It is removed at its last place. */
static int end_target(const struct db_text_file *f, struct nav_live *l, int words)
{
    struct nav_live_item *t = current(l);
    if (words != 1 || t == NULL || t->points < 2) {
        return db_text_error(f, "write it once, behind two places or more", "gone stands alone");
    }
    t->until_s = l->point[l->point_count - 1].at_s;
    return 0;
}

static int take_line(struct db_text_file *f, struct nav_live *l)
{
    char *word[WORDS_MAX];
    const int words = db_text_words(f->line, word, WORDS_MAX);
    if (words > WORDS_MAX) {
        return db_text_error(f, words_help, "has too many words");
    }
    if (strcmp(word[0], "target") == 0) {
        return begin_target(f, l, word, words);
    }
    if (strcmp(word[0], "at") == 0 || strcmp(word[0], "speed") == 0) {
        return add_point(f, l, word, words);
    }
    return strcmp(word[0], "gone") == 0
               ? end_target(f, l, words)
               : db_text_error(f, words_help, "\"%s\" is unknown", word[0]);
}

int nav_live_read(struct nav_live *l, const char *path)
{
    struct db_text_file f;
    if (db_text_open(&f, path) != 0) {
        return -1;
    }
    const int count = l->count;
    int status;
    while ((status = db_text_next(&f)) == 1) {
        if (take_line(&f, l) != 0) {
            status = -1;
            break;
        }
    }
    if (status == 0 && l->count == count) {
        status = db_text_error(&f, "begin with target NUMBER KIND", "has no target");
    }
    status = status == 0 ? finish(&f, l) : status;
    db_text_close(&f);
    return status;
}
