#include "lm/canas_report.h"

#include <stddef.h>

#include "fx/mem.h"
#include "lm/canas.h"

enum { TEN_MILLIONTHS = 10000000, THOUSANDTHS = 1000, HEADER_BYTES = 4, STALE = 1 };

/* clang-format off */
#define ROW(name_, id_, type_, set_, unit_, per_unit_)                                             \
    {                                                                                              \
        .name = (name_), .id = (id_), .type = LM_CANAS_##type_, .set = LM_REPORT_##set_,           \
        .unit = (unit_), .per_unit = (per_unit_)                                                   \
    }

const struct lm_report_row lm_report_rows[LM_REPORT_ITEMS] = {
    [LM_REPORT_CURSOR_LATITUDE] =  ROW("cursor latitude",     1510, LONG,   CURSOR, "deg", TEN_MILLIONTHS),
    [LM_REPORT_CURSOR_LONGITUDE] = ROW("cursor longitude",    1511, LONG,   CURSOR, "deg", TEN_MILLIONTHS),
    [LM_REPORT_CURSOR_ELEVATION] = ROW("cursor elevation",    1512, LONG,   CURSOR, "m",   THOUSANDTHS),
    [LM_REPORT_CURSOR_BEARING] =   ROW("cursor bearing",      1513, LONG,   CURSOR, "deg", TEN_MILLIONTHS),
    [LM_REPORT_CURSOR_RANGE] =     ROW("cursor ground range", 1514, LONG,   CURSOR, "m",   THOUSANDTHS),
    [LM_REPORT_CURSOR_SLANT] =     ROW("cursor slant range",  1515, LONG,   CURSOR, "m",   THOUSANDTHS),
    [LM_REPORT_PLACE_LATITUDE] =   ROW("place latitude",      1516, LONG,   PLACE,  "deg", TEN_MILLIONTHS),
    [LM_REPORT_PLACE_LONGITUDE] =  ROW("place longitude",     1517, LONG,   PLACE,  "deg", TEN_MILLIONTHS),
    [LM_REPORT_PLACE_ELEVATION] =  ROW("place elevation",     1518, LONG,   PLACE,  "m",   THOUSANDTHS),
    [LM_REPORT_PICTURE] =          ROW("picture",             1519, UCHAR4, STATE,  "kind mode field page", 1),
    [LM_REPORT_RANGE_SCALE] =      ROW("range scale",         1520, LONG,   STATE,  "NM",  1),
    [LM_REPORT_SETTINGS] =         ROW("settings",            1521, UCHAR2, STATE,  "half_sector_deg switches", 1),
    [LM_REPORT_GAIN] =             ROW("gain",                1522, CHAR,   STATE,  "dB",  1),
    [LM_REPORT_PATCH] =            ROW("patch",               1523, UCHAR3, STATE,  "state percent refusal", 1),
    [LM_REPORT_PATCH_CELL] =       ROW("patch cell",          1524, LONG,   STATE,  "m",   THOUSANDTHS),
    [LM_REPORT_TRACK] =            ROW("track",               1550, UCHAR4, TRACKED, "kind state loss number", 1),
    [LM_REPORT_TRACK_LATITUDE] =   ROW("track latitude",      1551, LONG,   TRACKED, "deg", TEN_MILLIONTHS),
    [LM_REPORT_TRACK_LONGITUDE] =  ROW("track longitude",     1552, LONG,   TRACKED, "deg", TEN_MILLIONTHS),
    [LM_REPORT_TRACK_ELEVATION] =  ROW("track elevation",     1553, LONG,   TRACKED, "m",   THOUSANDTHS),
    [LM_REPORT_TRACK_BEARING] =    ROW("track bearing",       1554, LONG,   TRACKED, "deg", TEN_MILLIONTHS),
    [LM_REPORT_TRACK_SLANT] =      ROW("track slant range",   1555, LONG,   TRACKED, "m",   THOUSANDTHS),
    [LM_REPORT_TRACK_RATE] =       ROW("track range rate",    1556, LONG,   TRACKED, "m/s", THOUSANDTHS),
    [LM_REPORT_TRACK_SPEED] =      ROW("track ground speed",  1557, LONG,   TRACKED, "m/s", THOUSANDTHS),
    [LM_REPORT_TRACK_COURSE] =     ROW("track course",        1558, LONG,   TRACKED, "deg", TEN_MILLIONTHS),
};
/* clang-format on */

/* The cursor and a track are followed by others; a place and a state by people. UNSOURCED. */
const uint32_t lm_report_period_us[LM_REPORT_SETS] = {[LM_REPORT_CURSOR] = 100000,
                                                      [LM_REPORT_PLACE] = 500000,
                                                      [LM_REPORT_STATE] = 200000,
                                                      [LM_REPORT_TRACKED] = 100000};

void lm_canas_report_init(struct lm_canas_report *r, uint8_t node)
{
    memset(r, 0, sizeof *r);
    r->node = node;
}

uint32_t lm_canas_report_due(const struct lm_canas_report *r, uint64_t now_us)
{
    uint32_t sets = 0;
    for (uint32_t i = 0; i < LM_REPORT_SETS; i++) {
        sets |= (uint32_t)(r->node != 0 && now_us >= r->set[i].next_us) << i;
    }
    return sets;
}

/* Copy the items of a set. Those of one set stand together. */
static void take_values(struct lm_canas_report *r, uint32_t set, const struct lm_report *values)
{
    uint32_t first = LM_REPORT_ITEMS, end = 0;
    for (uint32_t i = 0; i < LM_REPORT_ITEMS; i++) {
        if (lm_report_rows[i].set == set) {
            const uint32_t bit = (uint32_t)1 << i;
            r->told.word[i] = values->word[i];
            r->told.known = (r->told.known & ~bit) | (values->known & bit);
            first = first < i ? first : i;
            end = i + 1;
        }
    }
    r->set[set].item = (uint8_t)first;
    r->set[set].end = (uint8_t)end;
}

void lm_canas_report_begin(struct lm_canas_report *r, uint32_t sets, const struct lm_report *values,
                           uint64_t now_us)
{
    for (uint32_t i = 0; i < LM_REPORT_SETS; i++) {
        if (sets >> i & 1) {
            const uint32_t period_us = lm_report_period_us[i];
            r->count.cut += r->set[i].item != r->set[i].end;
            take_values(r, i, values);
            r->set[i].next_us = now_us - now_us % period_us + period_us;
            r->set[i].code++;
            r->set[i].service = values->is_stale ? STALE : 0;
        }
    }
}

static struct lm_can_frame frame_of(const struct lm_canas_report *r, uint32_t set, uint32_t item)
{
    const struct lm_report_row *row = &lm_report_rows[item];
    const struct lm_canas_type *type = &lm_canas_types[row->type];
    const bool is_known = (r->told.known >> item & 1) != 0;
    const uint32_t bytes = is_known ? (uint32_t)type->element_bytes * type->elements : 0;
    struct lm_can_frame frame = {
        .id = row->id,
        .length = (uint8_t)(HEADER_BYTES + bytes),
        .data = {r->node, is_known ? row->type : (uint8_t)LM_CANAS_NODATA, r->set[set].service,
                 r->set[set].code},
    };
    for (uint32_t i = 0; i < bytes; i++) {
        frame.data[HEADER_BYTES + i] = (uint8_t)(r->told.word[item] >> 8 * (bytes - 1 - i));
    }
    return frame;
}

/* First set of which items wait, or LM_REPORT_SETS. */
static uint32_t waiting_set(const struct lm_canas_report *r)
{
    uint32_t i = 0;
    while (i < LM_REPORT_SETS && r->set[i].item == r->set[i].end) {
        i++;
    }
    return i;
}

void lm_canas_report_send(struct lm_canas_report *r, const struct lm_can *can)
{
    for (uint32_t n = 0; n < LM_REPORT_FRAMES_A_STEP && can->send != NULL; n++) {
        const uint32_t set = waiting_set(r);
        if (set == LM_REPORT_SETS) {
            return;
        }
        const struct lm_can_frame frame = frame_of(r, set, r->set[set].item);
        const int status = can->send(can->ctx, &frame);
        if (status == LM_BUSY) {
            return;
        }
        r->count.sent += status == LM_OK;
        r->count.lost += status != LM_OK;
        r->set[set].item++;
    }
}
