#include "read_xml.h"

#include "hs/error.h"

#include <expat.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

struct document {
    XML_Parser parser;
    const char *name;
    const struct nav_xml_format *format;
    void *user;
    char *text; /* owned: of the innermost element, with room for its '\0' */
    size_t length, capacity;
    bool has_stopped; /* an error has been reported */
};

static void stop(struct document *d)
{
    d->has_stopped = true;
    XML_StopParser(d->parser, XML_FALSE);
}

static const char *local_name(const char *name)
{
    const char *colon = strrchr(name, ':');
    return colon ? colon + 1 : name;
}

static void XMLCALL begin_element(void *user, const char *name, const char **attributes)
{
    struct document *d = user;
    d->length = 0;
    if (d->format->begin(d->user, local_name(name), attributes) != 0) {
        stop(d);
    }
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

static void XMLCALL end_element(void *user, const char *name)
{
    struct document *d = user;
    char none[1] = "", *text = d->text ? d->text : none;
    while (d->length > 0 && is_blank(text[d->length - 1])) {
        d->length--;
    }
    text[d->length] = '\0';
    d->length = 0;
    const long line = (long)XML_GetCurrentLineNumber(d->parser);
    /* An empty element ends also after its beginning has stopped the parser. */
    if (!d->has_stopped && d->format->end(d->user, local_name(name), text, line) != 0) {
        stop(d);
    }
}

static bool make_room(struct document *d, size_t length)
{
    if (d->length + length + 1 <= d->capacity) {
        return true;
    }
    const size_t capacity = 2 * (d->length + length + 1);
    char *grown = realloc(d->text, capacity);
    if (!grown) {
        hs_error(d->name, "cut it into parts", "is too large");
        stop(d);
        return false;
    }
    d->text = grown;
    d->capacity = capacity;
    return true;
}

static void XMLCALL add_text(void *user, const char *text, int length)
{
    struct document *d = user;
    while (d->length == 0 && length > 0 && is_blank(*text)) {
        text++;
        length--;
    }
    if (length > 0 && make_room(d, (size_t)length)) {
        memcpy(d->text + d->length, text, (size_t)length);
        d->length += (size_t)length;
    }
}

static void XMLCALL refuse_document_type(void *user, const char *name, const char *system,
                                         const char *public, int has_internal)
{
    (void)name, (void)system, (void)public, (void)has_internal;
    struct document *d = user;
    hs_error(d->name, "remove the <!DOCTYPE> line",
             "declares a document type, which a track does not have");
    stop(d);
}

static int parse(struct document *d, const char *text, size_t size)
{
    XML_SetUserData(d->parser, d);
    XML_SetElementHandler(d->parser, begin_element, end_element);
    XML_SetCharacterDataHandler(d->parser, add_text);
    XML_SetStartDoctypeDeclHandler(d->parser, refuse_document_type);
    if (XML_Parse(d->parser, text, (int)size, XML_TRUE) == XML_STATUS_OK) {
        return 0;
    }
    return d->has_stopped ? -1
                          : hs_error(d->name, "export the track again",
                                     "is not well-formed XML at line %lu: %s",
                                     (unsigned long)XML_GetCurrentLineNumber(d->parser),
                                     XML_ErrorString(XML_GetErrorCode(d->parser)));
}

int nav_read_xml(const char *text, size_t size, const char *name,
                 const struct nav_xml_format *format, void *user)
{
    struct document d = {
        .parser = XML_ParserCreate(NULL), .name = name, .format = format, .user = user};
    const int result = d.parser && size <= INT_MAX
                           ? parse(&d, text, size)
                           : hs_error(name, "cut it into parts", "is too large");
    XML_ParserFree(d.parser);
    free(d.text);
    return result;
}
