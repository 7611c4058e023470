/* Menu of a program with sub-commands: prints the list, answers --help, --help=man, --help=list and
 * --version as hs/options.h does, and runs the command that was named. */
#ifndef HS_MENU_H
#define HS_MENU_H

struct hs_command {
    const char *name, *help; /* help: a few words, without a full stop */

    /* argv[0] is the command's own name. Returns the program's exit code (hs/error.h). */
    int (*run)(int argc, char **argv);
};

struct hs_menu {
    const char *program, *purpose; /* "landmass-db", and what it is for */
    const struct hs_command *commands;
    int count;
    const char *closing; /* printed below the commands, whole lines; may be NULL */
    void (*start)(void); /* called once before a command; may be NULL */
};

/* All that main() does. Names the program for hs_error. Returns its exit code. */
int hs_menu_main(const struct hs_menu *menu, int argc, char **argv);

#endif
