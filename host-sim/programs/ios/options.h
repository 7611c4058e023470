/* Command line of landmass-ios. */
#ifndef IOS_OPTIONS_H
#define IOS_OPTIONS_H

#include "hs/options.h"
#include "ios/request.h"

enum { DISPLAYS_MAX = 16, TOKEN_MAX = 128 };

struct display {
    char name[IOS_NAME_MAX + 1];
    long node;          /* its node on the bus; 0: not told */
    const char *folder; /* of its recordings; borrowed */
};

struct command {
    const char *can, *log_path; /* the bus; both NULL: pages among themselves */
    const char *out_path;
    const char *image_path, *site, *recordings; /* recordings NULL: none but the displays' */
    struct display display[DISPLAYS_MAX];
    int display_count;
    const char *bind;
    long port;
    struct hs_list hosts;
    const char *token_path;
    double seconds; /* 0: until it is interrupted */
    bool is_listening_only, is_quiet;
};

/* Returns true to go on. Otherwise *exit_code is an hs_exit: help was printed, or the mistake
 * reported. Free the command whatever is returned. */
bool ios_options_read(struct command *c, int argc, char **argv, int *exit_code);
void ios_options_free(struct command *c);

#endif
