#include "drv/gpio.h"

#include "lines.h"
#include "lm/status.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/epoll.h>
#include <unistd.h>

bool gpio_split_name(const char *name, char *chip, size_t size, unsigned *offset)
{
    const char *colon = strrchr(name, ':');
    char rest;
    if (colon == NULL || colon == name || (size_t)(colon - name) >= size ||
        strspn(colon + 1, "0123456789") != strlen(colon + 1) ||
        sscanf(colon + 1, "%5u%c", offset, &rest) != 1) {
        return false;
    }
    memcpy(chip, name, (size_t)(colon - name));
    chip[colon - name] = '\0';
    return true;
}

int drv_gpio_open(struct drv_gpio *g)
{
    *g = (struct drv_gpio){.fd = epoll_create1(EPOLL_CLOEXEC)};
    if (g->fd < 0) {
        snprintf(g->error, sizeof g->error, "epoll: %s", strerror(errno));
        return LM_ERR_IO;
    }
    return LM_OK;
}

void drv_gpio_close(struct drv_gpio *g)
{
    for (uint32_t i = 0; i < g->input_count; i++) {
        gpio_line_close(&g->input[i]);
    }
    for (uint32_t i = 0; i < g->output_count; i++) {
        gpio_line_close(&g->output[i]);
    }
    g->input_count = g->output_count = 0;
    if (g->fd >= 0) {
        close(g->fd);
        g->fd = -1;
    }
}

static int add(struct drv_gpio *g, struct drv_gpio_line *lines, uint32_t *count, const char *name,
               bool is_output, bool is_active_low)
{
    const char *cause = *count < DRV_GPIO_LINES
                            ? gpio_line_open(&lines[*count], name, is_output, is_active_low)
                            : "too many lines";
    if (cause != NULL) {
        snprintf(g->error, sizeof g->error, "%s: %s", name, cause);
        return LM_ERR_IO;
    }
    return (int)(*count)++;
}

int drv_gpio_add_input(struct drv_gpio *g, const char *name, bool is_active_low)
{
    const int number = add(g, g->input, &g->input_count, name, false, is_active_low);
    if (number >= 0 && g->input[number].fd >= 0) {
        struct epoll_event event = {.events = EPOLLIN, .data.u32 = (uint32_t)number};
        (void)epoll_ctl(g->fd, EPOLL_CTL_ADD, g->input[number].fd, &event);
    }
    return number;
}

int drv_gpio_add_output(struct drv_gpio *g, const char *name, bool is_active_low)
{
    return add(g, g->output, &g->output_count, name, true, is_active_low);
}

uint64_t drv_gpio_take_edges(struct drv_gpio *g)
{
    struct epoll_event events[DRV_GPIO_LINES];
    const int count = epoll_wait(g->fd, events, DRV_GPIO_LINES, 0);
    uint64_t edges = 0;
    for (int i = 0; i < count; i++) {
        const uint32_t number = events[i].data.u32;
        if ((events[i].events & EPOLLIN) == 0) { /* the chip has gone */
            (void)epoll_ctl(g->fd, EPOLL_CTL_DEL, g->input[number].fd, NULL);
            continue;
        }
        gpio_line_forget_events(&g->input[number]);
        edges |= UINT64_C(1) << number;
        g->count.edges++;
    }
    return edges;
}

uint64_t drv_gpio_levels(struct drv_gpio *g)
{
    uint64_t levels = 0;
    for (uint32_t i = 0; i < g->input_count; i++) {
        const int level = gpio_line_get(&g->input[i]);
        g->count.errors += level < 0;
        levels |= (uint64_t)(level > 0) << i;
    }
    return levels;
}

void drv_gpio_set(struct drv_gpio *g, uint32_t output, bool is_lit)
{
    g->count.errors += gpio_line_set(&g->output[output], is_lit) != 0;
}
