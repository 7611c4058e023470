#include "build/work.h"

#include "build/manifest.h"
#include "hs/error.h"
#include "hs/input_file.h"

#include <cpl_vsi.h>
#include <errno.h>
#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

enum { LINE_MAX_BYTES = 1 << 16, WORDS = 12 };

static const char first_line[] = "landmass-plan 1";
static const char plan_again[] = "make it again with `landmass-db plan`";

/* ---- writing ---- */

/* A text that is hashed while it is written. */
struct writer {
    FILE *out;
    struct image_sha256 sha256;
    bool has_failed;
};

static void line(struct writer *w, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void line(struct writer *w, const char *format, ...)
{
    char *text = NULL;
    va_list arguments;
    va_start(arguments, format);
    const int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    if (length < 0) {
        w->has_failed = true;
        return;
    }
    image_sha256_add(&w->sha256, text, (size_t)length);
    w->has_failed = fwrite(text, 1, (size_t)length, w->out) != (size_t)length || w->has_failed;
    free(text);
}

/* Each line of a text behind a word. */
static void lines_of(struct writer *w, const char *word, const char *text)
{
    while (text && *text) {
        const size_t length = strcspn(text, "\n");
        line(w, "%s %.*s\n", word, (int)length, text);
        text += length + (text[length] == '\n');
    }
}

static void write_source(struct writer *w, const struct build_source *s)
{
    line(w,
         "source %s %" PRId64 " %" PRId64 " %" PRIu32 " %" PRId64 " %" PRIu64 " %" PRId64
         " %s %s\n",
         s->role, s->area.south, s->area.north, s->area.west, s->area.width, s->bytes, s->changed,
         s->sha256, s->path);
}

static void write_shard(struct writer *w, int number, const struct build_work_shard *s)
{
    const struct build_shard *p = &s->place;
    line(w,
         "shard %d %u %u %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu32 " %" PRIu64 " %" PRIu32
         " %s\n",
         number, (unsigned)p->level, (unsigned)p->zone, p->row0, p->rows, p->column0, p->columns,
         s->tiles, s->memory_mib, s->key);
}

int build_work_write(const struct build_work *work, FILE *out)
{
    struct writer w = {.out = out};
    char digest[IMAGE_SHA256_TEXT];
    image_sha256_begin(&w.sha256);
    line(&w, "%s\n", first_line);
    for (int i = 0; i < work->option_count; i++) {
        line(&w, "option %s\n", work->options[i]);
    }
    line(&w, "grid %s\nheights", work->grid_sha256);
    for (int i = 0; i < 16; i++) {
        line(&w, " %u", (unsigned)work->heights_dm[i]);
    }
    line(&w, "\nvoids %s\n", work->has_voids ? "some" : "none");
    lines_of(&w, "manifest", work->manifest);
    for (int i = 0; i < work->source_count; i++) {
        write_source(&w, &work->sources[i]);
    }
    for (int i = 0; i < work->shard_count; i++) {
        write_shard(&w, i, &work->shards[i]);
    }
    image_sha256_end(&w.sha256, digest);
    return w.has_failed || fprintf(out, "end %s\n", digest) < 0
               ? hs_error("plan", "free some space and run again", "cannot be written")
               : 0;
}

int build_work_add_source(struct build_work *w, const struct build_source *source)
{
    if (strpbrk(source->path, "\n") || w->source_count == BUILD_WORK_SOURCES_MAX) {
        return hs_error(source->path, "rename it, or join sources into fewer",
                        "has a line break in its name, or is one of more than %d sources",
                        BUILD_WORK_SOURCES_MAX);
    }
    struct build_source *sources =
        realloc(w->sources, ((size_t)w->source_count + 1) * sizeof *sources);
    if (!sources) {
        return hs_error(source->path, NULL, "out of memory");
    }
    w->sources = sources;
    sources[w->source_count] = *source;
    sources[w->source_count].path = strdup(source->path);
    return sources[w->source_count++].path ? 0 : hs_error(source->path, NULL, "out of memory");
}

/* ---- reading ---- */

struct reader {
    const char *path;
    FILE *stream;
    struct build_work *work;
    char *text; /* owned */
    size_t capacity, manifest_bytes;
    int line_number;
    bool has_grid, has_heights, has_voids, is_ended;
    struct image_sha256 sha256;
};

static int wrong(const struct reader *r, const char *cause)
{
    char place[512];
    snprintf(place, sizeof place, "%s line %d", r->path, r->line_number);
    return hs_error(place, plan_again, "%s", cause);
}

/* A whole number of low..high. */
static bool number(const char *text, int64_t low, int64_t high, int64_t *value)
{
    char *end;
    errno = 0;
    const long long found = strtoll(text, &end, 10);
    *value = found;
    return errno == 0 && end != text && *end == '\0' && found >= low && found <= high;
}

/* Cut the first `count` words of a text off, at single blanks. Returns what is behind them, or NULL
 * when there are fewer. */
static char *cut(char *text, char *words[WORDS], int count)
{
    for (int i = 0; i < count; i++) {
        words[i] = text;
        text = text ? strchr(text, ' ') : NULL;
        if (!text && i + 1 < count) {
            return NULL;
        }
        if (text) {
            *text++ = '\0';
        }
    }
    return text ? text : words[count - 1] + strlen(words[count - 1]);
}

static bool is_digest(const char *text)
{
    return strlen(text) == IMAGE_SHA256_TEXT - 1 &&
           strspn(text, "0123456789abcdef") == IMAGE_SHA256_TEXT - 1;
}

static int read_option(struct reader *r, const char *text)
{
    struct build_work *w = r->work;
    if (w->option_count == BUILD_WORK_OPTIONS_MAX || strncmp(text, "--", 2) != 0) {
        return wrong(r, "is no option, or one too many");
    }
    w->options[w->option_count] = strdup(text);
    return w->options[w->option_count] ? (w->option_count++, 0) : wrong(r, "out of memory");
}

static int read_grid(struct reader *r, const char *text)
{
    if (!is_digest(text) || r->has_grid) {
        return wrong(r, "needs one digest of 64 digits");
    }
    memcpy(r->work->grid_sha256, text, IMAGE_SHA256_TEXT);
    r->has_grid = true;
    return 0;
}

static int read_heights(struct reader *r, char *text)
{
    char *rest = text;
    for (int i = 0; i < 16; i++) {
        char *word = rest;
        int64_t value;
        rest = rest ? strchr(rest, ' ') : NULL;
        if (rest) {
            *rest++ = '\0';
        }
        const uint16_t before = i > 0 ? r->work->heights_dm[i - 1] : 0;
        if (!word || !number(word, before, i == 0 ? 0 : UINT16_MAX, &value)) {
            return wrong(r, "needs 16 heights that do not fall, the first of them 0");
        }
        r->work->heights_dm[i] = (uint16_t)value;
    }
    r->has_heights = true;
    return rest ? wrong(r, "has a word too many") : 0;
}

static int read_voids(struct reader *r, const char *text)
{
    const bool has_some = strcmp(text, "some") == 0;
    if (!has_some && strcmp(text, "none") != 0) {
        return wrong(r, "needs none or some");
    }
    r->work->has_voids = has_some;
    r->has_voids = true;
    return 0;
}

static int read_manifest(struct reader *r, const char *text)
{
    const size_t length = strlen(text);
    char *whole = realloc(r->work->manifest, r->manifest_bytes + length + 2);
    if (!whole) {
        return wrong(r, "out of memory");
    }
    r->work->manifest = whole;
    snprintf(whole + r->manifest_bytes, length + 2, "%s\n", text);
    r->manifest_bytes += length + 1;
    return 0;
}

static int read_source(struct reader *r, char *text)
{
    char *words[WORDS];
    struct build_source s = {.path = cut(text, words, 8)};
    int64_t west, bytes;
    if (!s.path || *s.path == '\0' || strlen(words[0]) >= sizeof s.role ||
        !number(words[1], -IMAGE_BAM_QUARTER, IMAGE_BAM_QUARTER, &s.area.south) ||
        !number(words[2], s.area.south, IMAGE_BAM_QUARTER, &s.area.north) ||
        !number(words[3], 0, UINT32_MAX, &west) ||
        !number(words[4], 0, IMAGE_BAM_ROUND, &s.area.width) ||
        !number(words[5], 0, INT64_MAX, &bytes) ||
        !number(words[6], INT64_MIN, INT64_MAX, &s.changed) || !is_digest(words[7])) {
        return wrong(r, "is no source: role, area of four numbers, bytes, time, digest, path");
    }
    memcpy(s.role, words[0], strlen(words[0]));
    memcpy(s.sha256, words[7], sizeof s.sha256);
    s.area.west = (uint32_t)west;
    s.bytes = (uint64_t)bytes;
    return build_work_add_source(r->work, &s);
}

/* The numbers of a shard, in the order of its line. */
static bool read_place(char *const words[WORDS], struct build_work_shard *s)
{
    int64_t n[8];
    static const int64_t most[8] = {LM_DB_LODS_MAX - 1, 3,      1 << 26, 1 << 26, 1 << 26, 1 << 26,
                                    INT64_MAX,          1 << 20};
    for (int i = 0; i < 8; i++) {
        const bool is_count = i == 3 || i == 5;
        if (!number(words[1 + i], is_count ? 1 : 0, most[i], &n[i])) {
            return false;
        }
    }
    s->place = (struct build_shard){.level = (uint8_t)n[0],
                                    .zone = (uint8_t)n[1],
                                    .row0 = (uint32_t)n[2],
                                    .rows = (uint32_t)n[3],
                                    .column0 = (uint32_t)n[4],
                                    .columns = (uint32_t)n[5]};
    s->tiles = (uint64_t)n[6];
    s->memory_mib = (uint32_t)n[7];
    return true;
}

static int read_shard(struct reader *r, char *text)
{
    struct build_work *w = r->work;
    char *words[WORDS];
    struct build_work_shard s;
    int64_t which;
    const char *rest = cut(text, words, 10);
    if (!rest || *rest || !number(words[0], w->shard_count, w->shard_count, &which) ||
        w->shard_count == BUILD_SHARDS_MAX || !read_place(words, &s) || !is_digest(words[9]) ||
        (w->shard_count > 0 && s.place.level != w->shards[0].place.level)) {
        return wrong(r, "is no shard, or not the next one");
    }
    memcpy(s.key, words[9], sizeof s.key);
    struct build_work_shard *shards =
        realloc(w->shards, ((size_t)w->shard_count + 1) * sizeof *shards);
    if (!shards) {
        return wrong(r, "out of memory");
    }
    w->shards = shards;
    shards[w->shard_count++] = s;
    return 0;
}

static int read_end(struct reader *r, const char *text)
{
    char digest[IMAGE_SHA256_TEXT];
    image_sha256_end(&r->sha256, digest);
    r->is_ended = true;
    return strcmp(digest, text) == 0 ? 0 : wrong(r, "the plan was changed: its checksum is wrong");
}

static int read_line(struct reader *r)
{
    static const struct {
        const char *word;
        int (*read)(struct reader *r, const char *text);
    } plain[] = {{"option", read_option},
                 {"grid", read_grid},
                 {"voids", read_voids},
                 {"end", read_end},
                 {"manifest", read_manifest}};
    char *rest = strchr(r->text, ' ');
    if (r->line_number == 1) {
        return strcmp(r->text, first_line) == 0 ? 0 : wrong(r, "is no plan of this version");
    }
    if (!rest || r->is_ended) {
        return wrong(r, "is of no known form");
    }
    *rest++ = '\0';
    for (size_t i = 0; i < sizeof plain / sizeof plain[0]; i++) {
        if (strcmp(r->text, plain[i].word) == 0) {
            return plain[i].read(r, rest);
        }
    }
    return strcmp(r->text, "heights") == 0  ? read_heights(r, rest)
           : strcmp(r->text, "source") == 0 ? read_source(r, rest)
           : strcmp(r->text, "shard") == 0  ? read_shard(r, rest)
                                            : wrong(r, "is of no known form");
}

/* The next line without its end. Returns 1, 0 at the end of the file, or -1. */
static int next_line(struct reader *r)
{
    const ssize_t length = getline(&r->text, &r->capacity, r->stream);
    r->line_number++;
    if (length <= 0) {
        return ferror(r->stream) ? wrong(r, "cannot be read") : 0;
    }
    if (length > LINE_MAX_BYTES || r->text[length - 1] != '\n' ||
        strlen(r->text) != (size_t)length) {
        return wrong(r, "is too long, not ended, or no text");
    }
    if (strncmp(r->text, "end ", 4) != 0) {
        image_sha256_add(&r->sha256, r->text, (size_t)length);
    }
    r->text[length - 1] = '\0';
    return 1;
}

static int read_all(struct reader *r)
{
    int step = 1;
    image_sha256_begin(&r->sha256);
    while (step > 0) {
        step = next_line(r);
        if (step > 0 && read_line(r) != 0) {
            step = -1;
        }
    }
    const bool is_whole = r->is_ended && r->has_grid && r->has_heights && r->has_voids &&
                          r->work->shard_count > 0 && r->work->manifest;
    return step == 0 && !is_whole ? wrong(r, "the plan ends too early") : step;
}

int build_work_read(struct build_work *w, const char *path)
{
    struct reader r = {.path = path, .work = w, .stream = hs_input_open(path, "r")};
    *w = (struct build_work){.option_count = 0};
    if (!r.stream) {
        return hs_error(path, plan_again, "cannot be opened: %s", strerror(errno));
    }
    const int result = read_all(&r);
    fclose(r.stream);
    free(r.text);
    if (result != 0) {
        build_work_free(w);
    }
    return result;
}

void build_work_free(struct build_work *w)
{
    for (int i = 0; i < w->option_count; i++) {
        free(w->options[i]);
    }
    for (int i = 0; i < w->source_count; i++) {
        free(w->sources[i].path);
    }
    free(w->manifest);
    free(w->sources);
    free(w->shards);
    *w = (struct build_work){.option_count = 0};
}

/* ---- checks ---- */

void build_work_grid(const struct build_plan *plan, char sha256[IMAGE_SHA256_TEXT])
{
    struct image_sha256 sha;
    image_sha256_begin(&sha);
    image_sha256_add(&sha, &plan->shift0, 1);
    image_sha256_add(&sha, &plan->level_count, 1);
    image_sha256_add(&sha, plan->bands, plan->band_count * sizeof plan->bands[0]);
    image_sha256_end(&sha, sha256);
}

static int check_source(const struct build_source *s)
{
    VSIStatBufL status;
    uint64_t bytes;
    char digest[IMAGE_SHA256_TEXT];
    if (VSIStatL(s->path, &status) != 0) {
        return hs_error(s->path, "run from the folder where the plan was made",
                        "is a source of the plan and cannot be read");
    }
    if ((uint64_t)status.st_size == s->bytes && (int64_t)status.st_mtime == s->changed) {
        return 0;
    }
    return build_manifest_hash(s->path, &bytes, digest) == 0 && bytes == s->bytes &&
                   strcmp(digest, s->sha256) == 0
               ? 0
               : hs_error(s->path, plan_again, "has changed since the plan was made");
}

int build_work_check_sources(const struct build_work *w, const bool *counts)
{
    for (int i = 0; i < w->source_count; i++) {
        if ((!counts || counts[i]) && check_source(&w->sources[i]) != 0) {
            return -1;
        }
    }
    return 0;
}
