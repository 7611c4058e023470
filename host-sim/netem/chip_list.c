#include "netem/chip_list.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/number.h"
#include "hs/text_file.h"
#include "netem/chip.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char line_remedy[] = "write FILE [AZIMUTH DEPRESSION [SHIFT_X SHIFT_Y [GAIN [SET]]]]";
static const char *const set_names[] = {"-", "training", "validation"};

static struct nm_chip_entry *add(struct nm_chip_list *list, const char *place)
{
    if (list->count == NM_CHIPS_MAX) {
        hs_error(place, NULL, "names more than %d chips", NM_CHIPS_MAX);
        return NULL;
    }
    if (list->count == list->room) {
        const int room = list->room > 0 ? 2 * list->room : 64;
        void *more = realloc(list->entries, (size_t)room * sizeof *list->entries);
        if (!more) {
            hs_error(place, NULL, "out of memory");
            return NULL;
        }
        list->entries = more;
        list->room = room;
    }
    struct nm_chip_entry *e = &list->entries[list->count++];
    *e = (struct nm_chip_entry){NULL, NAN, NAN, 0, 0, NAN, NM_SET_OPEN};
    return e;
}

static char *join(const char *folder, size_t length, const char *name)
{
    char *path = malloc(length + strlen(name) + 2);
    if (path) {
        sprintf(path, "%.*s%s%s", (int)length, folder, length > 0 ? "/" : "", name);
    }
    return path;
}

static int by_path(const void *a, const void *b)
{
    return strcmp(((const struct nm_chip_entry *)a)->path, ((const struct nm_chip_entry *)b)->path);
}

static int read_folder(struct nm_chip_list *list, const char *folder, DIR *dir)
{
    for (struct dirent *d; (d = readdir(dir));) {
        struct stat status;
        char *path = join(folder, strlen(folder), d->d_name);
        if (path &&
            (stat(path, &status) != 0 || !S_ISREG(status.st_mode) || !nm_chip_seems(path))) {
            free(path);
            continue;
        }
        struct nm_chip_entry *e = path ? add(list, folder) : NULL;
        if (!e) {
            free(path);
            return -1;
        }
        e->path = path;
    }
    qsort(list->entries, (size_t)list->count, sizeof *list->entries, by_path);
    return 0;
}

/* A number or '-' within the bounds; false for anything else. */
static int take_number(const char *word, double low, double high, double *number)
{
    if (strcmp(word, "-") == 0) {
        return 1;
    }
    return hs_number_within(word, low, high, number);
}

static int take_set(const char *word, enum nm_set *set)
{
    for (int s = 0; s < 3; s++) {
        if (strcmp(word, set_names[s]) == 0) {
            *set = (enum nm_set)s;
            return 1;
        }
    }
    return 0;
}

/* The words after the name; returns whether all made sense. */
static int take_words(struct nm_chip_entry *e, char **rest)
{
    double shift[2] = {0, 0};
    const char *words[6];
    int count = 0;
    for (char *word; (word = strtok_r(NULL, " \t", rest));) {
        if (count == 6) {
            return 0;
        }
        words[count++] = word;
    }
    const int has_pairs = count != 1 && count != 3;
    const int is_fine = has_pairs &&
                        (count < 2 || (take_number(words[0], -360, 720, &e->azimuth_deg) &&
                                       take_number(words[1], 1, 89, &e->depression_deg))) &&
                        (count < 4 || (take_number(words[2], -4096, 4096, &shift[0]) &&
                                       take_number(words[3], -4096, 4096, &shift[1]))) &&
                        (count < 5 || take_number(words[4], 1e-12, 1e12, &e->gain)) &&
                        (count < 6 || take_set(words[5], &e->set));
    e->shift_x = (int)lround(shift[0]);
    e->shift_y = (int)lround(shift[1]);
    return is_fine;
}

static int read_line(struct nm_chip_list *list, struct db_text_file *f)
{
    const char *slash = strrchr(f->path, '/');
    const size_t folder = slash ? (size_t)(slash - f->path) : 0;
    char *rest;
    const char *name = strtok_r(f->line, " \t", &rest);
    struct nm_chip_entry *e = name ? add(list, f->path) : NULL;
    if (!e) {
        return -1;
    }
    e->path = name[0] == '/' ? strdup(name) : join(f->path, folder, name);
    if (!e->path) {
        return hs_error(f->path, NULL, "out of memory");
    }
    return take_words(e, &rest) ? 0 : db_text_error(f, line_remedy, "makes no sense");
}

static int read_list(struct nm_chip_list *list, const char *path)
{
    struct db_text_file f;
    int more, result = 0;
    if (db_text_open(&f, path) != 0) {
        return -1;
    }
    while (result == 0 && (more = db_text_next(&f)) != 0) {
        result = more < 0 ? -1 : read_line(list, &f);
    }
    db_text_close(&f);
    return result;
}

int nm_chip_list_read(struct nm_chip_list *list, const char *path)
{
    *list = (struct nm_chip_list){0};
    DIR *dir = opendir(path);
    int result = dir ? read_folder(list, path, dir) : read_list(list, path);
    if (dir) {
        closedir(dir);
    }
    if (result == 0 && list->count == 0) {
        result = hs_error(path, "name a folder of chips, or a list of them", "names no chips");
    }
    if (result != 0) {
        nm_chip_list_free(list);
    }
    return result;
}

void nm_chip_list_free(struct nm_chip_list *list)
{
    for (int i = 0; i < list->count; i++) {
        free(list->entries[i].path);
    }
    free(list->entries);
    *list = (struct nm_chip_list){0};
}

int nm_chip_list_append(struct nm_chip_list *list, struct nm_chip_list *more)
{
    int result = 0;
    for (int i = 0; i < more->count && result == 0; i++) {
        struct nm_chip_entry *e = add(list, more->entries[i].path);
        result = e ? 0 : -1;
        if (e) {
            *e = more->entries[i];
            more->entries[i].path = NULL;
        }
    }
    nm_chip_list_free(more);
    return result;
}

static void write_number(FILE *out, double number, const char *format)
{
    fputc('\t', out);
    if (isnan(number)) {
        fputc('-', out);
    } else {
        fprintf(out, format, number);
    }
}

int nm_chip_list_write(const struct nm_chip_list *list, const char *path, const char *remark)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fprintf(file.stream, "# %s\n# file\tazimuth\tdepression\tshift_x\tshift_y\tgain\tset\n",
            remark);
    for (int i = 0; i < list->count; i++) {
        const struct nm_chip_entry *e = &list->entries[i];
        char *whole = realpath(e->path, NULL);
        fputs(whole ? whole : e->path, file.stream);
        free(whole);
        write_number(file.stream, e->azimuth_deg, "%.4f");
        write_number(file.stream, e->depression_deg, "%.4f");
        fprintf(file.stream, "\t%d\t%d", e->shift_x, e->shift_y);
        write_number(file.stream, e->gain, "%.9g");
        fprintf(file.stream, "\t%s\n", set_names[e->set]);
    }
    return hs_atomic_commit(&file);
}
