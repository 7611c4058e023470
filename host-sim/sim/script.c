#include "script.h"

#include "fx/types.h"
#include "hs/error.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 8 };

static fx_bam_t bam_of_degrees(double degrees)
{
    return (fx_bam_t)(int64_t)llround(remainder(degrees, 360.0) * 4294967296.0 / 360.0);
}

/* All of `word` as a number within the limits. */
static bool number(const char *word, double low, double high, double *value)
{
    char *end;
    *value = strtod(word, &end);
    return end != word && *end == 0 && *value >= low && *value <= high;
}

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

static bool parse_sar(char **words, int count, struct lm_control *c)
{
    double lat, lon, cell, look = 0, range = 0, height = 0;
    const bool is_from_ownship = strcmp(words[1], "sar") == 0;
    if (count != (is_from_ownship ? 5 : 8) || !number(words[2], -90, 90, &lat) ||
        !number(words[3], -180, 180, &lon) || !number(words[4], 0.1, 1000, &cell)) {
        return false;
    }
    if (!is_from_ownship &&
        (!number(words[5], -360, 360, &look) || !number(words[6], 0, 1e6, &range) ||
         !number(words[7], -500, 30000, &height))) {
        return false;
    }
    c->kind = LM_CONTROL_SAR;
    c->sar = (struct lm_sar_command){
        .centre = {bam_of_degrees(lat), bam_of_degrees(lon)},
        .cell_mm = (uint32_t)lround(cell * 1000),
        .is_from_ownship = is_from_ownship,
        .look_azimuth = bam_of_degrees(look),
        .range_m = (uint32_t)lround(range),
        .height_q6 = (int32_t)lround(height * 64),
    };
    return true;
}

static bool parse_choice(char **words, int count, struct lm_control *c)
{
    static const char *const ranges[] = {"10", "20", "40", "80"};
    static const char *const azimuths[] = {"60", "30", "10"};
    static const char *const switches[] = {"off", "on"};
    if (count != 3) {
        return false;
    }
    if (strcmp(words[1], "range") == 0) {
        c->kind = LM_CONTROL_RANGE;
        return choice(words[2], ranges, 4, &c->value);
    }
    if (strcmp(words[1], "azimuth") == 0) {
        c->kind = LM_CONTROL_AZIMUTH;
        return choice(words[2], azimuths, 3, &c->value);
    }
    if (strcmp(words[1], "freeze") == 0) {
        c->kind = LM_CONTROL_FREEZE;
        return choice(words[2], switches, 2, &c->value);
    }
    double gain;
    c->kind = LM_CONTROL_GAIN;
    if (strcmp(words[1], "gain") != 0 || !number(words[2], -30, 30, &gain)) {
        return false;
    }
    c->value = (int32_t)lround(gain);
    return true;
}

static bool parse_event(char **words, int count, struct script_event *e)
{
    double seconds;
    memset(e, 0, sizeof *e);
    if (count < 2 || !number(words[0], 0, 1e6, &seconds)) {
        return false;
    }
    e->time_us = (uint64_t)llround(seconds * 1e6);
    if (strcmp(words[1], "gm") == 0) {
        e->control.kind = LM_CONTROL_GM;
        return count == 2;
    }
    if (strcmp(words[1], "picture") == 0) {
        e->is_picture = true;
        return count == 3 && !strchr(words[2], '/') &&
               (size_t)snprintf(e->picture, sizeof e->picture, "%s", words[2]) < sizeof e->picture;
    }
    if (strncmp(words[1], "sar", 3) == 0) {
        return parse_sar(words, count, &e->control);
    }
    return parse_choice(words, count, &e->control);
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

static int take_line(struct script *s, const char *path, int line_number, char *line)
{
    char *words[WORDS_MAX], place[512];
    snprintf(place, sizeof place, "%s line %d", path, line_number);
    const int count = split(line, words);
    if (count == 0) {
        return 0;
    }
    struct script_event e;
    if (count > WORDS_MAX || !parse_event(words, count, &e)) {
        return hs_error(place, "landmass-sim --help lists the commands",
                        "is not a command of a script");
    }
    if (s->count > 0 && e.time_us < s->events[s->count - 1].time_us) {
        return hs_error(place, "sort the script by time", "goes back in time");
    }
    struct script_event *grown = realloc(s->events, sizeof *grown * (size_t)(s->count + 1));
    if (!grown) {
        return hs_error(place, NULL, "out of memory");
    }
    s->events = grown;
    s->events[s->count++] = e;
    return 0;
}

static int next_control(void *ctx, struct lm_control *control)
{
    struct script *s = ctx;
    if (s->next < s->count && !s->events[s->next].is_picture &&
        s->events[s->next].time_us <= s->now_us) {
        *control = s->events[s->next++].control;
        return 1;
    }
    return 0;
}

int script_read(struct script *s, const char *path)
{
    memset(s, 0, sizeof *s);
    s->port = (struct lm_controls){.ctx = s, .next = next_control};
    if (!path) {
        return 0;
    }
    FILE *file = fopen(path, "r");
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
