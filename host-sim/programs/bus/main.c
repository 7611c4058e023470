/* landmass-bus: what the display takes from its bus, in the forms that other tools want. */
#include "bus/decode.h"
#include "bus/print.h"
#include "bus/table_text.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"

#include <errno.h>
#include <getopt.h>
#include <stdlib.h>
#include <string.h>

static const char help_text[] =
    "usage: landmass-bus COMMAND [OPTIONS] [LOG]\n"
    "Tell what the display takes from the avionics bus, and read a recorded bus.\n"
    "\n"
    "Commands:\n"
    "  table             the profile as a table of Markdown\n"
    "  dbc               the profile as a .dbc file, for analysers and other tools\n"
    "  filters           the kernel's filters, as candump takes them: can0,40C:C00007FF\n"
    "  decode [LOG]      each frame of a log of candump -L (of standard input without LOG):\n"
    "                    what it means, or why the display does not take it\n"
    "  fields            the fields that a table of your own may name, and their units\n"
    "\n"
    "Options:\n"
    "  --profile NAME    canas17 (the default), xcsoar, or generic: the one that was built in\n"
    "                    from a text table\n"
    "  --table FILE      a text table instead of a built-in profile; docs/bus.md explains it\n"
    "  --out FILE        where the text goes; without it, standard output\n"
    "  -h, --help        print this\n"
    "\n"
    "To try a table of your own on recorded traffic before it is built in:\n"
    "  landmass-bus decode --table my.bus flight.log\n"
    "Exit status: 0 done, 1 the work failed, 2 the command line makes no sense.\n";

struct command {
    const char *name;
    const char *log_path, *table_path, *out_path; /* NULL: not given */
    const struct lm_bus_profile *profile;
};

static int print_for(FILE *out, const struct command *c)
{
    if (strcmp(c->name, "table") == 0) {
        bus_print_table(out, c->profile);
    } else if (strcmp(c->name, "dbc") == 0) {
        bus_print_dbc(out, c->profile);
    } else if (strcmp(c->name, "filters") == 0) {
        bus_print_filters(out, c->profile);
    } else if (strcmp(c->name, "fields") == 0) {
        bus_print_fields(out);
    } else if (c->log_path == NULL || strcmp(c->log_path, "-") == 0) {
        return bus_decode(out, stdin, "standard input", c->profile);
    } else {
        FILE *in = hs_input_open(c->log_path, "r");
        if (in == NULL) {
            return hs_error(c->log_path, "landmass-nav and candump -L make one",
                            "cannot be opened: %s", strerror(errno));
        }
        const int status = bus_decode(out, in, c->log_path, c->profile);
        fclose(in);
        return status;
    }
    return 0;
}

static int run(const struct command *c)
{
    if (c->out_path == NULL) {
        const int status = print_for(stdout, c);
        if (status == 0 && (fflush(stdout) != 0 || ferror(stdout))) {
            return hs_error("standard output", "make room, or write to a file with --out", "%s",
                            strerror(errno));
        }
        return status;
    }
    struct hs_atomic_file file;
    if (c->log_path != NULL) {
        hs_input_note(c->log_path);
    }
    if (hs_atomic_open(&file, c->out_path) != 0) {
        return -1;
    }
    if (print_for(file.stream, c) != 0) {
        hs_atomic_abort(&file);
        return -1;
    }
    return hs_atomic_commit(&file);
}

static int read_table(struct bus_table *table, const char *path)
{
    FILE *in = hs_input_open(path, "r");
    if (in == NULL) {
        return hs_error(path, NULL, "cannot be opened: %s", strerror(errno));
    }
    const int status = bus_table_read(table, in, path);
    fclose(in);
    return status;
}

static void complain_of_profile(const char *name)
{
    char names[200] = "";
    for (const struct lm_bus_named_profile *p = lm_bus_profiles; p->name != NULL; p++) {
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used > 0 ? ", " : "one of ", p->name);
    }
    hs_error(name, names, "there is no such profile");
}

static bool is_command(const char *name)
{
    static const char *const names[] = {"table", "dbc", "filters", "decode", "fields"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        if (strcmp(names[i], name) == 0) {
            return true;
        }
    }
    return false;
}

/* HS_EXIT_OK to go on; -1 when help was printed; HS_EXIT_USAGE. */
static int read_options(struct command *c, int argc, char **argv)
{
    enum { OPT_PROFILE = 256, OPT_TABLE, OPT_OUT };
    static const struct option options[] = {
        {"profile", required_argument, NULL, OPT_PROFILE},
        {"table", required_argument, NULL, OPT_TABLE},
        {"out", required_argument, NULL, OPT_OUT},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    for (int code; (code = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
        switch (code) {
        case OPT_PROFILE:
            c->profile = lm_bus_profile_named(lm_bus_profiles, optarg);
            if (c->profile == NULL) {
                complain_of_profile(optarg);
                return HS_EXIT_USAGE;
            }
            break;
        case OPT_TABLE:
            c->table_path = optarg;
            break;
        case OPT_OUT:
            c->out_path = optarg;
            break;
        case 'h':
            fputs(help_text, stdout);
            return -1;
        default:
            return HS_EXIT_USAGE;
        }
    }
    c->name = optind < argc ? argv[optind++] : NULL;
    c->log_path = optind < argc ? argv[optind++] : NULL;
    if (c->name == NULL || !is_command(c->name) || optind < argc ||
        (c->log_path != NULL && strcmp(c->name, "decode") != 0)) {
        hs_error("command line", "try landmass-bus --help",
                 "expected one command, and for decode at most one log");
        return HS_EXIT_USAGE;
    }
    return HS_EXIT_OK;
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-bus");
    struct command c = {.profile = &lm_bus_canas17};
    const int status = read_options(&c, argc, argv);
    if (status != HS_EXIT_OK) {
        return status < 0 ? HS_EXIT_OK : status;
    }
    static struct bus_table table;
    if (c.table_path != NULL) {
        if (read_table(&table, c.table_path) != 0) {
            return HS_EXIT_FAILED;
        }
        c.profile = &table.profile;
    }
    return run(&c) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
