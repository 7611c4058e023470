#include "dis/kinds.h"

#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/number.h"
#include "hs/text_file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

enum { WORDS_MAX = 12, DOMAIN = 1, COUNTRY = 2 };

static const char *const names[DIS_TARGET_KINDS] = {"unknown",
                                                    "person",
                                                    "car",
                                                    "truck",
                                                    "tracked-armour",
                                                    "train",
                                                    "light-aircraft",
                                                    "fighter",
                                                    "large-aircraft",
                                                    "helicopter",
                                                    "missile",
                                                    "boat",
                                                    "small-ship",
                                                    "ship",
                                                    "large-ship",
                                                    "structure",
                                                    "corner-reflector",
                                                    "beacon"};

const char *dis_kind_name(uint8_t kind)
{
    return names[kind];
}

static uint16_t most_of(int field)
{
    return field == COUNTRY ? UINT16_MAX : UINT8_MAX;
}

/* A whole number of digits alone, at the beginning of *text, which it steps over. */
static bool read_number(const char **text, uint16_t most, uint16_t *number)
{
    uint32_t value = 0;
    const char *p = *text;
    for (; *p >= '0' && *p <= '9' && value <= most; p++) {
        value = value * 10 + (uint32_t)(*p - '0');
    }
    if (p == *text || value > most) {
        return false;
    }
    *text = p;
    *number = (uint16_t)value;
    return true;
}

static bool read_field(const char **text, int field, struct dis_rule *rule)
{
    rule->low[field] = 0;
    rule->high[field] = most_of(field);
    if (**text == '*') {
        ++*text;
        return true;
    }
    if (!read_number(text, most_of(field), &rule->low[field])) {
        return false;
    }
    rule->high[field] = rule->low[field];
    if (**text != '-') {
        return true;
    }
    ++*text;
    return read_number(text, most_of(field), &rule->high[field]) &&
           rule->low[field] <= rule->high[field];
}

static bool read_type(const char *text, struct dis_rule *rule)
{
    int field = 0;
    for (; field < DIS_RULE_FIELDS; field++) {
        if (!read_field(&text, field, rule)) {
            return false;
        }
        if (*text != '.') {
            break;
        }
        text++;
    }
    while (++field < DIS_RULE_FIELDS) {
        rule->low[field] = 0;
        rule->high[field] = most_of(field);
    }
    return *text == '\0' && field == DIS_RULE_FIELDS;
}

static bool find_kind(const char *name, uint8_t *kind)
{
    for (int i = 0; i < DIS_TARGET_KINDS; i++) {
        if (strcmp(names[i], name) == 0) {
            *kind = (uint8_t)i;
            return true;
        }
    }
    return false;
}

/* What stands behind the type. */
struct words {
    char *word[WORDS_MAX];
    int count, next;
    bool has_kind, has_rcs, has_signature;
};

static int take_surface(const struct db_text_file *f, struct dis_rule *rule, const char *word)
{
    if (rule->has_surface) {
        return db_text_error(f, "keep one of ground and height", "says twice where it stands");
    }
    rule->has_surface = true;
    rule->kind.is_on_ground = strcmp(word, "ground") == 0;
    return 0;
}

static int take_value(const struct db_text_file *f, struct words *w, struct dis_rule *rule,
                      const char *word, const char *value)
{
    double number;
    if (strcmp(word, "kind") == 0 && !w->has_kind) {
        w->has_kind = true;
        return find_kind(value, &rule->kind.kind)
                   ? 0
                   : db_text_error(f, "landmass-dis --print-kinds shows how they are written",
                                   "\"%s\" is no kind of target", value);
    }
    if (strcmp(word, "rcs") == 0 && !w->has_rcs) {
        w->has_rcs = true;
        return hs_number_within(value, -40, 60, &rule->kind.rcs_dbsm)
                   ? 0
                   : db_text_error(f, NULL, "\"%s\" is no cross section of -40..60 dBsm", value);
    }
    if (strcmp(word, "signature") == 0 && !w->has_signature) {
        w->has_signature = true;
        if (!hs_number_within(value, 1, 255, &number) || number != floor(number)) {
            return db_text_error(f, "landmass-db inspect lists those of an image",
                                 "\"%s\" is no signature of 1..255", value);
        }
        rule->kind.signature = (uint8_t)number;
        return 0;
    }
    return db_text_error(f, "the words are kind, rcs, signature, ground, height and skip",
                         "\"%s\" is unknown, or is said twice", word);
}

static int take_words(const struct db_text_file *f, struct words *w, struct dis_rule *rule)
{
    while (w->next < w->count) {
        const char *word = w->word[w->next++];
        int status;
        if (strcmp(word, "skip") == 0) {
            rule->kind.is_skipped = true;
            status = w->count == 2 ? 0 : db_text_error(f, NULL, "skip stands alone");
        } else if (strcmp(word, "ground") == 0 || strcmp(word, "height") == 0) {
            status = take_surface(f, rule, word);
        } else if (w->next == w->count) {
            return db_text_error(f, NULL, "nothing stands behind \"%s\"", word);
        } else {
            status = take_value(f, w, rule, word, w->word[w->next++]);
        }
        if (status != 0) {
            return status;
        }
    }
    return rule->kind.is_skipped || w->has_kind
               ? 0
               : db_text_error(f, "add kind NAME or skip", "does not say what it becomes");
}

static bool covers(const struct dis_rule *a, const struct dis_rule *b)
{
    for (int i = 0; i < DIS_RULE_FIELDS; i++) {
        if (a->low[i] > b->low[i] || a->high[i] < b->high[i]) {
            return false;
        }
    }
    return true;
}

static int read_rule(struct dis_kinds *kinds, struct db_text_file *f)
{
    struct words w = {.next = 1};
    w.count = db_text_words(f->line, w.word, WORDS_MAX);
    if (kinds->count == DIS_RULES_MAX) {
        return db_text_error(f, "join some by ranges", "is one rule too many: %d are allowed",
                             DIS_RULES_MAX);
    }
    struct dis_rule *rule = &kinds->rule[kinds->count];
    *rule = (struct dis_rule){.line = f->line_number, .kind = {.rcs_dbsm = (double)NAN}};
    if (w.count > WORDS_MAX || !read_type(w.word[0], rule)) {
        return db_text_error(f, "write 1.1.222.6: up to seven numbers, ranges or *",
                             "\"%s\" is no type of an entity", w.word[0]);
    }
    if (take_words(f, &w, rule) != 0) {
        return -1;
    }
    for (int i = 0; i < kinds->count; i++) {
        if (covers(&kinds->rule[i], rule)) {
            return db_text_error(f, "put it before that line", "line %d decides all of it",
                                 kinds->rule[i].line);
        }
    }
    kinds->count++;
    return 0;
}

int dis_kinds_read_stream(struct dis_kinds *kinds, FILE *in, const char *path)
{
    struct db_text_file f = {.stream = in, .path = path};
    kinds->count = 0;
    int status;
    while ((status = db_text_next(&f)) == 1) {
        if (read_rule(kinds, &f) != 0) {
            status = -1;
            break;
        }
    }
    free(f.line);
    if (status == 0 && kinds->count == 0) {
        return hs_error(path, "landmass-dis --print-kinds shows one", "has no rule");
    }
    return status;
}

int dis_kinds_read(struct dis_kinds *kinds, const char *path)
{
    FILE *in = hs_input_open(path, "r");
    if (in == NULL) {
        return hs_error(path, "landmass-dis --print-kinds writes one", "cannot be opened: %s",
                        strerror(errno));
    }
    const int status = dis_kinds_read_stream(kinds, in, path);
    fclose(in);
    return status;
}

int dis_kinds_read_builtin(struct dis_kinds *kinds)
{
    const char *text = dis_kinds_builtin();
    char *copy = strdup(text); /* fmemopen takes no const */
    FILE *in = copy == NULL ? NULL : fmemopen(copy, strlen(copy), "r");
    if (in == NULL) {
        free(copy);
        return hs_error("the built-in kinds", NULL, "no memory");
    }
    const int status = dis_kinds_read_stream(kinds, in, "the built-in kinds");
    fclose(in);
    free(copy);
    return status;
}

struct dis_rule *dis_kinds_find(struct dis_kinds *kinds, const struct dis_type *type,
                                struct dis_kind *kind)
{
    const uint16_t at[DIS_RULE_FIELDS] = {type->kind,     type->domain,      type->country,
                                          type->category, type->subcategory, type->specific,
                                          type->extra};
    for (int n = 0; n < kinds->count; n++) {
        struct dis_rule *rule = &kinds->rule[n];
        int i = 0;
        while (i < DIS_RULE_FIELDS && at[i] >= rule->low[i] && at[i] <= rule->high[i]) {
            i++;
        }
        if (i == DIS_RULE_FIELDS) {
            *kind = rule->kind;
            if (!rule->has_surface) {
                kind->is_on_ground = at[DOMAIN] == 1 || at[DOMAIN] == 3;
            }
            return rule;
        }
    }
    return NULL;
}
