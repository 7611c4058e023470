/* landmass-panel: the display unit's firmware as an installed cockpit panel. */
#include "check_devices.h"
#include "config.h"
#include "panel.h"
#include "report.h"
#include "storage.h"

#include "bus/table_text.h"
#include "hs/error.h"
#include "lm/version.h"

#include <errno.h>
#include <fcntl.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2, EXIT_DEVICES = 3 };
static const char default_path[] = "/etc/landmass-panel.conf";

static const char help[] =
    "Usage: landmass-panel [--config FILE]\n"
    "       landmass-panel --check [--devices] [--config FILE]\n"
    "\n"
    "Run the display unit's firmware on this machine's bus, keys, hand controller and glass.\n"
    "\n"
    "  --config FILE  the configuration (default /etc/landmass-panel.conf)\n"
    "  --check        read the configuration and check the database's signature, report what is "
    "wrong, and\n"
    "                 end\n"
    "  --devices      with --check: try the devices, too; a panel that runs is not disturbed, and "
    "what\n"
    "                 it holds is not tried\n"
    "  --options      print every option of the configuration with its default\n"
    "  --version      print the version\n"
    "  -h, --help     this text\n"
    "\n"
    "SIGTERM, SIGINT and SIGHUP stop it; SIGUSR1 reports its counters.\n"
    "Exit codes: 0 stopped by a signal, or the check found nothing; 1 failed; 2 wrong command "
    "line; 3 a device has a fault.\n";

struct command {
    const char *path;
    bool is_path_given, is_check, tries_devices;
};

static void print_options(void)
{
    for (uint32_t i = 0; i < config_option_count(); i++) {
        const struct config_option o = config_option_at(i);
        printf("%s = %s\n    %s\n    %s\n", o.name, o.initial, o.values, o.help);
    }
}

/* -1: go on. Otherwise the exit code. */
static int read_command_line(struct command *c, int argc, char **argv)
{
    static const struct option options[] = {
        {"config", required_argument, NULL, 'c'},
        {"check", no_argument, NULL, 'k'},
        {"devices", no_argument, NULL, 'd'},
        {"options", no_argument, NULL, 'o'},
        {"version", no_argument, NULL, 'v'},
        {"help", no_argument, NULL, 'h'},
        {0},
    };
    *c = (struct command){.path = default_path};
    opterr = 0; /* the words are ours */
    int option;
    while ((option = getopt_long(argc, argv, ":h", options, NULL)) != -1) {
        switch (option) {
        case 'c':
            c->path = optarg;
            c->is_path_given = true;
            break;
        case 'k':
            c->is_check = true;
            break;
        case 'd':
            c->tries_devices = true;
            break;
        case 'o':
            print_options();
            return EXIT_DONE;
        case 'v':
            printf("landmass-panel %s\n", LM_VERSION);
            return EXIT_DONE;
        case 'h':
            printf("%s", help);
            return EXIT_DONE;
        default:
            report(REPORT_ERROR, "command line: %s \"%s\"; landmass-panel --help",
                   option == ':' ? "the value is missing of" : "there is no option",
                   argv[optind - 1]);
            return EXIT_USAGE;
        }
    }
    if (optind < argc) {
        report(REPORT_ERROR, "command line: \"%s\" is not an option; landmass-panel --help",
               argv[optind]);
        return EXIT_USAGE;
    }
    if (c->tries_devices && !c->is_check) {
        report(REPORT_ERROR, "command line: --devices needs --check; landmass-panel --help");
        return EXIT_USAGE;
    }
    return -1;
}

static void report_line(void *ctx, uint32_t line, const char *cause)
{
    const struct command *c = ctx;
    report(REPORT_ERROR, "%s line %u: %s", c->path, line, cause);
}

/* The whole file, or as much as there is room for. -1 with errno. */
static ssize_t read_file(const char *path, char *text, size_t room)
{
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    if (fd < 0) {
        return -1;
    }
    size_t size = 0;
    ssize_t got = 0;
    while (size < room && (got = read(fd, text + size, room - size)) > 0) {
        size += (size_t)got;
    }
    const int cause = errno;
    close(fd);
    errno = cause;
    return got < 0 ? -1 : (ssize_t)size;
}

/* The number of wrong lines, or -1 when there is no file to be read. */
static int read_config(struct command *c, struct config *config)
{
    char text[CONFIG_FILE_BYTES + 1];
    config_defaults(config);
    const ssize_t size = read_file(c->path, text, sizeof text);
    if (size < 0 && errno == ENOENT && !c->is_path_given) {
        report(REPORT_WARNING, "%s: %s; every option has its default", c->path, strerror(errno));
        return 0;
    }
    if (size < 0 || (size_t)size == sizeof text) {
        report(REPORT_ERROR, "%s: %s", c->path, size < 0 ? strerror(errno) : "longer than 64 KiB");
        return -1;
    }
    return (int)config_read(config, text, (size_t)size, report_line, c);
}

/* What --check finds in the files that the configuration names, beside its own lines. */
static bool are_files_sound(const struct config *config)
{
    static struct bus_table table;
    const char *const paths[] = {config->can_table, config->can_2_table};
    bool is_sound = true;
    for (size_t i = 0; i < 2; i++) {
        is_sound = (paths[i][0] == '\0' || bus_table_load(&table, paths[i]) == 0) && is_sound;
    }
    return storage_check(config) && is_sound;
}

static int check(const struct command *c, const struct config *config, int wrong)
{
    const bool is_sound = wrong == 0 && are_files_sound(config);
    const int faults = wrong >= 0 && c->tries_devices ? check_devices(config) : 0;
    return !is_sound ? EXIT_FAILED : faults > 0 ? EXIT_DEVICES : EXIT_DONE;
}

int main(int argc, char **argv)
{
    struct config config;
    struct panel panel;
    struct command command;
    hs_set_program("landmass-panel");
    const int code = read_command_line(&command, argc, argv);
    if (code >= 0) {
        return code;
    }
    const int wrong = read_config(&command, &config);
    if (wrong < 0 || command.is_check) {
        return check(&command, &config, wrong);
    }
    if (wrong > 0) {
        report(REPORT_WARNING, "%s: %d wrong lines; their options keep the defaults", command.path,
               wrong);
    }
    if (panel_open(&panel, &config) != 0) {
        return EXIT_FAILED;
    }
    panel_run(&panel);
    panel_close(&panel);
    return EXIT_DONE;
}
