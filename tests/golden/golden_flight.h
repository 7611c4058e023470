/* The golden pictures: what each shows, and the unit flown until it is on the glass. Uses the
 * firmware and a flash in memory and nothing else, so that any board can run it. */
#ifndef GOLDEN_FLIGHT_H
#define GOLDEN_FLIGHT_H

#include "lm/unit.h"
#include "memory_flash.h"

/* What goes wrong, late in the flight. */
enum golden_fault {
    GOLDEN_FINE,
    GOLDEN_BUS_ENDS,   /* 0.6 s before the picture: position stale */
    GOLDEN_BUS_DEAD,   /* never a frame */
    GOLDEN_BAD_HEADER, /* no database */
    GOLDEN_BAD_READS,  /* every third read fails */
    GOLDEN_FROZEN      /* by the operator, in mid-sweep */
};

struct golden_picture {
    const char *name; /* also of its file */
    uint8_t place;    /* enum golden_place */
    uint8_t fault;    /* enum golden_fault */
    uint16_t width_px, height_px;
    /* The aircraft: where from the middle, how high, where it looks, whole units. */
    int32_t north_m, east_m, height_m, heading_deg;
    uint16_t speed_m_s; /* along the heading; it stands still all the same */
    /* Ground map: indices into the radar table. */
    uint8_t range, azimuth;
    int8_t gain_db;
    /* SAR when cell_mm is not 0: a patch at the middle, seen from the aircraft, or when range_m is
     * not 0 from so far in the direction of the heading. */
    uint32_t cell_mm, range_m;
    bool has_layover;
};

extern const struct golden_picture golden_pictures[];
extern const uint32_t golden_picture_count;

enum { GOLDEN_POOL_TILES = 256, GOLDEN_PIXELS_MAX = 1024 * 768 };

/* Everything a flight needs; the caller owns it, 15 MB. */
struct golden_rig {
    struct lm_unit unit;
    struct lm_board board;
    struct memory_flash flash;
    struct lm_can can;
    struct lm_controls controls;
    struct lm_display display;
    const struct golden_picture *picture;
    struct lm_place centre, aircraft;
    uint64_t now_us, bus_us; /* bus_us: when the next set of values is due */
    uint32_t bus_item, control_item;
    uint8_t message_code;
    uint8_t plane[GOLDEN_PIXELS_MAX];
    uint32_t glass[GOLDEN_PIXELS_MAX];
    _Alignas(8) uint8_t pool[GOLDEN_POOL_TILES * sizeof(struct lm_tile)];
};

/* Fly until the picture is on rig->glass, over the image, whose middle lies at `centre`. Returns
 * LM_OK or lm_unit_init's answer. */
int golden_fly(struct golden_rig *rig, const struct golden_picture *picture, struct lm_place centre,
               const uint8_t *image, size_t image_bytes);

/* CRC-32C of the glass, row by row, each pixel as four bytes, the lowest first. */
uint32_t golden_checksum(const struct golden_rig *rig);

#endif
