#include "hs/text_file.h"

#include "hs/error.h"
#include "hs/input_file.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

int db_text_open(struct db_text_file *f, const char *path)
{
    *f = (struct db_text_file){.path = path};
    f->stream = hs_input_open(path, "r");
    if (!f->stream) {
        return hs_error(path, "check the name", "cannot be read: %s", strerror(errno));
    }
    return 0;
}

static char *trim(char *text)
{
    while (isspace((unsigned char)*text)) {
        text++;
    }
    size_t length = strlen(text);
    while (length > 0 && isspace((unsigned char)text[length - 1])) {
        text[--length] = '\0';
    }
    return text;
}

int db_text_next(struct db_text_file *f)
{
    while (getline(&f->line, &f->capacity, f->stream) >= 0) {
        f->line_number++;
        f->remark[0] = '\0';
        char *hash = strchr(f->line, '#');
        if (hash) {
            *hash = '\0';
            snprintf(f->remark, sizeof f->remark, "%s", trim(hash + 1));
        }
        const char *text = trim(f->line);
        if (*text) {
            memmove(f->line, text, strlen(text) + 1);
            return 1;
        }
    }
    if (ferror(f->stream)) {
        return hs_error(f->path, NULL, "cannot be read: %s", strerror(errno));
    }
    return 0;
}

int db_text_error(const struct db_text_file *f, const char *remedy, const char *cause, ...)
{
    char place[512], text[512];
    snprintf(place, sizeof place, "%s:%d", f->path, f->line_number);
    va_list arguments;
    va_start(arguments, cause);
    vsnprintf(text, sizeof text, cause, arguments);
    va_end(arguments);
    return hs_error(place, remedy, "%s", text);
}

int db_text_split(char *line, char **key, char **value)
{
    char *equals = strchr(line, '=');
    if (!equals) {
        return -1;
    }
    *equals = '\0';
    *key = trim(line);
    *value = trim(equals + 1);
    return **key && **value ? 0 : -1;
}

int db_text_words(char *line, char **words, int most)
{
    int count = 0;
    char *const end = line + strlen(line);
    for (int i = 0; i < most; i++) {
        words[i] = end;
    }
    char *rest = NULL;
    for (char *w = strtok_r(line, " \t", &rest); w; w = strtok_r(NULL, " \t", &rest)) {
        if (count == most) {
            return most + 1;
        }
        words[count++] = w;
    }
    return count;
}

void db_text_close(struct db_text_file *f)
{
    if (f->stream) {
        fclose(f->stream);
    }
    free(f->line);
    *f = (struct db_text_file){0};
}
