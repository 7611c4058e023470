/* The sub-commands of landmass-netem. Each takes its own argc and argv and returns an exit code. */
#ifndef NETEM_COMMANDS_H
#define NETEM_COMMANDS_H

int nm_cmd_register(int argc, char **argv);
int nm_cmd_train(int argc, char **argv);
int nm_cmd_score(int argc, char **argv);
int nm_cmd_simulate(int argc, char **argv);
int nm_cmd_bake(int argc, char **argv);
int nm_cmd_plot(int argc, char **argv);
int nm_cmd_recover(int argc, char **argv);
int nm_cmd_response(int argc, char **argv);
int nm_cmd_paper(int argc, char **argv);

#endif
