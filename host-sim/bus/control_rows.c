#include "bus/control_rows.h"

#include <stddef.h>

#include "lm/bus_filters.h"
#include "lm/canas.h"
#include "lm/canas_control.h"

static const struct {
    const char *name, *unit;
    int32_t per_unit;
} items[LM_CONTROL_ITEMS] = {
    [LM_CONTROL_ITEM_STEP] = {"control step", "us", 1},
    [LM_CONTROL_ITEM_KEY] = {"control key", "button", 1},
    [LM_CONTROL_ITEM_SWITCH] = {"control switch", "act", 1},
    [LM_CONTROL_ITEM_KNOB] = {"control range knob", "full", 1000},
    [LM_CONTROL_ITEM_SLEW_X] = {"control slew right", "full", 1000},
    [LM_CONTROL_ITEM_SLEW_Y] = {"control slew up", "full", 1000},
    [LM_CONTROL_ITEM_SECTOR] = {"control sector", "mode field", 1},
    [LM_CONTROL_ITEM_RANGE] = {"control range scale", "NM", 1},
    [LM_CONTROL_ITEM_WIDTH] = {"control sector width", "number", 1},
    [LM_CONTROL_ITEM_GAIN] = {"control gain", "dB", 1},
    [LM_CONTROL_ITEM_CURSOR_LATITUDE] = {"control cursor latitude", "deg", 10000000},
    [LM_CONTROL_ITEM_CURSOR_LONGITUDE] = {"control cursor longitude", "deg", 10000000},
    [LM_CONTROL_ITEM_STEER_LATITUDE] = {"control steer latitude", "deg", 10000000},
    [LM_CONTROL_ITEM_STEER_LONGITUDE] = {"control steer longitude", "deg", 10000000},
    [LM_CONTROL_ITEM_PATCH_LATITUDE] = {"control patch latitude", "deg", 10000000},
    [LM_CONTROL_ITEM_PATCH_LONGITUDE] = {"control patch longitude", "deg", 10000000},
    [LM_CONTROL_ITEM_PATCH_CELL] = {"control patch cell", "m", 1000},
    [LM_CONTROL_ITEM_PATCH_LOOK] = {"control patch look", "deg", 10000000},
    [LM_CONTROL_ITEM_PATCH_RANGE] = {"control patch range", "m", 1},
    [LM_CONTROL_ITEM_PATCH_HEIGHT] = {"control patch height", "m", 64},
};

struct lm_report_row bus_control_row(int item)
{
    return (struct lm_report_row){.name = items[item].name,
                                  .id = (uint16_t)(LM_CONTROL_ID + item),
                                  .type = lm_control_type((enum lm_control_item)item),
                                  .unit = items[item].unit,
                                  .per_unit = items[item].per_unit};
}

struct lm_report_row bus_swap_row(void)
{
    return (struct lm_report_row){.name = "swap",
                                  .id = LM_BUS_SWAP_ID,
                                  .type = LM_CANAS_UCHAR4,
                                  .unit = "first second third fourth",
                                  .per_unit = 1};
}
