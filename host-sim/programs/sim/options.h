/* Command line of landmass-sim. */
#ifndef SIM_OPTIONS_H
#define SIM_OPTIONS_H

#include "lm/bus_event.h"
#include "lm/bus_profile.h"
#include "lm/glass_options.h"
#include "lm/port.h"

#include <stdbool.h>
#include <stdint.h>

struct options {
    const char *database, *radar, *bus_log, *can_interface, *bus_out, *script, *png_folder;
    const char *further[LM_IMAGES_MAX - 1]; /* images beside the database; NULL: none there */
    const char *record, *replay;            /* recordings to be written, and to be shown */
    double from_s;                          /* into the recording */
    double speed;                           /* of a recording in the window */
    bool is_any_replayed;                   /* what differs from the recording is a warning */
    double start_s;                         /* into the bus log */
    double seconds;                         /* 0: to the end of the bus log, or for ever */
    uint32_t every; /* of the pictures for --png; 0: only those the script asks for */
    uint32_t seed;  /* of the noise */
    uint16_t width_px, height_px;
    bool has_window, has_bezel, is_quiet;
    int heading;                          /* of the bus: 0 true, 1 magnetic */
    bool tells_reports;                   /* on the bus, as its node */
    bool obeys_controls;                  /* of the bus */
    const struct lm_bus_profile *profile; /* of the bus; NULL: the database's, or canas17 */
    const char *table;                    /* of the bus, a text; NULL: none */
    const char *bus_log_2;                /* the second interface; NULL: there is none */
    const struct lm_bus_profile *profile_2;
    const char *table_2;
    bool has_nodes; /* nodes.. are those that are heard */
    uint8_t nodes[LM_BUS_NODE_BYTES];
    uint8_t node;    /* on the bus; 0: it only listens */
    uint8_t partner; /* the other display's node; 0: there is none */
    struct lm_glass_options glass;
};

/* Returns true to run. Otherwise *exit_code is an hs_exit: help was printed, or the mistake
 * reported. */
bool options_read(struct options *o, int argc, char **argv, int *exit_code);

#endif
