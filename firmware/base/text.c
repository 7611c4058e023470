#include "lm/text.h"

#include "fx/sat.h"

static void add_char(struct lm_text *t, char c)
{
    if (t->length < LM_TEXT_MAX) {
        t->words[t->length++] = c;
        t->words[t->length] = 0;
    }
}

void lm_text_add(struct lm_text *t, const char *words)
{
    while (*words) {
        add_char(t, *words++);
    }
}

void lm_text_number(struct lm_text *t, uint32_t value, uint32_t digits)
{
    char reversed[10];
    uint32_t count = 0;
    do {
        reversed[count++] = (char)('0' + value % 10);
        value /= 10;
    } while (count < sizeof reversed && (value != 0 || count < digits));
    while (count > 0) {
        add_char(t, reversed[--count]);
    }
}

void lm_text_signed(struct lm_text *t, int32_t value)
{
    if (value != 0) {
        add_char(t, value < 0 ? '-' : '+');
    }
    lm_text_number(t, fx_abs_u32(value), 1);
}

void lm_text_tab(struct lm_text *t, uint32_t column)
{
    while (t->length < column && t->length < LM_TEXT_MAX) {
        add_char(t, ' ');
    }
}
