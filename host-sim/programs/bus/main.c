/* landmass-bus: what the display takes from its bus, in the forms that other tools want. */
#include "bus/decode.h"
#include "bus/print.h"
#include "bus/table_text.h"
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/menu.h"
#include "hs/options.h"
#include "hs/report.h"

#include <errno.h>
#include <string.h>

struct command {
    const char *name;
    const char *log_path, *table_path, *out_path, *profile_name; /* NULL: not given */
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
    } else if (strcmp(c->name, "reports") == 0) {
        bus_print_reports(out);
    } else if (strcmp(c->name, "controls") == 0) {
        bus_print_controls(out);
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
    if (hs_atomic_open(&file, c->out_path) != 0) {
        return -1;
    }
    if (print_for(file.stream, c) != 0) {
        hs_atomic_abort(&file);
        return -1;
    }
    return hs_atomic_commit(&file);
}

static int find_profile(struct command *c)
{
    c->profile = lm_bus_profile_named(lm_bus_profiles, c->profile_name);
    if (c->profile != NULL) {
        return 0;
    }
    char names[200] = "";
    for (const struct lm_bus_named_profile *p = lm_bus_profiles; p->name != NULL; p++) {
        const size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%s", used > 0 ? ", " : "one of ", p->name);
    }
    return hs_error(c->profile_name, names, "there is no such profile");
}

static bool read_options(struct command *c, const struct hs_usage *usage, int argc, char **argv,
                         int *exit_code)
{
    const struct hs_option options[] = {
        {"profile", HS_TEXT, &c->profile_name, 0, 0, "NAME",
         "canas17 (left out), xcsoar, or generic: the one that was built in from a text table",
         false},
        {"table", HS_INPUT, &c->table_path, 0, 0, "FILE",
         "a text table instead of a built-in profile; docs/bus.md explains it", false},
        {"out", HS_OUTPUT, &c->out_path, 0, 0, "FILE",
         "where the text goes; left out: standard output", false},
        HS_CLASHES_ROW("profile", "table"),
        {"LOG", HS_INPUT_ARGUMENT, &c->log_path, 0, 0, NULL,
         "of candump -L; left out: standard input", false},
    };
    const size_t count = sizeof options / sizeof options[0];
    const bool has_log = strcmp(c->name, "decode") == 0;
    return hs_options_read(usage, options, has_log ? count : count - 1, argc, argv, exit_code);
}

static int run_command(const struct hs_usage *usage, int argc, char **argv)
{
    struct command c = {.name = usage->command, .profile_name = "canas17"};
    int exit_code;
    if (!read_options(&c, usage, argc, argv, &exit_code)) {
        return exit_code;
    }
    if (find_profile(&c) != 0) {
        return HS_EXIT_USAGE;
    }
    static struct bus_table table;
    if (c.table_path != NULL) {
        if (bus_table_load(&table, c.table_path) != 0) {
            return HS_EXIT_FAILED;
        }
        c.profile = &table.profile;
    }
    hs_report_put("items", c.profile->row_count);
    return run(&c) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

static const struct hs_usage usages[] = {
    {"table", "the profile as a table of Markdown", "What the display takes from the bus."},
    {"dbc", "the profile as a .dbc file, for analysers and other tools",
     "The usual description of a CAN bus."},
    {"filters", "the kernel's filters, as candump takes them",
     "A line a filter: can0,40C:C00007FF. To hear what the display hears:\n"
     "\n"
     "  candump -L can0,$(landmass-bus filters | paste -sd, -)"},
    {"decode", "what each frame of a log means, or why the display does not take it",
     "To try a table of your own on recorded traffic before it is built in:\n"
     "\n"
     "  landmass-bus decode --table my.bus flight.log"},
    {"reports", "what the display tells the other avionics, as a table of Markdown",
     "The same whatever the profile: reports are frames of CANaerospace."},
    {"controls", "what the operator does, told and obeyed, as a table of Markdown",
     "The same whatever the profile: control frames are frames of CANaerospace."},
    {"fields", "the fields that a table of your own may name, and their units",
     "docs/bus.md explains the table."},
};
enum { COMMANDS = sizeof usages / sizeof usages[0] };

/* argv[0] is one of their names. */
static int run_named(int argc, char **argv)
{
    int i = 0;
    while (i < COMMANDS - 1 && strcmp(usages[i].command, argv[0]) != 0) {
        i++;
    }
    return run_command(&usages[i], argc, argv);
}

int main(int argc, char **argv)
{
    struct hs_command commands[COMMANDS];
    for (int i = 0; i < COMMANDS; i++) {
        commands[i] = (struct hs_command){usages[i].command, usages[i].summary, run_named};
    }
    const struct hs_menu menu = {
        .program = "landmass-bus",
        .purpose = "what the display takes from the avionics bus, and a recorded bus read",
        .commands = commands,
        .count = COMMANDS};
    return hs_menu_main(&menu, argc, argv);
}
