#include "obj_check.h"

#include "hs/error.h"

#include <cpl_vsi.h>
#include <ctype.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { READ_BYTES = 1 << 16, WORD_SIZE = 8 };

struct line {
    char first[WORD_SIZE], word[WORD_SIZE]; /* its first word and its last so far, cut */
    size_t length;                          /* of the last, as it stands; 0 between words */
    long words;
    bool is_indented; /* a blank stands before it */
    bool is_odd;      /* a word behind the first begins as no number does */
    bool is_in_remark;
};

/* A walk through a file, byte by byte. */
struct walk {
    long number;
    struct line line;
    bool has_bare_face; /* one without a material */
    bool has_material;
};

static bool is_called(const struct line *line, const char *name)
{
    return strncmp(line->first, name, WORD_SIZE) == 0;
}

/* As Assimp tells numbers. */
static bool is_number(const char *word)
{
    return isdigit((unsigned char)*word) || *word == '-' || *word == '+' ||
           strncasecmp(word, "nan", 3) == 0 || strncasecmp(word, "inf", 3) == 0;
}

static void end_word(struct line *line)
{
    if (line->length == 0) {
        return;
    }
    line->word[line->length < WORD_SIZE ? line->length : WORD_SIZE - 1] = '\0';
    if (line->words++ == 0) {
        memcpy(line->first, line->word, WORD_SIZE);
    } else {
        line->is_odd = line->is_odd || !is_number(line->word);
    }
    line->length = 0;
}

/* What goes wrong with the line that ends here, or NULL. */
static const char *fault_of(struct walk *w)
{
    const struct line *line = &w->line;
    const long numbers = line->words - 1;
    const bool is_vertex = is_called(line, "v"), is_face = is_called(line, "f");
    const bool is_material = is_called(line, "usemtl");
    if ((is_vertex || is_face || is_material) && line->is_indented) {
        return "a blank before the first word, which hides the line from its reader";
    }
    if (is_vertex && (line->is_odd || (numbers != 3 && numbers != 4 && numbers != 6))) {
        return "a vertex that its reader would pass over: it needs three, four or six numbers, "
               "written as 0.5";
    }
    if (is_material && w->has_bare_face && !w->has_material) {
        return "the first usemtl, behind faces that would get that material too";
    }
    w->has_bare_face = w->has_bare_face || is_face;
    w->has_material = w->has_material || is_material;
    return NULL;
}

/* Take a byte; the fault of a line at its end. */
static const char *take(struct walk *w, char c)
{
    struct line *line = &w->line;
    line->is_in_remark = line->is_in_remark || c == '#';
    if (c == '\n') {
        end_word(line);
        const char *fault = fault_of(w);
        w->number += fault == NULL;
        *line = (struct line){.words = 0};
        return fault;
    }
    if (c == ' ' || c == '\t' || c == '\r' || line->is_in_remark) {
        end_word(line);
        line->is_indented = line->is_indented || line->words == 0;
    } else if (line->length++ < WORD_SIZE) {
        line->word[line->length - 1] = c;
    }
    return NULL;
}

static const char *walk_through(struct walk *w, VSILFILE *in)
{
    char bytes[READ_BYTES];
    for (size_t n; (n = VSIFReadL(bytes, 1, sizeof bytes, in)) > 0;) {
        for (size_t i = 0; i < n; i++) {
            const char *fault = take(w, bytes[i]);
            if (fault) {
                return fault;
            }
        }
    }
    return take(w, '\n');
}

int obj_check(const char *path, const char *name)
{
    struct walk w = {.number = 1};
    VSILFILE *in = VSIFOpenL(path, "rb");
    if (!in) {
        return hs_error(name, "check the name", "cannot be opened");
    }
    const char *fault = walk_through(&w, in);
    VSIFCloseL(in);
    char place[512];
    snprintf(place, sizeof place, "%s line %ld", name, w.number);
    return fault ? hs_error(place, "correct the line, or save the model anew", "%s", fault) : 0;
}
