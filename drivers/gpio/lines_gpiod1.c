/* Lines through libgpiod 1.6 (Debian 12). The handle is the library's own line, which keeps its
 * chip open. */
#include "lines.h"

#include <errno.h>
#include <gpiod.h>
#include <string.h>

enum { EVENTS_AT_ONCE = 16 };

static struct gpiod_line *find(const char *name)
{
    char label[64];
    unsigned offset;
    struct gpiod_line *line = gpiod_line_find(name);
    if (line != NULL || !gpio_split_name(name, label, sizeof label, &offset)) {
        return line;
    }
    struct gpiod_chip *chip = gpiod_chip_open_lookup(label);
    if (chip == NULL) {
        return NULL;
    }
    line = gpiod_chip_get_line(chip, offset);
    if (line == NULL) {
        gpiod_chip_close(chip);
    }
    return line;
}

static int request(struct gpiod_line *line, bool is_output, bool is_active_low, int *fd)
{
    const int flags = is_active_low ? GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW : 0;
    *fd = -1;
    if (is_output) {
        return gpiod_line_request_output_flags(line, "landmass-panel", flags, 0);
    }
    if (gpiod_line_request_both_edges_events_flags(line, "landmass-panel", flags) == 0) {
        *fd = gpiod_line_event_get_fd(line);
        return 0;
    }
    return gpiod_line_request_input_flags(line, "landmass-panel", flags);
}

const char *gpio_line_open(struct drv_gpio_line *l, const char *name, bool is_output,
                           bool is_active_low)
{
    struct gpiod_line *line = find(name);
    if (line == NULL) {
        return "no chip has a line of this name; gpioinfo lists those there are";
    }
    if (request(line, is_output, is_active_low, &l->fd) != 0) {
        const int cause = errno;
        gpiod_line_close_chip(line);
        return strerror(cause);
    }
    l->handle = line;
    return NULL;
}

void gpio_line_close(struct drv_gpio_line *l)
{
    gpiod_line_release(l->handle);
    gpiod_line_close_chip(l->handle);
    *l = (struct drv_gpio_line){.fd = -1};
}

int gpio_line_get(const struct drv_gpio_line *l)
{
    return gpiod_line_get_value(l->handle);
}

int gpio_line_set(const struct drv_gpio_line *l, bool is_active)
{
    return gpiod_line_set_value(l->handle, is_active);
}

void gpio_line_forget_events(const struct drv_gpio_line *l)
{
    struct gpiod_line_event events[EVENTS_AT_ONCE];
    (void)gpiod_line_event_read_multiple(l->handle, events, EVENTS_AT_ONCE);
}
