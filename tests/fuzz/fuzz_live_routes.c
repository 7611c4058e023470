/* The routes of landmass-nav: what it accepts can be told on the bus, within the ranges of its
 * frames. */
#include "fuzz.h"
#include "nav/live.h"

const uint32_t fuzz_mutations = 20000;

static struct nav_live live;

static void check_target(int index)
{
    static const double at_s[] = {0, 1, 2.5, 60, 3600};
    struct canas_codes codes = {{0}};
    struct canas_frame frames[NAV_LIVE_FRAMES];
    const struct nav_live_item *t = &live.item[index];
    FUZZ_ASSERT(t->number >= 0 && t->number < NAV_LIVE_MAX && t->kind < NAV_LIVE_KINDS);
    FUZZ_ASSERT(t->points > 0 && t->first_point + t->points <= live.point_count);
    for (int i = 1; i < t->points; i++) {
        const struct nav_live_point *p = &live.point[t->first_point + i];
        FUZZ_ASSERT(p->at_s > p[-1].at_s);
    }
    for (size_t i = 0; i < sizeof at_s / sizeof *at_s; i++) {
        const int count = nav_live_frames(&live, index, &codes, t->from_s + at_s[i], 1,
                                          t->from_s + at_s[i], frames);
        FUZZ_ASSERT(count >= 0 && count <= NAV_LIVE_FRAMES);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_file file;
    fuzz_file_open(&file, data, size);
    memset(&live, 0, sizeof live);
    if (nav_live_read(&live, file.path) == 0) {
        FUZZ_ASSERT(live.count > 0 && live.count <= NAV_LIVE_MAX);
        for (int i = 0; i < live.count; i++) {
            check_target(i);
        }
    }
    fuzz_file_close(&file);
    return 0;
}
