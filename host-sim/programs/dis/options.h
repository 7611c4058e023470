/* Command line of landmass-dis. */
#ifndef DIS_OPTIONS_H
#define DIS_OPTIONS_H

#include "dis/gateway.h"
#include "hs/options.h"

struct command {
    const char *capture_path, *kinds_path, *image_path; /* NULL: not given */
    struct hs_list pdu_paths;
    const char *out_path, *can, *interface;
    const char *bind, *group;
    long listen_port, port; /* 0: not given */
    double seconds;         /* 0: no end */
    bool is_quiet, prints_kinds;
    bool is_cigi; /* the datagrams are of CIGI, not of DIS */
    struct dis_settings settings;
};

/* Returns true to go on. Otherwise *exit_code is an hs_exit: help was printed, or the mistake
 * reported. Free the command's lists whatever is returned. */
bool dis_options_read(struct command *c, int argc, char **argv, int *exit_code);
void dis_options_free(struct command *c);

#endif
