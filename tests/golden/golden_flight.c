#include "golden_flight.h"

#include "bus_frames.h"
#include "fx/crc32c.h"
#include "golden_scene.h"

#include <string.h>

enum { STEP_US = 2000, FIX_US = 100000, START_US = 200000 };
/* A place on the runway of golden_scene.c, from the middle. */
enum { RUNWAY_NORTH_M = -870, RUNWAY_EAST_M = 800 };

#define GLASS .width_px = 384, .height_px = 384
/* From the south, over the plain towards town and mountain. */
#define FROM_SOUTH .north_m = -3600, .east_m = 300, .height_m = 2500
#define GM(nm, deg, a)                                                                             \
    {                                                                                              \
        .name = "gm-" #nm "nm-" deg, FROM_SOUTH, .heading_deg = 5, GLASS, .range_nm = (nm),        \
        .azimuth = (a)                                                                             \
    }

/* Keys of the radar page and of the control page. */
#define CNTL        5
#define CURSOR_ZERO 9
#define TILT_UP     2
#define PENCIL      4
/* The town 9,260 m ahead, where the cursor goes on the shortest range. */
#define TOWN_AHEAD                                                                                 \
    GLASS, .north_m = -7560, .east_m = 600, .height_m = 2500, .speed_m_s = 200,                    \
           .keys = {CURSOR_ZERO}

const struct golden_picture golden_pictures[] = {
    GM(10, "60deg", 0),
    GM(10, "30deg", 1),
    GM(10, "10deg", 2),
    GM(20, "60deg", 0),
    GM(20, "30deg", 1),
    GM(20, "10deg", 2),
    GM(40, "60deg", 0),
    GM(40, "30deg", 1),
    GM(40, "10deg", 2),
    GM(80, "60deg", 0),
    GM(80, "30deg", 1),
    GM(80, "10deg", 2),
    {.name = "gm-low-and-looking-out-to-sea",
     GLASS,
     .north_m = 1000,
     .east_m = 2500,
     .height_m = 700,
     .heading_deg = -80},
    {.name = "gm-brighter-by-10-db", FROM_SOUTH, GLASS, .gain_db = 10},
    {.name = "gm-largest-glass", FROM_SOUTH, .width_px = 1024, .height_px = 768},
    {.name = "gm-smallest-glass", FROM_SOUTH, .width_px = 256, .height_px = 256},
    {.name = "gm-zone-border", .place = GOLDEN_BORDER, GLASS, .north_m = -5000, .height_m = 2500},
    {.name = "gm-antimeridian",
     .place = GOLDEN_ANTIMERIDIAN,
     GLASS,
     .east_m = -5000,
     .height_m = 2500,
     .heading_deg = 80},
    {.name = "gm-north", .place = GOLDEN_NORTH, GLASS, .north_m = -5000, .height_m = 2500},
    {.name = "gmt", GLASS, FROM_SOUTH, .speed_m_s = 200, .mode = LM_SECTOR_GMT, .has_movers = true},
    {.name = "gmt-exp", TOWN_AHEAD, .mode = LM_SECTOR_GMT, .has_movers = true, .field = LM_FOV_EXP},
    {.name = "sea",
     GLASS,
     .speed_m_s = 200,
     .height_m = 700,
     .heading_deg = -80,
     .mode = LM_SECTOR_SEA,
     .has_movers = true},
    {.name = "sea-exp", TOWN_AHEAD, .mode = LM_SECTOR_SEA, .field = LM_FOV_EXP},
    {.name = "sea-state-6",
     GLASS,
     .height_m = 700,
     .heading_deg = -80,
     .mode = LM_SECTOR_SEA,
     .sea_state = 6},
    {.name = "exp", TOWN_AHEAD, .field = LM_FOV_EXP},
    {.name = "dbs1-off-the-track", TOWN_AHEAD, .drift_deg = -40, .field = LM_FOV_DBS1},
    {.name = "dbs1-across-the-notch", TOWN_AHEAD, .field = LM_FOV_DBS1},
    {.name = "dbs2-off-the-track", TOWN_AHEAD, .drift_deg = -40, .field = LM_FOV_DBS2},
    {.name = "gm-rain", FROM_SOUTH, GLASS, .rain_mm_h = 60},
    {.name = "gm-jammer", FROM_SOUTH, GLASS, .jam_db = 40},
    {.name = "gm-pencil-beam", FROM_SOUTH, GLASS, .keys = {CNTL, PENCIL}},
    {.name = "page-control-tilt-by-hand",
     FROM_SOUTH,
     GLASS,
     .keys = {CNTL, PENCIL, TILT_UP, TILT_UP, TILT_UP, TILT_UP}},
    {.name = "sar-5m-from-the-ownship",
     GLASS,
     .north_m = -8000,
     .east_m = 3000,
     .height_m = 3000,
     .heading_deg = 20,
     .speed_m_s = 200,
     .cell_mm = 5000},
    {.name = "sar-2m-looking-north", GLASS, .height_m = 3000, .cell_mm = 2000, .range_m = 12000},
    {.name = "sar-5m-looking-south-west",
     GLASS,
     .height_m = 3000,
     .heading_deg = 225,
     .cell_mm = 5000,
     .range_m = 12000},
    {.name = "sar-5m-as-a-plan",
     GLASS,
     .height_m = 4000,
     .heading_deg = 225,
     .cell_mm = 5000,
     .range_m = 9000,
     .is_plan = true},
    {.name = "sar-20m-in-rain",
     GLASS,
     .height_m = 5000,
     .heading_deg = 180,
     .cell_mm = 20000,
     .range_m = 30000,
     .rain_mm_h = 60},
    {.name = "sar-10m-looking-east-from-afar",
     GLASS,
     .height_m = 9000,
     .heading_deg = 90,
     .cell_mm = 10000,
     .range_m = 70000},
    {.name = "sar-20m-looking-south",
     GLASS,
     .height_m = 5000,
     .heading_deg = 180,
     .cell_mm = 20000,
     .range_m = 30000},
    {.name = "sar-40m-largest-glass",
     .width_px = 1024,
     .height_px = 768,
     .height_m = 9000,
     .heading_deg = 20,
     .cell_mm = 40000,
     .range_m = 60000},
    {.name = "sar-zone-border",
     .place = GOLDEN_BORDER,
     GLASS,
     .height_m = 3000,
     .heading_deg = 30,
     .cell_mm = 10000,
     .range_m = 20000},
    {.name = "sar-antimeridian",
     .place = GOLDEN_ANTIMERIDIAN,
     GLASS,
     .height_m = 3000,
     .heading_deg = 100,
     .cell_mm = 10000,
     .range_m = 20000},
    {.name = "sar-north",
     .place = GOLDEN_NORTH,
     GLASS,
     .height_m = 3000,
     .heading_deg = 300,
     .cell_mm = 10000,
     .range_m = 20000},
    {.name = "sar-smallest-glass",
     .width_px = 256,
     .height_px = 256,
     .height_m = 3000,
     .heading_deg = 10,
     .cell_mm = 5000,
     .range_m = 12000},
    {.name = "parked-sar-1m-looking-north",
     GLASS,
     .height_m = 3000,
     .has_parked = true,
     .cell_mm = 1000,
     .range_m = 12000},
    {.name = "parked-sar-1m-looking-east",
     GLASS,
     .height_m = 3000,
     .heading_deg = 83,
     .has_parked = true,
     .cell_mm = 1000,
     .range_m = 12000},
    {.name = "parked-dbs2",
     GLASS,
     .north_m = -9260,
     .height_m = 2500,
     .speed_m_s = 200,
     .drift_deg = -40,
     .keys = {CURSOR_ZERO},
     .has_parked = true,
     .field = LM_FOV_DBS2},
    {.name = "page-steerpoint", FROM_SOUTH, GLASS, .speed_m_s = 200, .has_steerpoint = true},
    {.name = "page-steerpoint-smallest-glass",
     FROM_SOUTH,
     .width_px = 256,
     .height_px = 256,
     .speed_m_s = 200,
     .has_steerpoint = true},
    {.name = "page-nav-stale", FROM_SOUTH, GLASS, .fault = GOLDEN_BUS_ENDS},
    {.name = "page-bus-dead", FROM_SOUTH, GLASS, .fault = GOLDEN_BUS_DEAD},
    {.name = "page-db-fail", FROM_SOUTH, GLASS, .fault = GOLDEN_BAD_HEADER},
    {.name = "page-tile", FROM_SOUTH, GLASS, .fault = GOLDEN_BAD_READS},
    {.name = "page-frozen", FROM_SOUTH, GLASS, .fault = GOLDEN_FROZEN},
    {.name = "page-off-map", .place = GOLDEN_BORDER, .north_m = -280000, .height_m = 2500, GLASS},
};
const uint32_t golden_picture_count = sizeof golden_pictures / sizeof golden_pictures[0];

static uint64_t duration_us(const struct golden_picture *p)
{
    /* A sweep of GM takes a second, of the other modes two; a patch two and the reading of its
     * tiles; the window of DBS1 two and of DBS2 3.3, once the cursor is in its place. */
    uint32_t flown_us = p->cell_mm || p->mode || p->keys[0] ? 2600000 : 1300000;
    if (p->field != LM_FOV_NORM) {
        flown_us = p->field == LM_FOV_DBS2 ? 5600000 : 3800000;
    }
    return START_US + flown_us;
}

/* A binary angle as the bus's LONG, 1e-7 degree, rounded down. */
static uint32_t long_of(fx_bam_t angle)
{
    return (uint32_t)(int32_t)(((int64_t)(int32_t)angle * 3600000000) >> 32);
}

static int receive(void *ctx, struct lm_can_frame *frame)
{
    struct golden_rig *r = ctx;
    const struct golden_picture *p = r->picture;
    const bool has_ended = p->fault == GOLDEN_BUS_ENDS && r->bus_us + 600000 > duration_us(p);
    if (p->fault == GOLDEN_BUS_DEAD || has_ended || r->bus_us > r->now_us) {
        return 0;
    }
    const struct {
        uint16_t id;
        uint8_t type;
        uint32_t bits;
    } items[] = {{1036, LM_CANAS_LONG, long_of(r->aircraft.latitude)},
                 {1037, LM_CANAS_LONG, long_of(r->aircraft.longitude)},
                 {1038, LM_CANAS_FLOAT, bus_float_bits(p->height_m)},
                 {1039, LM_CANAS_FLOAT, bus_float_bits(p->speed_m_s)},
                 {1040, LM_CANAS_FLOAT, bus_float_bits(p->heading_deg + p->drift_deg)},
                 {1133, LM_CANAS_FLOAT, bus_float_bits(p->heading_deg)}};
    *frame = bus_frame(items[r->bus_item].id, items[r->bus_item].type, r->message_code,
                       items[r->bus_item].bits, r->now_us);
    if (++r->bus_item == sizeof items / sizeof items[0]) {
        r->bus_item = 0;
        r->message_code++;
        r->bus_us += FIX_US;
    }
    return 1;
}

static struct lm_sar_command patch_command(const struct golden_picture *p,
                                           struct lm_position centre)
{
    return (struct lm_sar_command){.centre = centre,
                                   .cell_mm = p->cell_mm,
                                   .is_plan = p->is_plan,
                                   .is_from_ownship = p->range_m == 0,
                                   .look_azimuth = FX_BAM_DEG(p->heading_deg),
                                   .range_m = p->range_m,
                                   .height_m_q6 = p->height_m * 64};
}

static struct lm_position moved(struct lm_position from, fx_bam_t azimuth, int32_t metres)
{
    struct lm_geo_origin origin;
    lm_geo_set_origin(&origin, from);
    return metres < 0 ? lm_geo_direct(&origin, azimuth + FX_BAM_180, (uint32_t)-metres * 256)
                      : lm_geo_direct(&origin, azimuth, (uint32_t)metres * 256);
}

static struct lm_environment environment_of(const struct golden_rig *r)
{
    const struct golden_picture *p = r->picture;
    return (struct lm_environment){
        .rain = {{.centre = r->centre, .radius_m = 2000, .mm_per_h = p->rain_mm_h}},
        .jammer = {{moved(r->centre, FX_BAM_90, 2000), (int16_t)(p->jam_db * 256)}},
        .rain_count = p->rain_mm_h != 0,
        .jammer_count = p->jam_db != 0,
        .sea_state = p->sea_state ? p->sea_state : (uint8_t)LM_SEA_STATE_OF_IMAGE};
}

/* Event `item` of those that press and let go the keys, one after the other. */
static int next_key(const struct golden_picture *p, uint32_t item, struct lm_control *control)
{
    if (item / 2 == sizeof p->keys || p->keys[item / 2] == 0) {
        return 0;
    }
    *control = lm_control_button(item % 2 == 0, p->keys[item / 2]);
    return 1;
}

static struct lm_control picture_control(const struct golden_picture *p, struct lm_position centre)
{
    if (p->cell_mm) {
        return (struct lm_control){.kind = LM_CONTROL_SAR, .sar = patch_command(p, centre)};
    }
    return (struct lm_control){.kind = LM_CONTROL_SECTOR, .sector = {p->mode, p->field}};
}

/* The operator: weather, scale, sector and gain when the bus is heard, then mode or patch; freezes
 * and presses keys late. */
static int next_control(void *ctx, struct lm_control *control)
{
    enum { EARLY = 6, ITEMS };
    struct golden_rig *r = ctx;
    const struct golden_picture *p = r->picture;
    const struct lm_control script[ITEMS] = {
        {.kind = LM_CONTROL_ENVIRONMENT, .environment = environment_of(r)},
        {.kind = LM_CONTROL_RANGE, .range_nm = p->range_nm ? p->range_nm : 10},
        {.kind = LM_CONTROL_AZIMUTH, .azimuth_index = p->azimuth},
        {.kind = LM_CONTROL_GAIN, .gain_db = p->gain_db},
        {.kind = LM_CONTROL_STEERPOINT,
         .steerpoint = {p->has_steerpoint, moved(r->centre, 0, 1852)}},
        picture_control(p, r->centre),
        {.kind = LM_CONTROL_FREEZE, .is_frozen = p->fault == GOLDEN_FROZEN}};
    const uint64_t due_us = r->control_item < EARLY ? START_US : START_US + 700000;
    if (r->now_us < due_us) {
        return 0;
    }
    if (r->control_item >= ITEMS) {
        const int count = next_key(p, r->control_item - ITEMS, control);
        r->control_item += (uint32_t)count;
        return count;
    }
    *control = script[r->control_item++];
    return 1;
}

static void prepare(struct golden_rig *r, const struct golden_picture *p,
                    const struct golden_country *country)
{
    memset(r, 0, sizeof *r);
    r->picture = p;
    r->centre = p->has_parked
                    ? moved(moved(country->centre, 0, RUNWAY_NORTH_M), FX_BAM_90, RUNWAY_EAST_M)
                    : country->centre;
    r->aircraft = moved(moved(r->centre, 0, p->north_m), FX_BAM_90, p->east_m);
    const struct memory_board_parts parts = {.ctx = r,
                                             .receive = receive,
                                             .next_control = next_control,
                                             .width_px = p->width_px,
                                             .height_px = p->height_px,
                                             .glass = r->glass,
                                             .plane = r->plane,
                                             .tile_pool = r->pool,
                                             .tile_pool_bytes = sizeof r->pool};
    memory_board_open(&r->board, country->image,
                      p->fault == GOLDEN_BAD_HEADER ? 511 : country->image_bytes, &parts);
    r->board.flash.fetch = country->fetch;
}

/* A vehicle that answers as a whole, driving to and fro over 6 km. */
static struct lm_target mover(uint32_t id, struct lm_position place, int32_t heading_deg,
                              uint32_t speed_mm_s)
{
    return (struct lm_target){.id = id,
                              .latitude = place.latitude,
                              .longitude = place.longitude,
                              .elevation_m_q6 = 3 * 64,
                              .heading = FX_BAM_DEG(heading_deg),
                              .swerling = 1,
                              .flags = LM_TARGET_ABOVE_GROUND,
                              .mean_rcs_dbsm_q8 = 35 * 256,
                              .speed_mm_s = speed_mm_s,
                              .leg_m = 6000};
}

static void put_movers(struct golden_rig *r)
{
    r->targets[0] = mover(1, moved(r->centre, 0, 1000), 180, 15000);
    r->targets[1] = mover(2, moved(moved(r->centre, 0, 2200), FX_BAM_90, 1100), 30, 25000);
    r->targets[2] = mover(3, moved(moved(r->centre, 0, 1500), FX_BAM_90, -3300), 25, 8000);
    r->unit.map.target_set.count = 3;
}

/* Side by side on the runway, each turned another way. */
static void put_parked(struct golden_rig *r)
{
    static const int32_t heading_deg[GOLDEN_TARGETS_MAX] = {0, 100, 190, 325};
    for (uint32_t i = 0; i < GOLDEN_TARGETS_MAX; i++) {
        const struct lm_position place = moved(r->centre, FX_BAM_90, (int32_t)i * 45 - 70);
        r->targets[i] = (struct lm_target){
            .id = i,
            .latitude = place.latitude,
            .longitude = place.longitude,
            .heading = FX_BAM_DEG(heading_deg[i]),
            .flags = LM_TARGET_ABOVE_GROUND | LM_TARGET_HAS_SIGNATURE,
        };
    }
    r->unit.map.target_set.count = GOLDEN_TARGETS_MAX;
}

int golden_fly(struct golden_rig *r, const struct golden_picture *p,
               const struct golden_country *country)
{
    prepare(r, p, country);
    const int status = lm_unit_init(&r->unit, &r->board.lent);
    if (p->has_movers || p->has_parked) {
        r->unit.map.target_set.items = r->targets;
        (p->has_movers ? put_movers : put_parked)(r);
    }
    r->board.flash.fail_every = p->fault == GOLDEN_BAD_READS ? 3 : 0; /* once the tables are in */
    for (; status == LM_OK && r->now_us <= duration_us(p); r->now_us += STEP_US) {
        lm_unit_step(&r->unit, r->now_us);
    }
    return status;
}

static size_t pixels_of(const struct golden_rig *r)
{
    return (size_t)r->board.display.width_px * r->board.display.height_px;
}

uint32_t golden_radar_checksum(const struct golden_rig *r)
{
    return fx_crc32c(0, r->plane, pixels_of(r));
}

uint32_t golden_glass_checksum(const struct golden_rig *r)
{
    return fx_crc32c(0, r->glass, pixels_of(r) * sizeof r->glass[0]);
}
