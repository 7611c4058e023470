/* The part of libgpiod 1.6 that the driver uses, over the fake chips. Its objects are ours: a line
 * is the fake line, a chip the fake chip. */
#include "fake_gpio.h"

#include <errno.h>
#include <gpiod.h>
#include <string.h>

static struct fake_line *fake(struct gpiod_line *line)
{
    return (struct fake_line *)(void *)line;
}

static struct fake_chip *chip_of(struct gpiod_line *line)
{
    const struct fake_line *f = fake(line);
    return f >= fake_chips[1].line ? &fake_chips[1] : &fake_chips[0];
}

static int status_of(int cause)
{
    errno = cause;
    return cause == 0 ? 0 : -1;
}

struct gpiod_line *gpiod_line_find(const char *name)
{
    for (int c = 0; c < FAKE_CHIPS; c++) {
        for (int i = 0; i < FAKE_LINES; i++) {
            struct fake_line *line = &fake_chips[c].line[i];
            if (line->name != NULL && strcmp(line->name, name) == 0) {
                fake_chips[c].opens++;
                return (struct gpiod_line *)(void *)line;
            }
        }
    }
    errno = ENOENT;
    return NULL;
}

struct gpiod_chip *gpiod_chip_open_lookup(const char *description)
{
    for (int c = 0; c < FAKE_CHIPS; c++) {
        if (strcmp(fake_chips[c].name, description) == 0 ||
            strcmp(fake_chips[c].label, description) == 0) {
            fake_chips[c].opens++;
            return (struct gpiod_chip *)(void *)&fake_chips[c];
        }
    }
    errno = ENOENT;
    return NULL;
}

void gpiod_chip_close(struct gpiod_chip *chip)
{
    ((struct fake_chip *)(void *)chip)->opens--;
}

struct gpiod_line *gpiod_chip_get_line(struct gpiod_chip *chip, unsigned int offset)
{
    struct fake_chip *f = (struct fake_chip *)(void *)chip;
    if (offset >= FAKE_LINES) {
        errno = EINVAL;
        return NULL;
    }
    return (struct gpiod_line *)(void *)&f->line[offset];
}

void gpiod_line_close_chip(struct gpiod_line *line)
{
    chip_of(line)->opens--;
}

static bool is_active_low(int flags)
{
    return (flags & GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW) != 0;
}

int gpiod_line_request_output_flags(struct gpiod_line *line, const char *consumer, int flags,
                                    int default_val)
{
    (void)consumer;
    (void)default_val;
    return status_of(fake_gpio_request(fake(line), true, is_active_low(flags), false));
}

int gpiod_line_request_input_flags(struct gpiod_line *line, const char *consumer, int flags)
{
    (void)consumer;
    return status_of(fake_gpio_request(fake(line), false, is_active_low(flags), false));
}

int gpiod_line_request_both_edges_events_flags(struct gpiod_line *line, const char *consumer,
                                               int flags)
{
    (void)consumer;
    return status_of(fake_gpio_request(fake(line), false, is_active_low(flags), true));
}

int gpiod_line_event_get_fd(struct gpiod_line *line)
{
    return fake(line)->events;
}

void gpiod_line_release(struct gpiod_line *line)
{
    fake_gpio_release(fake(line));
}

int gpiod_line_get_value(struct gpiod_line *line)
{
    return fake_gpio_get(fake(line));
}

int gpiod_line_set_value(struct gpiod_line *line, int value)
{
    return fake_gpio_set(fake(line), value != 0);
}

/* The events of 1.6 may be the wrong ones: their contents are nonsense here. */
int gpiod_line_event_read_multiple(struct gpiod_line *line, struct gpiod_line_event *events,
                                   unsigned int num_events)
{
    memset(events, 0xee, num_events * sizeof *events);
    return fake_gpio_read_events(fake(line)) == 0 ? 1 : -1;
}
