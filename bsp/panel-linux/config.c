#include "config_table.h"

#include <string.h>

enum { LINE_BYTES = 256, BITSET_WORDS = 4 };

_Static_assert(CONFIG_ROWS <= 32 * BITSET_WORDS, "one bit for each option");

/* Words beside each other are separated by one space. The number of `text` among them, or -1. */
static int word_number(const char *words, const char *text)
{
    const size_t length = strlen(text);
    int number = 0;
    for (const char *word = words; *word != '\0'; number++) {
        const size_t size = strcspn(word, " ");
        if (size == length && memcmp(word, text, size) == 0) {
            return number;
        }
        word += size + (word[size] == ' ');
    }
    return -1;
}

/* Decimal digits and nothing else, up to `high`; UINT32_MAX otherwise. */
static uint32_t whole_number(const char *text, size_t length, uint32_t high)
{
    uint64_t value = 0;
    for (size_t i = 0; i < length; i++) {
        if (text[i] < '0' || text[i] > '9' ||
            (value = value * 10 + (uint64_t)(text[i] - '0')) > high) {
            return UINT32_MAX;
        }
    }
    return length > 0 ? (uint32_t)value : UINT32_MAX;
}

static bool take_number(const struct config_row *row, const char *text, size_t length, void *value)
{
    const uint32_t n = whole_number(text, length, row->high);
    if (n == UINT32_MAX || n < row->low) {
        return false;
    }
    memcpy(value, &n, sizeof n);
    return true;
}

static bool take_text(const struct config_row *row, const char *text, void *value)
{
    const char *from = row->words != NULL && strcmp(text, row->words) == 0 ? "" : text;
    const size_t length = strlen(from);
    if (length >= row->high || (row->kind == CONFIG_PATH_TO && from[0] != '/' && from[0] != '\0')) {
        return false;
    }
    memset(value, 0, row->high);
    memcpy(value, from, length);
    return true;
}

static bool take_choice(const struct config_row *row, const char *text, void *value)
{
    const int number = word_number(row->words, text);
    const uint32_t chosen = (uint32_t)number;
    if (number < 0) {
        return false;
    }
    memcpy(value, &chosen, sizeof chosen);
    return true;
}

static bool take_size(const struct config_row *row, const char *text, void *value)
{
    struct config_size size = {0, 0};
    if (strcmp(text, row->words) != 0) {
        const size_t digits = strcspn(text, "x");
        uint32_t width, height;
        if (text[digits] != 'x' || !take_number(row, text, digits, &width) ||
            !take_number(row, text + digits + 1, strlen(text + digits + 1), &height)) {
            return false;
        }
        size = (struct config_size){(uint16_t)width, (uint16_t)height};
    }
    memcpy(value, &size, sizeof size);
    return true;
}

/* Four hexadecimal digits, or fewer. */
static bool take_hex(const char *text, size_t length, uint16_t *value)
{
    static const char digits[] = "0123456789abcdef";
    *value = 0;
    for (size_t i = 0; i < length; i++) {
        const char lower =
            text[i] >= 'A' && text[i] <= 'F' ? (char)(text[i] + ('a' - 'A')) : text[i];
        const char *digit = memchr(digits, lower, sizeof digits - 1);
        if (digit == NULL) {
            return false;
        }
        *value = (uint16_t)(*value << 4 | (digit - digits));
    }
    return length >= 1 && length <= 4;
}

static bool take_device(const char *text, void *value)
{
    struct config_stick stick = {.choice = CONFIG_STICK_NAMED};
    const size_t vendor = strcspn(text, ":");
    if (strcmp(text, "none") == 0) {
        stick.choice = CONFIG_STICK_NONE;
    } else if (strcmp(text, "auto") == 0) {
        stick.choice = CONFIG_STICK_AUTO;
    } else if (text[vendor] != ':' || !take_hex(text, vendor, &stick.vendor)) {
        return false;
    } else {
        const char *rest = text + vendor + 1;
        const size_t product = strcspn(rest, ":");
        const char *serial = rest[product] == ':' ? rest + product + 1 : "";
        if (!take_hex(rest, product, &stick.product) || strlen(serial) >= sizeof stick.serial ||
            (rest[product] == ':' && serial[0] == '\0')) {
            return false;
        }
        memcpy(stick.serial, serial, strlen(serial));
    }
    memcpy(value, &stick, sizeof stick);
    return true;
}

static bool take_profile(const char *text, void *value)
{
    const bool is_automatic = strcmp(text, "auto") == 0;
    const struct lm_bus_profile *profile =
        is_automatic ? NULL : lm_bus_profile_named(lm_bus_profiles, text);
    if (profile != NULL || is_automatic) {
        *(const struct lm_bus_profile **)value = profile;
    }
    return profile != NULL || is_automatic;
}

static bool take_nodes(const char *text, void *value)
{
    struct config_nodes nodes = {.is_list = strcmp(text, "all") != 0};
    while (nodes.is_list && text != NULL) {
        const size_t length = strcspn(text, ",");
        const uint32_t node = whole_number(text, length, 255);
        if (node == UINT32_MAX || node == 0) {
            return false;
        }
        nodes.bits[node / 8] |= (uint8_t)(1u << node % 8);
        text = text[length] == ',' ? text + length + 1 : NULL;
    }
    memcpy(value, &nodes, sizeof nodes);
    return true;
}

static bool take_axis(const char *text, void *value)
{
    struct drv_stick_axis axis = {.is_inverted = text[0] == '-'};
    if (axis.is_inverted) {
        text++;
    }
    static const uint16_t others[] = {DRV_STICK_HAT_X, DRV_STICK_HAT_Y, DRV_STICK_RUDDER,
                                      DRV_STICK_THROTTLE};
    const int other = word_number("hatx haty rudder throttle", text);
    const int desktop = word_number("x y z rx ry rz slider dial wheel", text);
    if (other >= 0) {
        axis.usage = others[other];
    } else if (desktop >= 0) {
        axis.usage = (uint16_t)(DRV_STICK_X + desktop);
    } else if (axis.is_inverted || strcmp(text, "none") != 0) {
        return false;
    }
    memcpy(value, &axis, sizeof axis);
    return true;
}

static bool take_button(const char *text, void *value)
{
    static const char keys[] =
        "1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 "
        "gain+ gain- sym+ sym- brt+ brt- con+ con-";
    struct drv_stick_button b = {.act = DRV_STICK_NOTHING};
    const int key = word_number(keys, text);
    const int act = word_number("none designate drop", text);
    if (key >= 0) {
        b = (struct drv_stick_button){DRV_STICK_PRESS, (uint8_t)(key + 1)};
    } else if (act > 0) {
        b.act = act == 1 ? DRV_STICK_DESIGNATE : DRV_STICK_DROP;
    } else if (act < 0) {
        return false;
    }
    memcpy(value, &b, sizeof b);
    return true;
}

static bool take(struct config *c, const struct config_row *row, const char *text)
{
    void *value = (char *)c + row->offset;
    switch (row->kind) {
    case CONFIG_TEXT:
    case CONFIG_PATH_TO:
        return take_text(row, text, value);
    case CONFIG_NUMBER:
        return take_number(row, text, strlen(text), value);
    case CONFIG_CHOICE:
        return take_choice(row, text, value);
    case CONFIG_PROFILE:
        return take_profile(text, value);
    case CONFIG_NODES:
        return take_nodes(text, value);
    case CONFIG_SIZE:
        return take_size(row, text, value);
    case CONFIG_DEVICE:
        return take_device(text, value);
    case CONFIG_AXIS:
        return take_axis(text, value);
    case CONFIG_BUTTON:
        return take_button(text, value);
    }
    return false;
}

void config_defaults(struct config *c)
{
    memset(c, 0, sizeof *c);
    for (uint32_t i = 0; i < CONFIG_ROWS; i++) {
        (void)take(c, &config_table[i], config_table[i].is.initial);
    }
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r';
}

/* Cut the remark and the blanks at both ends. */
static char *trim(char *text)
{
    for (char *c = text; *c != '\0'; c++) {
        if (*c == '#' && (c == text || is_blank(c[-1]))) {
            *c = '\0';
            break;
        }
    }
    while (is_blank(*text)) {
        text++;
    }
    size_t length = strlen(text);
    while (length > 0 && is_blank(text[length - 1])) {
        text[--length] = '\0';
    }
    return text;
}

/* NULL, or what is wrong with the line. `seen` has a bit for each option that was given. */
static const char *read_line(struct config *c, char *line, uint32_t seen[BITSET_WORDS])
{
    char *name = trim(line);
    if (*name == '\0') {
        return NULL;
    }
    char *equals = strchr(name, '=');
    if (equals == NULL) {
        return "not of the form \"option = value\"";
    }
    *equals = '\0';
    name = trim(name);
    const char *value = trim(equals + 1);
    for (uint32_t i = 0; i < CONFIG_ROWS; i++) {
        if (strcmp(config_table[i].is.name, name) != 0) {
            continue;
        }
        if ((seen[i / 32] >> i % 32 & 1) != 0) {
            return "the option was given before; the first value holds";
        }
        if (*value == '\0' || !take(c, &config_table[i], value)) {
            return "not a value of this option; --options lists what it takes";
        }
        seen[i / 32] |= 1u << i % 32;
        return NULL;
    }
    return "there is no such option; --options lists them";
}

/* Copy a line of `length` bytes, or tell why it cannot be one. */
static const char *copy_line(char line[LINE_BYTES], const char *text, size_t length)
{
    if (length >= LINE_BYTES) {
        return "longer than 255 bytes";
    }
    for (size_t i = 0; i < length; i++) {
        if (((unsigned char)text[i] < ' ' && !is_blank(text[i])) || text[i] == 0x7f) {
            return "not text";
        }
    }
    memcpy(line, text, length);
    line[length] = '\0';
    return NULL;
}

uint32_t config_read(struct config *c, const char *text, size_t size, config_report *report,
                     void *ctx)
{
    uint32_t seen[BITSET_WORDS] = {0};
    uint32_t wrong = 0;
    for (uint32_t number = 1; size > 0; number++) {
        char line[LINE_BYTES];
        const char *end = memchr(text, '\n', size);
        const size_t length = end != NULL ? (size_t)(end - text) : size;
        const char *cause = copy_line(line, text, length);
        if (cause == NULL) {
            cause = read_line(c, line, seen);
        }
        if (cause != NULL) {
            wrong++;
            report(ctx, number, cause);
        }
        const size_t used = length + (end != NULL);
        text += used;
        size -= used;
    }
    return wrong;
}

uint32_t config_option_count(void)
{
    return CONFIG_ROWS;
}

struct config_option config_option_at(uint32_t index)
{
    return config_table[index].is;
}
