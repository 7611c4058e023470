/* Virtual panel: the program landmass-panel, its own loop in its own time, where a pipe is the bus
 * and a file notes what its glass gets.
 *
 *     virtual_panel CONFIG SUMS <bus
 *
 * The bus are lines of candump -L, heard when they come; nothing is sent. SUMS gets a line for each
 * picture that the firmware presents: its number, the step that drew it, and the CRC-32C of its
 * pixels. SIGTERM ends it. */
#include "config.h"
#include "panel.h"

#include "drv/can_line.h"
#include "fx/crc32c.h"

#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

struct pipe_bus {
    struct panel *panel;
    char text[65536];
    size_t begin, end; /* of what was read and not yet taken */
};

/* What stands between the firmware and the panel's glass. */
static struct {
    const struct panel *panel;
    int (*present)(void *ctx, const struct lm_damage *changed);
    FILE *sums;
} noted;

static void read_more(struct pipe_bus *b)
{
    memmove(b->text, b->text + b->begin, b->end - b->begin);
    b->end -= b->begin;
    b->begin = 0;
    const ssize_t got = read(STDIN_FILENO, b->text + b->end, sizeof b->text - b->end);
    b->end += got > 0 ? (size_t)got : 0;
}

/* The next line, without its end; NULL: none is whole. */
static const char *next_line(struct pipe_bus *b)
{
    for (int tries = 0; tries < 2; tries++) {
        char *line = b->text + b->begin, *feed = memchr(line, '\n', b->end - b->begin);
        if (feed != NULL) {
            *feed = '\0';
            b->begin += (size_t)(feed - line) + 1;
            return line;
        }
        read_more(b);
    }
    return NULL;
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct pipe_bus *b = ctx;
    const char *line;
    b->panel->bus.polls++;
    while ((line = next_line(b)) != NULL) {
        if (drv_can_log_parse(line, frame) == NULL) {
            frame->time_us = panel_now_us(b->panel);
            return 1;
        }
    }
    return 0;
}

static int send_nowhere(void *ctx, const struct lm_can_frame *frame)
{
    (void)ctx;
    (void)frame;
    return LM_OK;
}

static int note(void *ctx, const struct lm_damage *changed)
{
    const struct glass *g = ctx;
    const struct lm_surface *p = &g->picture;
    const int status = noted.present(ctx, changed);
    const uint32_t pixels = (uint32_t)p->width_px * p->height_px;
    fprintf(noted.sums, "%" PRIu32 " %" PRIu32 " %08" PRIx32 "\n", g->count.pictures,
            noted.panel->count.steps + 1, fx_crc32c(0, p->pixels, pixels * sizeof *p->pixels));
    return status;
}

static void report_line(void *ctx, uint32_t line, const char *cause)
{
    fprintf(stderr, "virtual_panel: %s line %" PRIu32 ": %s\n", (const char *)ctx, line, cause);
}

/* The number of wrong lines; -1: it cannot be read. */
static int read_config(struct config *config, char *path)
{
    static char text[CONFIG_FILE_BYTES];
    FILE *file = fopen(path, "r");
    if (file == NULL) {
        return -1;
    }
    const size_t size = fread(text, 1, sizeof text, file);
    fclose(file);
    config_defaults(config);
    return (int)config_read(config, text, size, report_line, path);
}

int main(int argc, char **argv)
{
    static struct panel panel;
    static struct pipe_bus bus = {.panel = &panel};
    struct config config;
    noted.sums = argc == 3 ? fopen(argv[2], "w") : NULL;
    if (noted.sums == NULL || read_config(&config, argv[1]) != 0 ||
        panel_open(&panel, &config) != 0) {
        fprintf(stderr, "Usage: virtual_panel CONFIG SUMS <bus\n");
        return 1;
    }
    setvbuf(noted.sums, NULL, _IOLBF, 4096);
    (void)fcntl(STDIN_FILENO, F_SETFL, O_NONBLOCK);
    panel.bus.port.ctx = &bus;
    panel.bus.port.receive = receive;
    panel.bus.port.send = send_nowhere;
    noted.panel = &panel;
    noted.present = panel.glass.port.present;
    panel.glass.port.present = note;
    panel_run(&panel);
    panel_close(&panel);
    return fclose(noted.sums) == 0 ? 0 : 1;
}
