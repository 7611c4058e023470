#include "sim/script.h"

#include "fx/types.h"
#include "hs/angle.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/number.h"
#include "lm/radar.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 10, PRESS_US = 100000, REFUSAL_BYTES = 320 };

/* A line may mean two events: a button goes down and up again. */
struct line_events {
    struct script_event event[2];
    int count;
    char refusal[REFUSAL_BYTES]; /* why the radar cannot do it; "": the words are not understood */
};

static bool choice(const char *word, const char *const *names, int count, int32_t *index)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(word, names[i]) == 0) {
            *index = i;
            return true;
        }
    }
    return false;
}

/* Words behind a patch: its effects. */
static bool parse_effects(char **words, int count, struct lm_sar_command *sar)
{
    static const char *const names[] = {"plan", "steady"};
    for (int i = 0; i < count; i++) {
        int32_t index;
        if (!choice(words[i], names, 2, &index)) {
            return false;
        }
        *(index == 0 ? &sar->is_plan : &sar->is_steady) = true;
    }
    return true;
}

static bool place(char **words, struct lm_position *at)
{
    double lat, lon;
    if (!hs_number_within(words[0], -90, 90, &lat) ||
        !hs_number_within(words[1], -180, 180, &lon)) {
        return false;
    }
    *at = (struct lm_position){hs_bam(lat), hs_bam(lon)};
    return true;
}

static bool parse_sar(char **words, int count, struct lm_control *c)
{
    struct lm_position centre;
    double cell, look = 0, range = 0, height = 0;
    const bool is_from_ownship = strcmp(words[1], "sar") == 0;
    const int least = is_from_ownship ? 5 : 8;
    if (count < least || !place(words + 2, &centre) ||
        !hs_number_within(words[4], 0.1, 1000, &cell)) {
        return false;
    }
    if (!is_from_ownship && (!hs_number_within(words[5], -360, 360, &look) ||
                             !hs_number_within(words[6], 0, 1e6, &range) ||
                             !hs_number_within(words[7], -500, 30000, &height))) {
        return false;
    }
    c->kind = LM_CONTROL_SAR;
    c->sar = (struct lm_sar_command){
        .centre = centre,
        .cell_mm = (uint32_t)lround(cell * 1000),
        .is_from_ownship = is_from_ownship,
        .look_azimuth = hs_bam(look),
        .range_m = (uint32_t)lround(range),
        .height_m_q6 = (int32_t)lround(height * 64),
    };
    return parse_effects(words + least, count - least, &c->sar);
}

/* Whether mode and field of view have the scale; where a key may have chosen others, nobody knows.
 */
static bool has_scale(const struct script *s, struct line_events *line)
{
    const struct lm_radar *radar = s->radar;
    if (s->mode < 0 || s->range_nm < 0) {
        return true;
    }
    const uint32_t last = lm_radar_range_last(radar, (uint32_t)s->mode, (uint32_t)s->field);
    if (s->range_nm <= radar->range[last].range_nm) {
        return true;
    }
    snprintf(line->refusal, sizeof line->refusal, "%s %s has no scale of %d nautical miles",
             lm_radar_mode_name(radar, (uint32_t)s->mode), radar->fov[s->field].name,
             (int)s->range_nm);
    return false;
}

/* A scale by its nautical miles. */
static bool parse_range(struct script *s, const char *word, struct line_events *line)
{
    double range_nm;
    if (!hs_number_within(word, 1, 999, &range_nm)) {
        return false;
    }
    s->range_nm = (int32_t)range_nm;
    if (s->range_nm != range_nm || lm_radar_find_range(s->radar, s->range_nm) < 0) {
        snprintf(line->refusal, sizeof line->refusal, "the radar has no scale of %s nautical miles",
                 word);
        return false;
    }
    line->event[0].control = (struct lm_control){.kind = LM_CONTROL_RANGE, .range_nm = s->range_nm};
    return has_scale(s, line);
}

/* A sector by its degrees to each side. */
static bool parse_azimuth(const struct lm_radar *radar, const char *word, struct lm_control *c)
{
    double degrees;
    if (!hs_number_within(word, 0, 90, &degrees) || degrees != floor(degrees)) {
        return false;
    }
    c->kind = LM_CONTROL_AZIMUTH;
    c->azimuth_index = lm_radar_find_azimuth(radar, (int32_t)degrees);
    return c->azimuth_index >= 0;
}

static bool parse_choice(struct script *s, char **words, int count, struct line_events *line)
{
    static const char *const switches[] = {"off", "on"};
    struct lm_control *c = &line->event[0].control;
    if (count != 3) {
        return false;
    }
    if (strcmp(words[1], "range") == 0) {
        return parse_range(s, words[2], line);
    }
    if (strcmp(words[1], "azimuth") == 0) {
        return parse_azimuth(s->radar, words[2], c);
    }
    if (strcmp(words[1], "freeze") == 0) {
        int32_t is_on = 0;
        const bool is_switch = choice(words[2], switches, 2, &is_on);
        *c = (struct lm_control){.kind = LM_CONTROL_FREEZE, .is_frozen = is_on != 0};
        return is_switch;
    }
    double gain;
    c->kind = LM_CONTROL_GAIN;
    if (strcmp(words[1], "gain") != 0 || !hs_number_within(words[2], -30, 30, &gain)) {
        return false;
    }
    c->gain_db = (int32_t)lround(gain);
    return true;
}

/* The second event of a line, `after_s` behind the first. */
static void add_end(struct line_events *line, struct lm_control control, double after_s)
{
    line->event[1] = (struct script_event){
        .time_us = line->event[0].time_us + (uint64_t)llround(after_s * 1e6),
        .control = control,
    };
    line->count = 2;
}

static bool parse_button(char **words, int count, struct line_events *line)
{
    static const char *const rockers[] = {"gain", "sym", "brt", "con"};
    static const char *const steps[] = {"-1", "+1"};
    double held_s = PRESS_US / 1e6, osb;
    int32_t button;
    if (strcmp(words[1], "osb") == 0) {
        if (count < 3 || count > 4 || !hs_number_within(words[2], 1, LM_OSBS, &osb) ||
            osb != floor(osb) || (count == 4 && !hs_number_within(words[3], 0, 3600, &held_s))) {
            return false;
        }
        button = (int32_t)osb;
    } else {
        int32_t rocker, step;
        if (count != 4 || !choice(words[2], rockers, LM_ROCKERS, &rocker) ||
            !choice(words[3], steps, 2, &step)) {
            return false;
        }
        button = lm_rocker_button((enum lm_rocker)rocker, step == 1);
    }
    line->event[0].control = lm_control_button(true, button);
    add_end(line, lm_control_button(false, button), held_s);
    return true;
}

static bool parse_deflection(char **words, int count, struct line_events *line)
{
    const bool is_slew = strcmp(words[1], "slew") == 0;
    double x, y = 0, for_s = 0;
    if (count != (is_slew ? 5 : 3) || !hs_number_within(words[2], -1, 1, &x) ||
        (is_slew && (!hs_number_within(words[3], -1, 1, &y) ||
                     !hs_number_within(words[4], 0, 3600, &for_s)))) {
        return false;
    }
    const int32_t x_deflection = (int32_t)lround(x * LM_FULL_DEFLECTION);
    const int32_t y_deflection = (int32_t)lround(y * LM_FULL_DEFLECTION);
    if (is_slew) {
        line->event[0].control = lm_control_slew(x_deflection, y_deflection);
        add_end(line, lm_control_slew(0, 0), for_s);
    } else {
        line->event[0].control = lm_control_knob(x_deflection);
    }
    return true;
}

/* A mode of the radar table, and a field of view that it has; without one, the first. */
static bool parse_sector(struct script *s, char **words, int count, struct line_events *line)
{
    const struct lm_radar *radar = s->radar;
    const int32_t mode = lm_radar_find_mode(radar, words[1]);
    const int32_t field = count == 3 ? lm_radar_find_fov(radar, words[2]) : LM_FOV_NORM;
    if (count > 3 || field < 0) {
        return false;
    }
    if (field > (int32_t)lm_radar_fov_last(radar, (uint32_t)mode)) {
        snprintf(line->refusal, sizeof line->refusal, "%s has no %s",
                 lm_radar_mode_name(radar, (uint32_t)mode), radar->fov[field].name);
        return false;
    }
    s->mode = mode;
    s->field = field;
    line->event[0].control =
        (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {.mode = mode, .fov = field}};
    return has_scale(s, line);
}

/* "steer LAT LON", or "steer off": as the bus says. */
static bool parse_steer(char **words, int count, struct lm_control *c)
{
    c->kind = LM_CONTROL_STEERPOINT;
    c->steerpoint.is_set = count == 4;
    return count == 4 ? place(words + 2, &c->steerpoint.position)
                      : count == 3 && strcmp(words[2], "off") == 0;
}

static bool parse_cursor(char **words, int count, struct lm_control *c)
{
    c->kind = LM_CONTROL_CURSOR;
    return count == 4 && place(words + 2, &c->cursor);
}

/* "mount PLACE FILE" or "unmount PLACE". */
static bool parse_mount(char **words, int count, struct script_event *e)
{
    double place;
    const bool comes = strcmp(words[1], "mount") == 0;
    if (count != 3 + comes || !hs_number_within(words[2], 1, LM_IMAGES_MAX, &place) ||
        place != floor(place)) {
        return false;
    }
    e->control.kind = LM_CONTROL_IMAGE;
    e->control.image.place = (int32_t)place;
    return !comes || (size_t)snprintf(e->image, sizeof e->image, "%s", words[3]) < sizeof e->image;
}

/* Commands of one word. */
static bool parse_plain(const char *word, struct lm_control *c)
{
    static const char *const names[] = {"designate", "drop", "track", "ranging"};
    static const enum lm_control_kind kinds[] = {LM_CONTROL_DESIGNATE, LM_CONTROL_DROP,
                                                 LM_CONTROL_TRACK, LM_CONTROL_RANGING};
    int32_t index;
    if (!choice(word, names, 4, &index)) {
        return false;
    }
    c->kind = kinds[index];
    return true;
}

static bool add_rain(char **words, int count, struct lm_environment *e)
{
    double radius_km, mm_per_h;
    if (count != 6 || e->rain_count == LM_RAINS_MAX ||
        !hs_number_within(words[4], 0.1, 100, &radius_km) ||
        !hs_number_within(words[5], 1, 150, &mm_per_h)) {
        return false;
    }
    struct lm_rain *rain = &e->rain[e->rain_count++];
    rain->radius_m = (uint32_t)lround(radius_km * 1000);
    rain->mm_per_h = (uint16_t)lround(mm_per_h);
    return place(words + 2, &rain->centre);
}

static bool add_jammer(char **words, int count, struct lm_environment *e)
{
    double ratio_db;
    if (count != 5 || e->jammer_count == LM_JAMMERS_MAX ||
        !hs_number_within(words[4], -20, 80, &ratio_db)) {
        return false;
    }
    struct lm_jammer *jammer = &e->jammer[e->jammer_count++];
    jammer->noise_ratio_db_q8 = (int16_t)lround(ratio_db * 256);
    return place(words + 2, &jammer->position);
}

/* What changes the environment; the control carries the whole of it. */
static bool parse_environment(char **words, int count, struct lm_environment *e)
{
    double state, wind_deg = 0;
    if (strcmp(words[1], "rain") == 0) {
        return add_rain(words, count, e);
    }
    if (strcmp(words[1], "jam") == 0) {
        return add_jammer(words, count, e);
    }
    if (strcmp(words[1], "weather") == 0) {
        e->rain_count = e->jammer_count = 0;
        return count == 3 && strcmp(words[2], "fair") == 0;
    }
    if (count < 3 || count > 4 || !hs_number_within(words[2], 0, LM_SEA_STATE_MAX, &state) ||
        state != floor(state)) {
        return false;
    }
    e->sea_state = (uint8_t)state;
    e->is_sea_commanded = true;
    e->has_wind = count == 4;
    if (e->has_wind && !hs_number_within(words[3], -180, 360, &wind_deg)) {
        return false;
    }
    e->wind_from = hs_bam(wind_deg);
    return true;
}

/* Times of the exercise lie on the steps of the bench. */
static double time_of(const struct line_events *line)
{
    return round((double)line->event[0].time_us * 1e-4) * 1e-2;
}

/* "clock rate RATE", for a clock that is set. */
static bool parse_rate(struct nav_exercise *x, char **words, int count, struct line_events *line)
{
    double rate[2] = {-1, time_of(line)};
    if (!x->has_clock) {
        snprintf(line->refusal, sizeof line->refusal,
                 "no `clock SHOWN_S` stands before this `clock rate`");
    } else if (count != 4 || !hs_number_within(words[3], 0, 16, &rate[0])) {
        snprintf(line->refusal, sizeof line->refusal, "`clock rate` needs one value, 0..16");
    } else if (!nav_exercise_add_rate(x, rate, 2)) {
        snprintf(line->refusal, sizeof line->refusal,
                 x->rate_count == NAV_EXERCISE_RATES
                     ? "is one `clock rate` too many: a script has seven at most"
                     : "`clock rate` must stand 0.01 s or more behind the `clock` before it");
    }
    return !line->refusal[0];
}

/* "clock SHOWN_S [SEED]" or "clock rate RATE". */
static bool parse_clock(struct nav_exercise *x, char **words, int count, struct line_events *line)
{
    double shown_s, seed = 0;
    const double rate[2] = {1, time_of(line)};
    if (count > 2 && strcmp(words[2], "rate") == 0) {
        return parse_rate(x, words, count, line);
    }
    if (x->has_clock) {
        snprintf(line->refusal, sizeof line->refusal,
                 "the clock is set already; `clock rate` changes its pace");
        return false;
    }
    if (count < 3 || count > 4 || !hs_number_within(words[2], 0, 2147483, &shown_s) ||
        (count == 4 && (!hs_number_within(words[3], 0, INT32_MAX, &seed) || seed != floor(seed)))) {
        snprintf(line->refusal, sizeof line->refusal,
                 "`clock` needs SHOWN_S, 0..2147483, and perhaps a SEED, 0..2147483647");
        return false;
    }
    x->start_s = shown_s - rate[1];
    x->has_seed = count == 4;
    x->seed = (int32_t)seed;
    x->has_clock = nav_exercise_add_rate(x, rate, 2);
    return x->has_clock;
}

/* "break NAME[=VALUE[,VALUE]] [FOR_S]". */
static bool parse_break(struct nav_exercise *x, char **words, int count, struct line_events *line)
{
    char text[96];
    double for_s;
    if (count < 3 || count > 4 || strchr(words[2], '@') || strlen(words[2]) > 40 ||
        (count == 4 && !hs_number_within(words[3], 0.01, 1e6, &for_s))) {
        snprintf(line->refusal, sizeof line->refusal,
                 "`break` needs NAME[=VALUE[,VALUE]], and perhaps FOR_S, 0.01 seconds or more");
        return false;
    }
    const double from_s = time_of(line);
    const int length = snprintf(text, sizeof text, "%s@%.2f", words[2], from_s);
    if (count == 4) {
        snprintf(text + length, sizeof text - (size_t)length, ",%.2f",
                 from_s + round(for_s * 100) / 100);
    }
    const char *const cause = nav_exercise_add_malfunction(x, text);
    if (cause) {
        snprintf(line->refusal, sizeof line->refusal, "`break %s` %s", words[2], cause);
    }
    return !cause;
}

static bool is_exercise(const char *word)
{
    return strcmp(word, "clock") == 0 || strcmp(word, "break") == 0;
}

static bool parse_exercise(struct script *s, char **words, int count, struct line_events *line)
{
    line->count = 0; /* the bus tells it, not the operator */
    return (strcmp(words[1], "clock") == 0 ? parse_clock : parse_break)(&s->exercise, words, count,
                                                                        line);
}

static bool parse_line(struct script *s, char **words, int count, struct line_events *line)
{
    static const char *const weathers[] = {"rain", "jam", "weather", "seastate"};
    int32_t which;
    double seconds;
    struct script_event *e = &line->event[0];
    memset(line, 0, sizeof *line);
    line->count = 1;
    if (count < 2 || !hs_number_within(words[0], 0, 1e6, &seconds)) {
        return false;
    }
    e->time_us = (uint64_t)llround(seconds * 1e6);
    if (lm_radar_find_mode(s->radar, words[1]) >= 0) {
        return parse_sector(s, words, count, line);
    }
    if (is_exercise(words[1])) {
        return parse_exercise(s, words, count, line);
    }
    if (choice(words[1], weathers, 4, &which)) {
        const bool is_understood = parse_environment(words, count, &s->environment);
        e->control.kind = LM_CONTROL_ENVIRONMENT;
        e->control.environment = s->environment;
        return is_understood;
    }
    if (count == 2) {
        return parse_plain(words[1], &e->control);
    }
    if (strcmp(words[1], "picture") == 0) {
        e->is_picture = true;
        return count == 3 && !strchr(words[2], '/') &&
               (size_t)snprintf(e->picture, sizeof e->picture, "%s", words[2]) < sizeof e->picture;
    }
    if (strcmp(words[1], "osb") == 0 || strcmp(words[1], "rocker") == 0) {
        s->mode = s->range_nm = -1; /* a key may select others */
        return parse_button(words, count, line);
    }
    if (strcmp(words[1], "slew") == 0 || strcmp(words[1], "knob") == 0) {
        return parse_deflection(words, count, line);
    }
    if (strcmp(words[1], "mount") == 0 || strcmp(words[1], "unmount") == 0) {
        return parse_mount(words, count, e);
    }
    if (strcmp(words[1], "steer") == 0) {
        return parse_steer(words, count, &e->control);
    }
    if (strcmp(words[1], "cursor") == 0) {
        return parse_cursor(words, count, &e->control);
    }
    if (strncmp(words[1], "sar", 3) == 0) {
        return parse_sar(words, count, &e->control);
    }
    return parse_choice(s, words, count, line);
}

static int split(char *line, char **words)
{
    line[strcspn(line, "#")] = 0;
    int count = 0;
    char *rest = NULL;
    for (char *w = strtok_r(line, " \t\r\n", &rest); w; w = strtok_r(NULL, " \t\r\n", &rest)) {
        if (count == WORDS_MAX) {
            return WORDS_MAX + 1;
        }
        words[count++] = w;
    }
    return count;
}

static int append(struct script *s, const char *place, int line_number,
                  const struct line_events *line)
{
    const size_t count = (size_t)(s->count + line->count);
    struct script_event *grown = realloc(s->events, sizeof *grown * count);
    if (!grown) {
        return hs_error(place, NULL, "out of memory");
    }
    s->events = grown;
    for (int i = 0; i < line->count; i++) {
        s->events[s->count] = line->event[i];
        s->events[s->count].order = s->count;
        s->events[s->count].line = line_number;
        s->count++;
    }
    return 0;
}

/* What is wrong with a line that was not understood. */
static void find_reason(const struct script *s, char **words, int count, char text[REFUSAL_BYTES])
{
    static const char *const commands[] = {
        "range",     "azimuth", "gain",     "freeze",  "sar",     "sarfrom", "steer",  "rain",
        "jam",       "weather", "seastate", "osb",     "rocker",  "knob",    "slew",   "cursor",
        "designate", "drop",    "track",    "ranging", "picture", "mount",   "unmount"};
    int32_t which;
    double seconds;
    const size_t size = REFUSAL_BYTES;
    if (!hs_number_within(words[0], 0, 1e6, &seconds)) {
        snprintf(text, size, "begins with `%.40s`, which is no time in seconds", words[0]);
    } else if (count < 2) {
        snprintf(text, size, "has a time but no command");
    } else if (count > WORDS_MAX) {
        snprintf(text, size, "has more words than any command takes");
    } else if (lm_radar_find_mode(s->radar, words[1]) < 0 &&
               !choice(words[1], commands, sizeof commands / sizeof commands[0], &which)) {
        snprintf(text, size, "`%.40s` is not a command of a script", words[1]);
    } else if (count == 2) {
        snprintf(text, size, "`%.40s` needs values", words[1]);
    } else {
        snprintf(text, size, "`%.40s` does not take these %d values, or one is out of range",
                 words[1], count - 2);
    }
}

static int take_line(struct script *s, const char *path, int line_number, char *line)
{
    char *words[WORDS_MAX], place[512];
    snprintf(place, sizeof place, "%s line %d", path, line_number);
    const int count = split(line, words);
    if (count == 0) {
        return 0;
    }
    struct line_events parsed;
    if (count > WORDS_MAX || !parse_line(s, words, count, &parsed)) {
        if (count > WORDS_MAX || !parsed.refusal[0]) {
            find_reason(s, words, count, parsed.refusal);
        }
        return hs_error(place, "landmass-sim --help lists the commands", "%s", parsed.refusal);
    }
    if (parsed.event[0].time_us < s->last_us) {
        return hs_error(place, "sort the script by time", "goes back in time");
    }
    s->last_us = parsed.event[0].time_us;
    return parsed.count > 0 ? append(s, place, line_number, &parsed) : 0;
}

static int by_time(const void *a, const void *b)
{
    const struct script_event *x = a, *y = b;
    if (x->time_us != y->time_us) {
        return x->time_us < y->time_us ? -1 : 1;
    }
    return x->order < y->order ? -1 : 1;
}

/* The file is opened when its time has come. */
static bool hand_out(const struct script *s, const struct script_event *e,
                     struct lm_control *control)
{
    *control = e->control;
    return e->control.kind != LM_CONTROL_IMAGE ||
           (s->images.open && s->images.open(s->images.ctx, e->control.image.place,
                                             e->image[0] ? e->image : NULL, control));
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct script *s = ctx;
    while (s->next < s->count && !s->events[s->next].is_picture &&
           s->events[s->next].time_us <= s->now_us) {
        const struct script_event *e = &s->events[s->next++];
        s->line_taken = e->line;
        if (hand_out(s, e, control)) {
            return 1;
        }
    }
    return 0;
}

void script_report_refusal(const struct script *s, enum lm_refusal reason)
{
    static const char *const causes[LM_REFUSALS] = {
        [LM_REFUSED_NOT] = "nothing is wrong",
        [LM_REFUSED_VALUE] = "out of range, or mode and field of view lack it",
        [LM_REFUSED_PAGE] = "no cursor is on the page that is shown",
        [LM_REFUSED_CURSOR] = "the cursor is not placed yet",
        [LM_REFUSED_SILENT] = "the radar is silenced",
        [LM_REFUSED_MAP] = "there is no usable map",
        [LM_REFUSED_NAV] = "position, height, heading or velocity is not good",
        [LM_REFUSED_CELL] = "no patch has such cells",
        [LM_REFUSED_NEAR] = "the patch is too near",
        [LM_REFUSED_FAR] = "the patch is too far",
        [LM_REFUSED_HEIGHT] = "the antenna is too high or too low",
        [LM_REFUSED_SQUINT] = "the squint is too small: the patch is too near to the track",
        [LM_REFUSED_GIMBAL] = "the patch is beyond the antenna's gimbal",
        [LM_REFUSED_DWELL] = "the dwell would be too long",
        [LM_REFUSED_SWAP] = "there is no other display to swap with",
        [LM_REFUSED_POLE] = "the patch is too near to a pole",
    };
    char place[sizeof s->path + 32];
    snprintf(place, sizeof place, "%s line %d", s->path, s->line_taken);
    hs_warn(place, "the unit goes on without it", "refused: %s",
            causes[(unsigned)reason < LM_REFUSALS ? reason : LM_REFUSED_VALUE]);
}

static void report_refused(void *ctx, enum lm_refusal reason)
{
    script_report_refusal(ctx, reason);
}

int script_read(struct script *s, const char *path, const struct lm_radar *radar)
{
    memset(s, 0, sizeof *s);
    s->radar = radar;
    s->range_nm = radar->range_start_nm;
    s->port = (struct lm_controls){.ctx = s, .next = next_control, .refused = report_refused};
    snprintf(s->path, sizeof s->path, "%s", path ? path : "script");
    s->environment.sea_state = LM_SEA_STATE_OF_IMAGE;
    if (!path) {
        return 0;
    }
    FILE *file = hs_input_open(path, "r");
    if (!file) {
        return hs_error(path, "check the name", "cannot be opened: %s", strerror(errno));
    }
    char *line = NULL;
    size_t size = 0;
    int status = 0;
    for (int n = 1; status == 0 && getline(&line, &size, file) > 0; n++) {
        status = take_line(s, path, n, line);
    }
    free(line);
    fclose(file);
    if (status != 0) {
        script_free(s);
    } else if (s->count > 0) {
        qsort(s->events, (size_t)s->count, sizeof *s->events, by_time);
    }
    return status;
}

void script_free(struct script *s)
{
    free(s->events);
    s->events = NULL;
    s->count = s->next = 0;
}

const char *script_advance(struct script *s, uint64_t now_us)
{
    s->now_us = now_us;
    if (s->next < s->count && s->events[s->next].is_picture &&
        s->events[s->next].time_us <= now_us) {
        return s->events[s->next++].picture;
    }
    return NULL;
}
