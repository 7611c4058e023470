#include "drv/bezel_serial.h"

enum part { BETWEEN, TEXT, CHECKSUM };

enum { DIGITS_MOST = 4, BYTES_A_CALL = 64 };

/* A whole number of -9999..9999 at *text, which moves past it. */
static bool parse_number(const char **text, const char *end, int32_t *value)
{
    const char *c = *text;
    const bool is_negative = c < end && *c == '-';
    c += is_negative;
    const char *first = c;
    int32_t number = 0;
    for (; c < end && *c >= '0' && *c <= '9' && c - first < DIGITS_MOST; c++) {
        number = number * 10 + (*c - '0');
    }
    *value = is_negative ? -number : number;
    *text = c;
    return c > first;
}

static bool is_deflection(int32_t value)
{
    return value >= -LM_FULL_DEFLECTION && value <= LM_FULL_DEFLECTION;
}

/* The one number that is all of the text. */
static bool parse_one(const char *text, const char *end, int32_t *value)
{
    return parse_number(&text, end, value) && text == end;
}

static bool parse_button(bool is_down, const char *text, const char *end,
                         struct lm_control *control)
{
    int32_t button;
    if (!parse_one(text, end, &button) || button < 1 || button > LM_BUTTONS) {
        return false;
    }
    *control = lm_control_button(is_down, button);
    return true;
}

static bool parse_knob(const char *text, const char *end, struct lm_control *control)
{
    int32_t deflection;
    if (!parse_one(text, end, &deflection) || !is_deflection(deflection)) {
        return false;
    }
    *control = lm_control_knob(deflection);
    return true;
}

static bool parse_slew(const char *text, const char *end, struct lm_control *control)
{
    int32_t x, y;
    if (!parse_number(&text, end, &x) || text == end || *text++ != ',' ||
        !parse_one(text, end, &y) || !is_deflection(x) || !is_deflection(y)) {
        return false;
    }
    *control = lm_control_slew(x, y);
    return true;
}

bool drv_bezel_parse(const char *text, uint32_t length, struct lm_control *control)
{
    if (length == 0) {
        return false;
    }
    const char *const rest = text + 1, *const end = text + length;
    switch (text[0]) {
    case 'D':
    case 'U':
        return parse_button(text[0] == 'D', rest, end, control);
    case 'K':
        return parse_knob(rest, end, control);
    case 'S':
        return parse_slew(rest, end, control);
    case 'T':
        *control = lm_control_designate();
        return length == 1;
    case 'X':
        *control = lm_control_drop();
        return length == 1;
    default:
        return false;
    }
}

static int hex_value(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                  : -1;
}

static void give_up(struct drv_bezel_serial *b)
{
    b->count.malformed++;
    b->part = BETWEEN;
}

static void take_text(struct drv_bezel_serial *b, char c)
{
    if (c == '*') {
        b->part = CHECKSUM;
        b->digits = b->sum_told = 0;
    } else if (b->length == DRV_BEZEL_LINE) {
        give_up(b);
    } else {
        b->text[b->length++] = c;
        b->sum = (uint8_t)(b->sum ^ (uint8_t)c);
    }
}

/* True when the last digit completes a sentence that means something. */
static bool take_digit(struct drv_bezel_serial *b, char c, struct lm_control *control)
{
    const int value = hex_value(c);
    if (value < 0) {
        give_up(b);
        return false;
    }
    b->sum_told = (uint8_t)(b->sum_told << 4 | value);
    if (++b->digits < 2) {
        return false;
    }
    if (b->sum_told != b->sum || !drv_bezel_parse(b->text, b->length, control)) {
        give_up(b);
        return false;
    }
    b->part = BETWEEN;
    b->count.sentences++;
    return true;
}

static bool take_byte(struct drv_bezel_serial *b, char c, struct lm_control *control)
{
    if (c == '$') {
        b->count.malformed += b->part != BETWEEN;
        b->part = TEXT;
        b->length = b->sum = 0;
    } else if (b->part == TEXT) {
        take_text(b, c);
    } else if (b->part == CHECKSUM) {
        return take_digit(b, c, control);
    }
    return false;
}

static int next(void *ctx, struct lm_control *control)
{
    struct drv_bezel_serial *b = ctx;
    for (uint32_t i = 0; i < BYTES_A_CALL; i++) {
        const int byte = b->get(b->line);
        if (byte < 0) {
            return 0;
        }
        if (take_byte(b, (char)byte, control)) {
            return 1;
        }
    }
    return 0;
}

void drv_bezel_serial_init(struct drv_bezel_serial *b, int (*get)(void *line), void *line)
{
    *b = (struct drv_bezel_serial){.get = get, .line = line, .port = {.ctx = b, .next = next}};
}
