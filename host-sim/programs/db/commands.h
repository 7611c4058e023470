/* The sub-commands of landmass-db. Each takes its own argv (argv[0] is its name) and returns an
 * hs_exit. */
#ifndef DB_COMMANDS_H
#define DB_COMMANDS_H

int db_cmd_import(int argc, char **argv);
int db_cmd_train(int argc, char **argv);
int db_cmd_segment(int argc, char **argv);
int db_cmd_mosaic(int argc, char **argv);
int db_cmd_correct(int argc, char **argv);
int db_cmd_vectors(int argc, char **argv);
int db_cmd_reflect(int argc, char **argv);
int db_cmd_infrared(int argc, char **argv);
int db_cmd_build(int argc, char **argv);
int db_cmd_plan(int argc, char **argv);
int db_cmd_join(int argc, char **argv);
int db_cmd_convert(int argc, char **argv);
int db_cmd_inspect(int argc, char **argv);
int db_cmd_sign(int argc, char **argv);
int db_cmd_verify(int argc, char **argv);
int db_cmd_export(int argc, char **argv);
int db_cmd_qgis(int argc, char **argv);
int db_cmd_picture(int argc, char **argv);

#endif
