/* OpenStreetMap as XML, by expat. */
#include "hs/error.h"
#include "hs/number.h"
#include "hs/progress.h"
#include "hs/text_file.h"
#include "osm_reading.h"

#include <errno.h>
#include <expat.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK_BYTES = 1 << 16 };

struct xml {
    const char *path;
    struct osm_sink *sink;
    XML_Parser parser;
    bool is_open; /* within an element */
    struct osm_element element;
    int64_t *refs;
    uint8_t *kinds;
    size_t *roles, *tags; /* where each begins in `text` */
    char *text;
    const char **strings;
    size_t ref_capacity, kind_capacity, role_capacity, tag_capacity, text_capacity, text_used;
    size_t string_capacity;
    int result;
    const char *fault;
};

static void fail(struct xml *x, const char *fault)
{
    x->fault = x->fault ? x->fault : fault;
    x->result = -1;
    XML_StopParser(x->parser, XML_FALSE);
}

static const char *attribute(const char **attributes, const char *name)
{
    for (; *attributes; attributes += 2) {
        if (strcmp(*attributes, name) == 0) {
            return attributes[1];
        }
    }
    return NULL;
}

static bool read_id(const char *text, int64_t *id)
{
    char *end;
    errno = 0;
    *id = text ? strtoll(text, &end, 10) : 0;
    return text && *text && *end == '\0' && errno == 0;
}

static bool read_degrees(const char *text, double *value)
{
    return text && hs_number_within(text, -1000, 1000, value);
}

/* Keep a text; where it begins, or SIZE_MAX out of memory. */
static size_t keep(struct xml *x, const char *text)
{
    const size_t length = strlen(text) + 1, begin = x->text_used;
    if (!osm_room((void **)&x->text, &x->text_capacity, begin + length, 1)) {
        return SIZE_MAX;
    }
    memcpy(x->text + begin, text, length);
    x->text_used += length;
    return begin;
}

static void add_tag(struct xml *x, const char **attributes)
{
    const char *const k = attribute(attributes, "k"), *const v = attribute(attributes, "v");
    const size_t n = x->element.tag_count;
    if (!k || !v) {
        fail(x, "a tag without k or v");
        return;
    }
    if (!osm_room((void **)&x->tags, &x->tag_capacity, 2 * n + 2, sizeof *x->tags)) {
        fail(x, "out of memory");
        return;
    }
    x->tags[2 * n] = keep(x, k);
    x->tags[2 * n + 1] = keep(x, v);
    x->element.tag_count++;
    if (x->tags[2 * n] == SIZE_MAX || x->tags[2 * n + 1] == SIZE_MAX) {
        fail(x, "out of memory");
    }
}

static int kind_of(const char *word)
{
    static const char *const words[] = {"node", "way", "relation"};
    for (int i = 0; word && i < OSM_KINDS; i++) {
        if (strcmp(word, words[i]) == 0) {
            return i;
        }
    }
    return -1;
}

static void add_ref(struct xml *x, const char **attributes, bool is_member)
{
    const size_t n = x->element.ref_count;
    const int kind = is_member ? kind_of(attribute(attributes, "type")) : OSM_NODE;
    const char *const role = attribute(attributes, "role");
    if (!osm_room((void **)&x->refs, &x->ref_capacity, n + 1, sizeof *x->refs) ||
        !osm_room((void **)&x->kinds, &x->kind_capacity, n + 1, 1) ||
        !osm_room((void **)&x->roles, &x->role_capacity, n + 1, sizeof *x->roles)) {
        fail(x, "out of memory");
        return;
    }
    if (kind < 0 || !read_id(attribute(attributes, "ref"), &x->refs[n])) {
        fail(x, "a reference that is no number, or whose kind is none");
        return;
    }
    x->kinds[n] = (uint8_t)kind;
    x->roles[n] = keep(x, role ? role : "");
    x->element.ref_count++;
}

static void begin_element(struct xml *x, int kind, const char **attributes)
{
    x->element = (struct osm_element){.kind = (enum osm_kind)kind};
    x->is_open = true;
    x->text_used = 0;
    if (!read_id(attribute(attributes, "id"), &x->element.id) ||
        (kind == OSM_NODE &&
         (!read_degrees(attribute(attributes, "lat"), &x->element.latitude) ||
          !read_degrees(attribute(attributes, "lon"), &x->element.longitude)))) {
        fail(x, "an element whose id or place is no number");
    }
}

static void read_bounds(struct osm_box *box, const char **attributes)
{
    box->is_given = read_degrees(attribute(attributes, "minlat"), &box->south) &&
                    read_degrees(attribute(attributes, "minlon"), &box->west) &&
                    read_degrees(attribute(attributes, "maxlat"), &box->north) &&
                    read_degrees(attribute(attributes, "maxlon"), &box->east);
}

static void XMLCALL on_begin(void *context, const char *name, const char **attributes)
{
    struct xml *x = context;
    const int kind = kind_of(name);
    if (x->result != 0) {
        return;
    }
    if (kind >= 0 && !x->is_open) {
        begin_element(x, kind, attributes);
    } else if (kind >= 0) {
        fail(x, "an element within another");
    } else if (strcmp(name, "bounds") == 0) {
        read_bounds(&x->sink->box, attributes);
    } else if (x->is_open && strcmp(name, "tag") == 0) {
        add_tag(x, attributes);
    } else if (x->is_open && (strcmp(name, "nd") == 0 || strcmp(name, "member") == 0)) {
        add_ref(x, attributes, name[0] == 'm');
    }
}

/* Texts may have moved while they were gathered: only now are they pointed at. */
static void give(struct xml *x)
{
    struct osm_element *e = &x->element;
    const size_t texts = 2 * e->tag_count;
    if (!osm_room((void **)&x->strings, &x->string_capacity, texts + e->ref_count + 1,
                  sizeof *x->strings)) {
        fail(x, "out of memory");
        return;
    }
    for (size_t i = 0; i < texts; i++) {
        x->strings[i] = x->text + x->tags[i];
    }
    for (size_t i = 0; i < e->ref_count; i++) {
        x->strings[texts + i] = x->text + x->roles[i];
    }
    e->tags = x->strings;
    e->refs = x->refs;
    if (e->kind == OSM_RELATION) {
        e->ref_kinds = x->kinds;
        e->roles = x->strings + texts;
    }
    x->result = x->sink->take(x->sink->context, e);
    if (x->result != 0) {
        XML_StopParser(x->parser, XML_FALSE);
    }
}

static void XMLCALL on_end(void *context, const char *name)
{
    struct xml *x = context;
    if (x->is_open && x->result == 0 && kind_of(name) == (int)x->element.kind) {
        x->is_open = false;
        give(x);
    }
}

static int read_chunks(struct xml *x, FILE *file)
{
    size_t got = 1;
    uint64_t done = 0;
    struct hs_progress bar;
    hs_progress_begin(&bar, "reading", osm_bytes(file));
    while (got > 0 && x->result == 0) {
        void *buffer = XML_GetBuffer(x->parser, CHUNK_BYTES);
        if (!buffer) {
            fail(x, "out of memory");
            break;
        }
        got = fread(buffer, 1, CHUNK_BYTES, file);
        const enum XML_Status status = XML_ParseBuffer(x->parser, (int)got, got == 0);
        if (status != XML_STATUS_OK && x->result == 0) {
            x->result = -1;
            x->fault = XML_ErrorString(XML_GetErrorCode(x->parser));
        }
        done += got;
        hs_progress_update(&bar, done);
    }
    hs_progress_end(&bar);
    if (ferror(file)) {
        return hs_error(x->path, NULL, "cannot be read: %s", strerror(errno));
    }
    if (x->fault) {
        char place[512];
        snprintf(place, sizeof place, "%s:%lu", x->path,
                 (unsigned long)XML_GetCurrentLineNumber(x->parser));
        return hs_error(place, "get it again", "%s", x->fault);
    }
    return x->result;
}

int osm_xml_read(const char *path, struct osm_sink *sink)
{
    struct xml x = {.path = path, .sink = sink};
    FILE *file = fopen(path, "rb");
    if (!file) {
        return hs_error(path, "check the name", "cannot be read: %s", strerror(errno));
    }
    x.parser = XML_ParserCreate(NULL);
    int result = -1;
    if (x.parser) {
        XML_SetUserData(x.parser, &x);
        XML_SetElementHandler(x.parser, on_begin, on_end);
        result = read_chunks(&x, file);
        XML_ParserFree(x.parser);
    } else {
        hs_error(path, NULL, "out of memory");
    }
    fclose(file);
    free(x.refs);
    free(x.kinds);
    free(x.roles);
    free(x.tags);
    free(x.text);
    free(x.strings);
    return result;
}
