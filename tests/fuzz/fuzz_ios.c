/* Whatever a browser sends: a line of the bus, a path, a range, a host, a cookie. The first byte
 * says which. A path that is taken leads to nothing above its folder. */
#include "fuzz.h"
#include "ios/line.h"
#include "ios/request.h"

#include <string.h>

const uint32_t fuzz_mutations = 60000;

static void try_line(const char *text, size_t length)
{
    struct lm_can_frame frame, back;
    char line[IOS_LINE_MAX];
    if (ios_line_read(text, length, &frame) == NULL) {
        FUZZ_ASSERT(frame.length >= 4 && frame.length <= 8 &&
                    ios_instructor_slot(&frame) < IOS_INSTRUCTOR_IDS);
        const size_t written = ios_line_write(line, "can0", 0, &frame);
        FUZZ_ASSERT(ios_line_read(line, written - 1, &back) == NULL && back.id == frame.id &&
                    memcmp(back.data, frame.data, frame.length) == 0);
    }
}

static void try_path(const char *text)
{
    struct ios_route r;
    if (ios_route_read(&r, text)) {
        FUZZ_ASSERT(strstr(r.name, "..") == NULL || strstr(r.name, "/..") == NULL);
        FUZZ_ASSERT(r.name[0] != '/' && r.name[0] != '.' && strlen(r.name) <= IOS_PATH_MAX);
        FUZZ_ASSERT(r.kind != IOS_ROUTE_TILE ||
                    (r.zoom <= IOS_ZOOM_MAX && r.x >> r.zoom == 0 && r.y >> r.zoom == 0));
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const uint64_t sizes[] = {0, 1, 1000, UINT64_MAX / 2};
    char text[512], value[40];
    struct ios_range range;
    struct ios_hosts hosts = {0};
    if (size < 1 || size > sizeof text) {
        return 0;
    }
    memcpy(text, data + 1, size - 1);
    text[size - 1] = '\0';
    switch (data[0] % 5) {
    case 0:
        try_line(text, size - 1);
        break;
    case 1:
        try_path(text);
        break;
    case 2:
        for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
            if (ios_range_read(&range, text, sizes[i]) == IOS_RANGE_PART) {
                FUZZ_ASSERT(range.bytes > 0 && range.first < sizes[i] &&
                            range.bytes <= sizes[i] - range.first);
            }
        }
        break;
    case 3:
        (void)ios_hosts_add(&hosts, text);
        (void)ios_host_is_ours(&hosts, text);
        (void)ios_origin_is_ours(&hosts, text);
        break;
    default:
        if (ios_cookie_read(text, "landmass_token", value, sizeof value)) {
            FUZZ_ASSERT(strlen(value) < sizeof value);
        }
        (void)ios_bearer_token(text);
    }
    return 0;
}
