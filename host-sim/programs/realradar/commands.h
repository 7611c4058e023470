/* The two sub-commands of landmass-realradar. Each reads its own command line, argv[0] being its
 * name, and returns an exit code of hs/error.h. */
#ifndef REALRADAR_COMMANDS_H
#define REALRADAR_COMMANDS_H

/* A picture and the statistics of speckle and points, beside the firmware's. */
int rr_cmd_focus(int argc, char **argv);

/* Order and spread of the classes of a database beside a radar's picture. */
int rr_cmd_classes(int argc, char **argv);

#endif
