#include "ended.h"

#include "report.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Words of systemd.exec(5), and those of the glass. */
static const struct {
    const char *result, *cause;
} causes[] = {
    {"watchdog", "WATCHDOG"},      {"core-dump", "CRASH"},  {"signal", "CRASH"},
    {"oom-kill", "OUT OF MEMORY"}, {"exit-code", "FAILED"}, {"timeout", "TIME-OUT"},
};

const char *ended_cause(void)
{
    char path[160], word[16] = "";
    const char *folder = getenv("RUNTIME_DIRECTORY");
    if (folder == NULL ||
        snprintf(path, sizeof path, "%s/" ENDED_FILE, folder) >= (int)sizeof path) {
        return NULL;
    }
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    const ssize_t size = fd >= 0 ? read(fd, word, sizeof word - 1) : -1;
    if (fd >= 0) {
        close(fd);
    }
    if (size <= 0) {
        return NULL;
    }
    word[strcspn(word, "\n")] = '\0';
    for (size_t i = 0; i < sizeof causes / sizeof causes[0]; i++) {
        if (strcmp(word, causes[i].result) == 0) {
            report(REPORT_WARNING, "restart: systemd has ended the panel before: %s", word);
            return causes[i].cause;
        }
    }
    return NULL;
}
