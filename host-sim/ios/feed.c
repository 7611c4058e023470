#include "ios/feed.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

struct kept {
    uint64_t order; /* 0: none was seen */
    uint64_t time_us;
    struct lm_can_frame frame;
};

struct ios_past {
    struct kept kept[IOS_INSTRUCTOR_IDS * IOS_SERVICE_CODES];
    size_t count; /* of those that were seen */
};

int ios_feed_open(struct ios_feed *feed, size_t room)
{
    *feed = (struct ios_feed){
        .ring = malloc(room), .room = room, .past = calloc(1, sizeof *feed->past)};
    if (feed->ring == NULL || feed->past == NULL) {
        ios_feed_close(feed);
        return hs_error("feed of the bus", NULL, "out of memory");
    }
    return 0;
}

void ios_feed_close(struct ios_feed *feed)
{
    free(feed->ring);
    free(feed->past);
    *feed = (struct ios_feed){0};
}

static void keep(struct ios_feed *feed, uint64_t time_us, const struct lm_can_frame *frame)
{
    const int slot = ios_instructor_slot(frame);
    if (slot < 0) {
        return;
    }
    const unsigned service = frame->length > 2 ? frame->data[2] : 0;
    struct kept *k = &feed->past->kept[(unsigned)slot * IOS_SERVICE_CODES + service];
    feed->past->count += k->order == 0;
    *k = (struct kept){feed->frames, time_us, *frame};
}

void ios_feed_put(struct ios_feed *feed, const char *iface, uint64_t time_us,
                  const struct lm_can_frame *frame)
{
    char line[IOS_LINE_MAX];
    const size_t length = ios_line_write(line, iface, time_us, frame);
    const size_t at = (size_t)(feed->end % feed->room);
    const size_t first = length < feed->room - at ? length : feed->room - at;
    memcpy(feed->ring + at, line, first);
    memcpy(feed->ring, line + first, length - first);
    feed->end += length;
    feed->frames++;
    keep(feed, time_us, frame);
}

long ios_feed_take(const struct ios_feed *feed, uint64_t *at, char *to, size_t room)
{
    const uint64_t waiting = feed->end - *at;
    if (waiting > feed->room) {
        return -1;
    }
    size_t length = waiting < room ? (size_t)waiting : room;
    const size_t from = (size_t)(*at % feed->room);
    const size_t first = length < feed->room - from ? length : feed->room - from;
    memcpy(to, feed->ring + from, first);
    memcpy(to + first, feed->ring, length - first);
    while (length > 0 && to[length - 1] != '\n') {
        length--;
    }
    *at += length;
    return (long)length;
}

static int by_order(const void *a, const void *b)
{
    const struct kept *x = a, *y = b;
    return (x->order > y->order) - (x->order < y->order);
}

char *ios_feed_past(const struct ios_feed *feed, size_t *bytes)
{
    const struct ios_past *past = feed->past;
    struct kept *sorted = calloc(past->count + 1, sizeof *sorted);
    char *text = malloc((past->count + 1) * IOS_LINE_MAX);
    *bytes = 0;
    if (past->count == 0 || sorted == NULL || text == NULL) {
        free(sorted);
        free(text);
        return NULL;
    }
    size_t count = 0;
    for (size_t i = 0; i < sizeof past->kept / sizeof past->kept[0]; i++) {
        if (past->kept[i].order != 0) {
            sorted[count++] = past->kept[i];
        }
    }
    qsort(sorted, count, sizeof *sorted, by_order);
    for (size_t i = 0; i < count; i++) {
        *bytes += ios_line_write(text + *bytes, "past", sorted[i].time_us, &sorted[i].frame);
    }
    free(sorted);
    return text;
}
