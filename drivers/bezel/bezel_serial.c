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

static bool parse_values(const char *text, const char *end, struct lm_control *control)
{
    if (!parse_number(&text, end, &control->value)) {
        return false;
    }
    if (control->kind == LM_CONTROL_SLEW &&
        (text == end || *text++ != ',' || !parse_number(&text, end, &control->value_y))) {
        return false;
    }
    const bool is_button = control->kind == LM_CONTROL_DOWN || control->kind == LM_CONTROL_UP;
    const bool is_in_range = is_button
                                 ? control->value >= 1 && control->value <= LM_BUTTONS
                                 : is_deflection(control->value) && is_deflection(control->value_y);
    return is_in_range && text == end;
}

bool drv_bezel_parse(const char *text, uint32_t length, struct lm_control *control)
{
    *control = (struct lm_control){.kind = LM_CONTROL_DOWN};
    switch (length > 0 ? text[0] : '\0') {
    case 'D':
        break;
    case 'U':
        control->kind = LM_CONTROL_UP;
        break;
    case 'K':
        control->kind = LM_CONTROL_KNOB;
        break;
    case 'S':
        control->kind = LM_CONTROL_SLEW;
        break;
    case 'T':
        control->kind = LM_CONTROL_DESIGNATE;
        return length == 1;
    case 'X':
        control->kind = LM_CONTROL_DROP;
        return length == 1;
    default:
        return false;
    }
    return parse_values(text + 1, text + length, control);
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
