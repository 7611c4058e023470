#include "hs/report.h"

#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/json.h"
#include "lm/version.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* Of the keys and their meaning: raised when one goes or means something else. */
enum { SCHEMA = 1, ROOT_DEPTH = 1 };

/* A message, or a file: its path is `place`. Texts are owned. */
struct note {
    const char *severity;
    char *place, *cause, *remedy;
};

struct notes {
    struct note *items; /* owned */
    size_t count, room;
};

static struct report {
    bool is_wanted, is_claimed;
    const char *path;    /* "-": standard output */
    int standard_output; /* the one that the program was started with; -1: not used */
    char *bytes;         /* owned; what `json` has written */
    size_t size;
    FILE *stream;
    struct hs_json json;
    struct notes messages, files;
    struct timespec begin;
} report;

bool hs_report_is_wanted(void)
{
    return report.is_wanted;
}

void hs_report_object(const char *key)
{
    if (report.is_wanted) {
        hs_json_object(&report.json, key);
    }
}

void hs_report_array(const char *key)
{
    if (report.is_wanted) {
        hs_json_array(&report.json, key);
    }
}

void hs_report_close(void)
{
    if (report.is_wanted) {
        hs_json_close(&report.json);
    }
}

void hs_report_text(const char *key, const char *value)
{
    if (report.is_wanted) {
        hs_json_text(&report.json, key, value);
    }
}

void hs_report_text_within(const char *key, const char *value, size_t room)
{
    if (report.is_wanted) {
        char *copy = strndup(value, room);
        hs_json_text(&report.json, key, copy);
        free(copy);
    }
}

void hs_report_real(const char *key, double value)
{
    if (report.is_wanted) {
        hs_json_real(&report.json, key, value);
    }
}

void hs_report_integer(const char *key, int64_t value)
{
    if (report.is_wanted) {
        hs_json_integer(&report.json, key, value);
    }
}

void hs_report_count(const char *key, uint64_t value)
{
    if (report.is_wanted) {
        hs_json_count(&report.json, key, value);
    }
}

void hs_report_flag(const char *key, bool value)
{
    if (report.is_wanted) {
        hs_json_flag(&report.json, key, value);
    }
}

/* A report without its error would say that all is well. */
static char *copy_of(const char *text)
{
    char *copy = text ? strdup(text) : NULL;
    if (text && !copy) {
        abort();
    }
    return copy;
}

static void add_note(struct notes *notes, struct note note)
{
    if (notes->count == notes->room) {
        const size_t room = 2 * notes->room + 16;
        struct note *more = realloc(notes->items, room * sizeof *more);
        if (!more) {
            abort();
        }
        notes->items = more;
        notes->room = room;
    }
    notes->items[notes->count++] = note;
}

void hs_report_message(const char *severity, const char *place, const char *cause,
                       const char *remedy)
{
    if (report.is_wanted) {
        add_note(&report.messages,
                 (struct note){severity, copy_of(place), copy_of(cause), copy_of(remedy)});
    }
}

void hs_report_file(const char *path)
{
    if (report.is_wanted) {
        add_note(&report.files, (struct note){NULL, copy_of(path), NULL, NULL});
    }
}

/* What is printed from now on goes to standard error, so that standard output is JSON alone. */
static int take_standard_output(void)
{
    fflush(stdout);
    report.standard_output = dup(STDOUT_FILENO);
    return report.standard_output >= 0 && dup2(STDERR_FILENO, STDOUT_FILENO) >= 0
               ? 0
               : hs_error("--json -", "write to a file instead",
                          "standard output cannot be used: %s", strerror(errno));
}

int hs_report_begin(const char *command, const char *path)
{
    report.path = path;
    report.standard_output = -1;
    if (strcmp(path, "-") == 0 && take_standard_output() != 0) {
        return -1;
    }
    report.stream = open_memstream(&report.bytes, &report.size);
    if (!report.stream) {
        return hs_error(path, NULL, "out of memory");
    }
    clock_gettime(CLOCK_MONOTONIC, &report.begin);
    hs_json_begin(&report.json, report.stream);
    hs_json_integer(&report.json, "schema", SCHEMA);
    hs_json_text(&report.json, "program", hs_program());
    hs_json_text(&report.json, "command", command);
    hs_json_text(&report.json, "version", LM_VERSION);
    hs_json_object(&report.json, "report");
    report.is_wanted = true;
    return 0;
}

static void free_notes(struct notes *notes)
{
    for (size_t i = 0; i < notes->count; i++) {
        free(notes->items[i].place);
        free(notes->items[i].cause);
        free(notes->items[i].remedy);
    }
    free(notes->items);
    *notes = (struct notes){NULL, 0, 0};
}

static void abandon(void)
{
    report.is_wanted = false;
    free_notes(&report.messages);
    free_notes(&report.files);
    fclose(report.stream);
    free(report.bytes);
}

int hs_report_claim(void)
{
    if (!report.is_wanted || report.is_claimed || report.standard_output >= 0) {
        return 0;
    }
    report.is_claimed = true;
    if (hs_output_claim(report.path) != 0) {
        abandon();
        return -1;
    }
    return 0;
}

static void write_messages(struct hs_json *j)
{
    hs_json_array(j, "messages");
    for (size_t i = 0; i < report.messages.count; i++) {
        const struct note *m = &report.messages.items[i];
        hs_json_object(j, NULL);
        hs_json_text(j, "severity", m->severity);
        hs_json_text(j, "place", m->place);
        hs_json_text(j, "cause", m->cause);
        hs_json_text(j, "remedy", m->remedy);
        hs_json_close(j);
    }
    hs_json_close(j);
}

static void write_files(struct hs_json *j)
{
    hs_json_array(j, "files");
    for (size_t i = 0; i < report.files.count; i++) {
        struct stat status;
        const char *path = report.files.items[i].place;
        hs_json_object(j, NULL);
        hs_json_text(j, "path", path);
        if (stat(path, &status) == 0) {
            hs_json_integer(j, "bytes", status.st_size);
        }
        hs_json_close(j);
    }
    hs_json_close(j);
}

static void write_end(struct hs_json *j, int exit_code)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    while (j->depth > ROOT_DEPTH) {
        hs_json_close(j);
    }
    write_messages(j);
    write_files(j);
    hs_json_real(j, "seconds",
                 (double)(now.tv_sec - report.begin.tv_sec) +
                     1e-9 * (double)(now.tv_nsec - report.begin.tv_nsec));
    hs_json_integer(j, "exit_code", exit_code);
    hs_json_end(j);
}

static int write_to_standard_output(void)
{
    FILE *out = fdopen(report.standard_output, "w");
    const bool is_written = out && fwrite(report.bytes, 1, report.size, out) == report.size;
    const bool is_closed = out && fclose(out) == 0;
    return is_written && is_closed
               ? 0
               : hs_error("--json -", "free some space, or read to the end",
                          "standard output cannot be written: %s", strerror(errno));
}

/* Was it written by the run, into a folder of its own? Told by the file, not by its name. */
static bool is_written_already(void)
{
    struct stat wanted, status;
    for (size_t i = 0; stat(report.path, &wanted) == 0 && i < report.files.count; i++) {
        if (stat(report.files.items[i].place, &status) == 0 && status.st_dev == wanted.st_dev &&
            status.st_ino == wanted.st_ino) {
            return true;
        }
    }
    return false;
}

static int write_to_file(void)
{
    struct hs_atomic_file file;
    if (is_written_already()) {
        return hs_error(report.path, "name another file for --json",
                        "has been written by this run; it would be overwritten");
    }
    if (hs_atomic_open(&file, report.path) != 0) {
        return -1;
    }
    /* A failed write leaves the stream's error mark, which commit reports. */
    fwrite(report.bytes, 1, report.size, file.stream);
    return hs_atomic_commit(&file);
}

int hs_report_end(int exit_code)
{
    if (hs_outputs_end(exit_code == HS_EXIT_OK) != 0) {
        exit_code = HS_EXIT_FAILED;
    }
    if (!report.is_wanted) {
        return exit_code;
    }
    write_end(&report.json, exit_code);
    fflush(stdout);
    const bool is_file = report.standard_output < 0;
    const int whole = fflush(report.stream) == 0 ? 0 : hs_error(report.path, NULL, "out of memory");
    const int written = whole != 0 ? -1 : is_file ? write_to_file() : write_to_standard_output();
    abandon();
    return written == 0 ? exit_code : HS_EXIT_FAILED;
}
