/* A unit in flight for tests: a small country, a bus, a flash and a glass that misbehave on demand.
 */
#ifndef UNIT_RIG_H
#define UNIT_RIG_H

#include "lm/unit.h"

#include "memory_board.h"
#include "tiny_image.h"

enum { WIDTH = 480, HEIGHT = 480, STEP_US = 2000, POOL_TILES = 120, CONTROLS_MAX = 64 };

/* A bus that flies north at 150 m/s from 0.05 degrees south of a place, until told to stop. */
struct fake_bus {
    double latitude_deg, longitude_deg; /* the place, 46 N 11 E at first */
    uint64_t now_us, sent_us, stop_us;
    int queue_next;
    int is_down;
    double jump_degrees;
    double height_m;                        /* 2,000 at first */
    double pitch_deg;                       /* of the nose, 2 at first */
    double speed_m_s, nose_deg, turn_deg_s; /* north, whatever nose and turn say */
    bool has_no_velocity;                   /* neither speed nor track are sent */
    bool has_steerpoint;                    /* a steerpoint is sent, too */
    double steerpoint_deg[2];
    uint8_t code;
};

struct rig {
    struct tiny_image image;
    struct memory_board board;
    struct fake_bus bus;
    struct lm_control controls_waiting[CONTROLS_MAX];
    int control_count, control_next;
    uint32_t glass[WIDTH * HEIGHT];
    uint8_t plane[WIDTH * HEIGHT];
    uint64_t pool[POOL_TILES * sizeof(struct lm_tile) / 8];
    struct lm_unit unit;
    uint64_t now_us;
};

/* A rig whose unit is not started yet, one whose unit is, and one in good flight at 10 nm with a
 * picture. */
struct rig *make_rig(void);
struct rig *make_rig_at(double latitude_deg, double longitude_deg); /* the same elsewhere */
struct rig *start_rig(void);
struct rig *fly_rig(void);
void free_rig(struct rig *r);

/* Fly on. */
void run(struct rig *r, double seconds);

/* What the operator does at the next step, in the order of the calls. */
void command(struct rig *r, struct lm_control control);

/* Press a button (1..LM_BUTTONS) for a tenth of a second, or for as long as said. */
void press(struct rig *r, int button);
void hold(struct rig *r, int button, double seconds);

/* The glass, and whether these words stand on it in the symbols' colour. */
struct lm_surface glass_of(const struct rig *r);
bool says(const struct rig *r, const char *words);

uint32_t plane_sum(const struct rig *r);
uint32_t lit_pixels(const struct rig *r);

/* A scale, and a patch some 36 degrees to the right of the nose. */
extern const struct lm_control range_10, patch_here;

#endif
