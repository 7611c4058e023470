#include "bench.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lm/radar_check.h"

static int acquire(void *ctx, struct lm_surface *surface)
{
    const struct bench *b = ctx;
    *surface = (struct lm_surface){.pixels = b->buffer[(b->pictures + 1) % BENCH_BUFFERS],
                                   .stride_px = b->display.width_px,
                                   .width_px = b->display.width_px,
                                   .height_px = b->display.height_px,
                                   .age = b->pictures >= BENCH_BUFFERS ? BENCH_BUFFERS : 0};
    return LM_OK;
}

static int present(void *ctx, const struct lm_damage *changed)
{
    (void)changed;
    struct bench *b = ctx;
    b->pictures++;
    b->glass = b->buffer[b->pictures % BENCH_BUFFERS];
    return LM_OK;
}

static int lend_memory(struct bench *b)
{
    const size_t pixels = (size_t)b->display.width_px * b->display.height_px;
    b->board.tile_pool = malloc(b->board.tile_pool_bytes);
    b->board.plane = malloc(pixels);
    bool has_buffers = true;
    for (uint32_t i = 0; i < BENCH_BUFFERS; i++) {
        b->buffer[i] = calloc(pixels, sizeof *b->buffer[i]);
        has_buffers = has_buffers && b->buffer[i];
    }
    b->glass = b->buffer[0];
    b->unit = malloc(sizeof *b->unit);
    return b->board.tile_pool && b->board.plane && has_buffers && b->unit ? 0 : -1;
}

/* Why the unit refuses to start, into b->error. */
static void report_refusal(struct bench *b, const struct lm_radar *radar, int status)
{
    struct lm_radar_fault fault;
    if (status == LM_ERR_TABLE && lm_radar_check(radar, &fault) != LM_OK) {
        snprintf(b->error, sizeof b->error,
                 "the radar table breaks its contract: %s, element %u, must be %s", fault.field,
                 (unsigned)fault.index, fault.needs ? fault.needs : "inside its range");
    } else {
        snprintf(b->error, sizeof b->error, "%s",
                 status == LM_ERR_RANGE ? "the glass must have 256..1024 pixels each way"
                                        : "the memory for tiles is too small");
    }
}

/* Whether the recording that is to be replayed is of this image, table and firmware. */
static bool agrees(struct bench *b, const struct bench_scene *scene)
{
    if (!scene->replay || scene->is_any_replayed) {
        return true;
    }
    struct record_head mine;
    record_describe(&mine, &b->board, 0);
    const char *difference = replay_difference(scene->replay, &mine);
    if (difference) {
        snprintf(b->error, sizeof b->error, "the recording was made with %s", difference);
    }
    return difference == NULL;
}

/* The recorder or the recording stands between the ports and the unit. */
static int start_unit(struct bench *b, const struct bench_scene *scene)
{
    if (scene->replay && replay_wrap(scene->replay, &b->board) != 0) {
        return LM_ERR_NO_MEMORY;
    }
    if (lend_memory(b) != 0) {
        return LM_ERR_NO_MEMORY;
    }
    if (scene->recorder) {
        record_begin(scene->recorder, scene->sink, &b->board, 0, BENCH_CHECK_EVERY);
    }
    return lm_unit_init(b->unit, &b->board);
}

static bool has_file(const struct bench *b, uint32_t place)
{
    return b->flash[place].port.read_start != NULL;
}

static void close_files(struct bench *b)
{
    for (uint32_t i = 0; i < LM_IMAGES_MAX; i++) {
        if (has_file(b, i)) {
            drv_flash_file_close(&b->flash[i]);
        }
    }
    memset(b->flash, 0, sizeof b->flash);
}

static int open_file(struct bench *b, uint32_t place, const char *path)
{
    const int cause = drv_flash_file_open(&b->flash[place], path);
    if (cause != 0) {
        snprintf(b->error, sizeof b->error, "%s%scannot be opened: %s", place == 0 ? "" : path,
                 place == 0 ? "" : ": ", strerror(cause));
    }
    return cause;
}

static int open_files(struct bench *b, const struct bench_scene *scene)
{
    int cause = open_file(b, 0, scene->database);
    for (uint32_t i = 1; i < LM_IMAGES_MAX && cause == 0; i++) {
        cause = scene->further[i - 1] ? open_file(b, i, scene->further[i - 1]) : 0;
    }
    return cause;
}

/* The flash of the board: the files, each at its place. */
static void lend_flash(struct bench *b)
{
    const struct lm_flash *flash[LM_IMAGES_MAX];
    for (uint32_t i = 0; i < LM_IMAGES_MAX; i++) {
        flash[i] = has_file(b, i) ? &b->flash[i].port : NULL;
    }
    drv_flash_joined_open(&b->joined, flash, LM_IMAGES_MAX, b->board.images);
    b->board.flash = &b->joined.port;
}

int bench_open(struct bench *b, const struct bench_scene *scene, const struct bench_glass *glass,
               uint32_t noise_seed, const struct bench_bus *bus, const struct lm_controls *controls)
{
    memset(b, 0, sizeof *b);
    if (open_files(b, scene) != 0) {
        close_files(b);
        return -1;
    }
    b->display = (struct lm_display){.ctx = b,
                                     .width_px = glass->width_px,
                                     .height_px = glass->height_px,
                                     .acquire = acquire,
                                     .present = present};
    b->board = (struct lm_board){.radar = scene->radar,
                                 .can = bus->can,
                                 .bus_profile = bus->profile,
                                 .can_2 = bus->can_2,
                                 .bus_nodes = bus->nodes,
                                 .bus_node = bus->node,
                                 .bus_partner = bus->partner,
                                 .is_heading_magnetic = bus->is_heading_magnetic,
                                 .tells_reports = bus->tells_reports,
                                 .obeys_controls = bus->obeys_controls,
                                 .hardware_revision = 1,
                                 .controls = controls,
                                 .display = &b->display,
                                 .tile_pool_bytes = BENCH_TILE_SLOTS * sizeof(struct lm_tile),
                                 .glass_step_px = LM_GLASS_STEP_PX,
                                 .noise_seed = noise_seed,
                                 .options = glass->options,
                                 .flash_poll_limit = 1000};
    memcpy(b->board.tables, bus->tables, sizeof b->board.tables);
    lend_flash(b);
    if (!agrees(b, scene)) {
        close_files(b);
        return -1;
    }
    const int status = start_unit(b, scene);
    if (status != LM_OK) {
        const struct lm_radar *const radar = b->board.radar;
        bench_close(b);
        report_refusal(b, radar, status);
        return -1;
    }
    return 0;
}

void bench_settle(struct bench *b)
{
    for (uint32_t i = 0; i < LM_IMAGES_MAX; i++) {
        if (b->is_leaving[i] && lm_tile_cache_is_drained(&b->unit->map.tiles)) {
            (void)drv_flash_joined_put(&b->joined, i, NULL);
            drv_flash_file_close(&b->flash[i]);
            memset(&b->flash[i], 0, sizeof b->flash[i]);
            b->is_leaving[i] = false;
        }
    }
}

static int open_late(struct bench *b, uint32_t place, const char *path, struct lm_image_change *to)
{
    if (has_file(b, place)) {
        snprintf(b->error, sizeof b->error, "an image is at place %u; unmount it first", place + 1);
        return -1;
    }
    if (open_file(b, place, path) != 0) {
        return -1;
    }
    const struct lm_flash_part part =
        drv_flash_joined_put(&b->joined, place, &b->flash[place].port);
    to->bytes = part.bytes;
    to->crc = record_image_crc(&b->joined.port, &part, b->board.flash_poll_limit);
    if (part.bytes == 0) {
        snprintf(b->error, sizeof b->error, "%s: is empty", path);
        b->is_leaving[place] = true;
    }
    return part.bytes == 0 ? -1 : 0;
}

int bench_mount(struct bench *b, int32_t place, const char *path, struct lm_control *control)
{
    const uint32_t at = (uint32_t)place - 1;
    bench_settle(b);
    *control = (struct lm_control){.kind = LM_CONTROL_IMAGE, .image = {.place = place}};
    if (path) {
        return open_late(b, at, path, &control->image);
    }
    if (!has_file(b, at)) {
        snprintf(b->error, sizeof b->error, "no image is at place %d", (int)place);
        return -1;
    }
    if (lm_unit_map_is_last(&b->unit->map, b->board.images[at].offset)) {
        snprintf(b->error, sizeof b->error, "the image at place %d is the only one; it stays",
                 (int)place);
        return -1;
    }
    b->is_leaving[at] = true;
    return 0;
}

void bench_close(struct bench *b)
{
    close_files(b);
    free(b->board.tile_pool);
    free(b->board.plane);
    for (uint32_t i = 0; i < BENCH_BUFFERS; i++) {
        free(b->buffer[i]);
    }
    free(b->unit);
    memset(b, 0, sizeof *b);
}
