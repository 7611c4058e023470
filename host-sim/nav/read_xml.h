/* XML of track files by expat: elements by their local names, with the text of the innermost. */
#ifndef NAV_READ_XML_H
#define NAV_READ_XML_H

#include <stdbool.h>
#include <stddef.h>

/* What a format makes of its elements; `user` is the caller's. Each returns 0, or -1 to stop the
 * reading, with the error reported. */
struct nav_xml_format {
    /* `attributes`: names and values in turn, then NULL. */
    int (*begin)(void *user, const char *name, const char **attributes);
    /* `text`: what stands before this end tag and after the tag before it, without blanks around;
     * may be overwritten. `line`: of the tag. */
    int (*end)(void *user, const char *name, char *text, long line);
};

/* Read a whole document; `name` is for messages. A document type is refused, because entities are
 * how XML is made to eat memory; what is kept of the text is never longer than the document.
 * Returns 0, or -1 with the error reported: not well-formed, stopped, no memory. */
int nav_read_xml(const char *text, size_t size, const char *name,
                 const struct nav_xml_format *format, void *user);

#endif
