#include "hs/input_file.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* One list for the process: inputs are opened in many places, and an output must miss them all. */
static struct input {
    dev_t device;
    ino_t inode;
} * inputs;
static size_t input_count, input_room;
static bool is_guarded;

static size_t find(const struct stat *status)
{
    size_t i = 0;
    while (i < input_count &&
           (inputs[i].device != status->st_dev || inputs[i].inode != status->st_ino)) {
        i++;
    }
    return i;
}

static void note(const struct stat *status)
{
    if (!is_guarded || find(status) < input_count) {
        return;
    }
    if (input_count == input_room) {
        const size_t room = 2 * input_room + 16;
        struct input *more = realloc(inputs, room * sizeof *more);
        if (!more) {
            abort(); /* An unknown input could be overwritten. */
        }
        inputs = more;
        input_room = room;
    }
    inputs[input_count++] = (struct input){status->st_dev, status->st_ino};
}

void hs_input_guard(void)
{
    is_guarded = true;
}

FILE *hs_input_open(const char *path, const char *mode)
{
    FILE *stream = fopen(path, mode);
    struct stat status;
    if (stream && fstat(fileno(stream), &status) == 0 && S_ISREG(status.st_mode)) {
        note(&status);
    }
    return stream;
}

void hs_input_note(const char *path)
{
    struct stat status;
    if (stat(path, &status) == 0 && S_ISREG(status.st_mode)) {
        note(&status);
    }
}

void hs_input_note_folder(const char *path)
{
    struct stat status;
    if (stat(path, &status) == 0 && S_ISDIR(status.st_mode)) {
        note(&status);
    }
}

void hs_input_forget(const char *path)
{
    struct stat status;
    if (stat(path, &status) == 0) {
        const size_t i = find(&status);
        if (i < input_count) {
            inputs[i] = inputs[--input_count];
        }
    }
}

static bool is_noted(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && find(&status) < input_count;
}

bool hs_input_is(const char *path)
{
    char folder[PATH_MAX];
    const char *slash = strrchr(path, '/');
    const size_t length = slash == path ? 1 : slash ? (size_t)(slash - path) : 0;
    if (length >= sizeof folder) {
        return is_noted(path);
    }
    memcpy(folder, length > 0 ? path : ".", length > 0 ? length : 1);
    folder[length > 0 ? length : 1] = '\0';
    return is_noted(path) || is_noted(folder);
}
