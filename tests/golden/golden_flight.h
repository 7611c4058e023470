/* The golden pictures: what each shows, and the unit flown until it is on the glass. Uses the
 * firmware and a flash in memory and nothing else, so that any board can run it. */
#ifndef GOLDEN_FLIGHT_H
#define GOLDEN_FLIGHT_H

#include "memory_board.h"

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
    uint16_t speed_m_s; /* along the track; it stands still all the same */
    int8_t drift_deg;   /* the track is so far to the right of the heading */
    /* A sector: enum lm_sector_mode and lm_fov, indices into the radar table. A window lies half
     * the range straight ahead, where the cursor begins. */
    uint8_t mode, field;
    uint8_t range_nm, azimuth; /* range_nm 0: 10 */
    int8_t gain_db;
    /* Rain over 2 km around the middle, a jammer 2 km east of it, the sea (0: as in the image). */
    uint8_t rain_mm_h, jam_db, sea_state;
    bool has_steerpoint; /* a mile north of the middle */
    bool has_movers;     /* two of GOLDEN_MOVERS on land, one at sea */
    bool has_parked; /* four with the image's signature, on the runway, which is the middle then */
    uint8_t keys[6]; /* option select buttons pressed later, 0 behind the last */
    /* SAR when cell_mm is not 0: a patch at the middle, seen from the aircraft, or when range_m is
     * not 0 from so far in the direction of the heading. */
    uint32_t cell_mm, range_m;
    bool is_plan;
};

extern const struct golden_picture golden_pictures[];
extern const uint32_t golden_picture_count;

enum { GOLDEN_POOL_TILES = 256, GOLDEN_PIXELS_MAX = 1024 * 768, GOLDEN_TARGETS_MAX = 4 };

/* Everything a flight needs; the caller owns it, 15 MB. */
struct golden_rig {
    struct lm_unit unit;
    struct memory_board board;
    const struct golden_picture *picture;
    struct lm_position centre, aircraft;
    struct lm_target targets[GOLDEN_TARGETS_MAX]; /* in place of the image's */
    uint64_t now_us, bus_us;                      /* bus_us: when the next set of values is due */
    uint32_t bus_item, control_item;
    uint8_t message_code;
    uint8_t plane[GOLDEN_PIXELS_MAX];
    uint32_t glass[GOLDEN_PIXELS_MAX];
    _Alignas(8) uint8_t pool[GOLDEN_POOL_TILES * sizeof(struct lm_tile)];
};

/* A country to fly over. */
struct golden_country {
    struct lm_position centre;
    const uint8_t *image; /* borrowed */
    size_t image_bytes;
    memory_flash_fetch *fetch; /* NULL: the image is memory */
};

/* Fly until the picture is on rig->glass. Returns LM_OK or lm_unit_init's answer. */
int golden_fly(struct golden_rig *rig, const struct golden_picture *picture,
               const struct golden_country *country);

/* CRC-32C of the radar picture alone: the plane of grey levels before symbols and labels, row by
 * row. A label that changes leaves it as it is. */
uint32_t golden_radar_checksum(const struct golden_rig *rig);

/* CRC-32C of the whole glass, row by row, each pixel as four bytes, the lowest first. */
uint32_t golden_glass_checksum(const struct golden_rig *rig);

#endif
