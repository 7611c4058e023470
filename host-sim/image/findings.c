#include "image/findings.h"

#include "hs/report.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

static void report_finding(uint64_t offset, const char *cause)
{
    hs_report_object(NULL);
    hs_report_put("offset_bytes", offset);
    hs_report_put("cause", cause);
    hs_report_close();
}

static void keep(struct image_kept *kept, uint64_t offset, const char *text)
{
    if (kept->count == kept->room) {
        const size_t room = 2 * kept->room + 4;
        struct image_found *items = realloc(kept->items, room * sizeof *items);
        if (!items) {
            return; /* it is counted */
        }
        kept->items = items;
        kept->room = room;
    }
    kept->items[kept->count++] = (struct image_found){offset, strdup(text)};
}

void image_find(struct image_findings *f, uint64_t offset, const char *cause, ...)
{
    f->count++;
    if ((!f->out && !f->is_reported && !f->kept) || f->count > f->shown_max) {
        return;
    }
    char text[512];
    va_list arguments;
    va_start(arguments, cause);
    vsnprintf(text, sizeof text, cause, arguments);
    va_end(arguments);
    if (f->kept) {
        keep(f->kept, offset, text);
        return;
    }
    if (f->out) {
        fprintf(f->out, "offset 0x%08" PRIx64 ": %s\n", offset, text);
    }
    if (f->is_reported) {
        report_finding(offset, text);
    }
}

void image_findings_tell(struct image_findings *f, struct image_findings *part)
{
    const struct image_kept *kept = part->kept;
    if (!kept) {
        return;
    }
    for (size_t i = 0; i < kept->count; i++) {
        image_find(f, kept->items[i].offset, "%s",
                   kept->items[i].text ? kept->items[i].text : "not enough memory to say what");
    }
    f->count += part->count - kept->count; /* those that were not kept */
    image_findings_drop(part);
}

void image_findings_drop(struct image_findings *part)
{
    struct image_kept *kept = part->kept;
    if (!kept) {
        return;
    }
    for (size_t i = 0; i < kept->count; i++) {
        free(kept->items[i].text);
    }
    free(kept->items);
    *kept = (struct image_kept){0};
    part->count = 0;
}
