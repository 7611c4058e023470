#include "fx/mem.h"
#include "lm/text.h"
#include "page_table.h"

void lm_label_set(struct lm_label *label, const char *first, const char *second)
{
    struct lm_text lines[2] = {0};
    lm_text_add(&lines[0], first);
    lm_text_add(&lines[1], second);
    for (uint32_t i = 0; i < 2; i++) {
        lines[i].words[sizeof label->line[i] - 1] = 0;
        memcpy(label->line[i], lines[i].words, sizeof label->line[i]);
    }
}

static void set_under(struct lm_label *label, const char *name, const char *words)
{
    if (*name) {
        lm_label_set(label, name, words);
    } else {
        lm_label_set(label, words, "");
    }
}

void lm_label_number(struct lm_label *label, const char *name, int32_t value, bool is_signed)
{
    struct lm_text t = {0};
    if (is_signed) {
        lm_text_signed(&t, value);
    } else {
        lm_text_number(&t, (uint32_t)value, 1);
    }
    set_under(label, name, t.words);
}

void lm_label_tenths(struct lm_label *label, const char *name, const char *sign, uint32_t tenths)
{
    struct lm_text t = {0};
    lm_text_add(&t, sign);
    lm_text_number(&t, tenths / 10, 1);
    lm_text_add(&t, ".");
    lm_text_number(&t, tenths % 10, 1);
    set_under(label, name, t.words);
}
