/* Trace records: every reflection of every ray, before anything is known of its strength. [Niu],
 * III-B and Table I. This header is the contract between the tracer (trace.h), the laws
 * (reflect.h), the sum over cells (accumulate.h) and the trainable networks.
 *
 * SHAPE. A sensor plane of `columns` x `rows` emits parallel primary rays, numbered
 *     ray = row * columns + column,   column to the right, row upwards as the radar sees the scene.
 * Each reflection is one struct trace_record. Reflection number b + 1 of all rays is bounces[b]: a
 * list in rising order of `ray`, at most one record a ray. It is the paper's "image" keyed by
 * emission position (Fig. 8) with the empty pixels left out; trace_image() gives the full one.
 * records[i].parent is the index, in bounces[b - 1], of the reflection that this one's incident ray
 * comes from; it is always there and has TRACE_GOES_ON. In bounces[0] parent is 0 and means
 * nothing.
 *
 * AXES, of radar and target. across: to the right of the line of sight, level. away: level, from
 * the radar. up: against gravity. The origin is the scene's centre on the ground, and the target's
 * own origin. Distances are metres, angles radians where a name does not say degrees.
 *
 * TWO DIRECTIONS leave a reflection ([Niu], II-A):
 *     SP, specular: theta1 on the other side of the normal, turned by 2 * theta1 from where the ray
 *         came. TRACE_GOES_ON says that it meets the scene again: the record of the next bounce.
 *     BK, back to the radar: counts only without TRACE_BLOCKED. The echo's place across_m, range_m
 *         and its phase belong to this direction.
 *
 * INTENSITY that a law gives, with coefficients in [0, 1] for both directions ([Niu], Fig. 11):
 *     in[0] = 1,  in[b] = in[b - 1] * SPC(parent),  echo = in[b] * BKC(record), 0 when blocked.
 * The picture is the sum of the echoes in their cells (trace_cell), times the area of sensor plane
 * that a ray stands for, step_across_m * step_up_m (ends that are not plain: ends_echo_m2()). */
#ifndef TRACER_RECORDS_H
#define TRACER_RECORDS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    TRACE_BOUNCES_MAX = 5,
    TRACE_MATERIALS_MAX = 128,
    TRACE_FILE_MATERIALS_MAX = 32, /* of a file */
    TRACE_NAME_SIZE = 32,          /* of a material, with its end */
    TRACE_CELLS_MAX = 4096,        /* either way */
    TRACE_RAYS_MAX = 1 << 26,      /* columns * rows */
    TRACE_RECORD_BYTES = 52,
};

enum trace_flag {
    TRACE_BLOCKED = 1, /* the way back to the radar is cut off, or the surface faces away from it */
    TRACE_GOES_ON = 2, /* the specular ray meets the scene again, in the next bounce's list */
};

/* One reflection, in memory as in the file. */
struct trace_record {
    uint32_t ray;    /* place of emission */
    uint32_t parent; /* see above */
    float across_m;  /* of the echo: mean of the two ends of its way, eq. (2) */
    float range_m;   /* of the echo, slant, behind the scene's centre: half of its way, eq. (3) */
    float phase_rad; /* of the echo: -4 pi range / wavelength, in [-pi, pi], by geometry only */
    float hop_m;     /* from the parent's place; first bounce: from the plane through the origin */
    float incidence_rad; /* theta1: normal to where the ray came from, 0..pi/2 */
    float echo_rad;      /* theta2: normal to the radar, 0..pi; above pi/2 also TRACE_BLOCKED */
    float turn_rad;      /* theta4: where the ray came from to the radar; 0..pi, 0 in bounce 1 */
    float normal[3];     /* unit vector across, away, up; on the side the ray came from */
    uint8_t material;    /* index of materials[] */
    uint8_t flags;       /* enum trace_flag */
    uint16_t reserved;   /* 0 */
};
_Static_assert(sizeof(struct trace_record) == TRACE_RECORD_BYTES, "FORMATS.md says so");

struct trace_bounce {
    struct trace_record *records; /* owned */
    uint32_t count;
};

/* From where the radar looks. */
struct trace_look {
    double azimuth_deg; /* [0, 360): of the radar as the target sees it, from nose by the right */
    double depression_deg; /* (0, 90): of the line of sight below the horizon */
    double wavelength_m;   /* 0.001..10 */
};

/* Where the ends of an echo's way stand. All 0: one radar, so far away that its waves are plane.
 * Else ends.h says what the records mean; SHAPE and AXES above are those of the transmitter. */
struct trace_ends {
    double distance_m; /* of the transmitter from the scene's centre, 0.01..1e7; 0: plane waves */
    bool is_apart;     /* there is a receiver of its own; its numbers are 0 otherwise */
    double receiver_azimuth_deg, receiver_depression_deg, receiver_distance_m; /* likewise */
};

/* The picture: cell (column, row) spans across_m from -cells_across/2 * cell_m + column * cell_m,
 * range_m likewise. Row 0 is nearest to the radar, column 0 leftmost as the radar sees it. */
struct trace_grid {
    uint32_t cells_across, cells_range; /* 1..TRACE_CELLS_MAX */
    double cell_m;                      /* 0.001..1000 */
};

/* Ray (column, row) crosses the plane through the origin that is square to the line of sight at
 * low_across_m + (column + 1/2) step_across_m to the right and low_up_m + (row + 1/2) step_up_m
 * up. */
struct trace_sensor {
    uint32_t columns, rows;
    double step_across_m, step_up_m, low_across_m, low_up_m;
};

struct trace_records {
    struct trace_look look;
    struct trace_grid grid;
    struct trace_sensor sensor;
    uint32_t material_count; /* 1..TRACE_MATERIALS_MAX */
    char materials[TRACE_MATERIALS_MAX][TRACE_NAME_SIZE];
    uint32_t bounce_count; /* 1..TRACE_BOUNCES_MAX; lists may be empty */
    struct trace_bounce bounces[TRACE_BOUNCES_MAX];
    struct trace_ends ends;
};

/* Index row * cells_across + column of the cell in which an echo lies, or -1 outside the
 * picture. */
int32_t trace_cell(const struct trace_grid *grid, float across_m, float range_m);

/* Contents of a channel of the paper's Table I; TRACE_MATERIAL and TRACE_IS_BLOCKED as numbers. */
enum trace_channel {
    TRACE_IS_BLOCKED,
    TRACE_MATERIAL,
    TRACE_INCIDENCE,
    TRACE_ECHO,
    TRACE_TURN,
    TRACE_PHASE,
    TRACE_ACROSS,
    TRACE_RANGE,
    TRACE_CHANNELS
};

/* The full image of one channel of a bounce (0-based): columns * rows numbers, row 0 (lowest)
 * first; NaN where a ray has no such reflection. */
void trace_image(const struct trace_records *r, uint32_t bounce, enum trace_channel channel,
                 float *image);

/* Everything above that a record must keep: order, parents, angles, flags, finite numbers within
 * 1e6, unit normals. Returns 0, or -1 with `place` and the first fault reported. */
int trace_records_check(const struct trace_records *r, const char *place);

/* The file of docs/FORMATS.md, "Traced records". Writing checks first and is atomic. Reading
 * believes nothing: sizes are compared with the file's before memory is taken, checksums and every
 * record are checked. Return 0, or -1 with the error reported and *r empty. */
int trace_records_write(const struct trace_records *r, const char *path);
int trace_records_read(struct trace_records *r, const char *path);

/* Harmless on a zeroed struct. */
void trace_records_free(struct trace_records *r);

#endif
