/* Recordings in a folder, and the one that a display writes now (docs/panel.md, "Recording"): parts
 * SESSION-000.log, SESSION-001.log, ..., and current.log, a link to the part that grows. */
#ifndef IOS_RECORDINGS_H
#define IOS_RECORDINGS_H

#include "ios/request.h"

enum { IOS_RECORDINGS_MAX = 1000 };

struct ios_recording {
    char name[IOS_PATH_MAX + 1];
    uint64_t bytes;
    double start_s, seconds; /* start_s: since 1970 began, by the first line; 0: it has no time */
};

/* The logs of a folder, by name; `prefix` ("" or "DISPLAY/") is put before each. Fills at most
 * `room`, and returns how many; a folder that cannot be read has none. */
int ios_recordings(const char *folder, const char *prefix, struct ios_recording *list, int room);

/* The part that current.log leads to. False if there is none with a plain name. */
bool ios_recording_now(const char *folder, char name[IOS_NAME_MAX + 1]);

/* A reader of the session that is being recorded, from its part 000 on. */
struct ios_follow {
    const char *folder; /* borrowed */
    char session[IOS_NAME_MAX + 1];
    int fd, part; /* fd -1: closed */
    uint64_t at;  /* bytes read of the part */
};

/* Begin with the session that current.log belongs to; and end. False if there is none, or its part
 * 000 is gone. Closing twice does no harm. */
bool ios_follow_open(struct ios_follow *f, const char *folder);
void ios_follow_close(struct ios_follow *f);

/* Copy whole lines, at most `room` bytes. Returns the bytes; 0: there is nothing new; -1: the
 * session is over, because another has begun, or it cannot be read. */
long ios_follow_take(struct ios_follow *f, char *to, size_t room);

#endif
