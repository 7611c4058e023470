#include "build/targets.h"

#include "fx/crc32c.h"
#include "hs/angle.h"
#include "hs/error.h"
#include "hs/number.h"
#include "hs/text_file.h"
#include "image/path.h"
#include "image/scatterer_kinds.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 16 };

/* Lines of bodies: sizes, a place, and a direction where it has one. */
static const char *const body_forms[LM_SHAPE_KINDS] = {
    [LM_SHAPE_SPHERE] = "sphere RADIUS  FORWARD RIGHT UP",
    [LM_SHAPE_PLATE] = "plate WIDTH HEIGHT  FORWARD RIGHT UP  AZIMUTH ELEVATION [ROLL] [both]",
    [LM_SHAPE_DIHEDRAL] = "dihedral WIDTH LENGTH  FORWARD RIGHT UP  AZIMUTH ELEVATION [ROLL]",
    [LM_SHAPE_TRIHEDRAL] = "trihedral LEG  FORWARD RIGHT UP  AZIMUTH ELEVATION [ROLL]",
};

static const char target_form[] =
    "target NAME LATITUDE LONGITUDE ELEVATION|ground[+HEIGHT] HEADING, then `scatterers`, "
    "`swerling CASE DBSM` or `signature NAME` or `beacon CODE [LATE_US]`, then perhaps `moving "
    "SPEED LEG`, or `moving SPEED` "
    "and lines `via LATITUDE LONGITUDE`";
static const char via_form[] =
    "via LATITUDE LONGITUDE, behind a target without bodies that is `moving SPEED`";

/* Numbers in `count` words, each within low..high; false when one is not. */
static bool read_numbers(char *const *words, int count, double *numbers, double low, double high)
{
    for (int i = 0; i < count; i++) {
        if (!hs_number_within(words[i], low, high, &numbers[i])) {
            return false;
        }
    }
    return true;
}

/* ELEVATION above the sea, or `ground` and perhaps the height above it, with its sign. */
static bool set_elevation(struct lm_target *t, char *word)
{
    const bool is_above_ground = strncmp(word, "ground", 6) == 0;
    char *number = is_above_ground ? word + 6 : word;
    double metres = 0;
    if (is_above_ground && *number != '\0' && *number != '+' && *number != '-') {
        return false;
    }
    if (*number != '\0' && !read_numbers(&number, 1, &metres, -1000, 16000)) {
        return false;
    }
    t->flags = is_above_ground ? LM_TARGET_ABOVE_GROUND : 0;
    t->elevation_m_q6 = (int32_t)lround(metres * 64);
    return true;
}

/* Perhaps `moving SPEED LEG`, or `moving SPEED` of a path, at the end of `count` words; returns how
 * many are before it, 0 when it is wrong. */
static int set_motion(struct lm_target *t, char *const *words, int count)
{
    double speed, leg = 0;
    int before = 1;
    while (before < count && strcmp(words[before], "moving") != 0) {
        before++;
    }
    if (before == count) {
        return count;
    }
    const int numbers = count - before - 1;
    if (numbers < 1 || numbers > 2 ||
        !read_numbers(&words[before + 1], 1, &speed, 0.001, LM_TARGET_SPEED_MAX_MM_S / 1000.0) ||
        (numbers == 2 && !read_numbers(&words[before + 2], 1, &leg, 1, LM_TARGET_LEG_MAX_M))) {
        return 0;
    }
    t->speed_mm_s = (uint32_t)lround(speed * 1000);
    t->leg_m = (uint32_t)lround(leg);
    t->flags |= numbers == 1 ? LM_TARGET_HAS_PATH : 0;
    return before;
}

static bool set_signature(struct lm_target *t, const struct build_signatures *signatures,
                          const char *name)
{
    const int number = build_signatures_find(signatures, name);
    if (number >= 0) {
        t->flags |= LM_TARGET_HAS_SIGNATURE;
        t->signature = (uint8_t)number;
    }
    return number >= 0;
}

/* beacon CODE [LATE_US] */
static bool set_beacon(struct lm_target *t, char *const *words, int count)
{
    double number[2] = {0};
    if (count < 2 || count > 3 || !read_numbers(words + 1, count - 1, number, 0, 15) ||
        number[0] != floor(number[0]) || number[1] != floor(number[1])) {
        return false;
    }
    t->flags |= LM_TARGET_IS_BEACON;
    t->signature = (uint8_t)((int)number[0] | (int)number[1] << 4);
    return true;
}

/* Behind HEADING: what gives the target its return. */
static bool set_kind(struct lm_target *t, const struct build_signatures *signatures,
                     char *const *words, int count)
{
    double number[2];
    if (count == 1 && strcmp(words[0], "scatterers") == 0) {
        return true;
    }
    if (count == 2 && strcmp(words[0], "signature") == 0) {
        return set_signature(t, signatures, words[1]);
    }
    if (strcmp(words[0], "beacon") == 0) {
        return set_beacon(t, words, count);
    }
    if (count != 3 || strcmp(words[0], "swerling") != 0 ||
        !read_numbers(words + 1, 1, &number[0], 0, LM_TARGET_SWERLING_MAX) ||
        !read_numbers(words + 2, 1, &number[1], -LM_TARGET_RCS_MAX_Q8 / 256.0,
                      LM_TARGET_RCS_MAX_Q8 / 256.0) ||
        number[0] != floor(number[0])) {
        return false;
    }
    t->swerling = (uint8_t)number[0];
    t->mean_rcs_dbsm_q8 = (int32_t)lround(number[1] * 256);
    return true;
}

static int read_target(const struct db_text_file *f, const struct build_signatures *signatures,
                       struct lm_target *t, char *const *words, int count)
{
    double latitude, longitude, heading;
    if (count < 7 || strlen(words[1]) > sizeof t->name) {
        return db_text_error(f, target_form,
                             "a target needs a name of up to 16 letters, a place "
                             "and a kind");
    }
    if (!read_numbers(words + 2, 1, &latitude, -90, 90) ||
        !read_numbers(words + 3, 1, &longitude, -180, 360) || !set_elevation(t, words[4]) ||
        !read_numbers(words + 5, 1, &heading, -360, 360)) {
        return db_text_error(f, target_form,
                             "place, elevation or heading is no number of its range");
    }
    memcpy(t->name, words[1], strlen(words[1]));
    t->latitude = hs_bam(latitude);
    t->longitude = hs_bam(longitude);
    t->heading = hs_bam(heading);
    return set_kind(t, signatures, words + 6, set_motion(t, words + 6, count - 6))
               ? 0
               : db_text_error(f, target_form,
                               "\"%s\" and what follows is no kind, or names no library before it",
                               words[6]);
}

static int find_body(const char *word)
{
    for (int kind = LM_SHAPE_SPHERE; kind < LM_SHAPE_KINDS; kind++) {
        if (strcmp(scatterer_kinds[kind].name, word) == 0) {
            return kind;
        }
    }
    return 0;
}

/* Azimuth and elevation, perhaps a roll, perhaps `both`. */
static bool set_direction(struct lm_scatterer *s, char *const *words, int count)
{
    double degrees[3] = {0};
    if (count > 2 && s->kind == LM_SHAPE_PLATE && strcmp(words[count - 1], "both") == 0) {
        s->is_two_sided = 1;
        count--;
    }
    if (count < 2 || count > 3 || !read_numbers(words, count, degrees, -360, 360)) {
        return false;
    }
    s->azimuth = hs_bam(degrees[0]);
    s->elevation = hs_bam(degrees[1]);
    s->roll = hs_bam(degrees[2]);
    return true;
}

static bool set_body(struct lm_scatterer *s, char *const *words, int count)
{
    const struct scatterer_kind *b = &scatterer_kinds[s->kind];
    double size_m[2] = {0}, offset_m[3];
    const int behind = 1 + b->sizes + 3;
    if (count < behind ||
        !read_numbers(words + 1, b->sizes, size_m, 0.001, LM_SHAPE_SIZE_MAX_MM / 1000.0) ||
        !read_numbers(words + 1 + b->sizes, 3, offset_m, -LM_TARGET_OFFSET_MAX_MM / 1000.0,
                      LM_TARGET_OFFSET_MAX_MM / 1000.0)) {
        return false;
    }
    for (int i = 0; i < b->sizes; i++) {
        s->size_mm[i] = (uint32_t)lround(size_m[i] * 1000);
    }
    for (int i = 0; i < 3; i++) {
        s->offset_mm[i] = (int32_t)lround(offset_m[i] * 1000);
    }
    return b->has_direction ? set_direction(s, words + behind, count - behind) : count == behind;
}

static int read_body(const struct db_text_file *f, struct lm_target *t, int kind,
                     char *const *words, int count)
{
    if (!t) {
        return db_text_error(f, target_form, "a body without a target before it");
    }
    if (t->scatterer_count == LM_SCATTERERS_MAX) {
        return db_text_error(f, "make it two targets", "the target has more than %d bodies",
                             LM_SCATTERERS_MAX);
    }
    struct lm_scatterer *s = &t->scatterers[t->scatterer_count++];
    s->kind = (uint8_t)kind;
    return set_body(s, words, count)
               ? 0
               : db_text_error(f, body_forms[kind], "a number is missing or out of its range");
}

/* One more place of the last target's path. The way ends where it began when that is named again.
 */
static int read_via(const struct db_text_file *f, struct lm_target *t, char *const *words,
                    int count)
{
    double latitude, longitude;
    if (!t || !(t->flags & LM_TARGET_HAS_PATH) || t->path_is_round) {
        return db_text_error(f, via_form, "this place belongs to no path");
    }
    if (count != 3 || !read_numbers(words + 1, 1, &latitude, -90, 90) ||
        !read_numbers(words + 2, 1, &longitude, -180, 360)) {
        return db_text_error(f, via_form, "a place is no number of its range");
    }
    if (t->path_legs == LM_TARGET_LEGS_MAX) {
        return db_text_error(f, "leave some places out", "the path has more than %d legs",
                             LM_TARGET_LEGS_MAX);
    }
    const struct lm_position begin = {t->latitude, t->longitude};
    const struct lm_position to = {hs_bam(latitude), hs_bam(longitude)};
    const struct lm_position from =
        t->path_legs > 0 ? image_path_end(&t->path[t->path_legs - 1]) : begin;
    if (image_path_leg(from, to, &t->path[t->path_legs]) != 0) {
        return db_text_error(
            f, "name places between, or leave one out",
            "the leg to this place is shorter than 1 m, longer than %d km, or goes "
            "over a pole",
            LM_TARGET_LEG_MAX_M / 1000);
    }
    t->path_legs++;
    t->path_is_round = to.latitude == begin.latitude && to.longitude == begin.longitude;
    t->heading = t->path[0].heading;
    return 0;
}

/* What is being read: the last target, and whether it said `scatterers`. */
struct reading {
    struct db_text_file file;
    struct build_targets *targets;
    bool wants_bodies;
};

/* A target that said `scatterers`, or `moving` without a leg, must have had what it needs when the
 * next one begins. */
static int end_target(const struct reading *r)
{
    if (r->targets->count == 0) {
        return 0;
    }
    const struct lm_target *last = &r->targets->items[r->targets->count - 1];
    if ((last->flags & LM_TARGET_HAS_PATH) && (last->path_legs == 0 || r->wants_bodies)) {
        return db_text_error(&r->file, via_form, "the path of target %.16s %s", last->name,
                             r->wants_bodies ? "cannot be, for it has bodies" : "has no places");
    }
    if (r->wants_bodies && last->scatterer_count == 0) {
        return db_text_error(&r->file, "add a sphere, plate, dihedral or trihedral",
                             "target %.16s has no bodies", last->name);
    }
    return 0;
}

static int begin_target(struct reading *r, char *const *words, int count)
{
    struct build_targets *t = r->targets;
    if (end_target(r) != 0) {
        return -1;
    }
    if (t->count == LM_DB_TARGETS_MAX) {
        return db_text_error(&r->file, "leave some out", "more than %d targets", LM_DB_TARGETS_MAX);
    }
    t->items[t->count] = (struct lm_target){.id = t->count};
    if (read_target(&r->file, &t->signatures, &t->items[t->count], words, count) != 0) {
        return -1;
    }
    r->wants_bodies = strcmp(words[6], "scatterers") == 0;
    t->count++;
    return 0;
}

/* A path in the file is from the file's own folder. The caller frees it; NULL without memory. */
static char *path_beside(const char *file, const char *path)
{
    const char *slash = strrchr(file, '/');
    const int folder = slash && path[0] != '/' ? (int)(slash - file) + 1 : 0;
    char *whole = NULL;
    return asprintf(&whole, "%.*s%s", folder, file, path) < 0 ? NULL : whole;
}

/* library NAME FILE.sig */
static int read_library(struct reading *r, char *const *words, int count)
{
    struct build_signatures *s = &r->targets->signatures;
    if (count != 3 || strlen(words[1]) > sizeof s->items[0].head.name) {
        return db_text_error(&r->file, "library NAME FILE.sig",
                             "a library needs a name of up to 16 letters and a file");
    }
    if (build_signatures_find(s, words[1]) >= 0) {
        return db_text_error(&r->file, "give another name", "there is a library %s already",
                             words[1]);
    }
    if (s->count == LM_DB_SIGNATURES_MAX) {
        return db_text_error(&r->file, "leave some out", "more than %d libraries",
                             LM_DB_SIGNATURES_MAX);
    }
    char *path = path_beside(r->file.path, words[2]);
    const int result = path ? build_signatures_add(s, words[1], path)
                            : hs_error(r->file.path, NULL, "out of memory");
    free(path);
    return result == 0 ? 0 : db_text_error(&r->file, NULL, "library %s cannot be taken", words[1]);
}

static int read_line(struct reading *r)
{
    char *words[WORDS_MAX];
    const int count = db_text_words(r->file.line, words, WORDS_MAX);
    if (count > WORDS_MAX) {
        return db_text_error(&r->file, NULL, "more than %d words", WORDS_MAX);
    }
    if (strcmp(words[0], "target") == 0) {
        return begin_target(r, words, count);
    }
    if (strcmp(words[0], "library") == 0) {
        return read_library(r, words, count);
    }
    struct build_targets *t = r->targets;
    struct lm_target *last = t->count > 0 ? &t->items[t->count - 1] : NULL;
    if (strcmp(words[0], "via") == 0) {
        return read_via(&r->file, r->wants_bodies ? NULL : last, words, count);
    }
    const int kind = find_body(words[0]);
    if (!kind) {
        return db_text_error(
            &r->file, "begin with library, target, via, sphere, plate, dihedral or trihedral",
            "\"%s\" is none of these", words[0]);
    }
    return read_body(&r->file, r->wants_bodies ? last : NULL, kind, words, count);
}

static void seal(struct build_targets *t)
{
    for (uint32_t i = 0; i < t->count; i++) {
        struct lm_target *item = &t->items[i];
        item->crc =
            fx_crc32c(0, (const uint8_t *)item + sizeof item->crc, sizeof *item - sizeof item->crc);
    }
}

int build_targets_read(struct build_targets *t, const char *path)
{
    struct reading r = {.targets = t};
    *t = (struct build_targets){.items = calloc(LM_DB_TARGETS_MAX, sizeof *t->items)};
    if (!t->items) {
        return hs_error(path, NULL, "out of memory");
    }
    int step = db_text_open(&r.file, path) == 0 ? 1 : -1;
    while (step > 0) {
        step = db_text_next(&r.file);
        if (step > 0 && read_line(&r) != 0) {
            step = -1;
        }
    }
    if (step == 0) {
        step = end_target(&r);
    }
    db_text_close(&r.file);
    if (step < 0) {
        build_targets_free(t);
        return -1;
    }
    seal(t);
    return 0;
}

void build_targets_free(struct build_targets *t)
{
    free(t->items);
    build_signatures_free(&t->signatures);
    *t = (struct build_targets){0};
}

void *build_targets_section(const struct build_targets *t, size_t *bytes)
{
    struct lm_targets_head head = {.count = t->count, .record_bytes = LM_TARGET_BYTES};
    head.crc = fx_crc32c(0, &head, sizeof head - sizeof head.crc);
    *bytes = sizeof head + (size_t)t->count * LM_TARGET_BYTES;
    uint8_t *section = malloc(*bytes);
    if (section) {
        memcpy(section, &head, sizeof head);
        memcpy(section + sizeof head, t->items, (size_t)t->count * LM_TARGET_BYTES);
    }
    return section;
}
