#include "lm/bit.h"

#include "lm/version.h"

enum { ROW_COUNTERS = 3, COUNTER_ROWS = 13, ROW_NOW = 16, ROW_FAULTS = 17, ROW_RESTART = 21 };
enum { COLUMN_NUMBER = 9, COLUMN_SECOND = 18, COLUMN_SECOND_NUMBER = 27 };

static void add_counter(struct lm_text *t, const char *name, uint32_t value, uint32_t column)
{
    lm_text_add(t, name);
    lm_text_tab(t, column);
    lm_text_number(t, value, 1);
}

static void add_pair(struct lm_text *t, const char *first, uint32_t value, const char *second,
                     uint32_t second_value)
{
    add_counter(t, first, value, COLUMN_NUMBER);
    lm_text_add(t, " ");
    lm_text_tab(t, COLUMN_SECOND);
    add_counter(t, second, second_value, COLUMN_SECOND_NUMBER);
}

/* Frames of the profile's identifiers whose contents were refused. */
static uint32_t bad_frames(const struct lm_unit *u)
{
    uint32_t bad = 0;
    for (uint32_t i = LM_BUS_BAD_LENGTH; i < LM_BUS_OUTCOMES; i++) {
        if (i != LM_BUS_NO_DATA) {
            bad += u->bus.count.outcome[i];
            for (uint32_t t = 0; t < LM_BUS_TABLES_MORE; t++) {
                bad += u->more[t].count.outcome[i];
            }
        }
    }
    return bad;
}

struct lm_sender_counts lm_sender_counts(const struct lm_unit *u)
{
    struct lm_sender_counts c = {.stuck = u->bus.canas.count.stuck,
                                 .stuck_node = u->bus.canas.stuck_node,
                                 .rivals = u->nav.rivals,
                                 .disagreements = u->nav.disagreements,
                                 .refused = u->bus.count.outcome[LM_BUS_NODE_REFUSED]};
    for (uint32_t t = 0; t < LM_BUS_TABLES_MORE; t++) {
        c.stuck += u->more[t].canas.count.stuck;
        c.stuck_node = u->more[t].canas.stuck_node ? u->more[t].canas.stuck_node : c.stuck_node;
        c.refused += u->more[t].count.outcome[LM_BUS_NODE_REFUSED];
    }
    c.sum = c.stuck + c.rivals + c.disagreements;
    return c;
}

struct lm_text lm_sender_fault(const struct lm_unit *u)
{
    struct lm_text t = {0};
    if (u->senders.kind == 3) {
        lm_text_add(&t, "SENDERS DIFFER");
    } else if (u->senders.kind != 0) {
        lm_text_add(&t, u->senders.kind == 2 ? "RIVAL NODE " : "STUCK NODE ");
        lm_text_number(
            &t, u->senders.kind == 2 ? u->nav.rival_node : lm_sender_counts(u).stuck_node, 1);
    }
    return t;
}

/* The name of the radar table in use, after where it comes from. */
static void add_radar(const struct lm_unit_map *map, struct lm_text *t)
{
    static const char *const origins[] = {[LM_RADAR_BUILT_IN] = "RADAR",
                                          [LM_RADAR_OF_IMAGE] = "IMG RDR",
                                          [LM_RADAR_OF_BOARD] = "BRD RDR"};
    lm_text_add(t, " ");
    lm_text_tab(t, COLUMN_SECOND);
    lm_text_add(t, origins[map->radar_origin]);
    lm_text_tab(t, COLUMN_SECOND_NUMBER);
    lm_text_add(t, map->radar->name);
}

static void add_counters(const struct lm_unit *u, uint32_t row, struct lm_text *t)
{
    switch (row) {
    case 0:
        add_pair(t, "FRAMES", u->count.frames, "BUSY", u->count.display_busy);
        break;
    case 1:
        add_pair(t, "LINES", u->count.lines, "LATE", u->count.lines_dropped);
        break;
    case 2:
        add_pair(t, "BUS", u->count.bus_frames, "BUS ERR", u->count.bus_errors);
        break;
    case 3:
        add_pair(t, "BUS BAD", bad_frames(u), "SENDERS", lm_sender_counts(u).sum);
        break;
    case 4:
        add_pair(t, "JUMPS", u->nav.position_jumps, "REFUSED", u->count.commands_refused);
        break;
    case 5:
        add_pair(t, "TILES", u->map.tiles.count.tiles_read, "EVICTED", u->map.tiles.count.evicted);
        break;
    case 6:
        add_pair(t, "HITS", lm_tile_cache_hits(&u->map.tiles), "MISSES", u->map.tiles.count.misses);
        break;
    case 7:
        add_pair(t, "COARSER", u->map.tiles.count.substituted, "OFF MAP",
                 u->map.tiles.count.off_map);
        break;
    case 8:
        add_pair(t, "READ ERR", u->map.tiles.count.io_errors, "CRC ERR",
                 lm_unit_map_corrupt_records(&u->map));
        break;
    case 9:
        add_pair(t, "DROPPED", u->map.tiles.count.requests_dropped, "DISP ERR",
                 u->count.display_errors);
        break;
    case 10:
        add_pair(t, "TGT LOST", u->map.count.targets_lost, "SIG LOST",
                 u->map.count.signatures_lost);
        break;
    case 11:
        add_pair(t, "STUCK", u->keys.count.stuck, "SWAPS", u->count.swaps);
        break;
    default:
        add_counter(t, "DTL LOST", u->picture.sar.detail.left_out, COLUMN_NUMBER);
        add_radar(&u->map, t);
    }
}

/* How far a load is, or else the slot that is flown. */
static void add_slot(const struct lm_slots_state *s, struct lm_text *t)
{
    static const char *const loads[LM_LOADS] = {
        [LM_LOAD_RUNS] = "  LOAD ", [LM_LOAD_DONE] = "  LOADED", [LM_LOAD_FAILED] = "  LOAD FAIL"};
    if (s->load != LM_LOAD_NONE) {
        lm_text_add(t, loads[s->load]);
        if (s->load == LM_LOAD_RUNS) {
            lm_text_number(t, (uint32_t)s->percent, 1);
        }
    } else if (s->flown != 0) {
        lm_text_add(t, s->flown == 1 ? "  SLOT A" : "  SLOT B");
    }
}

/* Why it is not the other one: "SLOT A BAD". */
static void add_slot_faults(const struct lm_slots_state *s, struct lm_text *t)
{
    for (uint32_t i = 0; i < 2; i++) {
        const bool is_damaged = (s->damaged >> i & 1) != 0;
        if (is_damaged || (s->cut_off >> i & 1) != 0) {
            lm_text_add(t, t->length == 0 ? "SLOT " : "  SLOT ");
            lm_text_add(t, i == 0 ? "A" : "B");
            lm_text_add(t, is_damaged ? " BAD" : " CUT OFF");
        }
    }
}

static void add_restart(const struct lm_unit *u, struct lm_text *t)
{
    if (u->board->restart) {
        lm_text_add(t, "RESTART  ");
        lm_text_add(t, u->board->restart);
    }
    add_slot_faults(&u->slots, t);
}

static void add_database(const struct lm_unit *u, uint32_t row, struct lm_text *t)
{
    if (row == 0) {
        lm_text_add(t, "LANDMASS " LM_VERSION "  IMAGE V");
        lm_text_number(t, LM_DB_VERSION, 1);
        add_slot(&u->slots, t);
    } else if (row == 1) {
        const struct lm_text refusal = lm_unit_map_refusal(&u->map);
        lm_text_add(t, "DB ");
        lm_text_add(t, u->map.is_usable ? u->map.db.title
                       : refusal.length ? refusal.words
                                        : "FAIL");
        if (u->map.image_count > 1) {
            lm_text_add(t, "  +");
            lm_text_number(t, u->map.image_count - 1, 1);
        }
    } else {
        add_pair(t, "LEVELS", u->map.is_usable ? u->map.db.lod_count : 0, "RECORDS",
                 u->map.is_usable ? u->map.db.record_count : 0);
    }
}

static void add_flags(uint32_t flags, struct lm_text *t)
{
    const bool has_any = (flags & ~(uint32_t)LM_FLAG_MALFUNCTION) != 0;
    lm_text_add(t, has_any ? "NOW" : "NOW  NO FAULT");
    for (uint32_t i = 0; i < LM_FLAGS; i++) {
        if (flags & ~(uint32_t)LM_FLAG_MALFUNCTION & 1u << i) {
            lm_text_add(t, "  ");
            lm_text_add(t, lm_flag_word(i));
        }
    }
}

/* A fault: hours, minutes and seconds since the start when it rose, and its word. */
static void add_fault(const struct lm_unit *u, uint32_t age, struct lm_text *t)
{
    const struct lm_fault *fault = lm_fault_log_at(&u->faults, age);
    if (!fault) {
        return;
    }
    const uint32_t seconds = (uint32_t)(fault->time_us / 1000000);
    lm_text_number(t, seconds / 3600, 2);
    lm_text_add(t, ":");
    lm_text_number(t, seconds / 60 % 60, 2);
    lm_text_add(t, ":");
    lm_text_number(t, seconds % 60, 2);
    lm_text_add(t, "  ");
    lm_text_add(t, lm_flag_word(fault->flag));
}

/* Apart from the faults, and never among them. All words together fit a row. */
static void add_broken(const struct lm_malfunctions *m, struct lm_text *t)
{
    static const char words[LM_MALFUNCTIONS][6] = {
        [LM_MALFUNCTION_NO_TRANSMIT] = "TX", [LM_MALFUNCTION_WEAK_TRANSMIT] = "WEAK",
        [LM_MALFUNCTION_NOISE] = "RX",       [LM_MALFUNCTION_STUCK] = "STUCK",
        [LM_MALFUNCTION_DRIFT] = "DRIFT",    [LM_MALFUNCTION_LOST_FROM] = "SECT",
        [LM_MALFUNCTION_LOST_TO] = "",       [LM_MALFUNCTION_FROZEN] = "VIDEO",
        [LM_MALFUNCTION_TILT] = "TILT",      [LM_MALFUNCTION_KEY] = "KEY",
    };
    for (uint32_t i = 0; i < LM_MALFUNCTIONS; i++) {
        if ((m->set >> i & 1) != 0 && words[i][0] != '\0') {
            lm_text_add(t, t->length == 0 ? "EXC " : " ");
            lm_text_add(t, words[i]);
        }
    }
}

struct lm_text lm_bit_row(const struct lm_unit *u, uint32_t row)
{
    struct lm_text t = {0};
    if (row < ROW_COUNTERS) {
        add_database(u, row, &t);
    } else if (row < ROW_COUNTERS + COUNTER_ROWS) {
        add_counters(u, row - ROW_COUNTERS, &t);
    } else if (row == ROW_NOW) {
        add_flags(u->flags, &t);
    } else if (row < ROW_RESTART) {
        add_fault(u, row - ROW_FAULTS, &t);
    } else if (row == ROW_RESTART) {
        add_restart(u, &t);
    } else { /* the last one */
        add_broken(&u->malfunctions.now, &t);
    }
    return t;
}
