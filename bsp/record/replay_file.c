/* A recording in files, and its pictures in memory of the heap. */
#include "replay.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* NAME-003.log after NAME-002.log. False if the name has no such number, or there is no such
 * file. */
static bool open_next_part(struct replay *p)
{
    const size_t length = strlen(p->path);
    char *digits = p->path + length - 7; /* "002.log" */
    unsigned number;
    if (length < 8 || digits[-1] != '-' || sscanf(digits, "%3u", &number) != 1 || number == 999 ||
        strcmp(digits + 3, ".log") != 0) {
        return false;
    }
    char next[8];
    snprintf(next, sizeof next, "%03u.log", number + 1);
    memcpy(digits, next, 7);
    FILE *file = fopen(p->path, "r");
    if (!file) {
        return false;
    }
    fclose(p->source);
    p->source = file;
    p->line = 0;
    return true;
}

static enum replay_line next_line(struct replay *p, char *line)
{
    if (!fgets(line, REPLAY_LINE_BYTES, p->source) &&
        !(open_next_part(p) && fgets(line, REPLAY_LINE_BYTES, p->source))) {
        return REPLAY_LINE_OVER;
    }
    char *end = strchr(line, '\n');
    if (!end) {
        const bool is_torn =
            feof((FILE *)p->source) || line[0] == '\0'; /* zeros: the power was cut */
        return is_torn ? REPLAY_LINE_TORN : REPLAY_LINE_BAD;
    }
    *end = '\0';
    return REPLAY_LINE;
}

int replay_open(struct replay *p, const char *path)
{
    memset(p, 0, sizeof *p);
    snprintf(p->path, sizeof p->path, "%s", path);
    p->source = fopen(path, "r");
    if (!p->source) {
        snprintf(p->error, sizeof p->error, "%.200s: %s", path, strerror(errno));
        return -1;
    }
    if (replay_begin(p, next_line) != 0) {
        replay_close(p);
        return -1;
    }
    return 0;
}

int replay_wrap(struct replay *p, struct lm_board *board)
{
    p->memory = calloc(replay_pixels(p), sizeof *p->memory);
    if (!p->memory) {
        return -1;
    }
    replay_wrap_with(p, board, p->memory);
    return 0;
}

void replay_close(struct replay *p)
{
    if (p->source) {
        fclose(p->source);
        p->source = NULL;
    }
    free(p->memory);
    p->memory = NULL;
}
