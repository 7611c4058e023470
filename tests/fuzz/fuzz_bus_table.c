/* A text table of a bus: whatever it holds, it is refused, or makes a profile whose arithmetic
 * stays within its bounds for any frame, and prints. */
#include "bus/print.h"
#include "bus/table_text.h"
#include "fuzz.h"
#include "lm/bus.h"
#include "lm/nav.h"
#include "lm/status.h"
#include "lm/weather_bus.h"

const uint32_t fuzz_mutations = 8000;

static void try_frames(const struct lm_bus_profile *profile)
{
    struct lm_bus *bus = malloc(sizeof *bus);
    struct lm_nav *nav = malloc(sizeof *nav);
    FUZZ_ASSERT(bus && nav);
    lm_bus_init(bus, profile);
    lm_nav_init(nav);
    struct lm_weather_bus weather = {0};
    const bool is_packed = profile->framing == LM_BUS_PACKED;
    const uint32_t kinds = is_packed ? 4 : 4 * LM_CANAS_TYPES;
    for (uint32_t i = 0; i < kinds * profile->row_count; i++) {
        const uint8_t type = (uint8_t)(i % kinds / 4);
        struct lm_can_frame f = {.id = profile->rows[i / kinds].id,
                                 .is_extended = is_packed,
                                 .length = 8,
                                 .time_us = i * 1000};
        memset(f.data, (int)(i % 4 * 0x55), sizeof f.data);
        if (!is_packed) {
            const struct lm_canas_type *t = &lm_canas_types[type];
            f.data[1] = type;
            f.length = (uint8_t)(4 + t->element_bytes * t->elements);
        }
        struct lm_ownship ownship;
        struct lm_bus_event events[LM_BUS_EVENTS];
        const uint32_t count = lm_bus_take(bus, &f, events);
        for (uint32_t k = 0; k < count; k++) {
            lm_nav_take(nav, &events[k]);
            lm_weather_bus_take(&weather, &events[k]);
        }
        struct lm_environment e = {0};
        lm_weather_bus_at(&weather, f.time_us, &e);
        FUZZ_ASSERT(lm_environment_check(&e) == LM_OK);
        lm_nav_at(nav, f.time_us + i % 7 * 1000000, &ownship);
    }
    free(nav);
    free(bus);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static struct bus_table table;
    FILE *in = size > 0 ? fmemopen((void *)(uintptr_t)data, size, "r") : NULL;
    if (in == NULL) {
        return 0;
    }
    const int status = bus_table_read(&table, in, "table");
    fclose(in);
    if (status == 0) {
        try_frames(&table.profile);
        FILE *out = fopen("/dev/null", "w");
        FUZZ_ASSERT(out);
        bus_print_table(out, &table.profile);
        bus_print_dbc(out, &table.profile);
        bus_print_filters(out, &table.profile);
        bus_print_c(out, &table.profile);
        fclose(out);
    }
    return 0;
}
