#include "fake_gpio.h"

#include <errno.h>
#include <string.h>
#include <sys/eventfd.h>
#include <unistd.h>

struct fake_chip fake_chips[FAKE_CHIPS];

void fake_gpio_reset(void)
{
    memset(fake_chips, 0, sizeof fake_chips);
    fake_chips[0].name = "gpiochip0";
    fake_chips[0].label = "9030000.pl061";
    fake_chips[1].name = "gpiochip1";
    fake_chips[1].label = "bezel";
    for (int c = 0; c < FAKE_CHIPS; c++) {
        for (int i = 0; i < FAKE_LINES; i++) {
            fake_chips[c].line[i].events = -1;
        }
    }
    fake_chips[1].line[3].name = "OSB1";
    fake_chips[1].line[4].name = "OSB2";
    fake_chips[1].line[9].name = "ALIVE";
}

void fake_gpio_drive(struct fake_line *line, bool level)
{
    if (line->level != level && line->events >= 0) {
        eventfd_write(line->events, 1);
    }
    line->level = level;
}

int fake_gpio_request(struct fake_line *line, bool is_output, bool is_active_low, bool has_events)
{
    if (line->is_requested || line->is_taken) {
        return EBUSY;
    }
    if (has_events && line->no_interrupt) {
        return ENXIO;
    }
    line->is_requested = true;
    line->is_output = is_output;
    line->is_active_low = is_active_low;
    line->level = is_output ? is_active_low : line->level; /* begins inactive */
    line->events = has_events ? eventfd(0, EFD_CLOEXEC) : -1;
    return 0;
}

void fake_gpio_release(struct fake_line *line)
{
    if (line->events >= 0) {
        close(line->events);
        line->events = -1;
    }
    line->is_requested = false;
}

int fake_gpio_get(const struct fake_line *line)
{
    if (!line->is_requested || line->is_broken) {
        errno = ENODEV;
        return -1;
    }
    return line->level != line->is_active_low;
}

int fake_gpio_set(struct fake_line *line, bool is_active)
{
    if (!line->is_requested || !line->is_output || line->is_broken) {
        errno = EPERM;
        return -1;
    }
    line->level = is_active != line->is_active_low;
    return 0;
}

int fake_gpio_read_events(struct fake_line *line)
{
    eventfd_t count;
    return eventfd_read(line->events, &count);
}
