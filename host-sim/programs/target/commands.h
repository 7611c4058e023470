/* The sub-commands of landmass-target. Each takes its own argc and argv and returns an exit code.
 */
#ifndef TARGET_COMMANDS_H
#define TARGET_COMMANDS_H

int target_cmd_model(int argc, char **argv);
int target_cmd_trace(int argc, char **argv);
int target_cmd_render(int argc, char **argv);
int target_cmd_map(int argc, char **argv);
int target_cmd_sheet(int argc, char **argv);
int target_cmd_bake(int argc, char **argv);
int target_cmd_curves(int argc, char **argv);
int target_cmd_materials(int argc, char **argv);
int target_cmd_bench(int argc, char **argv);

#endif
